//! One step of damped Gauss-Newton in the six parameters of a pose.

use super::outline::BorderPixel;
use super::problem::Pass;
use super::{Iterate, Refined};
use crate::camera::Camera;
use crate::math::{
    Vector3, add, apply, cross, degrees, inverse_spd, multiply, norm, rotation_by, scale,
    solve_spd, sqrt, subtract, transpose,
};
use crate::pose::Pose;

/// A small motion: turn about the middle of the model (radians, camera axes), then shift (mm).
#[derive(Clone, Copy, Debug)]
pub(super) struct Step {
    turn: Vector3,
    shift: Vector3,
}

impl Step {
    /// The step of a solution, and the change of the offset.
    fn with_offset([a, b, c, x, y, z, offset]: [f64; UNKNOWNS]) -> (Self, f64) {
        (Self::of([a, b, c, x, y, z]), offset)
    }

    /// Three turns, then three shifts.
    pub(super) fn of([a, b, c, x, y, z]: [f64; 6]) -> Self {
        Self {
            turn: [a, b, c],
            shift: [x, y, z],
        }
    }

    /// A Jacobian in the camera's axes, turned into those of the world that the camera stands in.
    pub(super) fn in_world(jacobian: [f64; 6], placement: &Pose) -> [f64; 6] {
        let [a, b, c, x, y, z] = jacobian;
        let back = transpose(&placement.rotation);
        let ([a, b, c], [x, y, z]) = (apply(&back, &[a, b, c]), apply(&back, &[x, y, z]));
        [a, b, c, x, y, z]
    }

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
        let arm = subtract(&point, centre);
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
        let translation = subtract(&centre, &apply(&rotation, middle));
        Pose {
            rotation,
            translation,
        }
    }

    pub(super) fn scaled(&self, factor: f64) -> Self {
        Self {
            turn: scale(&self.turn, factor),
            shift: scale(&self.shift, factor),
        }
    }

    /// Degrees and mm in one number, as much as they move an outline.
    pub(super) fn size(&self) -> f64 {
        degrees(norm(&self.turn)) + norm(&self.shift) / 5.0
    }
}

/// Parameters of a step, and the offset of the target's edges from the model's outline.
const UNKNOWNS: usize = 7;
const OFFSET: usize = 6;

/// Histogram of absolute residuals: bins of this many pixels.
const BIN: f64 = 1.0 / 32.0;
const BINS: usize = 128;

/// How the pull of a residual fades with its size. Both are scaled in pixels.
#[derive(Clone, Copy, Debug)]
pub(super) enum Loss {
    /// `c^2 / 2 ln(1 + (r / c)^2)`
    Cauchy(f64),
    /// `c^2 / 6 (1 - (1 - (r / c)^2)^3)`, constant beyond `c` (Beaton and Tukey, Technometrics
    /// 16, 1974)
    Tukey(f64),
}

impl Loss {
    /// Loss (square pixels) and weight of a residual: the weight is that of the least squares
    /// that the loss is to first order.
    pub(super) fn at(self, residual: f64) -> (f64, f64) {
        let (c, weight) = (self.scale(), self.weight(residual));
        let cost = match self {
            Self::Cauchy(_) => 0.5 * c * c * libm::log1p((residual / c) * (residual / c)),
            Self::Tukey(_) => c * c / 6.0 * (1.0 - weight * sqrt(weight)),
        };
        (cost, weight)
    }
}

impl Loss {
    /// Derivative of the loss.
    pub(super) fn pull(self, residual: f64) -> f64 {
        residual * self.weight(residual)
    }

    fn weight(self, residual: f64) -> f64 {
        let ratio = residual / self.scale();
        match self {
            Self::Cauchy(_) => 1.0 / (1.0 + ratio * ratio),
            Self::Tukey(_) => {
                let rest = (1.0 - ratio * ratio).max(0.0);
                rest * rest
            }
        }
    }

