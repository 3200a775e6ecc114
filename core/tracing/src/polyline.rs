//! Lines through points: lengths, distances, and points along them.

use crate::error::TracingError;
use crate::vertex::Vertex;
use fluoropose::image::contour::Point;
use fluoropose::image::scan::MAX_COORDINATE;
use fluoropose::math::sqrt;

/// Refuses a line of fewer points than `least`, or with a coordinate that is no place on a frame.
pub(crate) fn check(points: &[Point], least: usize) -> Result<(), TracingError> {
    if points.len() < least {
        return Err(TracingError::TooFewPoints {
            given: points.len(),
            needed: least,
        });
    }
    let place = |value: f64| (-MAX_COORDINATE..=MAX_COORDINATE).contains(&value);
    let wrong = points
        .iter()
        .position(|p| !place(p.column) || !place(p.row));
    wrong.map_or(Ok(()), |at| Err(TracingError::NotAPlace(at)))
}

/// Number of sides of a line through `count` points.
pub(crate) fn side_count(count: usize, closed: bool) -> usize {
    if closed {
        count
    } else {
        count.saturating_sub(1)
    }
}

/// The ends of side `number`; the last side of a closed line ends at the first point.
pub(crate) fn side(points: &[Point], number: usize) -> (Point, Point) {
    let count = points.len().max(1);
    let at = |k: usize| points.get(k % count).copied().unwrap_or_default();
    (at(number), at(number + 1))
}

pub(crate) fn distance(a: Point, b: Point) -> f64 {
    let (right, down) = (b.column - a.column, b.row - a.row);
    sqrt(right * right + down * down)
}

/// The point of a segment at the fraction `t` of it.
pub(crate) fn between((a, b): (Point, Point), t: f64) -> Point {
    Point::new(
        a.column + t * (b.column - a.column),
        a.row + t * (b.row - a.row),
    )
}

