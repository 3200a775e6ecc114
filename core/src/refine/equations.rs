//! Normal equations of robust least squares in the six parameters of a pose.

use core::ops::AddAssign;

use super::border::{BorderPixel, Residual};
use super::motion::Motion;
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
const BIN: f32 = 1.0 / 32.0;
const BINS: usize = 128;

type Normal = [[f64; UNKNOWNS]; UNKNOWNS];

fn dot(a: &[f64; UNKNOWNS], b: &[f64; UNKNOWNS]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn add_each<T: AddAssign, U: Copy + Into<T>>(to: &mut [T], more: &[U]) {
    for (sum, &more) in to.iter_mut().zip(more) {
        *sum += more.into();
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
    histogram: [f32; BINS],
}

/// Samples that are summed in 32 bits before their sum is added in 64: a processor without those takes a tenth of the time,
/// and what so few lose by rounding is a millionth.
const BLOCK: usize = 64;

/// Sums over a few samples, as of [`Equations`].
#[derive(Default)]
struct Block {
    normal: [[f32; UNKNOWNS]; UNKNOWNS],
    right: [f32; UNKNOWNS],
    length: f32,
    known: f32,
    loss: f32,
    used: f32,
    squares: f32,
}

/// At least this part of the outline, by length, must be known.
const LEAST_KNOWN: f64 = 0.15;
/// In a correction a sample holds the pose at least by this part of its weight. By the weights alone, which are never less than the second
/// derivative of a redescending loss, steps are too short and converge slowly; with less than a third of them some go too far.
const LEAST_FIRM: f32 = 0.5;
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

    /// Adds what was found along the normals of samples, weighed as a stage does, where the outline moves so.
    pub(super) fn add_samples(&mut self, samples: &[BorderPixel], motion: &Motion, stage: &Stage) {
        for few in samples.chunks(BLOCK) {
            let mut block = Block::default();
            for sample in few {
                block.add_sample(sample, motion, stage, &mut self.histogram);
            }
            self.add_block(&block);
        }
    }

    fn add_block(&mut self, block: &Block) {
        for (count, (row, more)) in (1..).zip(self.normal.iter_mut().zip(&block.normal)) {
            add_each(row.get_mut(..count).unwrap_or_default(), more);
        }
        add_each(&mut self.right, &block.right);
        self.length += f64::from(block.length);
        self.known += f64::from(block.known);
        self.loss += f64::from(block.loss);
        self.used += f64::from(block.used);
        self.squares += f64::from(block.squares);
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
        let half = (self.used / 2.0) as f32;
        let mut below = 0.0;
        for (bin, &length) in self.histogram.iter().enumerate() {
            if below + length >= half && length > 0.0 {
                return 1.4826 * f64::from(BIN * (bin as f32 + (half - below) / length));
            }
            below += length;
        }
        1.4826 * f64::from(BIN * BINS as f32)
    }
}

/// Adds the products of a Jacobian with itself and with a residual to rows of normal equations.
macro_rules! add_lower {
    ($sums:ident, $jacobian:ident, $firm:ident, $weight:ident, $residual:ident;
        $($row:literal: $($column:literal)*;)*) => {$(
            $sums.right[$row] += $weight * $jacobian[$row] * $residual;
            let held = $firm * $jacobian[$row];
            $($sums.normal[$row][$column] += held * $jacobian[$column];)*
    )*};
}

impl Block {
    fn add_sample(
        &mut self,
        sample: &BorderPixel,
        motion: &Motion,
        stage: &Stage,
        histogram: &mut [f32; BINS],
    ) {
        let (length, range) = (sample.weight, stage.range as f32);
        match sample.residual() {
            Residual::None => {}
            // Only its length counts.
            Residual::Unknown => self.length += length,
            Residual::Px(residual) if residual.abs() <= range => {
                let bin = (residual.abs() / BIN) as usize;
                histogram[bin.min(BINS - 1)] += length;
                self.add(stage, &motion.jacobian(sample), residual, length);
            }
            // It costs as much as one at the end of the range.
            Residual::Px(_) | Residual::Missing => {
                self.length += length;
                self.known += length;
                self.loss += length * stage.loss.at(range).0;
            }
        }
    }

    /// Adds a sample: how far the target's outline is beyond the model's (pixels). It holds the pose as firmly as its weight, or, in
    /// a correction, as the second derivative of the loss.
    fn add(&mut self, stage: &Stage, jacobian: &[f32; 6], residual: f32, length: f32) {
        let (cost, weight) = stage.loss.at(residual);
        self.length += length;
        self.known += length;
        self.loss += length * cost;
        let w = length * weight;
        self.used += length;
        self.squares += w * residual * residual;
        let [a, b, c, x, y, z] = *jacobian;
        let jacobian = [a, b, c, x, y, z, 1.0];
        let firm = match stage.corrects {
            false => w,
            true => length * stage.loss.curvature(residual).max(LEAST_FIRM * weight),
        };
        // Solvers read the lower triangle alone. Number by number: loops would take a microcontroller three times as long.
        add_lower!(
            self, jacobian, firm, w, residual;
            0: 0;
            1: 0 1;
            2: 0 1 2;
            3: 0 1 2 3;
            4: 0 1 2 3 4;
            5: 0 1 2 3 4 5;
            6: 0 1 2 3 4 5 6;
        );
    }
}

#[cfg(test)]
mod tests;
