//! Candidates of a frame brought to where its film puts the edges, once its constants are known.

use heapless::Vec;

use super::candidate::{CANDIDATES, Candidate};
use crate::camera::Camera;
use crate::mesh::Model;
use crate::refine::{
    CameraView, ImageTarget, RefineError, RefineMemory, RefineOptions, assess, correct,
};
use crate::shortlist::keep;

/// Corrects the refined poses among the candidates of a frame by the film of `image`; best first again. One that cannot be
/// corrected is dropped while another can.
///
/// # Errors
/// That of the last candidate, where none can be corrected.
pub fn correct_candidates(
    model: &Model<'_>,
    camera: &Camera,
    image: ImageTarget<'_>,
    candidates: &[Candidate],
    options: RefineOptions,
    memory: &mut RefineMemory<'_>,
) -> Result<Vec<Candidate, CANDIDATES>, RefineError> {
    let views = [CameraView::only(camera, image)];
    let mut corrected = Vec::new();
    let mut failure = None;
    for candidate in candidates {
        let Some(refined) = &candidate.refined else {
            continue;
        };
        let mut one = || {
            let refined = correct(model, &views, refined, options, memory)?;
            let assessment = assess(model, &views, &refined, memory)?;
            Ok(Candidate {
                pose: refined.pose,
                refined: Some(refined),
                covariance: assessment.covariance,
                fit: assessment.fit,
                ..*candidate
            })
        };
        match one() {
            Ok(candidate) => {
                keep(&mut corrected, candidate, Candidate::misfit);
            }
            Err(error) => failure = Some(error),
        }
    }
    match failure.filter(|_| corrected.is_empty()) {
        Some(error) => Err(error),
        None => Ok(corrected),
    }
}
