//! A small motion of the model.

use crate::math::{
    Vector3, add, apply, degrees, multiply, norm, rotation_by, rotation_vector, scale, subtract,
    transpose,
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

    /// The one that leads from a pose to another; `middle` is as of [`Self::apply`].
    pub(super) fn between(from: &Pose, to: &Pose, middle: &Vector3) -> Self {
        let turn = multiply(&to.rotation, &transpose(&from.rotation));
        Self {
            turn: rotation_vector(&turn),
            shift: subtract(&to.transform(middle), &from.transform(middle)),
        }
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
