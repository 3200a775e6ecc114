//! A model drawn at a pose, and the samples of its outline.

use super::border::BorderPixel;
use super::error::RefineError;
use super::memory::RefineMemory;
use super::outline::{Depth, DrawnModel, Sampling};
use crate::camera::Camera;
use crate::film::LineMemory;
use crate::image::mask::{Mask, MaskMut, words_needed};
use crate::mesh::Model;
use crate::pose::Pose;
use crate::render::{Projected, render_with};

/// What drawing leaves in working memory, and the memory that it leaves.
pub(super) struct Drawing<'m, 'a> {
    /// The model as drawn.
    pub(super) drawn: Mask<'m>,
    /// The samples of its outline.
    pub(super) border: &'m mut [BorderPixel],
    pub(super) projected: &'m mut [Projected],
    /// Whether it holds the images of all vertices.
    pub(super) all: bool,
    pub(super) film: &'m mut LineMemory<'a>,
}

/// Draws `model` at `pose` (`camera_from_model`) and samples its border.
///
/// # Errors
/// [`RefineError`] where the model cannot be drawn or memory is too short.
pub(super) fn draw<'m, 'a>(
    model: &Model<'_>,
    camera: &Camera,
    pose: &Pose,
    sampling: Sampling,
    memory: &'m mut RefineMemory<'a>,
) -> Result<Drawing<'m, 'a>, RefineError> {
    let (width, height) = (camera.width(), camera.height());
    let words = memory.drawn.get_mut(..words_needed(width, height));
    let mut drawn = MaskMut::new(words.unwrap_or_default(), width, height)?;
    // Of an outline's depth alone few are wanted.
    let all = cfg!(feature = "frames") && sampling.depth != Depth::Edges;
    let all = render_with(model, camera, pose, memory.projected, &mut drawn, all)?;
    let drawn = drawn.into_mask();
    let outliner = DrawnModel {
        model,
        camera,
        pose,
        drawn: &drawn,
        sampling,
        all,
    };
    let border = outliner.border(memory.projected, memory.places, memory.border)?;
    Ok(Drawing {
        drawn,
        border,
        projected: memory.projected,
        all,
        film: &mut memory.film,
    })
}
