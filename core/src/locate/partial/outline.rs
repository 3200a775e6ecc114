//! An outline as points at equal distances with normals.

use heapless::Vec;

use super::smooth::{Plane, Smooth, resample};
use super::trace::{PixelSide, STRETCHES, Stretch};
use crate::math::sqrt;

/// A point of an outline in plane coordinates (to the right and upwards) and the unit normal that
/// leads out of the silhouette there. Opaque: the caller only provides memory for a number of them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OutlinePoint {
    pub(super) at: [f32; 2],
    pub(super) normal: [f32; 2],
}

/// Consecutive points along a stretch of an outline.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece<'a> {
    /// At least three.
    pub(super) points: &'a [OutlinePoint],
    /// Whether the last point is followed by the first.
    pub(super) closed: bool,
    /// Between neighbours, pixel widths.
    pub(super) step: f64,
}

impl Piece<'_> {
    /// Pixel widths.
    pub(super) fn length(&self) -> f64 {
        self.step * (self.points.len() - usize::from(!self.closed)) as f64
    }
}

/// An outline: the points of all its stretches, one stretch after another.
pub(super) struct OutlinePoints<'a> {
    pub(super) points: &'a [OutlinePoint],
    stretches: Vec<(Stretch, f64), STRETCHES>,
    /// Length of all stretches, pixel widths.
    pub(super) length: f64,
}

/// How sides become points.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sampling {
    pub(super) plane: Plane,
    /// Neighbours on either side that a point is averaged over.
    pub(super) reach: usize,
    /// Between points, pixel widths.
    pub(super) spacing: f64,
}

impl<'a> OutlinePoints<'a> {
    /// Points along `stretches` of `sides`; `None` where `points` is too short.
    pub(super) fn new(
        sides: &[PixelSide],
        stretches: &[Stretch],
        sampling: &Sampling,
        points: &'a mut [OutlinePoint],
    ) -> Option<Self> {
        let mut outline = Self {
            points: &[],
            stretches: Vec::new(),
            length: 0.0,
        };
        let mut used = 0;
        for stretch in stretches {
            let sides = sides.get(stretch.start..stretch.end)?;
            let rest = points.get_mut(used..)?;
            let line = Smooth::new(sides, stretch.closed, sampling.reach, sampling.plane);
            let (count, step) = write_points(&line, sampling.spacing, rest)?;
            if count < 3 {
                continue;
            }
            set_normals(rest.get_mut(..count)?, stretch.closed);
            let stretch = Stretch {
                start: used,
                end: used + count,
                closed: stretch.closed,
            };
            used += count;
            outline.length += step * (count - usize::from(!stretch.closed)) as f64;
            // As many as there are stretches of sides, at most.
            let _ = outline.stretches.push((stretch, step));
        }
        outline.points = points.get(..used)?;
        Some(outline)
    }

    /// The stretches.
    pub(super) fn pieces(&self) -> impl Iterator<Item = Piece<'a>> + '_ {
        self.stretches.iter().filter_map(|(stretch, step)| {
            Some(Piece {
                points: self.points.get(stretch.start..stretch.end)?,
                closed: stretch.closed,
                step: *step,
            })
        })
    }
}

/// Writes points along a line and gives their number and distance; `None` where `points` is too
/// short.
fn write_points(
    line: &Smooth<'_>,
    spacing: f64,
    points: &mut [OutlinePoint],
) -> Option<(usize, f64)> {
    let mut count = 0;
    let step = resample(line, spacing, points.len(), |[x, y]| {
        if let Some(point) = points.get_mut(count) {
            point.at = [x as f32, y as f32];
            count += 1;
        }
    })?;
    Some((count, step))
}

/// Outward normals across the line from the point before to the point after each.
fn set_normals(points: &mut [OutlinePoint], closed: bool) {
    let count = points.len();
    for index in 0..count {
        let (before, after) = if closed {
            ((index + count - 1) % count, (index + 1) % count)
        } else {
            (index.saturating_sub(1), (index + 1).min(count - 1))
        };
        let (a, b) = (points[before].at, points[after].at);
        let (x, y) = (f64::from(b[0] - a[0]), f64::from(b[1] - a[1]));
        // Where a line turns back on itself it has no normal.
        let length = sqrt(x * x + y * y).max(1e-6);
        // The silhouette is on the right hand.
        points[index].normal = [(-y / length) as f32, (x / length) as f32];
    }
}

