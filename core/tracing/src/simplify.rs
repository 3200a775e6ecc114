//! Fewer points for the same shape.

use heapless::Vec;

use super::list::List;
use super::polyline::{between, check, distance, side_count, squared_distance, twice_area};
use super::{AidError, ShapeError, Vertex, check_length, check_setting};
use fluoropose::image::contour::{Point, first_crossing};
use fluoropose::math::sqrt;

/// The greatest tolerance, pixels.
pub const MOST_TOLERANCE: f64 = 64.0;
/// A tolerance that would make a line cross itself is halved so often at most.
const ATTEMPTS: usize = 6;
/// Spans of points that wait: the shorter half is always looked at first, so there are fewer than bits in a length.
const WAITING: usize = 64;

/// How a line is simplified.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Simplify {
    /// Whether the last point is joined to the first.
    pub closed: bool,
    /// No part of the line moves by more than so many pixels when points are left out.
    pub tolerance: f64,
    /// Whether points that were not given but made are moved a little so that the new line lies as much to one side of
    /// the old as to the other. Chords of a convex outline lie inside of it, all of them: without that a silhouette
    /// would lose a part of the tolerance all round, and seem farther away than it is.
    pub balanced: bool,
}

/// Leaves out points of a line, after Douglas and Peucker (*Cartographica* 10, 1973). Where the closed line that is left
/// would cross itself the tolerance is halved, up to six times.
///
/// Two points far apart of a closed line, the ends of an open one and those that `keep` names always stay. `marks`
/// holds a place for each point, `out` as many as stay.
///
/// The distances of the error are those from the given line to the simple one. Where nothing was balanced those the
/// other way are no greater than the greatest of them.
///
/// # Errors
/// [`AidError`] about the line, the tolerance or the memory.
pub fn simplify(
    line: &[Vertex],
    settings: &Simplify,
    keep: impl Fn(&Vertex) -> bool,
    marks: &mut [bool],
    out: &mut List<'_, Vertex>,
) -> Result<ShapeError, AidError> {
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

/// Points of a line as [`Vertex`]es that come from themselves.
///
/// # Errors
/// [`AidError`] for a line of fewer points than 2 (open) or 3 (closed), one that is no place, or a short list.
pub fn as_vertices(
    points: &[Point],
    closed: bool,
    out: &mut List<'_, Vertex>,
) -> Result<(), AidError> {
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

/// Marks the points that stay in any case and gives one of them to begin with.
fn anchor(line: &[Vertex], closed: bool, marks: &mut [bool]) -> Option<usize> {
    let last = line.len().checked_sub(1)?;
    if !closed {
        marks[0] = true;
        marks[last] = true;
        return Some(0);
    }
    let first = marks.iter().position(|marked| *marked);
    // Independent of which point is the first: a live outline must not change with that.
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

/// Marks what stays strictly between two points that do. Numbers beyond the last point begin again.
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
                // Never full: every span waiting is at least as long as all that is looked at before it.
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

/// The distances of a line from the one that was made of its marked points. Each part is held against its own chord and
/// those beside it.
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

/// Moves the points of the simple line that are not the given outline's own, each by the mean distance of the line from
/// the chords on both sides of it.
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

/// A side of the simple line and the part of the line that it stands for.
#[derive(Clone, Copy)]
struct Chord {
    /// Unit vector to its left hand.
    left: [f64; 2],
    long: f64,
    /// Area between it and its part of the line, positive on the left hand.
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
            // A sharp corner: what lies beside it tells nothing of its place.
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
