//! A disc drawn along a stroke, added to an outline or taken away from it.
//!
//! The outline is cut exactly at the border of the stroke, not pixel by pixel: points outside the stroke stay unchanged
//! to the last bit. The stroke is painted capsule by capsule, each of them a convex polygon. The new outline follows the
//! old one from where it leaves a capsule to where it enters one, and there the border of the capsule (after Weiler and
//! Atherton, *Hidden surface removal using polygon area sorting*, SIGGRAPH 1977).

mod capsule;
mod clip;

use capsule::Capsule;
use clip::{Clip, Clipped};

use crate::error::{TracingError, check_setting};
use crate::list::List;
use crate::polyline::check;
use crate::simplify::{Simplify, simplify};
use crate::vertex::{NEW, Vertex};
use fluoropose::image::contour::Point;
use fluoropose::memory::check_length;

pub use clip::{Brush, Cut};

/// The least radius of the disc, pixels.
pub const LEAST_RADIUS: f64 = 0.5;
/// The greatest radius of the disc, pixels.
pub const MOST_RADIUS: f64 = 512.0;
/// New points are left out where the stroke's border moves by no more than this, pixels.
const TOLERANCE: f64 = 0.1;
/// Where a point of the outline lies on a side of the capsule, inside and outside cannot be told apart. The capsule is
/// then moved and widened by a tiny amount, up to this number of times.
const ATTEMPTS: usize = 8;

/// Working memory of [`brush`]: each slice is at least as long as [`brush_needed`] says.
#[derive(Debug)]
pub struct BrushMemory<'a> {
    /// The outline before a capsule is painted.
    pub before: &'a mut [Vertex],
    /// The outline after that; the two are swapped from capsule to capsule.
    pub after: &'a mut [Vertex],
    /// Where the outline crosses the border of a capsule.
    pub cuts: &'a mut [Cut],
    /// One mark for each point.
    pub marks: &'a mut [bool],
}

/// The length of each slice of a [`BrushMemory`] for an outline of `points` points and a stroke through `places` places.
#[must_use]
pub fn brush_needed(points: usize, places: usize) -> usize {
    // A capsule has at most as many corners as it can add, and cuts a side at most twice.
    2 * (points + (places + 1) * capsule::MOST_CORNERS)
}

/// Draws a disc of `radius` pixels ([`LEAST_RADIUS`] to [`MOST_RADIUS`]) along `stroke`, and adds it to the closed outline
/// `points` or erases it from it. The new outline is written to `out` and runs around in the same direction.
///
/// - An outline without points becomes that of the stroke.
/// - If the outline falls into several pieces, the largest stays. The area of the others, square pixels, is returned.
/// - The outline never gets a hole: erasing wholly inside of it changes nothing, and a hole that would arise is filled.
/// - If everything is erased, `out` stays empty.
///
/// # Errors
/// - [`TracingError::TooFewPoints`] and [`TracingError::NotAPlace`] about the outline (3 points) or the stroke (1 point);
/// - [`TracingError::Setting`] about the radius;
/// - [`TracingError::Memory`], and [`TracingError::TooLong`] where `out` is too short.
pub fn brush(
    points: &[Point],
    stroke: &[Point],
    radius: f64,
    what: Brush,
    memory: BrushMemory<'_>,
    out: &mut List<'_, Vertex>,
) -> Result<f64, TracingError> {
    if !points.is_empty() {
        check(points, 3)?;
    }
    check(stroke, 1)?;
    check_setting("the brush's radius", radius, LEAST_RADIUS, MOST_RADIUS)?;
    let needed = brush_needed(points.len(), stroke.len());
    check_length(
        "points",
        needed,
        memory.before.len().min(memory.after.len()),
    )?;
    check_length("cuts", needed, memory.cuts.len())?;
    check_length("marks", needed, memory.marks.len())?;
    if points.is_empty() && what == Brush::Erase {
        out.clear();
        return Ok(0.0);
    }
    let mut before = List::new(memory.before);
    let mut after = List::new(memory.after);
    for (number, &at) in points.iter().enumerate() {
        before.push(Vertex::kept(number, at))?;
    }
    let mut painter = Painter {
        stroke,
        radius,
        clip: Clip {
            what,
            given: points.len(),
            cuts: List::new(memory.cuts),
        },
        left_out: 0.0,
    };
    painter.paint(&mut before, &mut after, memory.marks)?;
    let settings = Simplify {
        closed: true,
        tolerance: TOLERANCE,
        balanced: false,
    };
    let keep = |vertex: &Vertex| vertex.from != NEW;
    simplify(before.as_slice(), &settings, keep, memory.marks, out)?;
    Ok(painter.left_out)
}

