//! Fewer points for the same shape.

use heapless::Vec;

use crate::error::{TracingError, check_setting};
use crate::list::List;
use crate::polyline::{between, check, distance, side_count, squared_distance, twice_area};
use crate::vertex::{ShapeError, Vertex};
use fluoropose::image::contour::{Point, first_crossing};
use fluoropose::math::sqrt;
use fluoropose::memory::check_length;

/// The greatest tolerance, pixels.
pub const MOST_TOLERANCE: f64 = 64.0;
/// A tolerance that would make a line cross itself is halved at most this number of times.
const ATTEMPTS: usize = 6;
/// Spans of points that wait: the shorter half is always split first, so they are fewer than the bits of a length.
const WAITING: usize = 64;

/// How a line is simplified.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Simplify {
    /// Whether the last point is joined to the first.
    pub closed: bool,
    /// The greatest distance by which any part of the line moves when points are left out, pixels: 0 to
    /// [`MOST_TOLERANCE`].
    pub tolerance: f64,
    /// Whether points that were made, not given, are moved a little so that the new line lies on both sides of the old
    /// one in equal parts. All chords of a convex outline lie inside of it: without this a silhouette would lose a part
    /// of the tolerance all around, and the implant would seem farther away than it is.
    pub balanced: bool,
}

/// Leaves out points of a line, after Douglas and Peucker (*Cartographica* 10, 1973). Where a closed line would cross
/// itself afterwards, the tolerance is halved, up to six times.
///
/// The ends of an open line, two points of a closed one that are far apart, and the points for which `keep` is true
/// always stay. `marks` has at least one place for each point of the line, `out` one for each point that stays.
///
/// Returns the distance of the given line from the simplified one. Without [`Simplify::balanced`] no point of the
/// simplified line is farther from the given one than [`ShapeError::max`].
///
/// # Errors
/// [`TracingError::Setting`] about the tolerance, [`TracingError::Memory`] about `marks`, and [`TracingError::TooLong`].
pub fn simplify(
    line: &[Vertex],
    settings: &Simplify,
    keep: impl Fn(&Vertex) -> bool,
    marks: &mut [bool],
    out: &mut List<'_, Vertex>,
) -> Result<ShapeError, TracingError> {
    check_setting("the tolerance", settings.tolerance, 0.0, MOST_TOLERANCE)?;
    check_length("marks", line.len(), marks.len())?;
    let marks = marks.get_mut(..line.len()).unwrap_or_default();
    let closed = settings.closed;
    let mut tolerance = settings.tolerance;
    for attempt in 0..=ATTEMPTS {
        mark(line, closed, tolerance, &keep, marks);
        out.clear();
        for (vertex, _) in line.iter().zip(&*marks).filter(|(_, marked)| **marked) {
            out.push(*vertex)?;
        }
        if settings.balanced {
            balance(line, closed, marks, out.as_mut_slice());
        }
        let whole = out.len() == line.len() || attempt == ATTEMPTS;
        if whole || !closed || !crosses(out.as_slice()) {
            break;
        }
        tolerance /= 2.0;
    }
    Ok(error_of(line, closed, marks, out.as_slice()))
}

/// Writes the points of a given line as unchanged [`Vertex`]es.
///
/// # Errors
/// [`TracingError::TooFewPoints`] for fewer than 2 points (open) or 3 (closed), [`TracingError::NotAPlace`], and
/// [`TracingError::TooLong`].
pub fn as_vertices(
    points: &[Point],
    closed: bool,
    out: &mut List<'_, Vertex>,
) -> Result<(), TracingError> {
    check(points, if closed { 3 } else { 2 })?;
    out.clear();
    let mut numbered = points.iter().enumerate();
    numbered.try_for_each(|(number, &at)| out.push(Vertex::kept(number, at)))
}

fn crosses(line: &[Vertex]) -> bool {
    first_crossing(line.len(), |number| line[number].at).is_some()
}

/// Marks the points that stay.
fn mark(
    line: &[Vertex],
    closed: bool,
    tolerance: f64,
    keep: &impl Fn(&Vertex) -> bool,
    marks: &mut [bool],
) {
    for (mark, vertex) in marks.iter_mut().zip(line) {
        *mark = keep(vertex);
    }
    let Some(first) = anchor(line, closed, marks) else {
        return;
    };
    let count = line.len();
    let mut from = first;
    for step in 1..=side_count(count, closed) {
        let to = first + step;
        if marks[to % count] {
            mark_between(line, from, to, tolerance, marks);
            from = to;
        }
    }
}

/// Marks the points that stay in any case and returns one of them to begin with.
fn anchor(line: &[Vertex], closed: bool, marks: &mut [bool]) -> Option<usize> {
    let last = line.len().checked_sub(1)?;
    if !closed {
        marks[0] = true;
        marks[last] = true;
        return Some(0);
    }
    let first = marks.iter().position(|marked| *marked);
    // It must not depend on which point is the first: that changes while an outline is being traced.
    let first = first.unwrap_or_else(|| farthest(line, middle(line)));
    marks[first] = true;
    marks[farthest(line, line[first].at)] = true;
    Some(first)
}

fn middle(line: &[Vertex]) -> Point {
    let count = line.len().max(1) as f64;
    let sum = line.iter().fold(Point::default(), |sum, vertex| {
        Point::new(sum.column + vertex.at.column, sum.row + vertex.at.row)
    });
    Point::new(sum.column / count, sum.row / count)
}

