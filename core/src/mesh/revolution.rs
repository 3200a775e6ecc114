//! That a part is round: a body of revolution looks the same however far it is turned about its axis.

use core::f64::consts::PI;

use crate::math::{Vector3, apply, cross, subtract};
use crate::pose::Pose;
use crate::pose::covariance::PoseCovariance;

/// The axis of a body of revolution, about which no outline tells how far it is turned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Revolution {
    /// A point of the axis in the middle of the surface, model coordinates, mm.
    pub point: Vector3,
    /// Unit vectors along the axis, model coordinates; of a ball, which has them in all directions, three that are perpendicular.
    directions: [Vector3; 3],
    /// Whether it is a ball.
    pub is_ball: bool,
}

/// Variance of an angle of which nothing is known, from a half turn back to a half turn on, square radians.
const ANY_TURN: f64 = PI * PI / 3.0;

impl Revolution {
    /// The first of `directions` is the axis; of a ball all three are.
    pub(super) fn new(point: Vector3, directions: [Vector3; 3], is_ball: bool) -> Self {
        Self {
            point,
            directions,
            is_ball,
        }
    }

    /// Unit vectors along the axis, model coordinates: one, or of a ball three.
    #[must_use]
    pub fn directions(&self) -> &[Vector3] {
        let count = if self.is_ball { 3 } else { 1 };
        self.directions.get(..count).unwrap_or_default()
    }

    /// The covariance of a pose, `middle` the middle of the model, with what no outline tells: the turn about the axis. What an outline seems to tell
    /// of it are the facets of the mesh and the pixels.
    #[must_use]
    pub fn widen(
        &self,
        covariance: PoseCovariance,
        pose: &Pose,
        middle: &Vector3,
    ) -> PoseCovariance {
        let arm = apply(&pose.rotation, &subtract(middle, &self.point));
        let mut matrix = covariance.matrix;
        for direction in self.directions() {
            let [a, b, c] = apply(&pose.rotation, direction);
            let [x, y, z] = cross(&[a, b, c], &arm);
            let step = [a, b, c, x, y, z];
            for (row, own) in matrix.iter_mut().zip(step) {
                for (entry, other) in row.iter_mut().zip(step) {
                    *entry += ANY_TURN * own * other;
                }
            }
        }
        PoseCovariance { matrix }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{degrees, rotation_by, sqrt};
    use crate::pose::covariance::Matrix6;

    /// The root of the variance of a pose along a step of it, of unit length in its turn.
    fn deviation(matrix: &Matrix6, step: &[f64; 6]) -> f64 {
        let length: f64 = step.iter().map(|x| x * x).sum();
        let sum: f64 = (0..36)
            .map(|k| step[k / 6] * matrix[k / 6][k % 6] * step[k % 6])
            .sum();
        sqrt(sum.max(0.0)) / length
    }

    #[test]
    fn the_turn_about_the_axis_alone_is_open_and_of_a_ball_every_turn() {
        let pose = Pose {
            rotation: rotation_by(&[0.4, -1.1, 0.7]),
            translation: [3.0, -20.0, -950.0],
        };
        let directions = [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]];
        let known = PoseCovariance {
            matrix: [[0.0; 6]; 6],
        };
        let turn = |direction: &Vector3| {
            let [a, b, c] = apply(&pose.rotation, direction);
            [a, b, c, 0.0, 0.0, 0.0]
        };
        // About an axis through the middle of the model.
        let middle = [5.0, 40.0, -2.0];
        let axis = Revolution::new([5.0, 0.0, -2.0], directions, false);
        let widened = axis.widen(known, &pose, &middle).matrix;
        assert!((degrees(deviation(&widened, &turn(&directions[0]))) - 103.9).abs() < 0.1);
        assert!(deviation(&widened, &turn(&directions[1])) < 1e-6);
        assert!((3..6).all(|k| widened[k][k].abs() < 1e-12));
        // Beside it the middle goes around with the turn: nothing else is open.
        let beside = Revolution::new([15.0, 0.0, -2.0], directions, false);
        let widened = beside.widen(known, &pose, &middle).matrix;
        let shift: f64 = (3..6).map(|k| widened[k][k]).sum();
        assert!((sqrt(shift) - 10.0 * sqrt(ANY_TURN)).abs() < 1e-9);
        let ball = Revolution::new(middle, directions, true);
        let widened = ball.widen(known, &pose, &middle).matrix;
        for direction in directions {
            assert!(degrees(deviation(&widened, &turn(&direction))) > 100.0);
        }
    }
}
