//! An outline and a capsule: their union, or the outline without the capsule.

use super::capsule::Capsule;
use crate::error::TracingError;
use crate::list::List;
use crate::polyline::{between, side, twice_area};
use crate::vertex::{NEW, Vertex};
use fluoropose::image::contour::Point;
use fluoropose::math::floor;

/// What a stroke does to an outline.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Brush {
    /// The area of the stroke becomes part of the implant.
    Add,
    /// The area of the stroke is taken from the implant.
    Erase,
}

/// Where an outline crosses the border of a capsule. Opaque: callers only provide the memory for it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cut {
    /// Place along the outline: the number of the side plus the fraction of it.
    along_outline: f64,
    /// The same along the border of the capsule.
    along_capsule: f64,
    /// Whether the outline goes into the capsule.
    enters: bool,
    visited: bool,
}

/// What became of an outline.
pub(super) enum Clipped {
    Untouched,
    /// Nothing is left.
    Gone,
    Changed {
        /// Area of the pieces that were left out, square pixels.
        left_out: f64,
    },
}

pub(super) struct Clip<'a> {
    pub(super) what: Brush,
    /// Number of points of the outline before the first capsule, to which [`Vertex::from`] refers.
    pub(super) given: usize,
    pub(super) cuts: List<'a, Cut>,
}

