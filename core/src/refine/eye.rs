//! How far a target's outline lies from the model's, along the normals of its samples.

use super::border::{BorderPixel, NormalReading, Residual};
use super::drawn::DrawnEdges;
use super::edge;
use super::equations::Equations;
use super::probe::{self, OWN_RANGE};
use super::stages::Stage;
use super::step::Step;
use super::view::{CameraView, ImageTarget, Target};
use crate::image::display::QuickCurve;
use crate::image::mask::Mask;
use crate::math::Vector3;

/// A view and the model as drawn in it.
pub(super) struct Eye<'e> {
    pub(super) view: &'e CameraView<'e>,
    pub(super) drawn: Mask<'e>,
    pub(super) edges: DrawnEdges<'e>,
    /// Middle of the model in camera coordinates.
    pub(super) centre: Vector3,
    /// How far the target's edges lie beyond the model's outline, pixels.
    pub(super) offset: f64,
    pub(super) stage: &'e Stage,
}

impl Eye<'_> {
    /// Measures the residuals of samples and adds them to the equations.
    pub(super) fn measure(&self, border: &mut [BorderPixel], equations: &mut Equations) {
        match &self.view.target {
            Target::Silhouette(silhouette) => {
                let find =
                    |sample: &BorderPixel, _| probe::crossing(silhouette, sample, self.stage.range);
                self.measure_by(find, border, equations);
            }
            Target::Image(image) => self.measure_on(image, border, equations),
        }
    }

    /// On a frame; what no film is drawn for is read as it is displayed. By itself, because a ready curve takes up a part of
    /// the stack that silhouettes need not have.
    #[inline(never)]
    fn measure_on(
        &self,
        image: &ImageTarget<'_>,
        border: &mut [BorderPixel],
        equations: &mut Equations,
    ) {
        let curve = if self.stage.drawn {
            image.curve()
        } else {
            image.display()
        };
        let curve = QuickCurve::from(curve);
        let find = |sample: &BorderPixel, expected| {
            edge::edge(image, &curve, sample, expected, self.stage.range)
        };
        self.measure_by(find, border, equations);
    }

    /// `find` gives where the target's outline crosses the normal of a sample, or where the frame has an edge.
    fn measure_by(
        &self,
        find: impl Fn(&BorderPixel, f64) -> NormalReading,
        border: &mut [BorderPixel],
        equations: &mut Equations,
    ) {
        for (number, sample) in border.iter_mut().enumerate() {
            if !sample.is_on_surface() {
                continue;
            }
            let own = probe::crossing(&(&self.drawn).into(), sample, OWN_RANGE);
            let NormalReading::At(own) = own else {
                continue;
            };
            let NormalReading::At(own) = self.edges.at(number, own) else {
                continue;
            };
            let expected = own + self.offset;
            sample.residual = Residual::of(find(sample, expected), expected);
            if let Residual::Px(_) = sample.residual {
                sample.jacobian = self.jacobian(sample).map(|value| value as f32);
            }
            equations.add_sample(sample, self.stage);
        }
    }

    fn jacobian(&self, sample: &BorderPixel) -> [f64; 6] {
        let normal = sample.normal.map(f64::from);
        let (place, depth) = (sample.place(), sample.depth());
        let jacobian = Step::jacobian(self.view.camera, &self.centre, place, depth, normal);
        Step::in_world(jacobian, &self.view.placement)
    }
}
