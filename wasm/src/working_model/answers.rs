//! What is told of a pose: how it was found, how well it fits, how sure it is.

use fluoropose::finder::{Candidate, Limits, Verdict, judge_fit, judge_one};
use fluoropose::locate::Located;
use fluoropose::locate::rerank::Reranked;
use fluoropose::pose::Pose;
use fluoropose::pose::covariance::PoseCovariance;
use fluoropose::refine::{Fit as OutlineFit, Refined};

use crate::uncertainty::Uncertainty;

/// A pose that explains an outline.
#[derive(Clone, Copy)]
pub(crate) struct Ranked {
    /// What the library said.
    pub(crate) located: Located,
    /// The pose, as good as it is known.
    pub(crate) pose: Pose,
    /// Known frame pixels that differ from the outline when the model is drawn there; nothing where it was not, or cannot
    /// be.
    pub(crate) drawn: Option<u64>,
    /// What refinement made of it.
    pub(crate) fit: Option<Fit>,
    /// How sure it is.
    pub(crate) covariance: Option<PoseCovariance>,
    /// How well it fits, where the finder compared it with others.
    pub(crate) judged: Option<Judged>,
}

/// How well a pose fits, whatever is chosen.
#[derive(Clone, Copy)]
pub(crate) struct Judged {
    /// By what candidates are compared ([`Candidate::misfit`]).
    pub(crate) misfit: f64,
    pub(crate) verdict: Verdict,
}

impl Judged {
    pub(super) fn of(candidates: &[Candidate], index: usize) -> Option<Self> {
        Some(Self {
            misfit: candidates.get(index)?.misfit(),
            verdict: judge_one(candidates, index, &Limits::USUAL)?,
        })
    }
}

/// What a target says of a refined pose.
pub(crate) struct Assessed {
    /// Nothing where the target tells nothing of the pose.
    pub(crate) uncertainty: Option<Uncertainty>,
    /// Whether the target determines it ([`fluoropose::finder::is_determined`]).
    pub(crate) determined: bool,
    /// How well the model's outline is met there.
    pub(crate) fit: OutlineFit,
}

impl Assessed {
    /// How far the pose is to be trusted by itself.
    pub(crate) fn verdict(&self) -> Verdict {
        judge_fit(&self.fit, self.determined, &Limits::USUAL)
    }
}

/// A refined pose.
#[derive(Clone, Copy)]
pub(crate) struct Fit {
    pub(crate) refined: Refined,
    /// The pose that it was refined from.
    pub(crate) start: Pose,
}

impl Ranked {
    /// A pose of the library, the model not drawn.
    pub(crate) fn undrawn(located: Located) -> Self {
        Self {
            located,
            pose: located.pose,
            drawn: None,
            fit: None,
            covariance: None,
            judged: None,
        }
    }
}

impl From<&Reranked> for Ranked {
    fn from(&Reranked { located, unmatched }: &Reranked) -> Self {
        Self {
            drawn: Some(unmatched),
            ..Self::undrawn(located)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fluoropose::finder::Doubt;

    /// A round part's outline is met all round, and tells nothing of its turn.
    #[test]
    fn a_pose_that_is_not_determined_is_doubtful_however_well_it_fits() {
        let verdict = |determined| {
            let fit = OutlineFit {
                size_px: 150.0,
                known: 1.0,
                met: 1.0,
                ..OutlineFit::default()
            };
            let assessed = Assessed {
                uncertainty: None,
                determined,
                fit,
            };
            assessed.verdict()
        };
        assert_eq!(verdict(true), Verdict::Good);
        assert_eq!(verdict(false), Verdict::Doubtful(Doubt::Undetermined));
    }
}
