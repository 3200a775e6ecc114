//! Whether a pose is where somebody pointed.

use fluoropose::camera::Camera;
use fluoropose::follow::holds_place;
use fluoropose::image::mask::{MaskMut, words_needed};
use fluoropose::mesh::Model;
use fluoropose::pose::Pose;
use fluoropose::render::{Projected, render, scratch_needed};
use wasm_bindgen::JsError;

use fluoropose_page::error::sentence;

/// Whether what is drawn at a pose holds a place of the frame (column, row, pixels).
///
/// # Errors
/// The core's sentence where it cannot be drawn.
pub(crate) fn holds(
    model: &Model<'_>,
    camera: &Camera,
    pose: &Pose,
    place: [f64; 2],
) -> Result<bool, JsError> {
    let (width, height) = (camera.width(), camera.height());
    let mut words = vec![0; words_needed(width, height)];
    let mut projected = vec![Projected::default(); scratch_needed(model)];
    let mut mask = MaskMut::new(&mut words, width, height).map_err(sentence)?;
    render(model, camera, pose, &mut projected, &mut mask).map_err(sentence)?;
    Ok(holds_place(&mask.as_mask(), place))
}
