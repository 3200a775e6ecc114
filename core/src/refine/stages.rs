//! From coarse to fine: how far the target's outline is searched for and at which scale the loss flattens.

use super::loss::Loss;
use super::memory::FILM_EVERY;
use super::view::Target;
use crate::math::within;

/// Number of stages of any target.
pub(super) const STAGES: usize = 4;

/// One stage of refinement.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stage {
    /// Largest distance between the outlines, pixels.
    pub(super) range: f64,
    pub(super) loss: Loss,
    /// Whether edges are compared with those that the film's model puts on the drawing.
    pub(super) drawn: bool,
    /// Which border pixels are looked at, where not all are.
    pub(super) turn: usize,
    /// Whether its steps are undamped ones of a correction.
    pub(super) corrects: bool,
    /// One of how many is, where the target says it.
    pub(super) every: Option<usize>,
}

/// Undamped steps after the last stage at most.
pub(super) const POLISHING: usize = 32;

/// One of this many border pixels is looked at against a film before it corrects the pose, and when it does.
const FILM_ROUGHLY: usize = 2 * FILM_EVERY;
pub(super) const FILM_PARTS: usize = 3;

/// Cauchy's loss is 95 % as efficient as least squares on normal noise when its scale is this
/// many standard deviations (Holland and Welsch, Commun. Stat. A 6, 1977).
const EFFICIENT: f64 = 2.385;
/// Least and greatest scale of the last stage's loss, pixels.
const SCALE: [f64; 2] = [1.0, 4.0];

impl Stage {
    /// The stage number `index` for a target; `sigma_px` is the robust standard deviation of the
    /// residuals of the stage before, pixels.
    pub(super) fn of(target: &Target<'_>, index: usize, sigma_px: f64) -> Self {
        let stage = |range, loss| Self {
            range,
            loss,
            drawn: false,
            turn: 0,
            corrects: false,
            every: None,
        };
        match (target, index) {
            (Target::Silhouette(_), 0) => stage(48.0, Loss::Cauchy(8.0)),
            (Target::Silhouette(_), 1) => stage(16.0, Loss::Cauchy(2.5)),
            (Target::Silhouette(_), 2) => stage(10.0, Loss::Cauchy(1.0)),
            (Target::Silhouette(_), _) => {
                let scale = within(EFFICIENT * sigma_px, SCALE[0], SCALE[1]);
                stage(10.0, Loss::Cauchy(scale as f32))
            }
            (Target::Image(_), 0) => stage(10.0, Loss::Tukey(8.0)),
            (Target::Image(_), 1) => stage(7.0, Loss::Tukey(4.0)),
            (Target::Image(_), 2) => stage(5.0, Loss::Tukey(2.5)),
            (Target::Image(_), _) => stage(4.0, Loss::Tukey(2.5)),
        }
    }
}

/// One stage as it applies to all views.
#[derive(Clone, Copy, Default)]
pub(super) struct Pass {
    pub(super) index: usize,
    /// Robust standard deviation of the residuals before, pixels.
    pub(super) sigma_px: f64,
    /// Whether the offset is estimated.
    pub(super) free: bool,
    /// Whether edges are compared with those that the film's model puts on the drawing, where there is one.
    pub(super) drawn: bool,
    /// Which border pixels are looked at, where not all are.
    pub(super) turn: usize,
    /// Whether a part of them corrects the pose by a film, and other parts do after it.
    pub(super) corrects: bool,
}

impl Pass {
    /// How a target is looked at.
    pub(super) fn stage(&self, target: &Target<'_>) -> Stage {
        let drawn = self.drawn && target.film().is_some();
        let every = match self.index + 1 < STAGES {
            true => FILM_ROUGHLY,
            false if self.corrects => FILM_PARTS,
            false => FILM_EVERY,
        };
        Stage {
            drawn,
            turn: self.turn,
            corrects: self.corrects,
            every: drawn.then_some(every),
            ..Stage::of(target, self.index, self.sigma_px)
        }
    }
}
