//! What is drawn of a line, and its convolution.

use super::lines::POINTS;
use crate::math::exp;

/// Parts of intensity that pass, one for each place of a line.
pub(crate) type Drawn = [f32; POINTS];

/// Weights of a Gaussian that reaches at most `MOST` places to either side, made once for all lines that are convolved with it.
pub(super) struct Gaussian<const MOST: usize> {
    /// Of the places at 1, 2 and so on places beside the middle, whose own is 1.
    weights: [f32; MOST],
    reach: usize,
    /// Of all places.
    sum: f32,
}

impl<const MOST: usize> Gaussian<MOST> {
    /// Of a width in places, which reaches so many places to either side.
    pub(super) fn of(width: f32, reach: usize) -> Self {
        let mut gaussian = Self {
            weights: [0.0; MOST],
            reach: reach.min(MOST),
            sum: 1.0,
        };
        for (k, weight) in gaussian.weights.iter_mut().take(reach).enumerate() {
            let part = (k + 1) as f32 / width;
            *weight = exp(f64::from(-0.5 * part * part)) as f32;
            gaussian.sum += 2.0 * *weight;
        }
        gaussian
    }

    /// Places to each side that it reaches.
    pub(super) fn reach(&self) -> usize {
        self.reach
    }

    /// A line convolved with it; both ends are continued.
    pub(super) fn convolved(&self, drawn: &Drawn) -> Drawn {
        // Continued on both sides, so that all places are summed alike, several at once.
        let long: [[f32; POINTS]; 3] = [[drawn[0]; POINTS], *drawn, [drawn[POINTS - 1]; POINTS]];
        let long = long.as_flattened();
        let mut totals = *drawn;
        for (j, weight) in self.weights.iter().enumerate().take(self.reach) {
            let (before, after) = (&long[POINTS - 1 - j..], &long[POINTS + 1 + j..]);
            for ((total, before), after) in totals.iter_mut().zip(before).zip(after) {
                *total += weight * (before + after);
            }
        }
        totals.map(|total| total / self.sum)
    }
}
