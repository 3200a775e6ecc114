//! How far in front of a camera, and how far aside, a surface may lie.

use crate::mesh::Bounds;
use crate::pose::Pose;

/// Poses are rigid but for this.
const RIGID: f64 = 1e-9;

/// What the sphere around a surface tells of where it is at a pose.
#[derive(Clone, Copy)]
pub(crate) struct Reach {
    /// Least and greatest distance, mm.
    pub(super) near: f64,
    pub(super) far: f64,
    /// Tangents of the largest angles off the axis, across and along.
    pub(super) aside: [f64; 2],
    /// Whether all of it is in front of the camera, moved there without a change of its shape: if not, nothing here means
    /// anything.
    pub(super) in_front: bool,
}

impl Reach {
    pub(super) fn of(bounds: &Bounds, pose: &Pose) -> Self {
        let radius = bounds.radius;
        let middle = pose.transform(&bounds.centre);
        let (near, far) = (-middle[2] - radius, -middle[2] + radius);
        let tangent = |x: f64| (x.abs() + radius) / near;
        Self {
            near,
            far,
            aside: [tangent(middle[0]), tangent(middle[1])],
            in_front: near > 0.0 && pose.is_rigid(RIGID),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pose::EulerPose;
    use proptest::prelude::*;

    properties! {
        #[test]
        fn all_of_a_sphere_lies_within_its_reach(
            centre in proptest::array::uniform3(-50.0..50.0f64), radius in 1.0..40.0f64,
            place in proptest::array::uniform3(-100.0..100.0f64), nearer in 0.0..400.0f64,
            angles in proptest::array::uniform3(-180.0..180.0f64),
            direction in proptest::array::uniform3(-1.0..1.0f64),
        ) {
            let [z_rot_deg, x_rot_deg, y_rot_deg] = angles;
            let [x_mm, y_mm, z_mm] = place;
            let pose = Pose::from(EulerPose {
                x_mm, y_mm, z_mm: z_mm - 400.0 + nearer, z_rot_deg, x_rot_deg, y_rot_deg
            });
            let bounds = Bounds { centre, radius };
            let reach = Reach::of(&bounds, &pose);
            let length = crate::math::norm(&direction);
            prop_assume!(length > 0.1);
            let point = core::array::from_fn(|k| centre[k] + radius * direction[k] / length);
            let [x, y, z] = pose.transform(&point);
            prop_assert!(reach.near <= -z + 1e-9 && -z <= reach.far + 1e-9);
            // The sphere is as deep as it is wide.
            prop_assert!((reach.far - reach.near - 2.0 * radius).abs() < 1e-9);
            prop_assert_eq!(reach.in_front, reach.near > 0.0);
            if reach.in_front {
                let tangents = [x.abs(), y.abs()].map(|off| off / -z);
                prop_assert!(tangents.iter().zip(reach.aside).all(|(&own, most)| own <= most + 1e-9));
            }
            let mut stretched = pose;
            stretched.rotation[0] = stretched.rotation[0].map(|x| 1.001 * x);
            prop_assert!(!Reach::of(&bounds, &stretched).in_front);
        }
    }
}