/// Squared distance of a point from a segment, square pixels.
#[must_use]
pub fn squared_distance(point: Point, (a, b): (Point, Point)) -> f64 {
    let (right, down) = (b.column - a.column, b.row - a.row);
    let (x, y) = (point.column - a.column, point.row - a.row);
    let length = right * right + down * down;
    let along = if length > 0.0 {
        ((x * right + y * down) / length).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let (x, y) = (x - along * right, y - along * down);
    x * x + y * y
}

/// Length of a line.
pub(crate) fn length(points: &[Point], closed: bool) -> f64 {
    (0..side_count(points.len(), closed))
        .map(|number| side(points, number))
        .map(|(a, b)| distance(a, b))
        .sum()
}

/// Twice the enclosed area, positive where the line runs clockwise on the screen.
pub(crate) fn twice_area(points: &[Point]) -> f64 {
    let origin = points.first().copied().unwrap_or_default();
    (0..points.len())
        .map(|number| side(points, number))
        .map(|(a, b)| {
            (a.column - origin.column) * (b.row - origin.row)
                - (a.row - origin.row) * (b.column - origin.column)
        })
        .sum()
}

/// Number of points that [`subdivide`] emits.
pub(crate) fn subdivided_count(points: &[Point], closed: bool, spacing: f64) -> usize {
    let sides =
        (0..side_count(points.len(), closed)).map(|number| parts(side(points, number), spacing));
    sides.sum::<usize>() + usize::from(!closed)
}

fn parts((a, b): (Point, Point), spacing: f64) -> usize {
    (libm::ceil(distance(a, b) / spacing) as usize).max(1)
}

/// Calls `emit` for the line's points and, along each of its sides, for points at equal distances of at most `spacing`.
pub(crate) fn subdivide(
    points: &[Point],
    closed: bool,
    spacing: f64,
    mut emit: impl FnMut(Vertex) -> Result<(), TracingError>,
) -> Result<(), TracingError> {
    for number in 0..side_count(points.len(), closed) {
        let ends = side(points, number);
        let count = parts(ends, spacing);
        emit(Vertex::kept(number, ends.0))?;
        for part in 1..count {
            let t = part as f64 / count as f64;
            emit(Vertex::from_side(number, t, between(ends, t)))?;
        }
    }
    match points.last() {
        Some(&last) if !closed => emit(Vertex::kept(points.len() - 1, last)),
        _ => Ok(()),
    }
}

/// Calls `emit` for `count` points at equal distances along a closed line, from its first point on.
pub(crate) fn space_evenly(
    points: &[Point],
    count: usize,
    mut emit: impl FnMut(Vertex) -> Result<(), TracingError>,
) -> Result<(), TracingError> {
    let step = length(points, true) / count.max(1) as f64;
    let (mut passed, mut emitted) = (0.0, 0);
    for number in 0..points.len() {
        let ends = side(points, number);
        let long = distance(ends.0, ends.1);
        while emitted < count && emitted as f64 * step < passed + long {
            let t = ((emitted as f64 * step - passed) / long).clamp(0.0, 1.0);
            emit(Vertex::from_side(number, t, between(ends, t)))?;
            emitted += 1;
        }
        passed += long;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> [Point; 4] {
        [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)].map(|(c, r)| Point::new(c, r))
    }

    #[test]
    fn subdividing_keeps_the_points_and_counts_right() {
        for closed in [false, true] {
            for spacing in [0.7, 1.0, 3.0, 9.0] {
                let mut made = std::vec::Vec::new();
                let emit = |vertex| {
                    made.push(vertex);
                    Ok(())
                };
                subdivide(&square(), closed, spacing, emit).expect("pushes");
                assert_eq!(made.len(), subdivided_count(&square(), closed, spacing));
                let kept = made.iter().filter_map(Vertex::kept_number);
                assert!(kept.eq(0..4));
                for pair in made.windows(2) {
                    assert!(distance(pair[0].at, pair[1].at) <= spacing + 1e-12);
                }
            }
        }
    }

    #[test]
    fn even_points_go_around_once() {
        let mut made = std::vec::Vec::new();
        let emit = |vertex: Vertex| {
            made.push(vertex.at);
            Ok(())
        };
        space_evenly(&square(), 5, emit).expect("pushes");
        let wanted = [(0.0, 0.0), (3.2, 0.0), (4.0, 2.4), (2.4, 4.0), (0.0, 3.2)];
        for (point, (column, row)) in made.iter().zip(wanted) {
            assert!(distance(*point, Point::new(column, row)) < 1e-12);
        }
        assert_eq!(made.len(), 5);
        assert_eq!(
            (length(&square(), true), twice_area(&square())),
            (16.0, 32.0)
        );
    }

    /// Oracle: the way along the line, point by point.
    #[test]
    fn even_points_know_how_far_along_the_line_they_are() {
        let uneven = [(0.0, 0.0), (4.0, 0.0), (4.0, 3.0)].map(|(c, r)| Point::new(c, r));
        for (points, count) in [
            (&square()[..], 4),
            (&square()[..], 8),
            (&uneven[..], 12),
            (&uneven[..], 7),
        ] {
            let whole = length(points, true);
            let mut made = std::vec::Vec::new();
            let emit = |vertex: Vertex| {
                made.push(vertex);
                Ok(())
            };
            space_evenly(points, count, emit).expect("pushes");
            assert_eq!(made.len(), count);
            for (k, vertex) in made.iter().enumerate() {
                let number = vertex.from as usize;
                let ends = side(points, number);
                let sides = (0..number).map(|number| side(points, number));
                let before: f64 = sides.map(|(a, b)| distance(a, b)).sum();
                let along = before + (vertex.from - number as f64) * distance(ends.0, ends.1);
                assert!((along - whole * k as f64 / count as f64).abs() < 1e-6);
                assert!(distance(vertex.at, between(ends, vertex.from - number as f64)) < 1e-6);
                // A corner is the beginning of its side, not the end of the one before.
                assert!(vertex.from - (number as f64) < 1.0 - 1e-6);
            }
        }
    }

    #[test]
    fn what_is_no_line_is_said() {
        let mut points = square();
        assert_eq!(check(&points, 3), Ok(()));
        points[2].row = f64::NAN;
        assert_eq!(check(&points, 3), Err(TracingError::NotAPlace(2)));
        let few = TracingError::TooFewPoints {
            given: 2,
            needed: 3,
        };
        assert_eq!(check(&points[..2], 3), Err(few));
    }
}