#[cfg(test)]
mod tests {
    use super::super::trace::trace;
    use super::*;
    use crate::image::mask::{MaskMut, words_needed};
    use crate::image::silhouette::Silhouette;

    const WIDTH: usize = 128;
    const HEIGHT: usize = 64;

    /// Columns 30 to 90 and rows 10 to 50, or all of these columns and those to the left of them.
    fn rectangle(from: i64, look: impl Fn(&OutlinePoints<'_>)) {
        let mut words = std::vec![0; words_needed(WIDTH, HEIGHT)];
        let mut mask = MaskMut::new(&mut words, WIDTH, HEIGHT).expect("fits");
        (10..50).for_each(|row| mask.fill_span(row, from, 90));
        let mask = mask.into_mask();
        let mut memory = std::vec![0; words_needed(WIDTH, HEIGHT)];
        let mut visited = MaskMut::new(&mut memory, WIDTH, HEIGHT).expect("fits");
        let mut sides = [PixelSide::default(); 400];
        let silhouette = Silhouette::from(&mask);
        let stretches = trace(&silhouette, &mut visited, &mut sides, 5).expect("fits");
        let sampling = Sampling {
            plane: Plane::new(WIDTH, HEIGHT, 1.0),
            reach: 1,
            spacing: 1.5,
        };
        let mut points = [OutlinePoint::default(); 200];
        look(&OutlinePoints::new(&sides, &stretches, &sampling, &mut points).expect("fits"));
    }

    fn away(a: [f32; 2], b: [f32; 2]) -> f64 {
        let [x, y] = [0, 1].map(|k| f64::from(b[k]) - f64::from(a[k]));
        sqrt(x * x + y * y)
    }

    #[test]
    fn an_outline_is_as_long_as_the_ways_between_its_points() {
        // Within the frame it is closed; of three sides that end at the frame's border it is not.
        for (from, closed, whole) in [(30, true, 200.0), (0, false, 220.0)] {
            rectangle(from, |outline| {
                let pieces = || outline.pieces();
                assert_eq!(pieces().count(), 1);
                assert!(pieces().all(|piece| piece.closed == closed));
                let lengths = pieces().map(|piece| piece.length());
                assert_eq!(lengths.sum::<f64>(), outline.length);
                let ways: f64 = pieces()
                    .map(|piece| {
                        let next = piece.points.iter().cycle().skip(1);
                        let count = piece.points.len() - usize::from(!closed);
                        let pairs = piece.points.iter().zip(next).take(count);
                        pairs.map(|(a, b)| away(a.at, b.at)).sum::<f64>()
                    })
                    .sum();
                // Of points that lie on both sides of a corner the way between is shorter than along it.
                let cut = outline.length - ways;
                assert!((0.0..1.2).contains(&cut), "{closed}: {cut}");
                // The four corners are cut by averaging; an open stretch ends half a side short at each end.
                let short = whole - outline.length;
                assert!((0.0..4.0).contains(&short), "{closed}: {short}");
            });
        }
    }

    #[test]
    fn normals_are_of_length_one_and_lead_out() {
        for from in [30, 0] {
            rectangle(from, |outline| {
                for OutlinePoint { at, normal } in outline.points {
                    assert!((away([0.0; 2], *normal) - 1.0).abs() < 1e-6);
                    let [column, row] = [64.0 + at[0], 32.0 - at[1]];
                    let sides = [
                        (90.0 - column, [1.0, 0.0]),
                        (column - from as f32, [-1.0, 0.0]),
                        (row - 10.0, [0.0, 1.0]),
                        (50.0 - row, [0.0, -1.0]),
                    ];
                    let near = sides.iter().filter(|(off, _)| off.abs() < 4.0);
                    // Not where two sides meet, at the corners and at the border.
                    let [(off, out)] = near.copied().collect::<std::vec::Vec<_>>()[..] else {
                        continue;
                    };
                    assert!(off.abs() < 1e-4, "{at:?}");
                    assert!(away(*normal, out) < 1e-4, "{at:?} {normal:?}");
                }
            });
        }
    }
}
