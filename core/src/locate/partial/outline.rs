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
