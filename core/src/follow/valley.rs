//! Poses along what a frame tells least of.
//!
//! Where an outline hardly changes along some turn, as that of a tray seen along its plate, small minima follow one another there, and
//! refinement ends in the nearest.

use heapless::Vec;

use crate::finder::nearby::about;
use crate::math::eigen::eigen_symmetric;
use crate::math::{Vector3, apply, radians, scale, sqrt};
use crate::pose::Pose;
use crate::pose::covariance::PoseCovariance;

/// Starts are turned by so many degrees along what is known least,
const VALLEY_DEG: f64 = 5.0;
/// and by so many standard deviations of it.
const VALLEY_DEVIATIONS: f64 = 2.0;
const VALLEY: usize = 4;

/// Starts along the turn that the frame tells least of, where its equations see the same all along: other minima lie there.
pub(super) fn along_valley(
    (pose, covariance): (&Pose, Option<&PoseCovariance>),
    middle: &Vector3,
) -> Vec<Pose, VALLEY> {
    let step = covariance.and_then(valley);
    let start = |by: f64, [turn, shift]: &[Vector3; 2]| {
        about(middle, pose, &scale(turn, by), scale(shift, by))
    };
    let starts = step.iter().flat_map(|(deviation, step)| {
        let far = radians(VALLEY_DEG);
        let near = VALLEY_DEVIATIONS * deviation;
        [-far, far, -near, near].map(|by| start(by, step))
    });
    starts.collect()
}

/// The turn of unit length that is known least, with its standard deviation, radians, and the shift that goes with it, mm a radian.
fn valley(covariance: &PoseCovariance) -> Option<(f64, [Vector3; 2])> {
    let block = |row: usize| {
        core::array::from_fn(|k: usize| covariance.matrix[row + k])
            .map(|row: [f64; 6]| [row[0], row[1], row[2]])
    };
    let ([most, ..], [turn, ..]) = eigen_symmetric(&block(0));
    let shift = scale(&apply(&block(3), &turn), 1.0 / most);
    (most > 0.0).then(|| (sqrt(most), [turn, shift]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::follow::fake::turned;
    use crate::pose::geodesic_deg;

    #[test]
    fn starts_lie_along_the_turn_that_is_known_least_with_the_shift_that_goes_with_it() {
        let pose = turned(0.0, 0.1).pose;
        let deviation = radians(0.4);
        let mut matrix = [[0.0; 6]; 6];
        for (k, row) in matrix.iter_mut().enumerate() {
            row[k] = radians(0.1) * radians(0.1);
        }
        // A turn about y of one radian goes with 50 mm of depth.
        matrix[1][1] = deviation * deviation;
        (matrix[1][5], matrix[5][1]) = (50.0 * matrix[1][1], 50.0 * matrix[1][1]);
        let covariance = PoseCovariance { matrix };
        let starts = along_valley((&pose, Some(&covariance)), &[0.0; 3]);
        let turns = starts
            .iter()
            .map(|start| geodesic_deg(&start.rotation, &pose.rotation));
        for (turn, expected) in turns.zip([5.0, 5.0, 0.8, 0.8]) {
            assert!((turn - expected).abs() < 1e-6, "{turn} for {expected}");
        }
        for start in &starts {
            let [x, y, z] = start.translation;
            // The turn about y, to the right-hand side, is what x of the third axis tells.
            let by = start.rotation[0][2].asin();
            assert!(
                x.abs() + y.abs() < 1e-9 && (z + 1000.0 - 50.0 * by).abs() < 1e-6,
                "{start:?}"
            );
        }
        assert!(along_valley((&pose, None), &[0.0; 3]).is_empty());
    }
}
