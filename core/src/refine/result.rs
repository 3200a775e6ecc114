//! What refinement gives: a pose, and the poses on the way to it.

use crate::pose::Pose;

/// A refined pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refined {
    /// `world_from_model`; of a single camera, `camera_from_model`.
    pub pose: Pose,
    /// Distance of the target's edges beyond the model's outline that was estimated with the
    /// pose, pixels; zero where it was not asked for or the data do not support it.
    pub offset_px: f64,
    /// Root mean square distance that remains between the outlines, pixels, weighted by arc length and by the robust
    /// loss.
    pub residual_px: f64,
    /// Robust standard deviation of the residuals, pixels: from their median absolute value as if they were normal, so
    /// that outliers do not count.
    pub robust_sigma_px: f64,
    /// Robust loss by which rival poses are compared, square pixels.
    pub loss: f64,
    /// Times the model was drawn.
    pub renders: usize,
    /// Whether the last step was below 0.001 degrees or 0.005 mm, or both together; on a grey frame,
    /// a fiftieth of that; with [`super::Effort::Interactive`], twenty times as much. Of a pose that its film corrected: whether
    /// the last step was small against what noise leaves open.
    pub converged: bool,
}

impl Refined {
    /// A pose before refinement, or one that was refined on a frame of which nothing but the pose was kept.
    #[must_use]
    pub fn at(pose: Pose) -> Self {
        Self {
            pose,
            offset_px: 0.0,
            residual_px: 0.0,
            robust_sigma_px: 0.0,
            loss: 0.0,
            renders: 0,
            converged: false,
        }
    }

    /// The same in pixels of a frame that was looked at in squares with sides of so many of them
    /// ([`crate::film::FilmConstants::square_px`]).
    #[must_use]
    pub fn in_pixels(&self, side: usize) -> Self {
        let side = side.max(1) as f64;
        Self {
            offset_px: side * self.offset_px,
            residual_px: side * self.residual_px,
            robust_sigma_px: side * self.robust_sigma_px,
            loss: side * side * self.loss,
            ..*self
        }
    }
}

/// A pose on the way, from which a caller can see how refinement converges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iterate {
    /// Stage, from 0; the range and the scale of the loss shrink from one to the next.
    pub stage: usize,
    /// Times the model was drawn so far.
    pub renders: usize,
    /// The pose.
    pub pose: Pose,
    /// Its robust loss in this stage, square pixels: stages differ in scale.
    pub loss: f64,
    /// Its residual, pixels.
    pub residual_px: f64,
}
