//! Refinement of several rival poses, and which of them explains what was seen best.

use heapless::Vec;

use crate::finder::nearby::nearby;
use crate::image::mask::{MaskMut, words_needed};
use crate::locate::rerank::{Reranked, unmatched_at_pose};
use crate::mesh::Model;
use crate::mesh::mirror::mirror_pose;
use crate::mesh::symmetry::SymmetryPlane;
use crate::pose::{Pose, geodesic_deg};
use crate::refine::{
    CameraView, Effort, RefineError, RefineMemory, RefineOptions, Refined, Target, refine,
};
use crate::shortlist::keep;

/// Poses to start from that are refined at most.
pub const STARTS: usize = 6;

/// Refined poses that may come of them: each start's own and its three mirror images.
pub const ANSWERS: usize = 4 * STARTS;

/// Rivals are refined when the model drawn at them leaves at most this many times the unmatched
/// pixels of the best: the library stage is some pixels off, so near rivals are still open.
const WORTH_REFINING: f64 = 4.0;

/// A part looks symmetric when its mirrored pose leaves at most this part of the mask unmatched.
const SYMMETRIC_FRACTION: f64 = 0.15;

/// See [`is_split`]: least residual, pixels, and how many times the spread of the residuals it is.
const SPLIT_PX: f64 = 0.1;
const SPLIT_RATIO: f64 = 3.0;
/// The same of an outline without noise: residuals that are spread less than the first leave no
/// more than the second at the right pose, pixels. By trial on the exact masks of two femoral and two
/// tibial components.
const EXACT_PX: f64 = 0.046;
const INEXACT_PX: f64 = 0.03;

/// Step of the search round a pose that may be a small minimum, degrees.
const CLOSE_DEG: f64 = 1.0;

/// What a glance finds is the best pose again where it is nearer to it than this, degrees, and is no rival
/// where its loss is more than so many times the best one's.
const BACK_DEG: f64 = 0.1;
const ALIKE: f64 = 1.25;

/// Of poses nearer to each other than this, degrees, the best is kept.
const SAME_DEG: f64 = 0.5;

/// A refined pose and what it was refined from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RefinedRival {
    /// Which of the poses to start from led to it, from 0.
    pub start: usize,
    /// Whether it was refined from the mirror image of what that start became.
    pub mirrored: bool,
    /// What refinement made of it.
    pub refined: Refined,
}

/// The first of `rivals` that are near enough to the best to be worth refining. They come best
/// first, as [`crate::locate::rerank::rerank`] puts them.
#[must_use]
pub fn worth_refining(rivals: &[Reranked]) -> &[Reranked] {
    let least = rivals.first().map_or(0, |best| best.unmatched);
    let limit = WORTH_REFINING * least as f64;
    let count = rivals.partition_point(|rival| rival.unmatched as f64 <= limit);
    &rivals[..count.min(STARTS)]
}

/// Refines the first [`STARTS`] poses of `starts`, then their mirror images
/// in each of `planes`, those of the model's near-symmetry
/// ([`crate::mesh::symmetry::symmetry_planes`]), where they cover the mask: such an image may lie
/// between the same views of a library and be no rival of its own. The poses by rising loss,
/// each once; empty only where there is no start.
///
/// # Errors
/// That of [`refine`] for the last start, when none can be refined.
pub fn refine_rivals(
    model: &Model<'_>,
    views: &[CameraView<'_>],
    starts: &[Pose],
    planes: &[SymmetryPlane],
    options: RefineOptions,
    memory: &mut RefineMemory<'_>,
) -> Result<Vec<RefinedRival, ANSWERS>, RefineError> {
    let mut search = RivalRefinement {
        model,
        views,
        planes,
        options,
        memory,
        answers: Vec::new(),
    };
    let mut failure = None;
    for (start, pose) in starts.iter().take(STARTS).enumerate() {
        if let Err(error) = search.refine(pose, start, false) {
            failure = Some(error);
        }
    }
    if let (true, Some(error)) = (search.answers.is_empty(), failure) {
        return Err(error);
    }
    search.mirror();
    search.look_closer();
    Ok(distinct(&search.answers))
}

/// Refinement from ever more poses.
struct RivalRefinement<'s, 'm> {
    model: &'s Model<'s>,
    views: &'s [CameraView<'s>],
    planes: &'s [SymmetryPlane],
    options: RefineOptions,
    memory: &'s mut RefineMemory<'m>,
    /// By rising loss.
    answers: Vec<RefinedRival, ANSWERS>,
}

