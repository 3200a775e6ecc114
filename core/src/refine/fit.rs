//! How well the model's outline at a pose is met by what was seen.

use super::beyond::part_beyond;
use super::border::{BorderPixel, Residual};
use super::view::Target;
use crate::camera::Camera;
use crate::image::mask::{Mask, MaskError, Word, words_needed};
use crate::math::sqrt;
use crate::mesh::{Model, has_knee_size};
use crate::pose::Pose;

/// A sample of the model's outline is met where the target's outline is nearer to it than this, pixels: three standard
/// deviations of a hand that traces, whose jitter is 1 px.
pub const MET_WITHIN_PX: f64 = 3.0;

/// How well the model's outline at a pose is met by what was seen. Of several views, of all of them together.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Fit {
    /// Part of the model's outline within the frame, by length, of which the target says anything: the rest lies in unknown pixels.
    pub known: f64,
    /// Part of the model beyond the frame's border, by what its triangles cover as seen.
    pub beyond: f64,
    /// Part of what is known that the target's outline meets within [`MET_WITHIN_PX`].
    pub met: f64,
    /// Root mean square distance of what is met, pixels.
    pub residual_px: f64,
    /// Root mean square distance of all that is known, pixels; what has no counterpart at all counts as far as was looked,
    /// 10 px from a silhouette and 4 px in a grey frame.
    pub misfit_px: f64,
    /// Known pixels that are in the silhouette or in the drawing but not in both, for each pixel of known outline: the
    /// mean distance between the two outlines, whichever is longer, pixels. `None` of a grey frame.
    pub apart_px: Option<f64>,
    /// Square root of the area of the model as drawn, pixels: what is one pixel off tells more of a larger silhouette.
    pub size_px: f64,
    /// How far behind the detector the model's middle lies, mm, where the camera knows its detector: a part cannot be there, so that
    /// the calibration is of other frames or the model in another unit.
    pub behind_mm: f64,
    /// How wide the model is, mm, where that is no size of a knee's component, as of a file in another unit; 0 of others.
    pub implausible_width_mm: f64,
    /// Side of the squares of pixels in which the frame was looked at, whose lengths are handed out in pixels ([`Self::in_pixels`]): what
    /// is asked of a good fit is asked in those. Else 1, or 0.
    pub square_px: usize,
}

impl Fit {
    /// Part of the whole outline, about, of which the target says anything.
    #[must_use]
    pub fn seen(&self) -> f64 {
        self.known * (1.0 - self.beyond)
    }

    /// The same in pixels of a frame that was looked at in squares with sides of so many of them
    /// ([`crate::film::FilmConstants::square_px`]).
    #[must_use]
    pub fn in_pixels(&self, side: usize) -> Self {
        Self {
            square_px: side,
            ..self.scaled(side.max(1) as f64)
        }
    }

    /// All lengths in the frame so many times as long.
    pub(crate) fn scaled(&self, times: f64) -> Self {
        Self {
            residual_px: times * self.residual_px,
            misfit_px: times * self.misfit_px,
            apart_px: self.apart_px.map(|apart| times * apart),
            size_px: times * self.size_px,
            ..*self
        }
    }
}

/// Sums over samples and views.
#[derive(Default)]
pub(super) struct FitSums {
    length: f64,
    known: f64,
    met: f64,
    met_squares: f64,
    squares: f64,
    /// Pixels that differ; `None` once a view is a grey frame.
    unmatched: Unmatched,
    area: f64,
    beyond: f64,
    views: f64,
    behind_mm: f64,
    implausible_width_mm: f64,
}

#[derive(Clone, Copy)]
enum Unmatched {
    Pixels(f64),
    Unseen,
}

impl Default for Unmatched {
    fn default() -> Self {
        Self::Pixels(0.0)
    }
}

impl FitSums {
    pub(super) fn add_samples(&mut self, border: &[BorderPixel], range: f64) {
        for sample in border {
            let length = f64::from(sample.weight);
            match sample.residual() {
                Residual::None => {}
                Residual::Unknown => self.length += length,
                Residual::Missing => self.add(length, range),
                Residual::Px(residual) => self.add(length, f64::from(residual).abs().min(range)),
            }
        }
    }

    fn add(&mut self, length: f64, distance: f64) {
        self.length += length;
        self.known += length;
        let square = length * distance * distance;
        self.squares += square;
        if distance < MET_WITHIN_PX {
            self.met += length;
            self.met_squares += square;
        }
    }

    /// `pose` is that of the model in the camera's frame.
    pub(super) fn add_place(&mut self, model: &Model<'_>, camera: &Camera, pose: &Pose) {
        let bounds = model.bounds();
        if !has_knee_size(&bounds) {
            self.implausible_width_mm = 2.0 * bounds.radius;
        }
        let middle = pose.transform(&bounds.centre);
        self.behind_mm = self.behind_mm.max(camera.behind_detector(-middle[2]));
        self.beyond += part_beyond(model, camera, pose);
    }

    /// `drawn` is the model as drawn in that view.
    pub(super) fn add_areas(
        &mut self,
        target: &Target<'_>,
        drawn: &[Word],
    ) -> Result<(), MaskError> {
        let (width, height) = target.size();
        let words = drawn.get(..words_needed(width, height));
        let drawn = Mask::new(words.unwrap_or_default(), width, height)?;
        self.area += drawn.area() as f64;
        self.views += 1.0;
        let unmatched = match target {
            Target::Silhouette(silhouette) => silhouette.unmatched(&drawn),
            Target::Image(_) => None,
        };
        self.unmatched = match (self.unmatched, unmatched) {
            (Unmatched::Pixels(sum), Some(pixels)) => Unmatched::Pixels(sum + pixels as f64),
            _ => Unmatched::Unseen,
        };
        Ok(())
    }

    pub(super) fn fit(&self) -> Fit {
        let part = |of: f64, all: f64| if all > 0.0 { of / all } else { 0.0 };
        Fit {
            known: part(self.known, self.length),
            beyond: part(self.beyond, self.views),
            met: part(self.met, self.known),
            residual_px: sqrt(part(self.met_squares, self.met)),
            misfit_px: sqrt(part(self.squares, self.known)),
            apart_px: match self.unmatched {
                Unmatched::Pixels(pixels) if self.known > 0.0 => Some(pixels / self.known),
                _ => None,
            },
            size_px: sqrt(part(self.area, self.views)),
            behind_mm: self.behind_mm,
            implausible_width_mm: self.implausible_width_mm,
            square_px: 1,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_lies_beyond_the_border_is_not_seen() {
        let fit = Fit {
            known: 0.6,
            beyond: 0.5,
            ..Fit::default()
        };
        assert_eq!(fit.seen(), 0.3);
    }
}
