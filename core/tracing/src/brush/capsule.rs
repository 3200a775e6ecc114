//! What a disc covers while it moves straight on.

use heapless::Vec;

use crate::polyline::side;
use fluoropose::image::contour::Point;
use fluoropose::math::{atan2, sin_cos, sqrt};

/// Corners of half a circle, at most.
const HALF: usize = 112;
/// Corners of a capsule, at most.
pub(super) const MOST_CORNERS: usize = 2 * (HALF + 1);
/// How far a side of the polygon may lie inside of the circle, pixels.
const FLAT: f64 = 0.05;

/// A convex polygon that runs clockwise on the screen.
pub(super) struct Capsule {
    corners: Vec<Point, MOST_CORNERS>,
}

impl Capsule {
    pub(super) fn new(from: Point, to: Point, radius: f64) -> Self {
        let parts = half_parts(radius);
        let (right, down) = (to.column - from.column, to.row - from.row);
        let ahead = atan2(down, right);
        let mut corners = Vec::new();
        // Around the far end from its left hand to its right, then around the near end.
        for (end, turn) in [(to, ahead), (from, ahead + core::f64::consts::PI)] {
            for part in 0..=parts {
                let fraction = part as f64 / parts as f64 - 0.5;
                let (sin, cos) = sin_cos(turn + fraction * core::f64::consts::PI);
                let corner = Point::new(end.column + radius * cos, end.row + radius * sin);
                // At most `MOST_CORNERS`. Of a disc that does not move the ends of both halves fall together.
                let twice = corners.last().is_some_and(|&last| near(last, corner));
                let again = corners.first().is_some_and(|&first| near(first, corner));
                if !twice && !again {
                    let _ = corners.push(corner);
                }
            }
        }
        Self { corners }
    }

    pub(super) fn corners(&self) -> &[Point] {
        &self.corners
    }

    /// Whether a point lies inside.
    pub(super) fn holds(&self, point: Point) -> bool {
        let mut sides = (0..self.corners.len()).map(|number| side(&self.corners, number));
        sides.all(|(a, b)| {
            (b.column - a.column) * (point.row - a.row)
                > (b.row - a.row) * (point.column - a.column)
        })
    }
}

fn near(a: Point, b: Point) -> bool {
    (a.column - b.column).abs() + (a.row - b.row).abs() < 1e-9
}

/// Sides of half a circle.
fn half_parts(radius: f64) -> usize {
    // A side that spans the angle a lies r (1 - cos(a / 2)), about r a^2 / 8, inside of the circle.
    let parts = core::f64::consts::PI / sqrt(8.0 * FLAT / radius);
    (parts as usize + 1).clamp(4, HALF)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polyline::{distance, squared_distance, twice_area};

    #[test]
    fn a_capsule_is_convex_clockwise_and_as_wide_as_the_disc() {
        let from = Point::new(20.0, 30.0);
        for (to, radius) in [
            (from, 8.0),
            (Point::new(41.0, 11.0), 3.0),
            (Point::new(20.0, 31.0), 200.0),
        ] {
            let capsule = Capsule::new(from, to, radius);
            let corners = capsule.corners();
            for k in 0..corners.len() {
                let at = |n: usize| corners[n % corners.len()];
                let (a, b, c) = (at(k), at(k + 1), at(k + 2));
                let turn = (b.column - a.column) * (c.row - b.row)
                    - (b.row - a.row) * (c.column - b.column);
                assert!(turn > -1e-6, "{turn}");
                let middle = Point::new((a.column + b.column) / 2.0, (a.row + b.row) / 2.0);
                let away = squared_distance(middle, (from, to)).sqrt();
                assert!(
                    away <= radius + 1e-9 && away > radius - 1.2 * FLAT,
                    "{away} {radius}"
                );
            }
            assert!(capsule.holds(from) && capsule.holds(to));
            assert!(!capsule.holds(Point::new(20.0 - 1.01 * radius, 30.0)));
            let long = distance(from, to);
            let wanted = core::f64::consts::PI * radius * radius + 2.0 * radius * long;
            assert!((twice_area(corners) / 2.0 / wanted - 1.0).abs() < 0.02);
        }
    }
}
