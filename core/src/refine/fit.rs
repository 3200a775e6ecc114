//! How well the model's outline at a pose is met by what was seen.

use super::beyond::Frame;
use super::border::{BorderPixel, Residual};
use super::view::{CameraView, Target};
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
    /// Part of the model beyond the frame's border, by the cells of a grid in the box about it in which it has vertices.
    pub beyond: f64,
    /// Part of what is known that the target's outline meets within [`MET_WITHIN_PX`].
    pub met: f64,
    /// Root mean square distance of what is met, pixels.
    pub residual_px: f64,
    /// Root mean square distance of all that is known, pixels; what has no counterpart at all counts as far as was looked,
    /// 10 px from a silhouette and 4 px in a grey frame.
    pub misfit_px: f64,
    /// Known pixels that are in the silhouette or in the drawing but not in both, for each pixel of known outline: the
    /// mean distance between the two outlines, whichever is longer, pixels, less what all of the silhouette's outline is known to lie off. `None` of
    /// a grey frame.
    pub apart_px: Option<f64>,
    /// Square root of the area of the model as drawn, pixels: what is one pixel off tells more of a larger silhouette.
    pub size_px: f64,
    /// How far behind the detector the model's middle lies, mm, where the camera knows its detector: a part cannot be there, so that
    /// the calibration is of other frames or the model in another unit.
    pub behind_mm: f64,
    /// How far the model's middle lies from the focus along the view, mm; 0 of several views, where it is not one number.
    pub depth_mm: f64,
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
    /// How far silhouettes are known to lie off everywhere alike, pixels.
    off: f64,
    beyond: f64,
    views: f64,
    behind_mm: f64,
    depth_mm: f64,
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
    pub(super) fn add_place(&mut self, model: &Model<'_>, view: &CameraView<'_>, pose: &Pose) {
        let (camera, beyond) = (view.camera, view.target.beyond());
        let bounds = model.bounds();
        if !has_knee_size(&bounds) {
            self.implausible_width_mm = 2.0 * bounds.radius;
        }
        let middle = pose.transform(&bounds.centre);
        self.behind_mm = self.behind_mm.max(camera.behind_detector(-middle[2]));
        self.depth_mm = -middle[2];
        self.beyond += Frame { camera, beyond }.part_beyond(model, pose);
    }

    /// `drawn` is the model as drawn in that view, of whose outline all of the target's is known to lie `offset_px` off.
    pub(super) fn add_areas(
        &mut self,
        target: &Target<'_>,
        offset_px: f64,
        drawn: &[Word],
    ) -> Result<(), MaskError> {
        let (width, height) = target.size();
        let words = drawn.get(..words_needed(width, height));
        let drawn = Mask::new(words.unwrap_or_default(), width, height)?;
        self.area += drawn.area() as f64;
        self.off += offset_px.abs();
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
                Unmatched::Pixels(pixels) if self.known > 0.0 => {
                    Some((pixels / self.known - part(self.off, self.views)).max(0.0))
                }
                _ => None,
            },
            size_px: sqrt(part(self.area, self.views)),
            behind_mm: self.behind_mm,
            depth_mm: if self.views == 1.0 {
                self.depth_mm
            } else {
                0.0
            },
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

    /// Of a long rod, whose cells reach farther beyond it than the part of the frame that holds it.
    #[cfg(feature = "alloc")]
    #[test]
    fn in_a_part_of_the_frame_a_model_fits_as_in_all_of_it() {
        use crate::camera::Camera;
        use crate::image::crop::Crop;
        use crate::image::mask::MaskMut;
        use crate::image::silhouette::Silhouette;
        use crate::mesh::edges::fake::add_box;
        use crate::refine::{RefineBuffers, fit_at};
        use core::ops::Range;
        use std::vec;
        use std::vec::Vec;
        let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
        let (low, high) = ([-100.0, -3.0, -3.0], [100.0, 3.0, 3.0]);
        add_box(low, high, &mut vertices, &mut triangles);
        let model = Model::from_triangles(&vertices, &triangles).expect("valid");
        let (width, height) = (1400, 500);
        let camera = Camera::new(width, height, [6000.0; 2], [700.0, 250.0]).expect("valid");
        let pose = Pose {
            translation: [0.0, 0.0, -1000.0],
            ..Pose::IDENTITY
        };
        let at =
            |camera: &Camera, columns: Range<usize>, rows: Range<usize>, crop: Option<Crop>| {
                let size = (camera.width(), camera.height());
                let mut words = vec![0; words_needed(size.0, size.1)];
                let mut mask = MaskMut::new(&mut words, size.0, size.1).expect("fits");
                let ends = [columns.start as i64, columns.end as i64];
                rows.for_each(|row| mask.fill_span(row, ends[0], ends[1]));
                let mask = mask.into_mask();
                let mut silhouette = Silhouette::from(&mask);
                if let Some(crop) = crop {
                    silhouette = silhouette.in_crop(&crop).expect("inside");
                }
                let mut buffers = RefineBuffers::default();
                let mut memory = buffers.borrow(&model, camera);
                let view = CameraView::only(camera, silhouette);
                fit_at(&model, &[view], &pose, &mut memory).expect("in front")
            };
        let (columns, rows) = (98..1302, 232..268);
        let whole = at(&camera, columns.clone(), rows.clone(), None);
        assert!(whole.met > 0.99 && whole.beyond == 0.0, "{whole:?}");
        let crop = Crop::around(columns, rows, Crop::MARGIN, [width, height]).expect("possible");
        let part = camera.cropped(&crop).expect("possible");
        let (left, above) = (crop.columns().start, crop.rows().start);
        let inside = (98 - left..1302 - left, 232 - above..268 - above);
        assert_eq!(at(&part, inside.0, inside.1, Some(crop)), whole);
    }

    /// A mask two pixels too large all along is as near to the model as one that is exact, once that is known.
    #[cfg(feature = "alloc")]
    #[test]
    fn what_a_silhouette_is_known_to_lie_off_everywhere_sets_no_outlines_apart() {
        use crate::camera::Camera;
        use crate::image::mask::MaskMut;
        use crate::image::silhouette::{CommonOffset, Silhouette};
        use crate::mesh::edges::fake::add_box;
        use crate::refine::{RefineBuffers, Refined, assess};
        use std::vec;
        use std::vec::Vec;
        let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
        let (low, high) = ([-30.0, -20.0, -1.0], [30.0, 20.0, 1.0]);
        add_box(low, high, &mut vertices, &mut triangles);
        let model = Model::from_triangles(&vertices, &triangles).expect("valid");
        let camera = Camera::new(400, 300, [3000.0; 2], [200.0, 150.0]).expect("valid");
        let pose = Pose {
            translation: [0.0, 0.0, -1001.0],
            ..Pose::IDENTITY
        };
        let apart = |wider: i64, offset_px: f64, common: f64| {
            let mut words = vec![0; words_needed(400, 300)];
            let mut mask = MaskMut::new(&mut words, 400, 300).expect("fits");
            let (rows, ends) = (90 - wider..210 + wider, [110 - wider, 290 + wider]);
            rows.for_each(|row| mask.fill_span(row as usize, ends[0], ends[1]));
            let mask = mask.into_mask();
            let common = CommonOffset {
                px: common,
                ..CommonOffset::OF_MASKS
            };
            let silhouette = Silhouette::from(&mask).lying_off(common);
            let refined = Refined {
                offset_px,
                ..Refined::at(pose)
            };
            let mut buffers = RefineBuffers::default();
            let mut memory = buffers.borrow(&model, &camera);
            let view = CameraView::only(&camera, silhouette);
            let seen = assess(&model, &[view], &refined, &mut memory).expect("in front");
            seen.fit.apart_px.expect("of a mask")
        };
        let exact = apart(0, 0.0, 0.0);
        assert!(exact < 0.6, "{exact}");
        assert!(apart(2, 0.0, 0.0) > 1.5);
        for (offset_px, common) in [(2.0, 0.0), (0.0, 2.0), (-1.0, 3.0)] {
            let left = apart(2, offset_px, common);
            assert!(left < 0.6, "{left}");
        }
    }
}
