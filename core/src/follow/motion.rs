//! Where a component is expected, from frames in which its pose is known.

use crate::math::{
    Vector3, add, apply, atan2, cross, degrees, dot, multiply, norm, rotation_by, rotation_vector,
    scale, subtract, transpose,
};
use crate::pose::Pose;

/// A pose in a frame of a film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Known {
    /// Number of the frame, from 0.
    pub frame: usize,
    /// `camera_from_model`.
    pub pose: Pose,
}

/// A pose that is expected in a frame, and how far from it the component may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Expected {
    /// `camera_from_model`.
    pub pose: Pose,
    /// Farthest turn from it that is in the ordinary, degrees.
    pub turn_deg: f64,
    /// Farthest way of the model's middle in the image plane, mm.
    pub shift_mm: f64,
    /// Farthest way along the view, mm.
    pub depth_mm: f64,
}

/// The pose at `fraction` of the way from one pose to another: turned at a constant rate about one axis, the model's
/// `middle` on a straight line. Below 0 and above 1 it goes on like that, but for the distance from the camera, which is the
/// weakest number and stays at that of the nearer of the two.
#[must_use]
pub fn between(from: &Pose, to: &Pose, fraction: f64, middle: &Vector3) -> Pose {
    let turn = rotation_vector(&multiply(&to.rotation, &transpose(&from.rotation)));
    let rotation = multiply(&rotation_by(&scale(&turn, fraction)), &from.rotation);
    let start = from.transform(middle);
    let way = subtract(&to.transform(middle), &start);
    let straight = add(&start, &scale(&way, fraction));
    let depth = start[2] + way[2] * fraction.clamp(0.0, 1.0);
    // Along the ray, so that the place in the image goes on straight.
    let centre = match straight[2] < 0.0 {
        true => scale(&straight, depth / straight[2]),
        false => straight,
    };
    Pose {
        rotation,
        translation: subtract(&centre, &apply(&rotation, middle)),
    }
}

/// Angle between the directions of the camera's axis in the model's axes at two poses, degrees: turns in the image plane, and shifts, leave it as it
/// is.
#[cfg(feature = "alloc")]
pub(super) fn out_of_plane_deg(a: &Pose, b: &Pose) -> f64 {
    between_deg(&a.rotation[2], &b.rotation[2])
}

/// How far a pose lies off the way between two others in that direction, degrees. Limbs swing fast in the image plane, and hardly out of it.
pub(super) fn off_out_of_plane_deg(pose: &Pose, [before, after]: [&Pose; 2]) -> f64 {
    let midway = add(&before.rotation[2], &after.rotation[2]);
    between_deg(&midway, &pose.rotation[2])
}

/// Angle between two directions of any length, degrees.
pub(super) fn between_deg(a: &Vector3, b: &Vector3) -> f64 {
    degrees(atan2(norm(&cross(a, b)), dot(a, b)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pose::{EulerPose, geodesic_deg};
    use proptest::prelude::*;

    fn pose(place: Vector3, angles: Vector3) -> Pose {
        let ([x_mm, y_mm, z_mm], [z_rot_deg, x_rot_deg, y_rot_deg]) = (place, angles);
        Pose::from(EulerPose {
            x_mm,
            y_mm,
            z_mm: z_mm - 1000.0,
            z_rot_deg,
            x_rot_deg,
            y_rot_deg,
        })
    }

    properties! {
        #[test]
        fn both_ends_are_met_and_the_middle_halves_the_turn(
            places in proptest::array::uniform2(proptest::array::uniform3(-60.0..60.0f64)),
            angles in proptest::array::uniform2(proptest::array::uniform3(-30.0..30.0f64)),
            middle in proptest::array::uniform3(-40.0..40.0f64),
        ) {
            let [a, b] = [pose(places[0], angles[0]), pose(places[1], angles[1])];
            for (fraction, end) in [(0.0, a), (1.0, b)] {
                let met = between(&a, &b, fraction, &middle);
                prop_assert!(met.is_rigid(1e-9));
                prop_assert!(geodesic_deg(&met.rotation, &end.rotation) < 1e-6);
                let apart = subtract(&met.translation, &end.translation);
                prop_assert!(norm(&apart) < 1e-6);
            }
            let half = between(&a, &b, 0.5, &middle);
            let whole = geodesic_deg(&a.rotation, &b.rotation);
            prop_assert!((geodesic_deg(&a.rotation, &half.rotation) - whole / 2.0).abs() < 1e-6);
        }

        #[test]
        fn beyond_the_last_pose_the_distance_stays(
            place in proptest::array::uniform3(-60.0..60.0f64), fraction in 1.0..3.0f64
        ) {
            let (a, b) = (pose([0.0; 3], [0.0; 3]), pose(place, [10.0, 2.0, -3.0]));
            let middle = [5.0, -8.0, 3.0];
            let on = between(&a, &b, fraction, &middle);
            prop_assert!((on.transform(&middle)[2] - b.transform(&middle)[2]).abs() < 1e-9);
            let turn = geodesic_deg(&a.rotation, &on.rotation);
            prop_assert!((turn - fraction * geodesic_deg(&a.rotation, &b.rotation)).abs() < 1e-6);
        }
    }
}
