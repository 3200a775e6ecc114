//! What is made of components that lie beside each other as in no knee.

use anyhow::Result;
use fluoropose::finder::{Doubt, FlippedFit, FlippedLooks, Verdict};
use fluoropose::joint::beside::Beside;
use fluoropose::mesh::anatomy::KneeComponent;
use rayon::prelude::*;

use super::decide::Decision;

/// Doubts poses of a component that lies beside the other as in no knee, by what is told of each frame; `others` says of which frames the other
/// one's pose is good by itself.
pub fn doubt_mirrored(
    decisions: &mut [Option<Decision>],
    others: &[bool],
    told: &[Option<Beside>],
) {
    for ((decision, told), other) in decisions.iter_mut().zip(told).zip(others) {
        let (Some(decision), Some(told)) = (decision, told) else {
            continue;
        };
        let Some(told) = told.against(decision.verdict == Verdict::Good, *other) else {
            continue;
        };
        let doubt = Doubt::Mirrored(told);
        decision.verdict = match decision.verdict {
            // It explains any other doubt, but for where one of both is astray.
            Verdict::Doubtful(_) if told.of_film && !told.is_beyond_flipping() => {
                Verdict::Doubtful(doubt)
            }
            verdict => verdict.or_doubt(Some(doubt)),
        };
    }
}

/// In which frames there is a pose that is good.
pub fn are_good(decisions: &[Option<Decision>]) -> Vec<bool> {
    let is_good = |one: &Option<Decision>| one.as_ref().map(|one| one.verdict);
    let good = decisions.iter().map(is_good);
    good.map(|verdict| verdict == Some(Verdict::Good)).collect()
}

/// How mirrored models fit some frames ([`FlippedLooks`]); `apart` is how far the components lie beside each other in each, `fit` looks
/// at a component in a frame.
///
/// # Errors
/// Those of `fit`.
pub fn fit_flipped(
    apart: &[f64],
    fit: impl Fn(KneeComponent, usize) -> Result<Option<FlippedFit>> + Sync,
) -> Result<Vec<Option<[FlippedFit; 2]>>> {
    let mut looks = FlippedLooks::new(apart);
    while !looks.wanted().is_empty() {
        let fits = looks.wanted().par_iter();
        let fits = fits.map(|&(component, frame)| fit(component, frame));
        for fit in fits.collect::<Result<Vec<_>>>()? {
            looks.take(fit);
        }
    }
    Ok(looks.fits())
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
