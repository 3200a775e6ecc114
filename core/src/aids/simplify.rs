//! Fewer points for the same shape.

use heapless::Vec;

use super::list::List;
use super::polyline::{check, side_count, squared_distance};
use super::{AidError, ShapeError, Vertex, check_length, check_setting};
use crate::contour::{Point, first_crossing};
use crate::math::sqrt;

/// The greatest tolerance, pixels.
pub const MOST_TOLERANCE: f64 = 64.0;
/// A tolerance that would make a line cross itself is halved so often at most.
const ATTEMPTS: usize = 6;
/// Spans of points that wait: the shorter half is always looked at first, so there are fewer than bits in a length.
const WAITING: usize = 64;

/// Leaves out points of a line as long as no part of it moves by more than `tolerance` pixels, after Douglas and
/// Peucker (*Cartographica* 10, 1973). No point moves. Where the closed line that is left would cross itself the
/// tolerance is halved, up to six times.
///
/// Two points far apart of a closed line, the ends of an open one and those that `keep` names always stay. `marks`
/// holds a place for each point, `out` as many as stay.
///
/// The distances of the error are those from the given line to the simple one; those the other way are no greater
/// than the greatest of them.
///
/// # Errors
/// [`AidError`] about the line, the tolerance or the memory.
pub fn simplify(
    line: &[Vertex],
    closed: bool,
    tolerance: f64,
    keep: impl Fn(&Vertex) -> bool,
    marks: &mut [bool],
    out: &mut List<'_, Vertex>,
) -> Result<ShapeError, AidError> {
    check_setting("the tolerance", tolerance, 0.0, MOST_TOLERANCE)?;
    check_length("marks", line.len(), marks.len())?;
    let marks = marks.get_mut(..line.len()).unwrap_or_default();
    let mut tolerance = tolerance;
    for attempt in 0..=ATTEMPTS {
        mark(line, closed, tolerance, &keep, marks);
        out.clear();
        for (vertex, _) in line.iter().zip(&*marks).filter(|(_, marked)| **marked) {
            out.push(*vertex)?;
        }
        let whole = out.len() == line.len() || attempt == ATTEMPTS;
        if whole || !closed || !crosses(out.as_slice()) {
            break;
        }
        tolerance /= 2.0;
    }
    Ok(error_of(line, closed, marks))
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
                let [longer, shorter] = if first_is_longer { halves } else { [halves[1], halves[0]] };
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

/// The distances of a line from the one that its marked points make.
fn error_of(line: &[Vertex], closed: bool, marks: &[bool]) -> ShapeError {
    let count = line.len();
    let Some(first) = marks.iter().position(|marked| *marked) else {
        return ShapeError::default();
    };
    let at = |number: usize| line[number % count].at;
    let (mut sum, mut long, mut greatest) = (0.0, 0.0, 0.0f64);
    let mut from = first;
    for step in 1..=side_count(count, closed) {
        let to = first + step;
        if !marks[to % count] {
            continue;
        }
        let chord = (at(from), at(to));
        for number in from..to {
            let (a, b) = (at(number), at(number + 1));
            let middle = super::polyline::between((a, b), 0.5);
            let [near, mid, far] = [a, middle, b].map(|p| squared_distance(p, chord));
            let side = super::polyline::distance(a, b);
            // Simpson's rule: exact where the distance from the chord grows evenly.
            sum += side * (near + 4.0 * mid + far) / 6.0;
            long += side;
            greatest = greatest.max(near).max(far);
        }
        from = to;
    }
    let mean = if long > 0.0 { sum / long } else { 0.0 };
    ShapeError {
        max: sqrt(greatest),
        rms: sqrt(mean),
    }
}

#[cfg(test)]
mod tests;
