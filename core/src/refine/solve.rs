//! One step of damped Gauss-Newton in the six parameters of a pose.

use super::outline::BorderPixel;
use crate::camera::Camera;
use crate::math::{
    Matrix3, Vector3, add, apply, cross, degrees, multiply, norm, scale, sin_cos, solve_spd, sqrt,
};
use crate::pose::Pose;

/// A small motion: turn about the middle of the model (radians, camera axes), then shift (mm).
#[derive(Clone, Copy, Debug)]
pub(super) struct Step {
    turn: Vector3,
    shift: Vector3,
}

/// Steps below these end an iteration: degrees and mm.
const SMALL_DEG: f64 = 1e-4;
const SMALL_MM: f64 = 1e-3;

impl Step {
    /// How fast the image of the contour behind `sample` moves along the sample's normal
    /// (pixels) for each parameter: three turns about `centre`, the middle of the model in camera
    /// coordinates (per radian), three shifts (per mm).
    ///
    /// With `u = fx X / D`, `v = -fy Y / D`, `D = -Z`:
    /// `du = fx (dX / D + X dZ / D^2)`, `dv = -fy (dY / D + Y dZ / D^2)`, and a turn `w` moves the
    /// point by `w x (X - c)`.
    pub(super) fn jacobian(camera: &Camera, centre: &Vector3, sample: &BorderPixel) -> [f64; 6] {
        let depth = sample.depth();
        let [fx, fy] = camera.focal();
        let [cx, cy] = camera.principal_point();
        let x = (f64::from(sample.column) + 0.5 - cx) / fx;
        let y = -(f64::from(sample.row) + 0.5 - cy) / fy;
        let point = [x * depth, y * depth, -depth];
        let arm = add(&point, &scale(centre, -1.0));
        let [right, down] = sample.normal.map(f64::from);
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
        let translation = add(&centre, &scale(&apply(&rotation, middle), -1.0));
        Pose {
            rotation,
            translation,
        }
    }

    pub(super) fn is_small(&self) -> bool {
        degrees(norm(&self.turn)) < SMALL_DEG && norm(&self.shift) < SMALL_MM
    }
}

/// The rotation by the angle and about the axis of a vector (Rodrigues).
fn rotation_by(turn: &Vector3) -> Matrix3 {
    let angle = norm(turn);
    if angle == 0.0 {
        return crate::math::IDENTITY;
    }
    let (sin, cos) = sin_cos(angle);
    let [x, y, z] = scale(turn, 1.0 / angle);
    let k = 1.0 - cos;
    [
        [cos + x * x * k, x * y * k - z * sin, x * z * k + y * sin],
        [y * x * k + z * sin, cos + y * y * k, y * z * k - x * sin],
        [z * x * k - y * sin, z * y * k + x * sin, cos + z * z * k],
    ]
}

/// Normal equations of robust least squares: Cauchy's loss `c^2 / 2 ln(1 + (r / c)^2)`.
pub(super) struct Equations {
    normal: [[f64; 6]; 6],
    right: [f64; 6],
    weight: f64,
    loss: f64,
    used: f64,
    squares: f64,
    scale: f64,
    range: f64,
}

/// At least this part of the outline, by length, must have a counterpart in the mask.
const LEAST_USED: f64 = 0.2;

impl Equations {
    pub(super) fn new(scale: f64, range: f64) -> Self {
        Self {
            normal: [[0.0; 6]; 6],
            right: [0.0; 6],
            weight: 0.0,
            loss: 0.0,
            used: 0.0,
            squares: 0.0,
            scale,
            range,
        }
    }

    /// Adds a sample: how far the mask's outline is beyond the model's (pixels), or `None` where
    /// it was not found, which costs as much as the farthest that is looked for.
    pub(super) fn add(&mut self, jacobian: &[f64; 6], residual: Option<f64>, length: f64) {
        let c = self.scale;
        let r = residual.unwrap_or(self.range);
        let ratio = (r / c) * (r / c);
        self.weight += length;
        self.loss += length * 0.5 * c * c * libm::log1p(ratio);
        let Some(residual) = residual else { return };
        let w = length / (1.0 + ratio);
        self.used += length;
        self.squares += w * residual * residual;
        for (row, &a) in jacobian.iter().enumerate() {
            self.right[row] += w * a * residual;
            for (column, &b) in jacobian.iter().enumerate() {
                self.normal[row][column] += w * a * b;
            }
        }
    }

    /// The damped step; `None` where too little of the outline was found or it does not
    /// determine the pose.
    pub(super) fn step(&self, damping: f64) -> Option<Step> {
        if self.used < LEAST_USED * self.weight {
            return None;
        }
        let mut normal = self.normal;
        for (k, row) in normal.iter_mut().enumerate() {
            row[k] *= 1.0 + damping;
        }
        let [a, b, c, x, y, z] = solve_spd(normal, self.right)?;
        Some(Step {
            turn: [a, b, c],
            shift: [x, y, z],
        })
    }

    /// Mean loss over the outline, square pixels.
    pub(super) fn loss(&self) -> f64 {
        self.loss / self.weight.max(1.0)
    }

    /// Root mean square residual of what was found, pixels.
    pub(super) fn residual_px(&self) -> f64 {
        sqrt(self.squares / self.used.max(1.0))
    }
}
