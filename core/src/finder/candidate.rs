//! A pose that explains a frame, and how well.

use super::choice::{CONTENDERS, RivalPose};
use crate::locate::rerank::Reranked;
use crate::math::sqrt;
use crate::pose::Pose;
use crate::pose::covariance::PoseCovariance;
use crate::refine::{Fit, Refined};

/// Most candidates of a frame: as many as are compared.
pub const CANDIDATES: usize = CONTENDERS;

/// A pose that explains a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate {
    /// `camera_from_model`, as good as was asked for.
    pub pose: Pose,
    /// The pose that it was refined from: one of the library, the mirror image of a refined pose, or, on a grey frame, that
    /// of the outline. Of a pose that was not refined, itself.
    pub start: Pose,
    /// What the library said, where it led to the pose.
    pub located: Option<Reranked>,
    /// What refinement made of it, where it was asked for.
    pub refined: Option<Refined>,
    /// How sure the refined pose is.
    pub covariance: Option<PoseCovariance>,
    /// How well the model drawn there is met by what was seen.
    pub fit: Fit,
}

impl Candidate {
    /// By what candidates of a frame are compared: pixels that differ when the model is drawn, or, after refinement, the
    /// root of twice the robust loss in pixels. That is the root mean square of what remains between the outlines where it
    /// is small, and counts outline that has no counterpart.
    #[must_use]
    pub fn misfit(&self) -> f64 {
        let refined = self.refined.map(|refined| sqrt(2.0 * refined.loss));
        let located = || self.located.map(|located| located.unmatched as f64);
        refined.or_else(located).unwrap_or(f64::INFINITY)
    }

    /// The same in pixels of a frame that was looked at in squares with sides of so many of them
    /// ([`crate::film::FilmConstants::square_px`]).
    #[must_use]
    pub fn in_pixels(&self, side: usize) -> Self {
        Self {
            refined: self.refined.map(|refined| refined.in_pixels(side)),
            fit: self.fit.in_pixels(side),
            ..*self
        }
    }

    /// The candidate as it is compared with others.
    #[must_use]
    pub fn rival(&self) -> RivalPose {
        RivalPose {
            pose: self.pose,
            residual_px: self.misfit(),
        }
    }
}
