//! A pose in a frame, with what the frame says of it.

use super::contrast::{Contrast, contrast};
use super::subject::Subject;
use super::valley::along_valley;
use crate::math::sqrt;
use crate::mesh::mirror::mirror_pose;
use crate::pose::covariance::PoseCovariance;
use crate::pose::{Pose, geodesic_deg};
use crate::refine::{
    CameraView, Effort, Fit, ImageTarget, RefineError, RefineMemory, RefineOptions, Refined,
    assess, correct_unless, fit_at, refine,
};

/// A pose in a frame, with what the frame says of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FramePose {
    /// `camera_from_model`.
    pub pose: Pose,
    /// How sure the pose is; `None` where the outline does not determine it, or a person gave it.
    pub covariance: Option<PoseCovariance>,
    /// What of the covariance is the film's ([`crate::refine::Assessment::film_steps`]).
    pub film_steps: [[f64; 6]; 2],
    /// How well the model's outline is met by edges.
    pub fit: Fit,
    /// What remains between outline and edges: the root of twice the robust loss, pixels.
    pub misfit_px: f64,
    /// How much darker it is inside than outside.
    pub contrast: Contrast,
}

/// Loss of an outline without any edge near it, square pixels: of the last stage on a frame, Tukey's with 2.5 px.
const WORST_PX2: f64 = 2.5 * 2.5 / 6.0;

/// Mirror images nearer to their pose than this are the same pose, degrees.
const SAME_DEG: f64 = 1.0;

impl FramePose {
    /// The pose with its covariance.
    pub(super) fn known(&self) -> (&Pose, Option<&PoseCovariance>) {
        (&self.pose, self.covariance.as_ref())
    }

    /// By what poses of a frame are compared, the greatest first: strength of the edges, multiplied by how near they lie.
    #[must_use]
    pub fn score(&self) -> f64 {
        let loss = loss_of(self.misfit_px);
        self.contrast.strength * (1.0 - (loss / WORST_PX2).clamp(0.0, 1.0))
    }
}

/// The robust loss of a misfit, square pixels: half of its square.
fn loss_of(misfit_px: f64) -> f64 {
    misfit_px * misfit_px / 2.0
}

/// From how far refinement comes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum From {
    /// Within some pixels: the edges that the film's model puts on the drawing are looked for at once, where it is known. On
    /// the way over edges as they seem to be, a faint component may be caught by others.
    Near,
    /// From where refinement has to find the way.
    Far,
}

/// The pose that refinement on the frame makes of a start.
///
/// # Errors
/// Those of [`refine`].
pub fn refined_on_frame(
    subject: &Subject<'_>,
    image: &ImageTarget<'_>,
    (start, from): (&Pose, From),
    memory: &mut RefineMemory<'_>,
) -> Result<FramePose, RefineError> {
    let start = (start, from);
    let refined = refined_unless(f64::INFINITY, subject, image, start, memory)?;
    seen(subject, image, &refined, memory)
}

/// The same where no more than `most_px` remain between outline and edges; `None` also where nothing is found. Where the film is known,
/// what will leave more is given up on the way.
#[must_use]
pub fn refined_within(
    most_px: f64,
    subject: &Subject<'_>,
    image: &ImageTarget<'_>,
    start: (&Pose, From),
    memory: &mut RefineMemory<'_>,
) -> Option<FramePose> {
    let hopeless = loss_of(most_px);
    let refined = refined_unless(hopeless, subject, image, start, memory).ok()?;
    if refined.loss > hopeless {
        return None;
    }
    seen(subject, image, &refined, memory).ok()
}

fn refined_unless(
    hopeless: f64,
    subject: &Subject<'_>,
    image: &ImageTarget<'_>,
    (start, from): (&Pose, From),
    memory: &mut RefineMemory<'_>,
) -> Result<Refined, RefineError> {
    let views = [CameraView::only(subject.camera, *image)];
    let (model, options) = (subject.model, subject.options);
    if image.film.is_none() {
        return refine(model, &views, start, options, memory);
    }
    let near = match from {
        From::Near => *start,
        From::Far => probed(subject, image, start, memory)?.pose,
    };
    let begun = Refined::at(near);
    correct_unless(hopeless, model, &views, &begun, options, memory)
}