    fn scale(self) -> f64 {
        let (Self::Cauchy(c) | Self::Tukey(c)) = self;
        c
    }

    /// Second derivative of the loss.
    pub(super) fn curvature(self, residual: f64) -> f64 {
        match self {
            Self::Cauchy(c) => {
                let ratio = (residual / c) * (residual / c);
                (1.0 - ratio) / ((1.0 + ratio) * (1.0 + ratio))
            }
            Self::Tukey(c) => {
                let ratio = (residual / c) * (residual / c);
                if ratio < 1.0 {
                    (1.0 - ratio) * (1.0 - 5.0 * ratio)
                } else {
                    0.0
                }
            }
        }
    }
}

type Normal = [[f64; UNKNOWNS]; UNKNOWNS];

fn dot(a: &[f64; UNKNOWNS], b: &[f64; UNKNOWNS]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Normal equations of robust least squares.
pub(super) struct Equations {
    /// The lower triangle alone.
    normal: Normal,
    right: [f64; UNKNOWNS],
    /// Length of the outline, and of what is known of it.
    length: f64,
    known: f64,
    loss: f64,
    used: f64,
    squares: f64,
    histogram: [f64; BINS],
}

/// At least this part of the outline, by length, must be known.
const LEAST_KNOWN: f64 = 0.15;
/// At least this part of what is known must have a counterpart in the target.
const LEAST_USED: f64 = 0.2;

impl Equations {
    pub(super) fn new() -> Self {
        Self {
            normal: [[0.0; UNKNOWNS]; UNKNOWNS],
            right: [0.0; UNKNOWNS],
            length: 0.0,
            known: 0.0,
            loss: 0.0,
            used: 0.0,
            squares: 0.0,
            histogram: [0.0; BINS],
        }
    }

    /// A sample of which the target says nothing: only its length counts.
    pub(super) fn add_unknown(&mut self, length: f64) {
        self.length += length;
    }

    /// A sample without a counterpart within `range`, which costs as much as one there.
    pub(super) fn add_missing(&mut self, loss: Loss, range: f64, length: f64) {
        self.length += length;
        self.known += length;
        self.loss += length * loss.at(range).0;
    }

    /// Adds a sample: how far the target's outline is beyond the model's (pixels).
    pub(super) fn add(&mut self, loss: Loss, jacobian: &[f64; 6], residual: f64, length: f64) {
        let (cost, weight) = loss.at(residual);
        self.length += length;
        self.known += length;
        self.loss += length * cost;
        let w = length * weight;
        self.used += length;
        self.squares += w * residual * residual;
        let bin = (residual.abs() / BIN) as usize;
        self.histogram[bin.min(BINS - 1)] += length;
        let [a, b, c, x, y, z] = *jacobian;
        let jacobian = [a, b, c, x, y, z, 1.0];
        for (row, &a) in jacobian.iter().enumerate() {
            self.right[row] += w * a * residual;
            // Solvers read the lower triangle alone.
            for (sum, &b) in self.normal[row].iter_mut().zip(&jacobian[..=row]) {
                *sum += w * a * b;
            }
        }
    }

    /// Whether enough of the outline is known and was found to say where the model is.
    fn is_enough(&self) -> bool {
        self.known >= LEAST_KNOWN * self.length && self.used >= LEAST_USED * self.known
    }

    /// The damped step and the change of the offset, which stays where it is unless `free`;
    /// `None` where too little of the outline was found or it does not determine the pose.
    pub(super) fn step(&self, damping: f64, free: bool) -> Option<(Step, f64)> {
        let (normal, right) = self.damped(damping, free)?;
        Some(Step::with_offset(solve_spd(normal, right)?))
    }

    /// The same where some combinations of the six parameters stay zero: the solution conditioned
    /// on them one by one.
    pub(super) fn held_step(
        &self,
        damping: f64,
        free: bool,
        rows: impl Iterator<Item = [f64; 6]>,
    ) -> Option<(Step, f64)> {
        let (normal, right) = self.damped(damping, free)?;
        let mut covariance = inverse_spd(&normal)?;
        let mut solution = covariance.map(|row| dot(&row, &right));
        for [a, b, c, x, y, z] in rows {
            let row = [a, b, c, x, y, z, 0.0];
            let gain = covariance.map(|column| dot(&column, &row));
            let variance = dot(&gain, &row);
            if variance <= 0.0 {
                // Held by the rows before it.
                continue;
            }
            let excess = dot(&solution, &row) / variance;
            for (at, &gain_at) in gain.iter().enumerate() {
                solution[at] -= gain_at * excess;
                for (value, &other) in covariance[at].iter_mut().zip(&gain) {
                    *value -= gain_at * other / variance;
                }
            }
        }
        Some(Step::with_offset(solution))
    }

    /// Damped normal equations; `None` where too little of the outline was found.
    fn damped(&self, damping: f64, free: bool) -> Option<(Normal, [f64; UNKNOWNS])> {
        if !self.is_enough() {
            return None;
        }
        let (mut normal, mut right) = (self.normal, self.right);
        if !free {
            normal.iter_mut().for_each(|row| row[OFFSET] = 0.0);
            normal[OFFSET] = [0.0; UNKNOWNS];
            (normal[OFFSET][OFFSET], right[OFFSET]) = (1.0, 0.0);
        }
        for (k, row) in normal.iter_mut().enumerate() {
            row[k] *= 1.0 + damping;
        }
        Some((normal, right))
    }

    /// The offset is worth having when the pose leaves it more than this part of its information
    /// and it exceeds this many of its standard deviations.
    const OFFSET_SHARE: f64 = 0.1;
    const OFFSET_DEVIATIONS: f64 = 3.0;
    /// Length of outline whose residuals count as one where they are not independent, pixels.
    const CORRELATED: f64 = 10.0;

    pub(super) fn supports_offset(&self, offset: f64) -> bool {
        let Some(covariance) = inverse_spd(&self.normal) else {
            return false;
        };
        let share = 1.0 / (self.normal[OFFSET][OFFSET] * covariance[OFFSET][OFFSET]);
        let residual = self.residual_px();
        let variance = covariance[OFFSET][OFFSET] * residual * residual * Self::CORRELATED;
        share >= Self::OFFSET_SHARE && offset.abs() > Self::OFFSET_DEVIATIONS * sqrt(variance)
    }

    /// Writes what the residuals say into a pose's record.
    pub(super) fn report(&self, state: &mut Refined) {
        state.loss = self.loss();
        state.residual_px = self.residual_px();
        state.spread_px = self.spread_px();
    }

    /// The pose of a record as a step on the way.
    pub(super) fn iterate(&self, pass: &Pass, state: &Refined) -> Iterate {
        Iterate {
            stage: pass.index,
            renders: state.renders,
            pose: state.pose,
            loss: self.loss(),
            residual_px: self.residual_px(),
        }
    }

    /// Mean loss over what is known of the outline, square pixels; infinite where that is too
    /// little.
    pub(super) fn loss(&self) -> f64 {
        if self.is_enough() {
            self.loss / self.known
        } else {
            f64::INFINITY
        }
    }

    /// Root mean square residual of what was found, pixels.
    pub(super) fn residual_px(&self) -> f64 {
        sqrt(self.squares / self.used.max(1.0))
    }

    /// Standard deviation of the residuals, pixels, from their median absolute value as if they
    /// were normal: what lies far out does not count (Hampel, JASA 69, 1974).
    pub(super) fn spread_px(&self) -> f64 {
        let half = self.used / 2.0;
        let mut below = 0.0;
        for (bin, &length) in self.histogram.iter().enumerate() {
            if below + length >= half && length > 0.0 {
                return 1.4826 * BIN * (bin as f64 + (half - below) / length);
            }
            below += length;
        }
        1.4826 * BIN * BINS as f64
    }
}
