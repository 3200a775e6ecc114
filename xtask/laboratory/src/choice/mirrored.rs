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

/// Those of the frames of which something is told that are looked at as if they were flipped: some, spread over all of them.
pub fn looked_at_flipped(told: &[Option<Beside>]) -> Vec<usize> {
    let frames: Vec<usize> = (0..told.len()).filter(|&k| told[k].is_some()).collect();
    let step = frames.len().div_ceil(LOOKED_AT).max(1);
    frames
        .iter()
        .copied()
        .skip(step / 2)
        .step_by(step)
        .collect()
}
