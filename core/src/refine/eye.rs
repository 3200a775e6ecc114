//! How far a target's outline lies from the model's, along the normals of its samples.

use super::border::{BorderPixel, NormalReading, Residual};
use super::drawn::DrawnEdges;
use super::edge;
use super::probe::{self, OWN_STEPS};
use super::stages::Stage;
use super::view::{CameraView, ImageTarget, Target};
use crate::image::display::QuickCurve;
use crate::image::mask::Mask;
use crate::image::silhouette::Silhouette;

/// A view and the model as drawn in it.
pub(super) struct Eye<'e> {
    pub(super) view: &'e CameraView<'e>,
    pub(super) drawn: Mask<'e>,
    pub(super) edges: DrawnEdges<'e>,
    /// How far the target's edges lie beyond the model's outline, pixels.
    pub(super) offset: f64,
    pub(super) stage: &'e Stage,
}

impl Eye<'_> {
    /// Measures the residuals of samples.
    pub(super) fn measure(&self, border: &mut [BorderPixel]) {
        match &self.view.target {
            Target::Silhouette(silhouette) => self.measure_against(silhouette, border),
            Target::Image(image) => self.measure_on(image, border),
        }
    }

    /// Against another silhouette, which is read as the drawing itself is.
    fn measure_against(&self, silhouette: &Silhouette<'_>, border: &mut [BorderPixel]) {
        let drawn = (&self.drawn).into();
        let offset = self.offset as f32;
        let steps = probe::steps_within(self.stage.range);
        for sample in border.iter_mut().filter(|sample| sample.is_on_surface()) {
            let normal = sample.normal();
            if let Residual::Px(own) = probe::crossing_along(&drawn, sample, normal, OWN_STEPS) {
                let found = probe::crossing_along(silhouette, sample, normal, steps);
                sample.set_residual(found.beyond(own + offset));
            }
        }
    }

    /// On a frame; what no film is drawn for is read as it is displayed. By itself, because a ready curve takes up a part of
    /// the stack that silhouettes need not have.
    #[inline(never)]
    fn measure_on(&self, image: &ImageTarget<'_>, border: &mut [BorderPixel]) {
        let curve = if self.stage.drawn {
            image.curve()
        } else {
            image.display()
        };
        let curve = QuickCurve::from(curve);
        let drawn = (&self.drawn).into();
        for (number, sample) in border.iter_mut().enumerate() {
            if !sample.is_on_surface() {
                continue;
            }
            let Residual::Px(own) = probe::crossing(&drawn, sample, OWN_STEPS) else {
                continue;
            };
            let NormalReading::At(own) = self.edges.at(number, f64::from(own)) else {
                continue;
            };
            let expected = own + self.offset;
            let found = edge::edge(image, &curve, sample, expected, self.stage.range);
            sample.set_residual(Residual::of(found, expected));
        }
    }
}
