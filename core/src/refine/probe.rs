//! Where a silhouette's outline crosses a normal.
//!
//! Readings are whole numbers: places of 1/16 777 216 pixel counted from the middle of the sample's own pixel, shares of a pixel
//! of 1/32 768. A reading takes some tens of instructions where floating point is made by software, as on the smallest
//! microcontrollers, and is the same on every target.

use super::border::{BorderPixel, Residual};
use crate::image::mask::Mask;
use crate::image::silhouette::Silhouette;

/// Distance between readings along a normal, pixels.
const STEP: f32 = 0.5;
/// Most of them to one side: a place must stay within 32 bits.
const MOST_STEPS: i32 = 127;

/// Binary places of a place along a row or column.
const PLACES: u32 = 24;
/// Binary places of a share of a pixel, and the bits of a place below them.
const SHARE: u32 = 15;
const ONE: u32 = 1 << SHARE;
/// Of a pixel that is all inside: a product of two shares. The outline is where half of it is.
const WHOLE: i32 = 1 << (2 * SHARE);
const HALF: i32 = WHOLE / 2;

/// Readings to one side of a sample, as many as a distance of so many pixels takes: told once for many samples.
pub(super) const fn steps_within(range: f64) -> i32 {
    let steps = (range / STEP as f64) as i32;
    if steps < MOST_STEPS {
        steps
    } else {
        MOST_STEPS
    }
}

/// Where the outline of `silhouette` crosses the normal of a sample, within so many steps ([`steps_within`]): its distance from the middle of the
/// sample's pixel along the outward normal. [`Residual::Missing`] where it does not.
///
/// The mask is read by bilinear interpolation between pixel centres; the outline is where it is
/// one half. From inside the first crossing outwards is taken, from outside the first inwards.
pub(super) fn crossing(silhouette: &Silhouette<'_>, sample: &BorderPixel, steps: i32) -> Residual {
    crossing_along(silhouette, sample, sample.normal(), steps)
}

/// The same along the normal of the sample where that is known already.
pub(super) fn crossing_along(
    silhouette: &Silhouette<'_>,
    sample: &BorderPixel,
    normal: [f32; 2],
    steps: i32,
) -> Residual {
    let Some(inside) = at_centre(silhouette, sample) else {
        return Residual::Unknown;
    };
    let direction = if inside { 1 } else { -1 };
    let walk = Walk::of(silhouette, sample, normal, direction);
    let mut value = if inside { WHOLE } else { 0 };
    for step in 1..steps + 1 {
        let Some(next) = walk.coverage(step) else {
            return Residual::Unknown;
        };
        if (next >= HALF) != inside {
            let share = (value - HALF) as f32 / (value - next) as f32;
            return Residual::Px(direction as f32 * STEP * ((step - 1) as f32 + share));
        }
        value = next;
    }
    Residual::Missing
}

/// Whether a sample's pixel is in the silhouette; `None` where it or one of the three after it is not known.
fn at_centre(silhouette: &Silhouette<'_>, sample: &BorderPixel) -> Option<bool> {
    let (column, row) = (usize::from(sample.column), usize::from(sample.row));
    let mask = silhouette.mask();
    let unknown = |unknown: &Mask<'_>| unknown.square(column, row) != 0;
    let beyond = column + 1 >= mask.width() || row + 1 >= mask.height();
    let known = !beyond && !silhouette.unknown().is_some_and(unknown);
    known.then(|| mask.square_within(column, row) & 1 != 0)
}

/// The way along a normal to one side.
struct Walk<'w, 's> {
    silhouette: &'w Silhouette<'s>,
    column: i32,
    row: i32,
    /// A step to the right and downwards.
    step: [i32; 2],
    /// Pixels with a neighbour to the right and below.
    columns: u32,
    rows: u32,
}

