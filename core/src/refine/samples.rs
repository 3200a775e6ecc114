//! The occluding contour as samples: what bounds and tests need of it.

use super::border::NormalReading;
use super::error::RefineError;
use super::memory::{RefineMemory, check_memory};
use super::outline::{Depth, DrawnModel};
use super::probe::{self, OWN_RANGE};
use super::step::Step;
use crate::camera::Camera;
use crate::image::mask::{MaskMut, words_needed};
use crate::mesh::Model;
use crate::pose::Pose;
use crate::render::render;

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
    let (width, height) = (camera.width(), camera.height());
    let words = memory.drawn.get_mut(..words_needed(width, height));
    let mut drawn = MaskMut::new(words.unwrap_or_default(), width, height)?;
    render(model, camera, pose, memory.projected, &mut drawn)?;
    let drawn = drawn.into_mask();
    let outliner = DrawnModel {
        model,
        camera,
        pose,
        drawn: &drawn,
        depth: Depth::Edges,
        every: 1,
    };
    let places = memory.places.get_mut(..width * height);
    let border = outliner.border(memory.projected, places.unwrap_or_default(), memory.border)?;
    let centre = pose.transform(&model.bounds().centre);
    for sample in border.iter().filter(|sample| sample.is_on_surface()) {
        let NormalReading::At(own) = probe::crossing(&(&drawn).into(), sample, OWN_RANGE) else {
            continue;
        };
        let normal = sample.normal.map(f64::from);
        let [column, row] = sample.place();
        visit(&OutlineSample {
            column: column + own * normal[0],
            row: row + own * normal[1],
            normal,
            length: f64::from(sample.weight),
            jacobian: Step::jacobian(camera, &centre, sample.place(), sample.depth(), normal),
        });
    }
    Ok(())
}