impl Clip<'_> {
    /// Writes what becomes of `outline` to `out`; `None` where the two touch in a way that cannot be decided.
    pub(super) fn clip(
        &mut self,
        outline: &[Vertex],
        capsule: &Capsule,
        out: &mut List<'_, Vertex>,
    ) -> Result<Option<Clipped>, TracingError> {
        self.find_cuts(outline, capsule)?;
        let cuts = self.cuts.as_slice();
        let alternate = cuts.windows(2).all(|pair| pair[0].enters != pair[1].enters);
        if cuts.len() % 2 == 1 || !alternate {
            return Ok(None);
        }
        if cuts.is_empty() {
            return self.whole(outline, capsule, out).map(Some);
        }
        let outline = Ring { line: outline };
        self.largest(&outline, capsule, out)
    }

    fn find_cuts(&mut self, outline: &[Vertex], capsule: &Capsule) -> Result<(), TracingError> {
        self.cuts.clear();
        let corners = capsule.corners();
        let bounds = Bounds::of(corners);
        for (number, vertex) in outline.iter().enumerate() {
            let ends = (vertex.at, outline[(number + 1) % outline.len()].at);
            if !bounds.meet(ends) {
                continue;
            }
            for at in 0..corners.len() {
                if let Some((t, u, enters)) = crossing(ends, side(corners, at)) {
                    self.cuts.push(Cut {
                        along_outline: number as f64 + t,
                        along_capsule: at as f64 + u,
                        enters,
                        visited: false,
                    })?;
                }
            }
        }
        let order = |a: &Cut, b: &Cut| a.along_outline.total_cmp(&b.along_outline);
        self.cuts.as_mut_slice().sort_unstable_by(order);
        Ok(())
    }

    /// Where the borders do not meet.
    fn whole(
        &self,
        outline: &[Vertex],
        capsule: &Capsule,
        out: &mut List<'_, Vertex>,
    ) -> Result<Clipped, TracingError> {
        let swallowed = outline.first().is_some_and(|first| capsule.holds(first.at));
        if !swallowed {
            return Ok(Clipped::Untouched);
        }
        out.clear();
        if self.what == Brush::Erase {
            return Ok(Clipped::Gone);
        }
        let clockwise = Ring { line: outline }.is_clockwise();
        let corners = capsule.corners();
        for number in 0..corners.len() {
            let number = if clockwise {
                number
            } else {
                corners.len() - 1 - number
            };
            out.push(Vertex::new(corners[number]))?;
        }
        Ok(Clipped::Changed { left_out: 0.0 })
    }

    /// Writes the largest of the loops that outline and capsule make.
    fn largest(
        &mut self,
        outline: &Ring<'_>,
        capsule: &Capsule,
        out: &mut List<'_, Vertex>,
    ) -> Result<Option<Clipped>, TracingError> {
        let clockwise = outline.is_clockwise();
        let (mut best, mut left_out) = ((0.0, None), 0.0);
        for start in 0..self.cuts.len() {
            let cut = self.cuts.as_slice()[start];
            if cut.enters || cut.visited {
                continue;
            }
            out.clear();
            if !self.walk(outline, capsule, clockwise, start, out)? {
                return Ok(None);
            }
            let sign = if clockwise { 1.0 } else { -1.0 };
            let area = sign
                * Ring {
                    line: out.as_slice(),
                }
                .twice_area()
                / 2.0;
            if area > best.0 {
                left_out += best.0;
                best = (area, Some(start));
            } else {
                // A loop in the other direction is a hole, which is filled.
                left_out += area.max(0.0);
            }
        }
        out.clear();
        let Some(start) = best.1 else {
            return Ok(Some(Clipped::Gone));
        };
        self.walk(outline, capsule, clockwise, start, out)?;
        Ok(Some(Clipped::Changed { left_out }))
    }

    /// Writes one loop: along the outline from where it leaves the capsule to where it enters it, along the capsule's
    /// border to where the outline leaves again, and so on. Returns whether the loop came back to where it began.
    fn walk(
        &mut self,
        outline: &Ring<'_>,
        capsule: &Capsule,
        clockwise: bool,
        start: usize,
        out: &mut List<'_, Vertex>,
    ) -> Result<bool, TracingError> {
        let count = self.cuts.len();
        let forwards = (self.what == Brush::Add) == clockwise;
        let mut at = start;
        for _ in 0..count {
            self.cuts.as_mut_slice()[at].visited = true;
            let leaves = self.cuts.as_slice()[at];
            let entry = (at + 1) % count;
            let enters = self.cuts.as_slice()[entry];
            out.push(outline.vertex(leaves.along_outline, self.given))?;
            outline.emit(leaves.along_outline, enters.along_outline, |vertex| {
                out.push(vertex)
            })?;
            out.push(outline.vertex(enters.along_outline, self.given))?;
            let Some(next) = self.next_along_capsule(enters.along_capsule, forwards) else {
                return Ok(false);
            };
            let leaves = self.cuts.as_slice()[next];
            if leaves.enters {
                return Ok(false);
            }
            let corners = capsule.corners();
            let span = (enters.along_capsule, leaves.along_capsule);
            emit_corners(corners, span, forwards, |corner| {
                out.push(Vertex::new(corner))
            })?;
            at = next;
            if at == start {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// The cut that comes next along the capsule's border.
    fn next_along_capsule(&self, from: f64, forwards: bool) -> Option<usize> {
        let mut best: Option<(f64, usize)> = None;
        for (number, cut) in self.cuts.as_slice().iter().enumerate() {
            let ahead = if forwards {
                cut.along_capsule - from
            } else {
                from - cut.along_capsule
            };
            // More than any capsule has corners.
            let ahead = if ahead > 0.0 { ahead } else { ahead + 1e6 };
            if cut.along_capsule != from && best.is_none_or(|(least, _)| ahead < least) {
                best = Some((ahead, number));
            }
        }
        best.map(|(_, number)| number)
    }
}

/// A closed outline.
struct Ring<'a> {
    line: &'a [Vertex],
}

impl Ring<'_> {
    fn twice_area(&self) -> f64 {
        let origin = self.line.first().map_or(Point::default(), |first| first.at);
        let count = self.line.len();
        let areas = (0..count).map(|k| {
            let (a, b) = (self.line[k].at, self.line[(k + 1) % count].at);
            twice_area(&[origin, a, b])
        });
        areas.sum()
    }

    fn is_clockwise(&self) -> bool {
        self.twice_area() > 0.0
    }

    /// The point at a place along the outline, with its place on the outline before the first capsule.
    fn vertex(&self, along: f64, given: usize) -> Vertex {
        let number = floor(along);
        let count = self.line.len();
        let (a, b) = (
            self.line[number as usize % count],
            self.line[(number as usize + 1) % count],
        );
        let t = along - number;
        let at = between((a.at, b.at), t);
        if a.from == NEW || b.from == NEW {
            return Vertex::new(at);
        }
        let given_side = floor(a.from);
        // The next point of the given outline ends the side; the last side ends at the first point.
        let ends =
            b.from == given_side + 1.0 || (b.from == 0.0 && given_side as usize + 1 == given);
        let until = if ends { given_side + 1.0 } else { b.from };
        if until <= a.from || until > given_side + 1.0 {
            return Vertex::new(at);
        }
        let from = a.from + t * (until - a.from);
        Vertex::from_side(given_side as usize, from - given_side, at)
    }

    /// Calls `emit` for the points strictly between two places along the outline.
    fn emit(
        &self,
        from: f64,
        to: f64,
        mut emit: impl FnMut(Vertex) -> Result<(), TracingError>,
    ) -> Result<(), TracingError> {
        let count = self.line.len();
        let first = floor(from) as usize + 1;
        let last = floor(to) as usize + if to < from { count } else { 0 };
        for number in first..=last {
            emit(self.line[number % count])?;
        }
        Ok(())
    }
}