impl<'w, 's> Walk<'w, 's> {
    fn of(
        silhouette: &'w Silhouette<'s>,
        sample: &BorderPixel,
        normal: [f32; 2],
        direction: i32,
    ) -> Self {
        let scale = direction as f32 * STEP * (1u32 << PLACES) as f32;
        let last = |side: usize| side.saturating_sub(1) as u32;
        let mask = silhouette.mask();
        Self {
            silhouette,
            column: i32::from(sample.column),
            row: i32::from(sample.row),
            // Exact but for what is cut off: 24 bits times a power of two.
            step: [(normal[0] * scale) as i32, (normal[1] * scale) as i32],
            columns: last(mask.width()),
            rows: last(mask.height()),
        }
    }

    /// The mask after some steps, between the centres of four pixels. `None` beyond the outermost centres and where one of the
    /// four is unknown.
    #[inline]
    fn coverage(&self, steps: i32) -> Option<i32> {
        let (right, down) = (self.step[0] * steps, self.step[1] * steps);
        let (left, above) = (self.column + (right >> PLACES), self.row + (down >> PLACES));
        // Below zero is beyond too.
        if left as u32 >= self.columns || above as u32 >= self.rows {
            // Beside a part of a frame that is all of the silhouette there is nothing of it.
            return self.silhouette.is_clear_beyond(left, above).then_some(0);
        }
        let (left, above) = (left as usize, above as usize);
        if let Some(unknown) = self.silhouette.unknown()
            && unknown.square(left, above) != 0
        {
            return None;
        }
        // Most squares are all inside or all outside.
        match self.silhouette.mask().square_within(left, above) {
            0 => Some(0),
            0b1111 => Some(WHOLE),
            square => Some(between(square, share(right), share(down))),
        }
    }
}

/// How far a place is beyond the middle of the pixel before it.
fn share(place: i32) -> u32 {
    (place as u32) << (u32::BITS - PLACES) >> (u32::BITS - SHARE)
}

/// Four pixels, from the lowest bit, read a share to the right and a share down between their middles.
fn between(square: u32, right: u32, down: u32) -> i32 {
    // Without a branch and a call, for each of some readings of a sample.
    let bit = |place: u32| square >> place & 1;
    let above = bit(0) * (ONE - right) + bit(1) * right;
    let below = bit(2) * (ONE - right) + bit(3) * right;
    (above * (ONE - down) + below * down) as i32
}