/// A stroke being painted.
struct Painter<'a> {
    stroke: &'a [Point],
    radius: f64,
    clip: Clip<'a>,
    left_out: f64,
}

impl Painter<'_> {
    /// Paints capsule after capsule and leaves the result in `outline`.
    ///
    /// A capsule to be erased that lies wholly inside, or one to be added that lies wholly outside, has to wait until
    /// another capsule connects it with the border. Therefore the capsules that changed nothing are tried again,
    /// alternately from the end and from the beginning, until none of them changes anything.
    fn paint<'o>(
        &mut self,
        outline: &mut List<'o, Vertex>,
        other: &mut List<'o, Vertex>,
        done: &mut [bool],
    ) -> Result<(), TracingError> {
        let count = self.stroke.len().saturating_sub(1).max(1);
        let done = done.get_mut(..count).unwrap_or_default();
        done.fill(false);
        for pass in 0..=count {
            let mut changed = false;
            for k in 0..count {
                let number = if pass % 2 == 0 { k } else { count - 1 - k };
                if done.get(number).is_none_or(|done| *done) {
                    continue;
                }
                done[number] = self.paint_one(number, outline, other)?;
                changed |= done[number];
                if outline.is_empty() && self.clip.what == Brush::Erase {
                    return Ok(());
                }
            }
            if !changed {
                return Ok(());
            }
        }
        Ok(())
    }

    /// Paints one capsule and returns whether that changed anything.
    fn paint_one<'o>(
        &mut self,
        number: usize,
        outline: &mut List<'o, Vertex>,
        other: &mut List<'o, Vertex>,
    ) -> Result<bool, TracingError> {
        let at = |number: usize| self.stroke[number.min(self.stroke.len() - 1)];
        let ends = (at(number), at(number + 1));
        if outline.is_empty() {
            let capsule = Capsule::new(ends.0, ends.1, self.radius);
            let mut corners = capsule.corners().iter();
            corners.try_for_each(|&corner| outline.push(Vertex::new(corner)))?;
            return Ok(true);
        }
        match stroked(&mut self.clip, outline.as_slice(), ends, self.radius, other)? {
            Clipped::Untouched => return Ok(false),
            Clipped::Gone => outline.clear(),
            Clipped::Changed { left_out } => {
                self.left_out += left_out;
                core::mem::swap(outline, other);
            }
        }
        Ok(true)
    }
}

/// Paints one capsule, slightly moved where it touches the outline in a way that cannot be decided.
fn stroked(
    clip: &mut Clip<'_>,
    outline: &[Vertex],
    (from, to): (Point, Point),
    radius: f64,
    out: &mut List<'_, Vertex>,
) -> Result<Clipped, TracingError> {
    for attempt in 0..ATTEMPTS {
        let by = attempt as f64 * 1e-7;
        let moved = |p: Point| Point::new(p.column + 1.37 * by, p.row - 0.91 * by);
        let capsule = Capsule::new(moved(from), moved(to), radius * (1.0 + by));
        if let Some(clipped) = clip.clip(outline, &capsule, out)? {
            return Ok(clipped);
        }
    }
    Ok(Clipped::Untouched)
}

#[cfg(test)]
mod tests;
