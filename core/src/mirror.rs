//! The mirror trap: a part with a plane of symmetry has two poses with nearly one silhouette.
//!
//! Reflected in the plane through its middle that is perpendicular to the ray to it, an object
//! keeps its silhouette but for perspective; reflected in its own plane of symmetry it is
//! itself. Both together are a rotation: `R' = (I - 2 d d^T) R M`, `d` the unit ray to the middle
//! and `M` the reflection in the part's plane.

use crate::math::{IDENTITY, Vector3, add, apply, multiply, norm, scale};
use crate::pose::Pose;

/// The pose with the mirrored view, for a part symmetric about the plane through `middle` that is
/// perpendicular to its axis number `axis` (0 to 2, model coordinates, mm). It leaves `middle`
/// where it is. Mirroring twice gives the pose back.
///
/// For `middle` at the focus or an axis beyond 2 the pose is returned as it is.
#[must_use]
pub fn mirror_pose(pose: &Pose, middle: &Vector3, axis: usize) -> Pose {
    let centre = pose.transform(middle);
    let distance = norm(&centre);
    if distance == 0.0 || axis > 2 {
        return *pose;
    }
    let ray = scale(&centre, 1.0 / distance);
    let mut reflection = IDENTITY;
    for (row, values) in reflection.iter_mut().enumerate() {
        for (column, value) in values.iter_mut().enumerate() {
            *value -= 2.0 * ray[row] * ray[column];
        }
    }
    let mut rotation = multiply(&reflection, &pose.rotation);
    for row in &mut rotation {
        row[axis] = -row[axis];
    }
    Pose {
        rotation,
        translation: add(&centre, &scale(&apply(&rotation, middle), -1.0)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pose::{EulerPose, geodesic_deg};
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn mirroring_is_rigid_undoes_itself_and_keeps_the_middle(
            z in -180.0..180.0f64, x in -20.0..20.0f64, y in -20.0..20.0f64,
            shift in -80.0..80.0f64, axis in 0usize..3
        ) {
            let pose = Pose::from(EulerPose {
                x_mm: shift, y_mm: -shift / 2.0, z_mm: -1000.0,
                z_rot_deg: z, x_rot_deg: x, y_rot_deg: y,
            });
            let middle = [3.0, -8.0, 5.0];
            let mirrored = mirror_pose(&pose, &middle, axis);
            prop_assert!(mirrored.is_rigid(1e-12));
            let (a, b) = (pose.transform(&middle), mirrored.transform(&middle));
            prop_assert!(norm(&add(&a, &scale(&b, -1.0))) < 1e-9);
            let back = mirror_pose(&mirrored, &middle, axis);
            prop_assert!(geodesic_deg(&back.rotation, &pose.rotation) < 1e-6);
        }
    }

    #[test]
    fn on_the_axis_both_out_of_plane_rotations_change_their_sign() {
        let euler = EulerPose {
            z_mm: -1000.0,
            z_rot_deg: -84.0,
            x_rot_deg: 0.6,
            y_rot_deg: -9.0,
            ..EulerPose::default()
        };
        let mirrored = EulerPose::from(mirror_pose(&Pose::from(euler), &[0.0; 3], 2));
        assert!((mirrored.z_rot_deg + 84.0).abs() < 1e-9);
        assert!((mirrored.x_rot_deg + 0.6).abs() < 1e-9);
        assert!((mirrored.y_rot_deg - 9.0).abs() < 1e-9);
    }
}
