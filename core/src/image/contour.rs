//! Outlines: polygons traced around a silhouette, in sub-pixel image coordinates.

use heapless::Vec;
use thiserror::Error;

use super::crossing::orientation;
use crate::math::Decimal;

pub use super::crossing::first_crossing;
pub use super::point::Point;

/// A traced polygon in fixed memory: at most `N` vertices.
pub type Contour<const N: usize> = Vec<Point, N>;

/// Why a polygon is not an outline. Fields count points from 0, sentences from 1.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum OutlineError {
    /// Fewer than three vertices.
    #[error("the outline has {0} points; it needs at least 3")]
    TooFewPoints(usize),
    /// A coordinate is NaN or infinite.
    #[error("point {} of the outline has a coordinate that is not a number", .0 + 1)]
    NotFinite(usize),
    /// A vertex lies beyond the frame's border.
    #[error(
        "point {} of the outline, at column {}, row {}, is outside the frame", index + 1, Decimal::new(*column, 1), Decimal::new(*row, 1)
    )]
    OutsideFrame {
        /// Which vertex, from 0.
        index: usize,
        /// Where it is.
        column: f64,
        /// Where it is.
        row: f64,
    },
    /// Two sides meet where they should not.
    #[error(
        "the outline crosses itself: the side after point {} meets the side after point {}; move one of their points",
        first + 1,
        second + 1
    )]
    SelfCrossing {
        /// The side from this vertex to the next, from 0.
        first: usize,
        /// The other side.
        second: usize,
    },
    /// All vertices lie on one line.
    #[error("the outline encloses no area")]
    ZeroArea,
}

/// A polygon that is known to be closed, simple and inside its frame. The last vertex is joined to the first; it may be written once more
/// at the end, as files of polygons have it.
#[derive(Clone, Copy, Debug)]
pub struct Outline<'a> {
    points: &'a [Point],
}

impl<'a> Outline<'a> {
    /// Checks `points` against a frame of `width` x `height` pixels.
    ///
    /// # Errors
    /// An [`OutlineError`] that names the first offending point or pair of sides.
    pub fn new(points: &'a [Point], width: usize, height: usize) -> Result<Self, OutlineError> {
        let points = once_each(points);
        if points.len() < 3 {
            return Err(OutlineError::TooFewPoints(points.len()));
        }
        for (index, point) in points.iter().enumerate() {
            if !point.is_finite() {
                return Err(OutlineError::NotFinite(index));
            }
            if !(is_within(point.column, width) && is_within(point.row, height)) {
                return Err(OutlineError::OutsideFrame {
                    index,
                    column: point.column,
                    row: point.row,
                });
            }
        }
        // Before crossings, because points on one line also fold back; a crossing polygon may
        // enclose equal areas of both signs, so its area says nothing.
        if on_one_line(points) {
            return Err(OutlineError::ZeroArea);
        }
        let at = |number: usize| points.get(number).copied().unwrap_or_default();
        match first_crossing(points.len(), at) {
            Some((first, second)) => Err(OutlineError::SelfCrossing { first, second }),
            None => Ok(Self { points }),
        }
    }

    /// The vertices.
    #[must_use]
    pub fn points(&self) -> &'a [Point] {
        self.points
    }

    /// The sides, each as its two ends; the last one closes the polygon.
    pub fn sides(&self) -> impl Iterator<Item = (Point, Point)> + use<'a> {
        sides(self.points)
    }

    /// Enclosed area in square pixels, never negative.
    #[must_use]
    pub fn area(&self) -> f64 {
        libm::fabs(signed_area(self.points))
    }
}

/// Vertices without the first one's second mention at the end.
fn once_each(points: &[Point]) -> &[Point] {
    match points {
        [before @ .., last] if before.len() >= 3 && before.first() == Some(last) => before,
        _ => points,
    }
}

/// Whether a finite coordinate is between 0 and `most`. Bits of numbers that are not negative rise with them, and to compare those takes a
/// tenth of the time on a processor without numbers of 64 bits.
fn is_within(value: f64, most: usize) -> bool {
    value.to_bits() <= (most as f64).to_bits() || value == 0.0
}

fn sides(points: &[Point]) -> impl Iterator<Item = (Point, Point)> + '_ {
    let next = points.iter().cycle().skip(1);
    points.iter().copied().zip(next.copied())
}

/// Shoelace formula; positive where the polygon runs clockwise on the screen. The coordinates
/// are taken from the first vertex, so a small outline far from the corner loses no digits.
fn signed_area(points: &[Point]) -> f64 {
    let origin = points.first().copied().unwrap_or_default();
    let shifted = |p: Point| (p.column - origin.column, p.row - origin.row);
    let twice: f64 = sides(points)
        .map(|(a, b)| {
            let ((ax, ay), (bx, by)) = (shifted(a), shifted(b));
            ax * by - bx * ay
        })
        .sum();
    twice / 2.0
}

