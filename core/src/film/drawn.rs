//! What is drawn of a line, and its convolution.

use super::lines::POINTS;
use crate::math::exp;

/// Parts of intensity that pass, one for each place of a line.
pub(crate) type Drawn = [f32; POINTS];

/// Convolved with a Gaussian of a width in places, which reaches so many places to either side, at most `MOST`; both ends are
/// continued.
pub(super) fn convolved<const MOST: usize>(drawn: &Drawn, width: f32, reach: usize) -> Drawn {
    let reach = reach.min(MOST);
    let mut weights = [0.0; MOST];
    let mut sum = 1.0;
    for (k, weight) in weights.iter_mut().take(reach).enumerate() {
        let part = (k + 1) as f32 / width;
        *weight = exp(f64::from(-0.5 * part * part)) as f32;
        sum += 2.0 * *weight;
    }
    // Continued on both sides, so that all places are summed alike, several at once.
    let long: [[f32; POINTS]; 3] = [[drawn[0]; POINTS], *drawn, [drawn[POINTS - 1]; POINTS]];
    let long = long.as_flattened();
    let mut totals = *drawn;
    for (j, weight) in weights.iter().enumerate().take(reach) {
        let (before, after) = (&long[POINTS - 1 - j..], &long[POINTS + 1 + j..]);
        for ((total, before), after) in totals.iter_mut().zip(before).zip(after) {
            *total += weight * (before + after);
        }
    }
    totals.map(|total| total / sum)
}
