//! What is made of components that lie beside each other as in no knee.

use anyhow::Result;
use fluoropose::finder::{Doubt, FlippedFit, Verdict};
use fluoropose::joint::beside::Beside;
use fluoropose::mesh::anatomy::KneeComponent;
use rayon::prelude::*;

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

/// How mirrored models fit some frames, spread over all that have both poses; `apart` is how far the components lie beside each other in
/// each, `fit` looks at a component in a frame. The femur comes first: where most of its fits tell that nothing is flipped, no more is
/// looked at, and the answer is one frame without fits.
///
/// # Errors
/// Those of `fit`.
pub fn fit_flipped(
    apart: &[f64],
    fit: impl Fn(KneeComponent, usize) -> Result<Option<FlippedFit>> + Sync,
) -> Result<Vec<Option<[FlippedFit; 2]>>> {
    let all = |component, frames: &[usize]| -> Result<Vec<Option<FlippedFit>>> {
        let fits = frames.par_iter().map(|&frame| fit(component, frame));
        fits.collect()
    };
    let frames = looked_at_flipped(apart);
    let (most, rest) = frames.split_at(frames.len().min(frames.len() / 2 + 1));
    let mut femur = all(KneeComponent::Femur, most)?;
    if femur.iter().all(|fit| fit.is_none_or(|fit| fit.is_poor())) {
        return Ok(vec![None]);
    }
    femur.extend(all(KneeComponent::Femur, rest)?);
    let tibia = all(KneeComponent::Tibia, &frames)?;
    let both = femur.into_iter().zip(tibia);
    let both = both.map(|(femur, tibia)| Some([femur?, tibia?]));
    Ok(both.collect())
}

/// Those of the frames with both poses that are looked at as if they were flipped.
fn looked_at_flipped(apart: &[f64]) -> Vec<usize> {
    let frames: Vec<usize> = (0..apart.len()).filter(|&k| apart[k].is_finite()).collect();
    let step = frames.len().div_ceil(LOOKED_AT).max(1);
    let spread = frames.iter().copied().skip(step / 2);
    spread.step_by(step).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use fluoropose::pose::Pose;
    use std::sync::atomic::{AtomicUsize, Ordering};

    fn looks(gains: [f64; 3]) -> (usize, Vec<Option<[FlippedFit; 2]>>) {
        let count = AtomicUsize::new(0);
        let fit = |component, frame: usize| {
            count.fetch_add(1, Ordering::Relaxed);
            let gain = match component {
                KneeComponent::Femur => gains[frame / 10],
                KneeComponent::Tibia => 1.0,
            };
            let pose = Pose::IDENTITY;
            Ok(Some(FlippedFit { pose, gain }))
        };
        let fits = fit_flipped(&[0.0; 30], fit).unwrap();
        (count.into_inner(), fits)
    }

    #[test]
    fn no_more_is_looked_at_where_the_femur_tells() {
        let (count, fits) = looks([0.1, 0.2, 5.0]);
        assert_eq!((count, fits), (2, vec![None]));
        let (count, fits) = looks([0.1, 2.0, 0.1]);
        assert_eq!(count, 6);
        let femur = |fit: &Option<[FlippedFit; 2]>| fit.unwrap()[0].gain;
        assert_eq!(fits.iter().map(femur).collect::<Vec<_>>(), [0.1, 2.0, 0.1]);
    }
}
