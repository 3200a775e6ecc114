//! Answers as candidates of the finder, so that a click's pose is chosen and judged as any other.

use heapless::Vec;

use super::candidates::Answer;
use super::observation::Observation;
use fluoropose::finder::{CANDIDATES, Candidate};
use fluoropose::mesh::Model;
use fluoropose::refine::{CameraView, RefineError, RefineMemory, assess};

/// An answer whose score is below this fraction of the best's is no rival of it.
const RIVAL: f64 = 0.75;

/// The answers that are rivals, the best first, each with how sure it is and how well it fits the frame.
///
/// # Errors
/// [`RefineError`] where one cannot be drawn.
pub fn candidates(
    answers: &[Answer],
    observation: &Observation<'_>,
    model: &Model<'_>,
    memory: &mut RefineMemory<'_>,
) -> Result<Vec<Candidate, CANDIDATES>, RefineError> {
    let least = answers.first().map_or(0.0, |best| RIVAL * best.score);
    let target = observation.target();
    let view = CameraView::only(observation.camera, target);
    let rivals = answers.iter().filter(|answer| answer.score >= least);
    let candidate = |answer: &Answer| {
        let assessment = assess(model, &[view], &answer.refined, memory)?;
        Ok(Candidate {
            pose: answer.refined.pose,
            start: answer.start,
            located: None,
            refined: Some(answer.refined),
            covariance: assessment.covariance,
            fit: assessment.fit,
        })
    };
    rivals.take(CANDIDATES).map(candidate).collect()
}
