//! What is made of components that lie beside each other as in no knee.

use fluoropose::finder::{Doubt, Verdict};
use fluoropose::joint::beside::Beside;

use super::decide::Decision;

/// Frames of a film that are looked at as if they were flipped.
const LOOKED_AT: usize = 3;

/// Doubts poses of a component that lies beside the other as in no knee, by what is told of each frame.
pub fn doubt_mirrored(decisions: &mut [Option<Decision>], told: &[Option<Beside>]) {
    for (decision, told) in decisions.iter_mut().zip(told) {
        if let (Some(decision), Some(told)) = (decision, told) {
            let doubt = Doubt::Mirrored(*told);
            decision.verdict = match decision.verdict {
                // It explains any other doubt.
                Verdict::Doubtful(_) if told.of_film => Verdict::Doubtful(doubt),
                verdict => verdict.or_doubt(Some(doubt)),
            };
        }
    }
}

/// Those of the frames with both poses that are looked at as if they were flipped: some, spread over all of them. `apart` is how far the
/// components lie beside each other in each.
pub fn looked_at_flipped(apart: &[f64]) -> Vec<usize> {
    let frames: Vec<usize> = (0..apart.len()).filter(|&k| apart[k].is_finite()).collect();
    let step = frames.len().div_ceil(LOOKED_AT).max(1);
    frames
        .iter()
        .copied()
        .skip(step / 2)
        .step_by(step)
        .collect()
}
