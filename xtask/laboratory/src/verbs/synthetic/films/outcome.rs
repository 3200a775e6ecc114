//! A pose against the truth, and whether what was said of it holds.

use fluoropose::finder::choice::{ChoiceContext, choose};
use fluoropose::finder::{Candidate, Limits, Verdict, contenders, judge};
use fluoropose::pose::Pose;
use fluoropose::pose::covariance::{Deviations, PoseCovariance};

use crate::finding::misfits::Beside;
use crate::measure::accuracy::Errors;

/// Poses farther from the truth than this many standard deviations are wrong.
const WRONG_SD: f64 = 3.0;
/// And those farther than this, whatever was said of them: degrees, and mm of depth.
const FAR_DEG: f64 = 2.0;
const FAR_MM: f64 = 5.0;

/// What came of one component of one film.
#[derive(Clone, Copy, Debug)]
pub(super) struct Outcome {
    /// Whether it was good, doubtful or none.
    pub(super) verdict: &'static str,
    /// Of a pose that was not refused, in the chosen place.
    pub(super) found: Option<Found>,
    /// Wall time, ms.
    pub(super) ms: f64,
}

/// A pose against the truth.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    pub(super) pose: Pose,
    pub(super) errors: Errors,
    /// Where it is.
    pub(super) truth: Pose,
    /// How sure the pose was said to be, as a whole and number by number.
    pub(super) covariance: Option<PoseCovariance>,
    pub(super) sd: Option<Deviations>,
    /// Whether depth or rotation is off by more than three standard deviations.
    pub(super) wrong: bool,
    /// Whether depth or rotation is off by much, whatever was said.
    pub(super) far: bool,
}

impl Outcome {
    /// Chooses among candidates by what else is known, and compares the choice with the truth; `beside` are the misfits of
    /// other poses on the film, `middle` is that of the model's box.
    pub(super) fn of(
        candidates: &[Candidate],
        (context, beside): (&ChoiceContext<'_>, &Beside),
        truth: &Pose,
        middle: &[f64; 3],
        ms: f64,
    ) -> Self {
        let chosen = chosen(candidates, context).map(|(candidate, verdict)| {
            (
                candidate,
                verdict.or_doubt(beside.doubt(candidate.misfit())),
            )
        });
        Self {
            verdict: chosen.map_or("none", |(_, verdict)| verdict.word()),
            found: chosen
                .filter(|(_, verdict)| !matches!(verdict, Verdict::NoFit(_)))
                .map(|(candidate, _)| Found::of(&candidate, truth, middle)),
            ms,
        }
    }
}

/// The candidate that is chosen, and how far it is trusted.
pub(super) fn chosen(
    candidates: &[Candidate],
    context: &ChoiceContext<'_>,
) -> Option<(Candidate, Verdict)> {
    let choice = choose(&contenders(candidates), context)?;
    let verdict = judge(candidates, &choice, &Limits::USUAL)?;
    Some((*candidates.get(choice.index)?, verdict))
}

impl Found {
    fn of(candidate: &Candidate, truth: &Pose, middle: &[f64; 3]) -> Self {
        let errors = Errors::of(&candidate.pose, truth);
        let sd = candidate
            .covariance
            .map(|covariance| covariance.deviations(&candidate.pose, middle));
        let beyond = |error: f64, sd: f64| error.abs() > WRONG_SD * sd;
        Self {
            pose: candidate.pose,
            errors,
            truth: *truth,
            covariance: candidate.covariance,
            sd,
            wrong: sd.is_none_or(|sd| {
                beyond(errors.z_mm, sd.z_mm) || beyond(errors.geodesic_deg, sd.rotation_deg)
            }),
            far: errors.geodesic_deg > FAR_DEG || errors.z_mm.abs() > FAR_MM,
        }
    }
}