impl RivalRefinement<'_, '_> {
    fn refine(&mut self, pose: &Pose, start: usize, mirrored: bool) -> Result<(), RefineError> {
        let refined = refine(self.model, self.views, pose, self.options, self.memory)?;
        let answer = RefinedRival {
            start,
            mirrored,
            refined,
        };
        keep(&mut self.answers, answer, |other| other.refined.loss);
        Ok(())
    }

    /// Refines the mirror images of all poses so far, where they cover what was seen.
    fn mirror(&mut self) {
        for RefinedRival { start, refined, .. } in distinct(&self.answers) {
            for plane in self.planes {
                let mirrored = mirror_pose(&refined.pose, plane);
                let near = self
                    .views
                    .iter()
                    .all(|view| is_near(self.model, view, &mirrored, &refined.pose, self.memory));
                if near {
                    // A mirror image that leads nowhere is no rival.
                    let _ = self.refine(&mirrored, start, true);
                }
            }
        }
    }

    /// Where most of the outline fits exactly and a part does not, the best pose may be a small
    /// minimum beside the right one: it is refined from round about.
    fn look_closer(&mut self) {
        let (Some(best), [view]) = (self.answers.first().copied(), self.views) else {
            return;
        };
        let Target::Silhouette(silhouette) = &view.target else {
            return;
        };
        if !is_split(&best.refined) || view.placement != Pose::IDENTITY {
            return;
        }
        let (model, camera, pose) = (self.model, view.camera, &best.refined.pose);
        let starts = nearby(model, camera, silhouette, pose, CLOSE_DEG, self.memory);
        let turned =
            |start: &&Pose| geodesic_deg(&start.rotation, &pose.rotation) > CLOSE_DEG / 2.0;
        for start in starts.iter().filter(turned) {
            if let Some(found) = self.probe(start, &best.refined) {
                // From there it leads somewhere.
                let _ = self.refine(&found, best.start, best.mirrored);
            }
        }
    }

    /// Where a start leads, unless that is back to the best pose or to a worse one. Most do.
    fn probe(&mut self, start: &Pose, best: &Refined) -> Option<Pose> {
        let options = RefineOptions {
            effort: Effort::Probe,
            edge_offset: false,
            ..self.options
        };
        let found = refine(self.model, self.views, start, options, self.memory).ok()?;
        let apart = geodesic_deg(&found.pose.rotation, &best.pose.rotation);
        (apart > BACK_DEG && found.loss < ALIKE * best.loss).then_some(found.pose)
    }
}

/// Whether most of an outline fits exactly and a part does not at all, which noise does not do, or
/// an outline without noise leaves more than rounding does.
fn is_split(refined: &Refined) -> bool {
    let (residual, sigma) = (refined.residual_px, refined.robust_sigma_px);
    let split = residual > SPLIT_PX && residual > SPLIT_RATIO * sigma;
    split || (sigma < EXACT_PX && residual > INEXACT_PX)
}

/// Whether the model drawn at a mirrored pose covers the silhouette nearly as well as at its own,
/// or well by itself. A grey frame cannot say.
fn is_near(
    model: &Model<'_>,
    view: &CameraView<'_>,
    mirrored: &Pose,
    own: &Pose,
    memory: &mut RefineMemory<'_>,
) -> bool {
    let Target::Silhouette(silhouette) = &view.target else {
        return true;
    };
    let mut unmatched = |pose: &Pose| {
        let (width, height) = (silhouette.mask().width(), silhouette.mask().height());
        let words = memory.drawn.get_mut(..words_needed(width, height))?;
        let mut drawn = MaskMut::new(words, width, height).ok()?;
        let pose = view.placement.compose(pose);
        let scratch = &mut *memory.projected;
        unmatched_at_pose(model, view.camera, &pose, silhouette, scratch, &mut drawn).ok()
    };
    let Some(there) = unmatched(mirrored) else {
        return false;
    };
    let limit = SYMMETRIC_FRACTION * silhouette.mask().area() as f64;
    there as f64 <= limit || unmatched(own).is_none_or(|here| there <= 2 * here)
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
