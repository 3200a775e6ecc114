//! Which samples of an outline are compared with each other, and in which bin of distance.

use super::border::BorderPixel;

/// Bins of distance.
pub(super) const BINS: usize = 24;

/// One part of so many of an outline's length: samples farther apart are not compared. A fit of six numbers takes waves of up to three
/// periods out of an outline, so that half a period of the shortest of them is the farthest over which residuals still tell what erred
/// alike. An outline's length and not pixels, because what errs is of the part, its film or the hand: it grows with the picture.
const REACH_IN: f32 = 6.0;
/// Nothing is compared over more pixels than this, whose squares are whole numbers of 32 bits.
const FARTHEST: f32 = 30_000.0;
/// A bin holds at least so many samples' distances, so that hardly any is empty.
const LEAST_SAMPLES: f32 = 2.0;

/// A bin's number, from 1, by the square of a distance in bins.
const BIN_OF: [u8; BINS * BINS] = {
    let mut bins = [0; BINS * BINS];
    let (mut square, mut bin) = (0, 1);
    while square < bins.len() {
        if square >= bin as usize * bin as usize {
            bin += 1;
        }
        bins[square] = bin;
        square += 1;
    }
    bins
};
/// Bins squared are counted in parts of this.
const ONE_BIN: f32 = (1 << 20) as f32;

/// Bins of distance for an outline.
#[derive(Clone, Copy)]
pub(super) struct Distances {
    /// Least distance that is not compared any more, pixels.
    reach: i32,
    width_px: f32,
    /// Of [`ONE_BIN`], for each square pixel.
    per_square: u32,
    /// Mean distance between samples, pixels.
    apart_px: f32,
}

impl Distances {
    /// For the samples of an outline whose residuals are known.
    pub(super) fn of(border: &[BorderPixel]) -> Self {
        let known = border.iter().filter(|one| one.has_residual());
        let (count, length) = known.fold((0.0f32, 0.0), |(count, length), one| {
            (count + 1.0, length + one.weight)
        });
        let apart_px = length / count.max(1.0);
        let reach_px = (length / REACH_IN).clamp(1.0, FARTHEST);
        let width_px = (reach_px / BINS as f32).max(LEAST_SAMPLES * apart_px);
        Self {
            reach: reach_px as i32,
            width_px,
            per_square: (ONE_BIN / (width_px * width_px)) as u32,
            apart_px,
        }
    }

    /// The first bins alone.
    pub(super) fn of_first(&self, bins: usize) -> Self {
        let reach = (self.width_px * bins as f32) as i32 + 1;
        Self {
            reach: if bins == 0 { 0 } else { self.reach.min(reach) },
            ..*self
        }
    }

    /// Number of bins within reach.
    pub(super) fn bins(&self) -> usize {
        ((self.reach as f32 / self.width_px) as usize + 1).min(BINS)
    }

    pub(super) fn width_px(&self) -> f32 {
        self.width_px
    }

    /// Mean distance between samples, pixels.
    pub(super) fn apart_px(&self) -> f32 {
        self.apart_px
    }

    /// One of so many samples is compared with those after it: as many pairs as if bins were as narrow as can be, however long the
    /// outline is.
    pub(super) fn one_in(&self) -> u32 {
        let samples = LEAST_SAMPLES * BINS as f32 * self.apart_px;
        (self.reach as f32 / samples) as u32 + 1
    }

    /// The samples listed after one that are within reach of it and on the same side of the part, with their places in the list and
    /// the bin of their distance; of one sample in [`Self::one_in`] alone.
    pub(super) fn after<'b>(
        &self,
        border: &'b [BorderPixel],
        index: usize,
    ) -> impl Iterator<Item = (usize, &'b BorderPixel, usize)> {
        let (reach, per_square) = (self.reach, self.per_square);
        let sample = border.get(index).copied().unwrap_or_default();
        let offset = |a: u16, b: u16| i32::from(a) - i32::from(b);
        let end = if is_one(index, self.one_in()) {
            border.len()
        } else {
            0
        };
        // They are listed row by row.
        let close = move |other: &&BorderPixel| offset(other.row, sample.row) < reach;
        let rest = border.get(index + 1..end).unwrap_or_default();
        let rest = (index + 1..).zip(rest.iter().take_while(close));
        rest.filter_map(move |(number, other)| {
            let right = offset(other.column, sample.column);
            if right.abs() >= reach {
                return None;
            }
            let down = offset(other.row, sample.row);
            let square = (right * right + down * down) as u32;
            if square >= (reach * reach) as u32 {
                return None;
            }
            let bin = *BIN_OF.get(((square * per_square) >> 20) as usize)?;
            let counts = other.has_residual() && alike(sample.slope, other.slope);
            counts.then_some((number, other, usize::from(bin)))
        })
    }
}

