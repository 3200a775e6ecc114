//! Poses along what a frame tells least of.
//!
//! Where an outline hardly changes along some turn, as that of a tray seen along its plate, small minima follow one another there, and
//! refinement ends in the nearest.

use heapless::Vec;

use super::frame_pose::FramePose;
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
pub(super) fn along_valley(own: &FramePose, middle: &Vector3) -> Vec<Pose, VALLEY> {
    let step = own.covariance.and_then(|covariance| valley(&covariance));
    let start = |by: f64, [turn, shift]: &[Vector3; 2]| {
        about(middle, &own.pose, &scale(turn, by), scale(shift, by))
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
