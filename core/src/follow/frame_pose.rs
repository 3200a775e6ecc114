//! A pose in a frame, with what the frame says of it.

use super::contrast::{Contrast, contrast};
use super::subject::Subject;
use crate::math::sqrt;
use crate::pose::Pose;
use crate::pose::covariance::PoseCovariance;
use crate::refine::{
    CameraView, Effort, Ended, Fit, ImageTarget, RefineError, RefineMemory, RefineOptions, Refined,
    Unless, assess, correct_unless, fit_at, refine,
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
    /// What remains between outline and edges: the root of twice the robust loss, pixels; of a pose as a person gave it, the root mean square
    /// distance ([`Fit::misfit_px`]), which is another measure.
    pub misfit_px: f64,
    /// How much darker it is inside than outside.
    pub contrast: Contrast,
}

/// Loss of an outline without any edge near it, square pixels: of the last stage on a frame, Tukey's with 2.5 px.
const WORST_PX2: f64 = 2.5 * 2.5 / 6.0;

impl FramePose {
    /// The same where frames are read in squares with sides of so many pixels.
    pub(super) fn in_squares(&self, side: usize) -> Self {
        self.scaled(1.0 / side.max(1) as f64)
    }

    /// The same in pixels of the frames, where these are followed in squares with sides of so many of them.
    #[must_use]
    pub fn in_pixels(&self, side: usize) -> Self {
        self.scaled(side.max(1) as f64)
    }

    fn scaled(&self, times: f64) -> Self {
        Self {
            // What is asked of films is asked of theirs as they are followed.
            fit: self.fit.scaled(times),
            misfit_px: times * self.misfit_px,
            ..*self
        }
    }

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
pub(super) fn loss_of(misfit_px: f64) -> f64 {
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
    let (refined, _) = refined_unless(Unless::NOTHING, subject, image, start, memory)?;
    seen(subject, image, &refined, memory)
}

/// Where refinement comes from a start, and how it ended: where the film is known, it may be given up on the way.
///
/// # Errors
/// Those of [`refine`].
pub(super) fn refined_unless(
    unless: Unless<'_>,
    subject: &Subject<'_>,
    image: &ImageTarget<'_>,
    (start, from): (&Pose, From),
    memory: &mut RefineMemory<'_>,
) -> Result<(Refined, Ended), RefineError> {
    let views = [CameraView::only(subject.camera, *image)];
    let (model, options) = (subject.model, subject.options);
    if image.film.is_none() {
        let refined = refine(model, &views, start, options, memory)?;
        return Ok((refined, Ended::Itself));
    }
    let near = match from {
        From::Near => *start,
        From::Far => probed(subject, image, start, memory)?.pose,
    };
    let begun = Refined::at(near);
    correct_unless(unless, model, &views, &begun, options, memory)
}

/// A refined pose, with what the frame says of it.
///
/// # Errors
/// [`RefineError`] where the model cannot be drawn at the pose.
pub(super) fn seen(
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