/// Whether a number is one of so many, spread evenly also over every second number, every third and so on: an outline crosses each row
/// of the frame as many times, and its samples are listed row by row.
fn is_one(number: usize, of: u32) -> bool {
    const GOLDEN: u32 = 0x9e37_79b9;
    (number as u32).wrapping_mul(GOLDEN) <= u32::MAX / of.max(1)
}

/// Whether the cosine between two normals is at least one half: the two sides of a thin plate err apart. In whole numbers, because
/// there are many pairs; slopes are at most 160.
fn alike(a: [i16; 2], b: [i16; 2]) -> bool {
    let dot = |a: [i16; 2], b: [i16; 2]| {
        i32::from(a[0]) * i32::from(b[0]) + i32::from(a[1]) * i32::from(b[1])
    };
    let along = dot(a, b);
    let squares = dot(a, a) as u32 * dot(b, b) as u32;
    along >= 0 && along as u32 * along as u32 >= squares.div_ceil(4)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::refine::border::Residual;
    use proptest::prelude::*;
    use std::vec::Vec;

    fn samples(places: &[(u16, u16)], weight: f32) -> Vec<BorderPixel> {
        let mut places = places.to_vec();
        places.sort_unstable();
        places.dedup();
        let sample = |(row, column)| BorderPixel {
            column,
            row,
            slope: [3, 1],
            weight,
            residual: Residual::Px(0.5).into(),
            ..BorderPixel::EMPTY
        };
        places.into_iter().map(sample).collect()
    }

    properties! {
        #[test]
        fn bins_are_those_of_the_distance(
            places in proptest::collection::vec((0u16..400, 0u16..400), 20..300), weight in 0.7f32..9.0,
        ) {
            let border = samples(&places, weight);
            let distances = Distances::of(&border);
            let (reach, width) = (f64::from(distances.reach), f64::from(distances.width_px));
            prop_assert!(distances.bins() as f64 * width >= reach || distances.bins() == BINS);
            for (index, sample) in border.iter().enumerate() {
                let mut found = distances.after(&border, index).peekable();
                if found.peek().is_none() {
                    continue;
                }
                prop_assert!(is_one(index, distances.one_in()));
                let mut expected = Vec::new();
                for (number, other) in border.iter().enumerate().skip(index + 1) {
                    let away = |a: u16, b: u16| f64::from(a) - f64::from(b);
                    let px = away(other.row, sample.row).hypot(away(other.column, sample.column));
                    if px < reach {
                        expected.push((number, px / width));
                    }
                }
                let found: Vec<_> = found.collect();
                prop_assert_eq!(found.len(), expected.len());
                for ((number, _, bin), (place, bins)) in found.into_iter().zip(expected) {
                    prop_assert_eq!(number, place);
                    // Squares are counted in whole parts.
                    prop_assert!((bins - bin as f64 + 0.5).abs() < 0.51, "{} {}", bins, bin);
                }
            }
        }
    }

    properties! {
        #[test]
        fn of_the_first_bins_no_pair_is_left_out_and_none_beyond_them_compared(
            places in proptest::collection::vec((0u16..90, 0u16..90), 20..200), bins in 0usize..BINS,
        ) {
            let border = samples(&places, 2.0);
            let all = Distances::of(&border);
            let first = all.of_first(bins);
            prop_assert_eq!((all.one_in(), first.one_in()), (1, 1));
            let end = f64::from(all.width_px()) * bins as f64;
            for index in 0..border.len() {
                let count = |of: Distances, most: f64| {
                    let place = |one: &BorderPixel| (f64::from(one.column), f64::from(one.row));
                    let near = of.after(&border, index).filter(|(_, other, _)| {
                        let ((a, b), (c, d)) = (place(&border[index]), place(other));
                        (a - c).hypot(b - d) < most
                    });
                    near.count()
                };
                prop_assert_eq!(count(first, end), count(all, end));
                prop_assert_eq!(count(first, f64::INFINITY), count(first, if bins == 0 { 0.0 } else { end + 1.0 }));
            }
        }
    }

    /// An outline that crosses each row four times would lose the same two of its sides by every second sample.
    #[test]
    fn one_of_so_many_is_of_every_side_alike() {
        for of in 1..12u32 {
            for crossings in 1..7usize {
                for side in 0..crossings {
                    let numbers = (side..crossings * 600).step_by(crossings);
                    let kept = numbers.filter(|&number| is_one(number, of)).count();
                    let expected = 600.0 / f64::from(of);
                    assert!(
                        (kept as f64 - expected).abs() < 4.0,
                        "{kept} for {expected}"
                    );
                }
            }
        }
    }
}