fn on_one_line(points: &[Point]) -> bool {
    let first = points.first().copied().unwrap_or_default();
    let other = points.iter().copied().find(|&point| point != first);
    other.is_none_or(|other| points.iter().all(|&p| orientation(first, other, p) == 0.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points<const N: usize>(pairs: [(f64, f64); N]) -> [Point; N] {
        pairs.map(|(column, row)| Point::new(column, row))
    }

    #[test]
    fn a_square_is_an_outline() {
        let square = points([(1.0, 1.0), (5.0, 1.0), (5.0, 5.0), (1.0, 5.0)]);
        let outline = Outline::new(&square, 8, 8).expect("valid");
        assert_eq!(outline.area(), 16.0);
        assert_eq!(outline.sides().count(), 4);
        let reversed = points([(1.0, 5.0), (5.0, 5.0), (5.0, 1.0), (1.0, 1.0)]);
        assert_eq!(
            Outline::new(&reversed, 8, 8).map(|o| o.area()).ok(),
            Some(16.0)
        );
    }

    #[test]
    fn the_first_vertex_may_be_written_once_more_at_the_end() {
        let closed = points([(1.0, 1.0), (5.0, 1.0), (5.0, 5.0), (1.0, 1.0)]);
        let outline = Outline::new(&closed, 8, 8).expect("valid");
        assert_eq!((outline.points().len(), outline.area()), (3, 8.0));
        // Twice more is a side without a length, as anywhere else.
        let twice = points([(1.0, 1.0), (5.0, 1.0), (5.0, 5.0), (1.0, 1.0), (1.0, 1.0)]);
        assert!(matches!(
            Outline::new(&twice, 8, 8),
            Err(OutlineError::SelfCrossing { .. })
        ));
    }

    #[test]
    fn each_fault_has_its_name() {
        let error = |points: &[Point]| Outline::new(points, 8, 8).map(|_| ()).err();
        assert_eq!(
            error(&points([(1.0, 1.0), (2.0, 2.0)])),
            Some(OutlineError::TooFewPoints(2))
        );
        assert_eq!(
            error(&points([(1.0, 1.0), (2.0, f64::NAN), (3.0, 1.0)])),
            Some(OutlineError::NotFinite(1))
        );
        assert_eq!(
            error(&points([(1.0, 1.0), (2.0, 2.0), (9.0, 1.0)])),
            Some(OutlineError::OutsideFrame {
                index: 2,
                column: 9.0,
                row: 1.0
            })
        );
        assert_eq!(
            error(&points([(1.0, 1.0), (2.0, 2.0), (4.0, 4.0)])),
            Some(OutlineError::ZeroArea)
        );
        let even = points([(1.0, 1.0), (5.0, 5.0), (5.0, 1.0), (1.0, 5.0)]);
        assert!(matches!(
            error(&even),
            Some(OutlineError::SelfCrossing { .. })
        ));
        assert_eq!(
            error(&points([(3.0, 3.0); 4])),
            Some(OutlineError::ZeroArea)
        );
        let bow_tie = points([(1.0, 1.0), (5.0, 5.0), (5.0, 1.0), (1.0, 6.0)]);
        assert_eq!(
            error(&bow_tie),
            Some(OutlineError::SelfCrossing {
                first: 0,
                second: 2
            })
        );
        let spike = points([(1.0, 1.0), (5.0, 1.0), (3.0, 1.0), (3.0, 5.0)]);
        assert_eq!(
            error(&spike),
            Some(OutlineError::SelfCrossing {
                first: 0,
                second: 1
            })
        );
        let doubled = points([(1.0, 1.0), (5.0, 1.0), (5.0, 1.0), (3.0, 5.0)]);
        assert!(matches!(
            error(&doubled),
            Some(OutlineError::SelfCrossing { .. })
        ));
        let touching = points([(1.0, 1.0), (5.0, 1.0), (5.0, 5.0), (3.0, 1.0), (1.0, 5.0)]);
        assert!(matches!(
            error(&touching),
            Some(OutlineError::SelfCrossing { .. })
        ));
    }

    #[test]
    fn the_border_of_the_frame_is_within_it() {
        for inside in [0.0, -0.0, f64::MIN_POSITIVE, 7.5, 8.0] {
            assert!(is_within(inside, 8), "{inside}");
        }
        for outside in [-f64::MIN_POSITIVE, -3.0, 8.0f64.next_up(), 1e300] {
            assert!(!is_within(outside, 8), "{outside}");
        }
    }

    #[test]
    fn a_point_in_the_middle_of_a_side_is_allowed() {
        let square = points([(1.0, 1.0), (3.0, 1.0), (5.0, 1.0), (5.0, 5.0), (1.0, 5.0)]);
        assert!(Outline::new(&square, 8, 8).is_ok());
    }

    #[test]
    fn a_small_outline_far_from_the_corner_loses_no_digits() {
        // As short as numbers there can tell: differences are exact, sums and their products are not.
        let side = libm::ldexp(1.0, -40);
        let [column, row] = [4000.0, 3000.5];
        let triangle = points([
            (column, row),
            (column + 3.0 * side, row),
            (column + side, row + 2.0 * side),
        ]);
        for turned in [false, true] {
            let mut triangle = triangle;
            if turned {
                triangle.reverse();
            }
            let outline = Outline::new(&triangle, 4096, 4096).expect("valid");
            assert_eq!(outline.area(), 3.0 * side * side);
        }
    }
}
