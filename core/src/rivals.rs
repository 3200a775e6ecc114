//! Refinement of several rival poses, and which of them explains the mask best.

use heapless::Vec;

use crate::camera::Camera;
use crate::mask::{Mask, MaskMut};
use crate::mesh::Mesh;
use crate::mirror::mirror_pose;
use crate::pose::{Pose, geodesic_deg};
use crate::refine::{RefineError, RefineMemory, Refined, refine};
use crate::verify::{Verified, unmatched_at};

/// Rivals that are refined at most.
pub const RIVALS: usize = 4;

/// Refined poses that may come of them: each rival's own and its three mirror images.
pub const ANSWERS: usize = 4 * RIVALS;

/// Rivals are refined when the model drawn at them leaves at most this many times the unmatched
/// pixels of the best: the library stage is some pixels off, so near rivals are still open.
const WORTH_REFINING: f64 = 4.0;

/// A part looks symmetric when its mirrored pose leaves at most this part of the mask unmatched.
const SYMMETRIC_SHARE: f64 = 0.15;

/// Of poses nearer to each other than this, degrees, the best is kept.
const SAME_DEG: f64 = 0.5;

/// A refined pose and the rival that led to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RefinedRival {
    /// The rival that was refined, or whose mirror image was.
    pub rival: Verified,
    /// What refinement made of it.
    pub refined: Refined,
}

/// Refines those of the first [`RIVALS`] rivals that are near the best, then their mirror images
/// about each axis of the model about which it looks symmetric from there: such an image may lie
/// between the same views and be no rival of its own. The poses by rising loss, each once; empty
/// only where there is no rival.
///
/// `rivals` come best first, as [`crate::verify::verify`] puts them.
///
/// # Errors
/// That of [`refine`] for the last rival, when none can be refined.
pub fn refine_rivals(
    mesh: &Mesh<'_>,
    camera: &Camera,
    mask: &Mask<'_>,
    rivals: &[Verified],
    memory: &mut RefineMemory<'_>,
) -> Result<Vec<RefinedRival, ANSWERS>, RefineError> {
    let least = rivals.first().map_or(0, |best| best.unmatched);
    let limit = WORTH_REFINING * least as f64;
    let worth = |rival: &&Verified| rival.unmatched as f64 <= limit;
    let mut answers = Vec::new();
    let mut failure = None;
    for rival in rivals.iter().take(RIVALS).filter(worth) {
        match refine(mesh, camera, mask, &rival.located.pose, memory) {
            Ok(refined) => add(&mut answers, rival, refined),
            Err(error) => failure = Some(error),
        }
    }
    if let (true, Some(error)) = (answers.is_empty(), failure) {
        return Err(error);
    }
    let middle = mesh.bounds().centre;
    for RefinedRival { rival, refined } in answers.clone() {
        for axis in 0..3 {
            let mirrored = mirror_pose(&refined.pose, &middle, axis);
            if !is_near(mesh, camera, mask, &mirrored, memory) {
                continue;
            }
            if let Ok(refined) = refine(mesh, camera, mask, &mirrored, memory) {
                add(&mut answers, &rival, refined);
            }
        }
    }
    Ok(distinct(&answers))
}

/// Whether the model drawn at a mirrored pose covers the mask nearly as well.
fn is_near(
    mesh: &Mesh<'_>,
    camera: &Camera,
    mask: &Mask<'_>,
    pose: &Pose,
    memory: &mut RefineMemory<'_>,
) -> bool {
    let Ok(mut drawn) = MaskMut::new(memory.drawn, mask.width(), mask.height()) else {
        return false;
    };
    let limit = SYMMETRIC_SHARE * mask.area() as f64;
    unmatched_at(mesh, camera, pose, mask, memory.projected, &mut drawn)
        .is_ok_and(|unmatched| unmatched as f64 <= limit)
}

/// Puts a pose in its place by rising loss.
fn add(answers: &mut Vec<RefinedRival, ANSWERS>, rival: &Verified, refined: Refined) {
    let place = answers.partition_point(|other| other.refined.loss <= refined.loss);
    // Each of the rivals gives four poses at most, so there is room.
    let _ = answers.insert(
        place,
        RefinedRival {
            rival: *rival,
            refined,
        },
    );
}

/// Each pose once.
fn distinct(answers: &[RefinedRival]) -> Vec<RefinedRival, ANSWERS> {
    let mut kept: Vec<RefinedRival, ANSWERS> = Vec::new();
    for answer in answers {
        let rotation = &answer.refined.pose.rotation;
        let same =
            |other: &RefinedRival| geodesic_deg(&other.refined.pose.rotation, rotation) < SAME_DEG;
        if !kept.iter().any(same) {
            // No longer than what it is made from.
            let _ = kept.push(*answer);
        }
    }
    kept
}
