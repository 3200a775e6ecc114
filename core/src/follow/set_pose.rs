//! A pose that somebody set, brought onto a frame: from there, and from around there where that leads to none that is good.

use super::contrast::usual_step;
use super::look::{REACH_PX, REFINED};
use super::near::near_poses;
use super::subject::Subject;
use crate::finder::{Limits, Verdict, judge_fit};
use crate::pose::Pose;
use crate::refine::{
    CameraView, Fit, ImageTarget, RefineError, RefineMemory, Refined, fit_at, refine,
};

/// Refines from a pose that somebody set. Where that is not good by itself, places around are refined from as well, and the pose is taken that
/// leaves least between outline and edges. What is locked stays, and then nothing else is looked at.
///
/// # Errors
/// [`RefineError`] where no pose can be refined, that of the pose itself.
pub fn refined_around(
    subject: &Subject<'_>,
    image: &ImageTarget<'_>,
    start: &Pose,
    memory: &mut RefineMemory<'_>,
) -> Result<Refined, RefineError> {
    let own = refined_with_fit(subject, image, start, memory);
    let is_good = |(_, fit): &(Refined, Fit)| judge_fit(fit, true, &Limits::USUAL) == Verdict::Good;
    if !subject.options.locks.is_empty() || own.as_ref().is_ok_and(is_good) {
        return own.map(|(refined, _)| refined);
    }
    let step = usual_step(image.frame);
    let near = near_poses(subject, image, start, REACH_PX, step, memory).unwrap_or_default();
    let mut best = own;
    for (_, pose) in near.iter().take(REFINED) {
        let Ok(found) = refined_with_fit(subject, image, pose, memory) else {
            continue;
        };
        if !matches!(&best, Ok((_, fit)) if fit.misfit_px <= found.1.misfit_px) {
            best = Ok(found);
        }
    }
    best.map(|(refined, _)| refined)
}

fn refined_with_fit(
    subject: &Subject<'_>,
    image: &ImageTarget<'_>,
    start: &Pose,
    memory: &mut RefineMemory<'_>,
) -> Result<(Refined, Fit), RefineError> {
    let (model, views) = (subject.model, [CameraView::only(subject.camera, *image)]);
    let refined = refine(model, &views, start, subject.options, memory)?;
    let fit = fit_at(model, &views, &refined.pose, memory)?;
    Ok((refined, fit))
}

#[cfg(all(test, feature = "alloc"))]
mod tests {
    use super::*;
    use crate::finder::fake::{SIDE, camera, crank, grey, placed};
    use crate::image::frame::Frame;
    use crate::math::{norm, subtract};
    use crate::pose::geodesic_deg;
    use crate::refine::{Locks, RefineBuffers, RefineOptions};

    /// How far from the truth the crank comes to lie that somebody set `by` (mm) off, degrees and mm; and where it was set.
    fn off(by: [f64; 2], turn_deg: f64, locks: Locks) -> ([f64; 2], Pose, Pose) {
        let (model, camera) = (crank(), camera());
        let truth = placed([15.0, -20.0, 8.0], [4.0, 3.0, 0.0]);
        let pixels = grey(&model, &camera, &truth);
        let frame = Frame::new(&pixels, SIDE, SIDE, SIDE).expect("valid");
        let image = ImageTarget::dark(&frame);
        let (mut buffers, model) = (RefineBuffers::default(), model.as_model());
        let options = RefineOptions {
            locks,
            ..RefineOptions::default()
        };
        let subject = Subject {
            options,
            ..Subject::new(&model, &[], &camera)
        };
        let mut memory = buffers.borrow(&model, &camera);
        let start = placed(
            [15.0, -20.0, 8.0 + turn_deg],
            [4.0 + by[0], 3.0 + by[1], 0.0],
        );
        let found = refined_around(&subject, &image, &start, &mut memory).expect("in front");
        let middle = model.bounds().centre;
        let apart = subtract(&found.pose.transform(&middle), &truth.transform(&middle));
        let aside = norm(&[apart[0], apart[1], 0.0]);
        let deg = geodesic_deg(&found.pose.rotation, &truth.rotation);
        ([deg, aside], start, found.pose)
    }

    #[test]
    fn a_part_that_was_let_go_of_beside_its_edges_comes_back() {
        // From the last two refinement alone ends 23 degrees off, or nowhere.
        for by in [[2.0, 0.0], [-14.0, 2.0], [3.0, 13.0], [-18.0, 12.0]] {
            let ([deg, mm], ..) = off(by, 3.0, Locks::default());
            assert!(deg < 1.0 && mm < 0.05, "{by:?}: {deg} degrees, {mm} mm");
        }
    }

    #[test]
    fn what_is_locked_stays() {
        let locks = Locks {
            translation: [true, false, true],
            ..Locks::default()
        };
        let (_, start, found) = off([9.0, 0.0], 0.0, locks);
        assert_eq!(found.translation[0], start.translation[0]);
        assert_eq!(found.translation[2], start.translation[2]);
    }
}
