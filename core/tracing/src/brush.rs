//! A disc drawn along a stroke, added to an outline or taken away from it.
//!
//! The outline is cut at the border of the stroke exactly, not by pixels: points outside the stroke are untouched to the
//! last bit. The stroke is taken as one capsule after another, each a convex polygon; where an outline leaves a capsule
//! one goes along the outline, where it enters one goes along the capsule (after Weiler and Atherton, *Hidden surface
//! removal using polygon area sorting*, SIGGRAPH 1977).

mod capsule;
mod clip;

use capsule::Capsule;
use clip::{Clip, Clipped};

use super::list::List;
use super::polyline::check;
use super::simplify::{Simplify, simplify};
use super::{AidError, NEW, Vertex, check_length, check_setting};
use fluoropose::image::contour::Point;

pub use clip::Cut;

/// The least and the greatest radius of the disc, pixels.
pub const LEAST_RADIUS: f64 = 0.5;
/// The greatest radius of the disc, pixels.
pub const MOST_RADIUS: f64 = 512.0;
/// New points are left out where the stroke's border moves by no more than this, pixels.
const TOLERANCE: f64 = 0.1;
/// Where points fall onto lines nothing can be told; then the capsule is moved by so little, in other directions, so
/// often.
const ATTEMPTS: usize = 8;

/// What a stroke does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Brush {
    /// The disc belongs to the implant.
    Add,
    /// The disc does not.
    Erase,
}

/// Working memory of [`brush`]: each slice as long as [`brush_needed`] says.
#[derive(Debug)]
pub struct BrushMemory<'a> {
    /// The outline before and after a capsule.
    pub before: &'a mut [Vertex],
    /// The same, by turns.
    pub after: &'a mut [Vertex],
    /// Where the outline meets the border of a capsule.
    pub cuts: &'a mut [Cut],
    /// One for each point.
    pub marks: &'a mut [bool],
}

/// The length of a [`BrushMemory`]'s slices for an outline of `points` points and a stroke through `places` places.
#[must_use]
pub fn brush_needed(points: usize, places: usize) -> usize {
    // A capsule has at most as many corners as it can add, and cuts a side at most twice.
    2 * (points + (places + 1) * capsule::MOST_CORNERS)
}

/// Draws a disc of `radius` pixels along `stroke` and adds it to the outline or takes it away. An outline without points
/// becomes that of the stroke. Writes the new outline to
/// `out`, in the same direction round, and gives the area in square pixels of the pieces that were left out: of several
/// the largest stays. Holes are not made: where the stroke lies inside and is to be erased, or encloses something,
/// nothing happens there. Nothing is written where all is erased.
///
/// # Errors
/// [`AidError`] about the outline, the stroke or the memory.
pub fn brush(
    points: &[Point],
    stroke: &[Point],
    radius: f64,
    what: Brush,
    memory: BrushMemory<'_>,
    out: &mut List<'_, Vertex>,
) -> Result<f64, AidError> {
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
    /// Paints capsule after capsule. One that lies inside, to be erased, or outside, to be added, waits for another to
    /// join it to the border: so all are looked at again, from the end and from the beginning by turns, until none
    /// changes anything. What is left is in `outline`.
    fn paint<'o>(
        &mut self,
        outline: &mut List<'o, Vertex>,
        other: &mut List<'o, Vertex>,
        done: &mut [bool],
    ) -> Result<(), AidError> {
        let count = self.stroke.len().saturating_sub(1).max(1);
        let done = done.get_mut(..count).unwrap_or_default();
        done.fill(false);
        for round in 0..=count {
            let mut changed = false;
            for k in 0..count {
                let number = if round % 2 == 0 { k } else { count - 1 - k };
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

    /// Paints one capsule and gives whether that changed anything.
    fn paint_one<'o>(
        &mut self,
        number: usize,
        outline: &mut List<'o, Vertex>,
        other: &mut List<'o, Vertex>,
    ) -> Result<bool, AidError> {
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

/// One capsule; a little moved where it touches the outline in a way that cannot be told.
fn stroked(
    clip: &mut Clip<'_>,
    outline: &[Vertex],
    (from, to): (Point, Point),
    radius: f64,
    out: &mut List<'_, Vertex>,
) -> Result<Clipped, AidError> {
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
