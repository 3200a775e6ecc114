//! A pose against the truth, and whether what was said of it holds.

use fluoropose::finder::choice::{ChoiceContext, choose};
use fluoropose::finder::{Candidate, Limits, Verdict, contenders, judge};
use fluoropose::math::solve_spd;
use fluoropose::pose::covariance::Deviations;
use fluoropose::pose::{Pose, Quaternion};

use crate::finding::misfits::Beside;
use crate::measure::accuracy::Errors;

/// Squared radii that hold 68.3 and 95 % of a normal distribution in three dimensions.
const OF_THREE: [f64; 2] = [3.527, 7.815];
/// Standard deviations that hold 68.3 and 95 % of one number.
const OF_ONE: [f64; 2] = [1.0, 1.96];
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
    /// How sure the pose was said to be.
    pub(super) sd: Option<Deviations>,
    /// Whether the truth lies in the regions of 68 and 95 % of each number (x, y, z, rotations about z, x, y), and of the
    /// rotation as a whole.
    pub(super) inside: [[bool; 2]; 6],
    pub(super) rotation_inside: [bool; 2],
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
        let rotation = turn_squared(candidate, truth);
        let beyond = |error: f64, sd: f64| error.abs() > WRONG_SD * sd;
        Self {
            pose: candidate.pose,
            errors,
            sd,
            inside: inside(&errors, sd.as_ref()),
            rotation_inside: OF_THREE.map(|radius| rotation.is_some_and(|square| square <= radius)),
            wrong: sd.is_none_or(|sd| {
                beyond(errors.z_mm, sd.z_mm) || beyond(errors.geodesic_deg, sd.rotation_deg)
            }),
            far: errors.geodesic_deg > FAR_DEG || errors.z_mm.abs() > FAR_MM,
        }
    }
}

fn inside(errors: &Errors, sd: Option<&Deviations>) -> [[bool; 2]; 6] {
    let Some(sd) = sd else {
        return [[false; 2]; 6];
    };
    let numbers = [
        (errors.x_mm, sd.x_mm),
        (errors.y_mm, sd.y_mm),
        (errors.z_mm, sd.z_mm),
        (errors.z_rot_deg, sd.z_rot_deg),
        (errors.x_rot_deg, sd.x_rot_deg),
        (errors.y_rot_deg, sd.y_rot_deg),
    ];
    numbers.map(|(error, sd)| OF_ONE.map(|reach| error.abs() <= reach * sd))
}

/// The turn to the truth in units of its covariance, squared.
fn turn_squared(candidate: &Candidate, truth: &Pose) -> Option<f64> {
    let covariance = candidate.covariance?;
    let matrix = std::array::from_fn(|i| std::array::from_fn(|j| covariance.matrix[i][j]));
    let back = fluoropose::math::transpose(&candidate.pose.rotation);
    let turn = fluoropose::math::multiply(&truth.rotation, &back);
    let turn = vector_of(Quaternion::from(turn));
    let solved: [f64; 3] = solve_spd(matrix, turn)?;
    Some(turn.iter().zip(solved).map(|(a, b)| a * b).sum())
}

/// The rotation vector of a unit quaternion, radians.
fn vector_of(turn: Quaternion) -> [f64; 3] {
    let Quaternion { w, x, y, z } = turn;
    let sine = x.hypot(y).hypot(z);
    let angle = 2.0 * sine.atan2(w.abs());
    let factor = if sine > 0.0 { angle / sine } else { 2.0 };
    [x, y, z].map(|part| part * factor * w.signum())
}
