//! Normal equations of robust least squares in the six parameters of a pose.

use super::border::{BorderPixel, Residual};
use super::loss::Loss;
use super::result::{Iterate, Refined};
use super::stages::{Pass, Stage};
use super::step::Step;
use crate::math::{inverse_spd, solve_spd, sqrt};

/// Parameters of a step, and the offset of the target's edges from the model's outline.
const UNKNOWNS: usize = 7;
const OFFSET: usize = 6;

/// The step of a solution, and the change of the offset.
fn with_offset([a, b, c, x, y, z, offset]: [f64; UNKNOWNS]) -> (Step, f64) {
    (Step::of([a, b, c, x, y, z]), offset)
}

/// Histogram of absolute residuals: bins of this many pixels.
const BIN: f64 = 1.0 / 32.0;
const BINS: usize = 128;

type Normal = [[f64; UNKNOWNS]; UNKNOWNS];

fn dot(a: &[f64; UNKNOWNS], b: &[f64; UNKNOWNS]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn add_each(to: &mut [f64], more: &[f64]) {
    for (sum, more) in to.iter_mut().zip(more) {
        *sum += more;
    }
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
/// In a correction a sample holds the pose at least by this part of its weight. By the weights alone, which are never less than the second
/// derivative of a redescending loss, steps are too short and converge slowly; with less than a third of them some go too far.
const LEAST_FIRM: f64 = 0.5;
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

    /// As new.
    pub(super) fn clear(&mut self) {
        self.normal.as_flattened_mut().fill(0.0);
        self.right.fill(0.0);
        self.histogram.fill(0.0);
        (self.length, self.known) = (0.0, 0.0);
        (self.loss, self.used, self.squares) = (0.0, 0.0, 0.0);
    }

    /// Adds what was found along the normal of a sample, weighed as a stage does.
    pub(super) fn add_sample(&mut self, sample: &BorderPixel, stage: &Stage) {
        let length = f64::from(sample.weight);
        match sample.residual {
            Residual::None => {}
            Residual::Unknown => self.add_unknown(length),
            Residual::Px(residual) if f64::from(residual).abs() <= stage.range => {
                let jacobian = sample.jacobian.map(f64::from);
                let firmness = stage.corrects.then_some(LEAST_FIRM);
                self.add(
                    (stage.loss, firmness),
                    &jacobian,
                    f64::from(residual),
                    length,
                );
            }
            Residual::Px(_) | Residual::Missing => {
                self.add_missing(stage.loss, stage.range, length);
            }
        }
    }

    /// A sample of which the target says nothing: only its length counts.
    fn add_unknown(&mut self, length: f64) {
        self.length += length;
    }

    /// A sample without a counterpart within `range`, which costs as much as one there.
    fn add_missing(&mut self, loss: Loss, range: f64, length: f64) {
        self.length += length;
        self.known += length;
        self.loss += length * loss.at(range).0;
    }

    /// Adds a sample: how far the target's outline is beyond the model's (pixels). It holds the pose as firmly as its weight, or,
    /// with a least part of that, as the second derivative of the loss.
    fn add(
        &mut self,
        (loss, least_firm): (Loss, Option<f64>),
        jacobian: &[f64; 6],
        residual: f64,
        length: f64,
    ) {
        let (cost, weight) = loss.at(residual);
        self.length += length;
        self.known += length;
        self.loss += length * cost;
        let w = length * weight;
        self.used += length;
        self.squares += w * residual * residual;
        let bin = (residual.abs() / BIN) as usize;
        self.histogram[bin.min(BINS - 1)] += length;
        let firm = least_firm.map_or(w, |least| {
            length * loss.curvature(residual).max(least * weight)
        });
        let [a, b, c, x, y, z] = *jacobian;
        let jacobian = [a, b, c, x, y, z, 1.0];
        for (row, &a) in jacobian.iter().enumerate() {
            self.right[row] += w * a * residual;
            // Solvers read the lower triangle alone.
            for (sum, &b) in self.normal[row].iter_mut().zip(&jacobian[..=row]) {
                *sum += firm * a * b;
            }
        }
    }

    /// Adds what was seen of another part of the outline.
    pub(super) fn join(&mut self, other: &Self) {
        for (row, others) in self.normal.iter_mut().zip(&other.normal) {
            add_each(row, others);
        }
        add_each(&mut self.right, &other.right);
        add_each(&mut self.histogram, &other.histogram);
        self.length += other.length;
        self.known += other.known;
        self.loss += other.loss;
        self.used += other.used;
        self.squares += other.squares;
    }

    /// What would be seen, to first order, after a step and a change of the offset.
    pub(super) fn follow(&mut self, step: &Step, more: f64) {
        let [a, b, c, x, y, z] = step.values();
        let change = [a, b, c, x, y, z, more];
        let (down, up) = (dot(&self.right, &change), self.along(&change));
        self.loss += up / 2.0 - down;
        self.squares += up - 2.0 * down;
        for row in 0..UNKNOWNS {
            for column in 0..=row {
                let entry = self.normal[row][column];
                self.right[row] -= entry * change[column];
                if column < row {
                    self.right[column] -= entry * change[row];
                }
            }
        }
    }

    /// The square of a change by the normal matrix.
    fn along(&self, change: &[f64; UNKNOWNS]) -> f64 {
        let row = |row: usize| {
            let own = &self.normal[row];
            // Twice what is below the diagonal, which stands for both sides of it.
            change[row] * (2.0 * dot(own, change) - own[row] * change[row])
        };
        (0..UNKNOWNS).map(row).sum()
    }

    /// Size of a step in standard deviations of the pose, as far as these residuals tell them.
    pub(super) fn deviations(&self, step: &Step) -> f64 {
        let [a, b, c, x, y, z] = step.values();
        let square = self.along(&[a, b, c, x, y, z, 0.0]);
        sqrt(square.max(0.0) / Self::CORRELATED) / self.residual_px().max(f64::MIN_POSITIVE)
    }

    /// Whether enough of the outline is known and was found to say where the model is.
    fn is_enough(&self) -> bool {
        self.known >= LEAST_KNOWN * self.length && self.used >= LEAST_USED * self.known
    }

    /// The damped step and the change of the offset, which stays where it is unless `free`;
    /// `None` where too little of the outline was found or it does not determine the pose.
    pub(super) fn step(&self, damping: f64, free: bool) -> Option<(Step, f64)> {
        let (normal, right) = self.damped(damping, free)?;
        Some(with_offset(solve_spd(normal, right)?))
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
        Some(with_offset(solution))
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
    const OFFSET_FRACTION: f64 = 0.1;
    const OFFSET_DEVIATIONS: f64 = 3.0;
    /// Length of outline whose residuals count as one where they are not independent, pixels.
    const CORRELATED: f64 = 10.0;

    pub(super) fn supports_offset(&self, offset: f64) -> bool {
        let Some(covariance) = inverse_spd(&self.normal) else {
            return false;
        };
        let fraction = 1.0 / (self.normal[OFFSET][OFFSET] * covariance[OFFSET][OFFSET]);
        let residual = self.residual_px();
        let variance = covariance[OFFSET][OFFSET] * residual * residual * Self::CORRELATED;
        fraction >= Self::OFFSET_FRACTION && offset.abs() > Self::OFFSET_DEVIATIONS * sqrt(variance)
    }

    /// Writes what the residuals say into a pose's record.
    pub(super) fn report(&self, state: &mut Refined) {
        state.loss = self.loss();
        state.residual_px = self.residual_px();
        state.robust_sigma_px = self.robust_sigma_px();
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
    pub(super) fn robust_sigma_px(&self) -> f64 {
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Six numbers, each held by one sample of this residual.
    fn step(corrects: bool, residual: f32) -> [f64; 6] {
        let stage = Stage {
            range: 10.0,
            loss: Loss::Tukey(2.5),
            drawn: true,
            turn: 0,
            corrects,
            every: None,
        };
        let mut equations = Equations::new();
        for number in 0..6 {
            let mut jacobian = [0.0; 6];
            jacobian[number] = 2.0;
            equations.add_sample(
                &BorderPixel {
                    weight: 1.0,
                    residual: Residual::Px(residual),
                    jacobian,
                    ..BorderPixel::EMPTY
                },
                &stage,
            );
        }
        equations.step(0.0, false).expect("determined").0.values()
    }

    #[test]
    fn a_correction_takes_newtons_step_and_at_most_twice_that_of_the_weights() {
        for number in 0..6 {
            // By the weights it goes all of the way, in two pixels for each unit.
            let by_weights = step(false, 0.5)[number];
            assert!((by_weights - 0.25).abs() < 1e-12);
            // Of Tukey's loss at a fifth of its scale: (1 - r^2)^2 and (1 - r^2)(1 - 5 r^2).
            let newton = 0.25 * 0.96 / 0.8;
            assert!((step(true, 0.5)[number] - newton).abs() < 1e-6);
            assert!((step(true, 2.0)[number] - 2.0).abs() < 1e-6);
        }
    }
}
