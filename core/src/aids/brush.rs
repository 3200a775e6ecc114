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
use super::polyline::{check, distance};
use super::simplify::{Simplify, simplify};
use super::{AidError, NEW, Vertex, check_length, check_setting};
use crate::contour::Point;

pub use clip::Cut;

/// The least and the greatest radius of the disc, pixels.
pub const LEAST_RADIUS: f64 = 0.5;
/// The greatest radius of the disc, pixels.
pub const MOST_RADIUS: f64 = 512.0;
/// New points are left out where the stroke's border moves by no more than this, pixels.
const TOLERANCE: f64 = 0.1;
/// Places of a stroke nearer to each other than this share of the radius are one.
const STRIDE: f64 = 0.1;
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
    check_length("points", needed, memory.before.len().min(memory.after.len()))?;
    check_length("cuts", needed, memory.cuts.len())?;
    let mut before = List::new(memory.before);
    let mut after = List::new(memory.after);
    for (number, &at) in points.iter().enumerate() {
        before.push(Vertex::kept(number, at))?;
    }
    let mut left_out = 0.0;
    for (from, to) in capsules(stroke, radius) {
        if before.is_empty() && what == Brush::Add {
            let capsule = Capsule::new(from, to, radius);
            let mut corners = capsule.corners().iter();
            corners.try_for_each(|&corner| before.push(Vertex::new(corner)))?;
        }
        let mut clip = Clip {
            what,
            given: points.len(),
            cuts: List::new(memory.cuts),
        };
        match stroked(&mut clip, before.as_slice(), (from, to), radius, &mut after)? {
            Clipped::Untouched => continue,
            Clipped::Gone => return Ok(left_out),
            Clipped::Changed { left_out: area } => left_out += area,
        }
        core::mem::swap(&mut before, &mut after);
    }
    let keep = |vertex: &Vertex| vertex.from != NEW;
    let settings = Simplify {
        closed: true,
        tolerance: TOLERANCE,
        balanced: true,
    };
    simplify(before.as_slice(), &settings, keep, memory.marks, out)?;
    Ok(left_out)
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

/// The ends of the capsules that a stroke is made of.
fn capsules(stroke: &[Point], radius: f64) -> impl Iterator<Item = (Point, Point)> + '_ {
    let mut last = stroke.first().copied().unwrap_or_default();
    let single = (stroke.len() == 1).then_some((last, last));
    let count = stroke.len();
    let moves = stroke.iter().enumerate().skip(1).filter_map(move |(number, &place)| {
        let far = distance(last, place) >= STRIDE * radius || number + 1 == count;
        let from = last;
        far.then(|| {
            last = place;
            (from, place)
        })
    });
    single.into_iter().chain(moves)
}

#[cfg(test)]
mod tests;
