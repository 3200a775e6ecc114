//! Mirror images of corrected poses that nobody looked at.
//!
//! Before its film is known a tray may lie on its inner rim, and the mirror image of that pose leads nowhere; where the film puts
//! the pose its mirror image explains the frame as well, or better.

use heapless::Vec;

use super::candidate::{CANDIDATES, Candidate, has_as_good, keep_once, misfit_of};
use crate::mesh::Model;
use crate::mesh::mirror::mirror_pose;
use crate::mesh::symmetry::SymmetryPlane;
use crate::pose::{Pose, geodesic_deg};
use crate::refine::{CameraView, RefineError, RefineMemory, RefineOptions, assess, refine};

/// Refinement brings a mirror image back to a candidate that is nearer than this; it was looked at then.
const LOOKED_AT_DEG: f64 = 2.0;

/// Adds the refined mirror images of the best candidate to all of them, best first; one that leads nowhere is no rival.
///
/// # Errors
/// [`RefineError`] where memory is too short.
pub(super) fn add_mirror_images(
    model: &Model<'_>,
    view: CameraView<'_>,
    planes: &[SymmetryPlane],
    candidates: &mut Vec<Candidate, CANDIDATES>,
    options: RefineOptions,
    memory: &mut RefineMemory<'_>,
) -> Result<(), RefineError> {
    let Some(best) = candidates.first().copied() else {
        return Ok(());
    };
    for plane in planes {
        let start = mirror_pose(&best.pose, plane);
        if has_one_near(candidates, &start) {
            continue;
        }
        let tried = refine(model, &[view], &start, options, memory);
        let Some(refined) = RefineError::passed_over(tried)? else {
            continue;
        };
        if has_as_good(candidates, &refined.pose, misfit_of(&refined)) {
            continue;
        }
        let assessment = assess(model, &[view], &refined, memory)?;
        let mirrored = Candidate {
            pose: refined.pose,
            start,
            located: best.located,
            refined: Some(refined),
            covariance: assessment.covariance,
            fit: assessment.fit,
        };
        keep_once(candidates, mirrored);
    }
    Ok(())
}

fn has_one_near(candidates: &[Candidate], pose: &Pose) -> bool {
    let mut turns = candidates
        .iter()
        .map(|known| geodesic_deg(&known.pose.rotation, &pose.rotation));
    turns.any(|turn| turn < LOOKED_AT_DEG)
}