/// A refined pose, with what the frame says of it.
fn seen(
    subject: &Subject<'_>,
    image: &ImageTarget<'_>,
    refined: &Refined,
    memory: &mut RefineMemory<'_>,
) -> Result<FramePose, RefineError> {
    let views = [CameraView::only(subject.camera, *image)];
    let assessment = assess(subject.model, &views, refined, memory)?;
    Ok(FramePose {
        pose: refined.pose,
        covariance: assessment.covariance,
        film_steps: assessment.film_steps,
        fit: assessment.fit,
        misfit_px: sqrt(2.0 * refined.loss),
        contrast: contrast(subject, image, &refined.pose, memory)?,
    })
}

/// Where refinement comes from a start on the first look, over edges as they seem to be, with what remains there.
///
/// # Errors
/// Those of [`refine`].
pub(super) fn probed(
    subject: &Subject<'_>,
    image: &ImageTarget<'_>,
    start: &Pose,
    memory: &mut RefineMemory<'_>,
) -> Result<Refined, RefineError> {
    let views = [CameraView::only(subject.camera, *image)];
    let probe = RefineOptions {
        effort: Effort::Probe,
        ..subject.options
    };
    refine(subject.model, &views, start, probe, memory)
}

/// What the frame says of a pose as it is, such as one that a person gave.
///
/// # Errors
/// [`RefineError`] where the model cannot be drawn at the pose.
pub fn frame_pose_at(
    subject: &Subject<'_>,
    image: &ImageTarget<'_>,
    pose: &Pose,
    memory: &mut RefineMemory<'_>,
) -> Result<FramePose, RefineError> {
    let views = [CameraView::only(subject.camera, *image)];
    let fit = fit_at(subject.model, &views, pose, memory)?;
    Ok(FramePose {
        pose: *pose,
        covariance: None,
        film_steps: [[0.0; 6]; 2],
        fit,
        misfit_px: fit.misfit_px,
        contrast: contrast(subject, image, pose, memory)?,
    })
}

/// The best of the poses that the mirror images of a pose lead to; `None` where they lead back to it or nowhere.
#[must_use]
pub fn mirrored_pose(
    subject: &Subject<'_>,
    image: &ImageTarget<'_>,
    own: &FramePose,
    memory: &mut RefineMemory<'_>,
) -> Option<FramePose> {
    let mut best: Option<FramePose> = None;
    for plane in subject.planes {
        let start = mirror_pose(&own.pose, plane);
        let found = refined_on_frame(subject, image, (&start, From::Far), memory);
        let Ok(found) = found else { continue };
        let apart = geodesic_deg(&found.pose.rotation, &own.pose.rotation) > SAME_DEG;
        if apart && best.is_none_or(|best| found.score() > best.score()) {
            best = Some(found);
        }
    }
    best.map(|best| least_along_valley(subject, image, (&best, own), memory))
}

/// The pose that leaves least of one and of what starts along what the frame tells least of lead to, but for those that lead to `other`.
fn least_along_valley(
    subject: &Subject<'_>,
    image: &ImageTarget<'_>,
    (one, other): (&FramePose, &FramePose),
    memory: &mut RefineMemory<'_>,
) -> FramePose {
    let mut least = *one;
    for start in along_valley(one.known(), &subject.model.bounds().centre) {
        let start = (&start, From::Near);
        let found = refined_within(least.misfit_px, subject, image, start, memory);
        let off = |found: &FramePose| geodesic_deg(&found.pose.rotation, &other.pose.rotation);
        if let Some(found) = found.filter(|found| off(found) > SAME_DEG) {
            least = found;
        }
    }
    least
}
