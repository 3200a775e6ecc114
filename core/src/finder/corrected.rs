//! Candidates of a frame brought onto its grey values, and to where its film puts the edges once its constants are known.

use heapless::Vec;

use super::candidate::{CANDIDATES, Candidate, has_as_good, keep_once, misfit_of};
use super::mirrored::add_mirror_images;
use super::rivals::{RefinedRival, refine_rivals};
use crate::camera::Camera;
use crate::locate::rerank::Reranked;
use crate::mesh::Model;
use crate::mesh::symmetry::SymmetryPlane;
use crate::pose::Pose;
use crate::refine::{
    CameraView, ImageTarget, RefineError, RefineMemory, RefineOptions, Target, assess, correct,
};

/// Refined poses of an outline that are brought onto the grey frame: the best of them.
const ON_IMAGE: usize = 3;
/// But none that misses the outline by more than this many times what the best does, and by more than so many pixels: a
/// ratio of 1.3 decides.
const HOPELESS: f64 = 2.0;
const HOPELESS_PX: f64 = 0.5;

/// Brings the best poses that an outline led to onto what else was seen: the edges of a frame, or the outline as it is known to
/// lie ([`crate::image::silhouette::Silhouette::lying_off`]); best first.
///
/// # Errors
/// [`RefineError`] where none can be brought there.
pub fn onto_target<'t>(
    model: &Model<'_>,
    camera: &Camera,
    target: impl Into<Target<'t>>,
    outline: &[Candidate],
    options: RefineOptions,
    memory: &mut RefineMemory<'_>,
) -> Result<Vec<Candidate, CANDIDATES>, RefineError> {
    let least = outline.first().map_or(0.0, Candidate::misfit);
    let limit = (HOPELESS * least).max(HOPELESS_PX);
    let open = outline.iter().take_while(|found| found.misfit() <= limit);
    let starts = open.take(ON_IMAGE).map(|found| found.pose);
    let starts: Vec<Pose, ON_IMAGE> = starts.collect();
    let target = target.into();
    let view = CameraView::only(camera, target);
    // Their mirror images are among them.
    let refined = refine_rivals(model, &[view], &starts, &[], options, memory)?;
    let mut candidates = Vec::new();
    for found in &refined {
        // Each was refined from one of them.
        let located = outline.get(found.start).and_then(|from| from.located);
        add_assessed(model, &view, (found, located), memory, &mut candidates)?;
    }
    Ok(candidates)
}

/// Adds a refined pose with what led to it, how sure it is and how well it fits, unless it is there already and fits as well. By itself, so that
/// candidates take no place on the stack while poses are refined.
#[inline(never)]
pub(super) fn add_assessed(
    model: &Model<'_>,
    view: &CameraView<'_>,
    (found, located): (&RefinedRival, Option<Reranked>),
    memory: &mut RefineMemory<'_>,
    candidates: &mut Vec<Candidate, CANDIDATES>,
) -> Result<(), RefineError> {
    let refined = &found.refined;
    if has_as_good(candidates, &refined.pose, misfit_of(refined)) {
        return Ok(());
    }
    let assessment = assess(model, &[*view], &found.refined, memory)?;
    let candidate = Candidate {
        pose: found.refined.pose,
        start: found.from,
        located,
        refined: Some(found.refined),
        covariance: assessment.covariance,
        fit: assessment.fit,
    };
    keep_once(candidates, candidate);
    Ok(())
}

/// Corrects the refined poses among the candidates of a frame by the film of `image`, and adds mirror images of the best in the
/// model's `planes` where none is among them; best first again. One that cannot be corrected is dropped while another can, and of those that come to one pose the best is left.
///
/// # Errors
/// That of the last candidate, where none can be corrected.
pub fn correct_candidates(
    model: &Model<'_>,
    (camera, image): (&Camera, ImageTarget<'_>),
    planes: &[SymmetryPlane],
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
            Ok(candidate) => keep_once(&mut corrected, candidate),
            Err(error) => failure = Some(error),
        }
    }
    if let Some(error) = failure.filter(|_| corrected.is_empty()) {
        return Err(error);
    }
    add_mirror_images(model, views[0], planes, &mut corrected, options, memory)?;
    Ok(corrected)
}

#[cfg(all(test, feature = "alloc"))]
mod tests {
    use super::*;
    use crate::finder::fake::{SIDE, camera, crank, drawn, located, placed};
    use crate::image::mask::Mask;
    use crate::image::silhouette::Silhouette;
    use crate::refine::{RefineBuffers, Refined};

    /// Refined poses turned by so many degrees, whose outlines are left by ever more, and those that became candidates.
    fn added(turns_deg: &[f64], located: Option<Reranked>) -> std::vec::Vec<f64> {
        let losses: std::vec::Vec<f64> = (1..=turns_deg.len()).map(|k| k as f64).collect();
        let poses = turns_deg.iter().zip(&losses);
        let poses = poses.map(|(&deg, &loss)| (placed([20.0, 30.0, deg], [0.0; 3]), loss));
        let kept = added_with(&poses.collect::<std::vec::Vec<_>>(), located);
        kept.into_iter().map(|number| turns_deg[number]).collect()
    }

    /// Which of refined poses, of which so much is left, became candidates, the best first.
    fn added_with(poses: &[(Pose, f64)], located: Option<Reranked>) -> std::vec::Vec<usize> {
        let (model, camera, right) = (crank(), camera(), placed([20.0, 30.0, 0.0], [0.0; 3]));
        let words = drawn(&model, &camera, &right);
        let mask = Mask::new(&words, SIDE, SIDE).expect("valid");
        let view = CameraView::only(&camera, Silhouette::from(&mask));
        let (mut buffers, model) = (RefineBuffers::default(), model.as_model());
        let mut memory = buffers.borrow(&model, &camera);
        let mut candidates = Vec::new();
        for (k, &(pose, loss)) in poses.iter().enumerate() {
            let found = RefinedRival {
                refined: Refined {
                    loss: 0.02 * loss,
                    renders: k,
                    ..Refined::at(pose)
                },
                ..RefinedRival::at(right, k, false)
            };
            let added = add_assessed(
                &model,
                &view,
                (&found, located),
                &mut memory,
                &mut candidates,
            );
            assert_eq!(added, Ok(()));
        }
        let refined = candidates.iter().filter_map(|one| one.refined);
        refined.map(|refined| refined.renders).collect()
    }

    /// Pieces of an outline are looked for after the whole, and may lead nearer to the right pose than that did.
    #[test]
    fn a_better_one_takes_the_place_of_a_candidate_that_came_before() {
        let at = |deg| placed([20.0, 30.0, deg], [0.0; 3]);
        let [one, better, other] = [(at(0.0), 3.0), (at(0.4), 1.0), (at(9.0), 2.0)];
        assert_eq!(added_with(&[one, other, better], None), [2, 1]);
        assert_eq!(added_with(&[better, other, one], None), [0, 1]);
    }

    #[test]
    fn a_pose_is_a_candidate_once_whether_the_library_or_the_frame_before_led_to_it() {
        let from = Some(located(0));
        assert_eq!(added(&[0.0, 0.3, 0.0, -0.3], from), [0.0]);
        assert_eq!(added(&[0.0, 0.9, 0.0, -0.9], from), [0.0, 0.9, -0.9]);
        assert_eq!(added(&[0.0, 0.9], None), [0.0, 0.9]);
    }
}