/// How far the drawn model's own outline may be from the middle of a border pixel, pixels.
const OWN_RANGE: f64 = 3.0;
/// The same in steps.
pub(super) const OWN_STEPS: i32 = steps_within(OWN_RANGE);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::mask::{MaskMut, Word, words_needed};
    use core::cell::Cell;
    use proptest::prelude::*;
    use std::vec;

    const WIDTH: usize = 70;
    const HEIGHT: usize = 60;

    /// What two readings, whose shares are whole numbers of 2^-15, may be off together.
    const GRAIN: f64 = 4.0 / 32768.0;

    /// Oracle: in 64-bit floating point, pixel by pixel. Gives also how near a reading came to where it would have been decided
    /// otherwise, and how far a crossing may be off, pixels: the flatter the readings beside it, the farther.
    fn naive(mask: &Mask<'_>, sample: &BorderPixel, range: f64) -> (Residual, f64, f64) {
        let [right, down] = sample.slope.map(f64::from);
        let length = libm::hypot(right, down);
        let brink = Cell::new(f64::INFINITY);
        let coverage = |t: f64| {
            let column = f64::from(sample.column) + t * right / length;
            let row = f64::from(sample.row) + t * down / length;
            let within = |x: f64, side: usize, moves: bool| {
                let end = side as f64 - 1.0;
                // What goes along it stays where it is; all else may be rounded over it.
                if moves {
                    brink.set(brink.get().min(x.abs()).min((end - x).abs()));
                }
                x >= 0.0 && x < end
            };
            if !within(column, WIDTH, right != 0.0) | !within(row, HEIGHT, down != 0.0) {
                return None;
            }
            let (left, above) = (column as usize, row as usize);
            let (x, y) = (column - left as f64, row - above as f64);
            let at = |c: usize, r: usize| f64::from(u8::from(mask.get(left + c, above + r)));
            let upper = at(0, 0) * (1.0 - x) + at(1, 0) * x;
            let lower = at(0, 1) * (1.0 - x) + at(1, 1) * x;
            Some(upper * (1.0 - y) + lower * y)
        };
        let Some(mut value) = coverage(0.0) else {
            return (Residual::Unknown, 1.0, 0.0);
        };
        let (direction, mut nearest) = (if value >= 0.5 { 1.0 } else { -1.0 }, (value - 0.5).abs());
        brink.set(f64::INFINITY);
        for step in 1..=(2.0 * range) as usize {
            let t = direction * step as f64 / 2.0;
            let next = coverage(t);
            nearest = nearest.min(brink.get());
            let Some(next) = next else {
                return (Residual::Unknown, nearest, 0.0);
            };
            nearest = nearest.min((next - 0.5).abs());
            if (next >= 0.5) != (value >= 0.5) {
                let share = (value - 0.5) / (value - next);
                return (
                    Residual::Px((t - direction * 0.5 * (1.0 - share)) as f32),
                    nearest,
                    0.5 * GRAIN / (value - next).abs(),
                );
            }
            value = next;
        }
        (Residual::Missing, nearest, 0.0)
    }

    /// Half a plane, with speckles where `noise` has a bit.
    fn half_plane(noise: &[Word], turn: f64, from: f64) -> std::vec::Vec<Word> {
        let mut words = vec![0; words_needed(WIDTH, HEIGHT)];
        let mut mask = MaskMut::new(&mut words, WIDTH, HEIGHT).expect("fits");
        let (sin, cos) = libm::sincos(turn);
        for row in 0..HEIGHT {
            for column in 0..WIDTH {
                let (x, y) = (column as f64 - 35.2, row as f64 - 30.7);
                let noisy = noise[(row * WIDTH + column) % noise.len()].is_multiple_of(16);
                mask.set(column, row, (x * cos + y * sin < from) != noisy);
            }
        }
        words
    }

    properties! {
        #[test]
        fn readings_in_whole_numbers_are_those_in_floating_point(
            noise in proptest::collection::vec(any::<Word>(), 1..300),
            turn in 0.0..7.0f64, from in -20.0..20.0f64,
            column in 0..WIDTH as u16, row in 0..HEIGHT as u16,
            slope in (-160i16..=160, -160i16..=160), range in 1.0..48.0f64,
        ) {
            prop_assume!(slope != (0, 0));
            let words = half_plane(&noise, turn, from);
            let mask = Mask::new(&words, WIDTH, HEIGHT).expect("fits");
            let sample = BorderPixel { column, row, slope: [slope.0, slope.1], ..BorderPixel::EMPTY };
            let (wanted, nearest, off) = naive(&mask, &sample, range);
            // Of what is as near as rounding nobody can tell which way it falls.
            prop_assume!(nearest > 1e-3);
            match (crossing(&(&mask).into(), &sample, steps_within(range)), wanted) {
                (Residual::Px(a), Residual::Px(b)) => {
                    prop_assert!(f64::from((a - b).abs()) < off + 1e-5, "{a} for {b}, within {off}");
                }
                (found, wanted) => prop_assert_eq!(found, wanted),
            }
        }
    }

    #[test]
    fn along_rows_and_columns_readings_are_exact() {
        let words = half_plane(&[1], 0.0, 4.3);
        let mask = Mask::new(&words, WIDTH, HEIGHT).expect("fits");
        for (column, wanted) in [(30, 9.5), (39, 0.5), (45, -5.5)] {
            let sample = BorderPixel {
                column,
                row: 9,
                slope: [77, 0],
                ..BorderPixel::EMPTY
            };
            assert_eq!(
                crossing(&(&mask).into(), &sample, steps_within(20.0)),
                Residual::Px(wanted)
            );
        }
    }
}
