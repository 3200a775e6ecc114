//! What is told of a pose: how it was found, how well it fits, how sure it is.

use fluoropose::finder::{Candidate, Limits, Verdict, judge_fit, judge_one};
use fluoropose::locate::Located;
use fluoropose::locate::rerank::Reranked;
use fluoropose::pose::Pose;
use fluoropose::pose::covariance::PoseCovariance;
use fluoropose::refine::{Fit as OutlineFit, Refined};

use crate::found::Uncertainty;

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
    /// Nothing where the target does not determine the pose.
    pub(crate) uncertainty: Option<Uncertainty>,
    /// How well the model's outline is met there.
    pub(crate) fit: OutlineFit,
}

impl Assessed {
    /// How far the pose is to be trusted by itself.
    pub(crate) fn verdict(&self) -> Verdict {
        judge_fit(&self.fit, self.uncertainty.is_some(), &Limits::USUAL)
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