fn farthest(line: &[Vertex], from: Point) -> usize {
    let away = |vertex: &Vertex| squared_distance(vertex.at, (from, from));
    let mut best = (0, -1.0);
    for (number, vertex) in line.iter().enumerate() {
        if away(vertex) > best.1 {
            best = (number, away(vertex));
        }
    }
    best.0
}

/// Marks the points that stay strictly between two points that stay. Numbers beyond the last point begin again at 0.
fn mark_between(line: &[Vertex], from: usize, to: usize, tolerance: f64, marks: &mut [bool]) {
    let mut waiting: Vec<(usize, usize), WAITING> = Vec::new();
    let mut span = Some((from, to));
    while let Some((from, to)) = span {
        span = match split(line, from, to, tolerance) {
            None => waiting.pop(),
            Some(at) => {
                marks[at % line.len()] = true;
                let halves = [(from, at), (at, to)];
                let first_is_longer = at - from > to - at;
                let [longer, shorter] = if first_is_longer {
                    halves
                } else {
                    [halves[1], halves[0]]
                };
                // Never full: every waiting span is at least as long as all spans that are split before it.
                let _ = waiting.push(longer);
                Some(shorter)
            }
        };
    }
}

/// The point farthest from the chord, where it is farther than the tolerance.
fn split(line: &[Vertex], from: usize, to: usize, tolerance: f64) -> Option<usize> {
    let at = |number: usize| line[number % line.len()].at;
    let chord = (at(from), at(to));
    let mut best = (None, tolerance * tolerance);
    for number in from + 1..to {
        let away = squared_distance(at(number), chord);
        if away > best.1 {
            best = (Some(number), away);
        }
    }
    best.0
}

/// The spans of a line between marked points, in the order of these, as numbers that may go beyond the last point.
fn spans(marks: &[bool], closed: bool) -> impl Iterator<Item = (usize, usize)> + '_ {
    let count = marks.len();
    let marked = move |&number: &usize| marks[number % count];
    let first = marks.iter().position(|marked| *marked).unwrap_or_default();
    let last = if closed {
        first + count
    } else {
        count - usize::from(count > 0)
    };
    let starts = (first..last).filter(marked);
    let ends = (first + 1..=last).filter(marked);
    starts.zip(ends)
}

/// The distances of a line from the one that was made of its marked points. Each part is compared with its own chord and
/// the chords next to it.
fn error_of(line: &[Vertex], closed: bool, marks: &[bool], made: &[Vertex]) -> ShapeError {
    let (count, chords) = (line.len(), side_count(made.len(), closed));
    let (mut sum, mut long, mut greatest) = (0.0, 0.0, 0.0f64);
    for (number, (from, to)) in spans(marks, closed).enumerate() {
        let away = |point: Point| {
            let near = (number + chords.max(1) - 1)..=(number + chords + 1);
            let ends = near
                .map(|k| k % chords.max(1))
                .map(|k| (made[k].at, made[(k + 1) % made.len()].at));
            ends.map(|ends| squared_distance(point, ends))
                .fold(f64::INFINITY, f64::min)
        };
        for k in from..to {
            let (a, b) = (line[k % count].at, line[(k + 1) % count].at);
            let [near, mid, far] = [a, between((a, b), 0.5), b].map(away);
            let side = distance(a, b);
            // Simpson's rule: exact where the distance from the chord grows evenly.
            sum += side * (near + 4.0 * mid + far) / 6.0;
            long += side;
            greatest = greatest.max(near).max(mid).max(far);
        }
    }
    let mean = if long > 0.0 { sum / long } else { 0.0 };
    ShapeError {
        max: sqrt(greatest),
        rms: sqrt(mean),
    }
}

/// Moves the points of the simplified line that are not unchanged points of the given one, each by the mean distance of
/// the line from the chords on both sides of the point.
fn balance(line: &[Vertex], closed: bool, marks: &[bool], made: &mut [Vertex]) {
    let chords = || spans(marks, closed).map(|span| Chord::new(line, span));
    let mut before = if closed { chords().last() } else { None };
    for (vertex, after) in made.iter_mut().zip(chords()) {
        if let Some(before) = before
            && vertex.kept_number().is_none()
        {
            vertex.at = after.balanced(&before, vertex.at);
        }
        before = Some(after);
    }
}

/// A side of the simplified line, with the part of the line that it replaces.
#[derive(Clone, Copy)]
struct Chord {
    /// Unit vector to its left.
    left: [f64; 2],
    long: f64,
    /// Area between it and its part of the line, square pixels, positive on its left.
    area: f64,
}

impl Chord {
    fn new(line: &[Vertex], (from, to): (usize, usize)) -> Self {
        let at = |number: usize| line[number % line.len()].at;
        let (a, b) = (at(from), at(to));
        let long = distance(a, b).max(f64::MIN_POSITIVE);
        let twice = (from..to).map(|k| twice_area(&[a, at(k), at(k + 1)]));
        Self {
            left: [(b.row - a.row) / long, (a.column - b.column) / long],
            long,
            area: twice.sum::<f64>() / 2.0,
        }
    }

    /// Where the point between this chord and the one before it belongs.
    fn balanced(&self, before: &Self, at: Point) -> Point {
        let [x, y] = [0, 1].map(|k| self.left[k] + before.left[k]);
        let size = sqrt(x * x + y * y);
        if size < 1.0 {
            // A sharp corner: the chords next to it say nothing about its place.
            return at;
        }
        // Both chords move by the mean where the point moves by that over the cosine of half the bend, size / 2.
        let mean = (self.area + before.area) / (self.long + before.long);
        let by = mean / (size / 2.0) / size;
        Point::new(at.column + by * x, at.row + by * y)
    }
}

#[cfg(test)]
mod tests;
