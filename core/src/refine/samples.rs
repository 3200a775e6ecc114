//! The occluding contour as samples: what bounds and tests need of it.

use super::border::Residual;
use super::drawing::{Drawing, draw};
use super::error::RefineError;
use super::memory::{RefineMemory, check_memory};
use super::motion::Motion;
use super::outline::Sampling;
use super::probe::{self, OWN_STEPS};
use crate::camera::Camera;
use crate::mesh::Model;
use crate::pose::Pose;

/// A piece of the model's occluding contour as one camera sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OutlineSample {
    /// Continuous image coordinates, pixels.
    pub column: f64,
    /// Downwards.
    pub row: f64,
    /// Outward unit normal, to the right and downwards.
    pub normal: [f64; 2],
    /// Arc length, pixels.
    pub length: f64,
    /// How fast the contour moves along the normal, pixels per radian of three turns about the
    /// middle of the model's box and per mm of three shifts, all along the camera's axes.
    pub jacobian: [f64; 6],
}

/// Samples the occluding contour of `model` at `pose` (`camera_from_model`), one sample for each
/// border pixel of its silhouette; what the frame's border cuts off is left out.
///
/// # Errors
/// [`RefineError`] where the model cannot be drawn or memory is too short.
pub fn outline_samples(
    model: &Model<'_>,
    camera: &Camera,
    pose: &Pose,
    memory: &mut RefineMemory<'_>,
    mut visit: impl FnMut(&OutlineSample),
) -> Result<(), RefineError> {
    check_memory(camera, memory)?;
    let Drawing { drawn, border, .. } = draw(model, camera, pose, Sampling::ALL, memory)?;
    let motion = Motion::in_camera(camera, &pose.transform(&model.bounds().centre));
    for sample in border.iter().filter(|sample| sample.is_on_surface()) {
        let Residual::Px(own) = probe::crossing(&(&drawn).into(), sample, OWN_STEPS) else {
            continue;
        };
        let (own, normal) = (f64::from(own), sample.normal().map(f64::from));
        let [column, row] = sample.place();
        visit(&OutlineSample {
            column: column + own * normal[0],
            row: row + own * normal[1],
            normal,
            length: f64::from(sample.weight),
            jacobian: motion.jacobian(sample).map(f64::from),
        });
    }
    Ok(())
}
