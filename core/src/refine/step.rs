//! A small motion of the model, and how its outline moves with it.

use crate::camera::Camera;
use crate::math::{
    Vector3, add, apply, cross, degrees, multiply, norm, rotation_by, scale, subtract, transpose,
};
use crate::pose::Pose;

/// A small motion: turn about the middle of the model (radians, camera axes), then shift (mm).
#[derive(Clone, Copy, Debug)]
pub(super) struct Step {
    turn: Vector3,
    shift: Vector3,
}

impl Step {
    /// Three turns, then three shifts.
    pub(super) fn of([a, b, c, x, y, z]: [f64; 6]) -> Self {
        Self {
            turn: [a, b, c],
            shift: [x, y, z],
        }
    }

    /// A Jacobian in the camera's axes, brought to the axes of the world in which the camera stands.
    pub(super) fn in_world(jacobian: [f64; 6], placement: &Pose) -> [f64; 6] {
        let [a, b, c, x, y, z] = jacobian;
        let back = transpose(&placement.rotation);
        let ([a, b, c], [x, y, z]) = (apply(&back, &[a, b, c]), apply(&back, &[x, y, z]));
        [a, b, c, x, y, z]
    }

    /// How fast the image of a contour moves along its `normal` (pixels) for each parameter: three
    /// turns about `centre`, the middle of the model in camera coordinates (per radian), three
    /// shifts (per mm). `place` is a point of the image, continuous image coordinates, and `depth`
    /// the distance of the contour behind it from the camera plane, mm.
    ///
    /// With `u = fx X / D`, `v = -fy Y / D`, `D = -Z`:
    /// `du = fx (dX / D + X dZ / D^2)`, `dv = -fy (dY / D + Y dZ / D^2)`, and a turn `w` moves the
    /// point by `w x (X - c)`.
    pub(super) fn jacobian(
        camera: &Camera,
        centre: &Vector3,
        place: [f64; 2],
        depth: f64,
        normal: [f64; 2],
    ) -> [f64; 6] {
        let [fx, fy] = camera.focal();
        let [cx, cy] = camera.principal_point();
        let x = (place[0] - cx) / fx;
        let y = -(place[1] - cy) / fy;
        let point = [x * depth, y * depth, -depth];
        let arm = subtract(&point, centre);
        let [right, down] = normal;
        let (a, b) = (right * fx / depth, -down * fy / depth);
        // Image motion along the normal per mm of motion of the point.
        let push = [a, b, a * x + b * y];
        // push . (w x arm) = w . (arm x push)
        let twist = cross(&arm, &push);
        [twist[0], twist[1], twist[2], push[0], push[1], push[2]]
    }

    /// The pose after the step; `middle` is the point of the model that the turn leaves in place.
    pub(super) fn apply(&self, pose: &Pose, middle: &Vector3) -> Pose {
        let centre = add(&pose.transform(middle), &self.shift);
        let rotation = multiply(&rotation_by(&self.turn), &pose.rotation);
        let translation = subtract(&centre, &apply(&rotation, middle));
        Pose {
            rotation,
            translation,
        }
    }

    /// Three turns, then three shifts.
    pub(super) fn values(&self) -> [f64; 6] {
        let ([a, b, c], [x, y, z]) = (self.turn, self.shift);
        [a, b, c, x, y, z]
    }

    pub(super) fn scaled(&self, factor: f64) -> Self {
        Self {
            turn: scale(&self.turn, factor),
            shift: scale(&self.shift, factor),
        }
    }

    /// Rotation and shift in one number, weighted by how far they move an outline.
    pub(super) fn size(&self) -> f64 {
        degrees(norm(&self.turn)) + norm(&self.shift) / 5.0
    }
}
