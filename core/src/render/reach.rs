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