/// Calls `emit` for the corners strictly between two places along a capsule.
fn emit_corners(
    corners: &[Point],
    (from, to): (f64, f64),
    forwards: bool,
    mut emit: impl FnMut(Point) -> Result<(), TracingError>,
) -> Result<(), TracingError> {
    let count = corners.len();
    let (low, high) = if forwards { (from, to) } else { (to, from) };
    let first = floor(low) as usize + 1;
    let last = floor(high) as usize + if high < low { count } else { 0 };
    for number in first..=last {
        let number = if forwards {
            number
        } else {
            first + last - number
        };
        emit(corners[number % count])?;
    }
    Ok(())
}

/// The box around some points.
struct Bounds {
    low: [f64; 2],
    high: [f64; 2],
}

impl Bounds {
    fn of(points: &[Point]) -> Self {
        let mut bounds = Self {
            low: [f64::INFINITY; 2],
            high: [f64::NEG_INFINITY; 2],
        };
        for point in points {
            for (k, value) in [point.column, point.row].into_iter().enumerate() {
                bounds.low[k] = bounds.low[k].min(value);
                bounds.high[k] = bounds.high[k].max(value);
            }
        }
        bounds
    }

    fn meet(&self, (a, b): (Point, Point)) -> bool {
        let pairs = [(a.column, b.column), (a.row, b.row)]
            .into_iter()
            .enumerate();
        pairs
            .into_iter()
            .all(|(k, (a, b))| a.max(b) >= self.low[k] && a.min(b) <= self.high[k])
    }
}

/// The fractions of a side of the outline and of a side of a capsule at which they cross, and whether the outline enters
/// the capsule there.
fn crossing((a, b): (Point, Point), (c, d): (Point, Point)) -> Option<(f64, f64, bool)> {
    let (px, py) = (b.column - a.column, b.row - a.row);
    let (qx, qy) = (d.column - c.column, d.row - c.row);
    let (x, y) = (c.column - a.column, c.row - a.row);
    // Positive where the side goes to the right hand of the capsule's, which is its inside.
    let turn = qx * py - qy * px;
    let t = (y * qx - x * qy) / turn;
    let u = (y * px - x * py) / turn;
    let within = (0.0..1.0).contains(&t) && (0.0..1.0).contains(&u);
    within.then_some((t, u, turn > 0.0))
}
