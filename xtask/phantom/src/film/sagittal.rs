//! Where a ray passes through the sagittal plane of a bone.

use crate::implant::Side;
use fluoropose::camera::Camera;
use fluoropose::pose::Pose;
use glam::DVec3;

/// The direction of the ray through a place of the frame (continuous coordinates), with depth 1 along the view.
pub(super) fn ray(camera: &Camera, column: f64, row: f64) -> DVec3 {
    let ([fx, fy], [cx, cy]) = (camera.focal(), camera.principal_point());
    DVec3::new((column - cx) / fx, (cy - row) / fy, -1.0)
}

/// The plane `z = 0` of an implant, with axes as for a left knee about 70 mm wide.
pub(super) struct Sagittal {
    origin: DVec3,
    anterior: DVec3,
    proximal: DVec3,
    across: DVec3,
    scale: f64,
}

impl Sagittal {
    /// The plane of an implant at a pose; `scale` is its size relative to 70 mm.
    pub(super) fn new(pose: &Pose, side: Side, scale: f64) -> Self {
        let axis = |k: usize| DVec3::from(pose.rotation.map(|row| row[k]));
        let mirror = if side == Side::Right { -1.0 } else { 1.0 };
        Self {
            origin: DVec3::from(pose.translation),
            anterior: axis(0) * mirror,
            proximal: axis(1),
            across: axis(2),
            scale,
        }
    }

    /// Where a ray from the focus meets the plane: `[anterior, proximal]` in mm at scale 1.
    pub(super) fn locate(&self, ray: &DVec3) -> [f64; 2] {
        let depth = self.origin.dot(self.across) / ray.dot(self.across);
        self.within(*ray * depth)
    }

    /// How far another plane's proximal axis is turned backwards against this one's, in radians: flexion.
    pub(super) fn flexion(&self, other: &Self) -> f64 {
        libm::atan2(
            other.proximal.dot(self.anterior),
            other.proximal.dot(self.proximal),
        )
    }

    fn within(&self, point: DVec3) -> [f64; 2] {
        let from_origin = (point - self.origin) / self.scale;
        [
            from_origin.dot(self.anterior),
            from_origin.dot(self.proximal),
        ]
    }
}
