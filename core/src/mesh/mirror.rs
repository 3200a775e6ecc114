//! The mirror trap: a part with a plane of symmetry has two poses with nearly one silhouette.
//!
//! Reflected in the plane through its middle that is perpendicular to the ray to it, an object
//! keeps its silhouette but for perspective; reflected in its own plane of symmetry it is nearly
//! itself. Both together are a rotation: `R' = (I - 2 d d^T) R (I - 2 n n^T)`, `d` the unit ray
//! to the middle and `n` the normal of the part's plane.

use crate::math::{IDENTITY, Matrix3, Vector3, add, apply, multiply, norm, scale, subtract};
use crate::mesh::symmetry::SymmetryPlane;
use crate::pose::Pose;

/// The pose with the mirrored view, for a part symmetric in `plane`. It leaves the plane's point
/// where it is. Mirroring twice gives the pose back.
///
/// Where the plane's point is at the focus the pose is returned as it is.
#[must_use]
pub fn mirror_pose(pose: &Pose, plane: &SymmetryPlane) -> Pose {
    let centre = pose.transform(&plane.point);
    let distance = norm(&centre);
    if distance == 0.0 {
        return *pose;
    }
    let behind = reflection(&scale(&centre, 1.0 / distance));
    let within = reflection(&plane.normal);
    let rotation = multiply(&multiply(&behind, &pose.rotation), &within);
    Pose {
        rotation,
        translation: subtract(&centre, &apply(&rotation, &plane.point)),
    }
}

/// `I - 2 n n^T`.
fn reflection(normal: &Vector3) -> Matrix3 {
    let mut matrix = IDENTITY;
    for (row, &x) in matrix.iter_mut().zip(normal) {
        *row = add(row, &scale(normal, -2.0 * x));
    }
    matrix
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::dot;
    use crate::pose::{EulerPose, geodesic_deg, rotation_zxy};
    use proptest::prelude::*;

    fn plane(point: Vector3, normal: Vector3) -> SymmetryPlane {
        SymmetryPlane {
            point,
            normal,
            deviation_mm: 0.0,
        }
    }

    properties! {
        #[test]
        fn mirroring_is_rigid_undoes_itself_and_keeps_the_middle(
            z in -180.0..180.0f64, x in -20.0..20.0f64, y in -20.0..20.0f64,
            shift in -80.0..80.0f64, tilt in -90.0..90.0f64, turn in -180.0..180.0f64
        ) {
            let pose = Pose::from(EulerPose {
                x_mm: shift, y_mm: -shift / 2.0, z_mm: -1000.0,
                z_rot_deg: z, x_rot_deg: x, y_rot_deg: y,
            });
            let plane = plane([3.0, -8.0, 5.0], rotation_zxy(0.0, tilt, turn)[0]);
            let mirrored = mirror_pose(&pose, &plane);
            prop_assert!(mirrored.is_rigid(1e-12));
            let (a, b) = (pose.transform(&plane.point), mirrored.transform(&plane.point));
            prop_assert!(norm(&subtract(&a, &b)) < 1e-9);
            let back = mirror_pose(&mirrored, &plane);
            prop_assert!(geodesic_deg(&back.rotation, &pose.rotation) < 1e-6);
        }

        /// What the method rests on: from the focus, a point and the part's mirror image of it,
        /// the latter at the mirrored pose, lie on either side of the middle, on rays that differ
        /// by perspective alone.
        #[test]
        fn image_points_are_mirrored_along_the_ray_to_the_middle(
            z in -180.0..180.0f64, x in -20.0..20.0f64, y in -20.0..20.0f64,
            turn in -180.0..180.0f64, point in prop::array::uniform3(-40.0..40.0f64)
        ) {
            let pose = Pose::from(EulerPose {
                x_mm: 30.0, y_mm: -50.0, z_mm: -1000.0,
                z_rot_deg: z, x_rot_deg: x, y_rot_deg: y,
            });
            let plane = plane([3.0, -8.0, 5.0], rotation_zxy(turn, 10.0, 30.0)[2]);
            let middle = pose.transform(&plane.point);
            let ray = scale(&middle, 1.0 / norm(&middle));
            let from_middle = |p: &Vector3| subtract(p, &middle);
            let seen = from_middle(&pose.transform(&point));
            let image = mirror_pose(&pose, &plane).transform(&plane.reflect(&point));
            let image = from_middle(&image);
            prop_assert!((dot(&seen, &ray) + dot(&image, &ray)).abs() < 1e-9);
            let across = |p: &Vector3| add(p, &scale(&ray, -dot(p, &ray)));
            let difference = subtract(&across(&seen), &across(&image));
            prop_assert!(norm(&difference) < 1e-9);
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
        let mediolateral = plane([0.0; 3], [0.0, 0.0, 1.0]);
        let mirrored = EulerPose::from(mirror_pose(&Pose::from(euler), &mediolateral));
        assert!((mirrored.z_rot_deg + 84.0).abs() < 1e-9);
        assert!((mirrored.x_rot_deg + 0.6).abs() < 1e-9);
        assert!((mirrored.y_rot_deg - 9.0).abs() < 1e-9);
    }

    #[test]
    fn at_the_focus_there_is_no_ray_to_mirror_along() {
        let pose = Pose::IDENTITY;
        let plane = plane([0.0; 3], [0.0, 0.0, 1.0]);
        assert_eq!(mirror_pose(&pose, &plane), pose);
    }
}
