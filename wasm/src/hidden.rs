//! Pixels of a frame whose edges are not the component's: the joint's other one lies there.

use fluoropose::camera::Camera;
use fluoropose::image::mask::{Mask, MaskMut, Word};
use fluoropose_tracing::beside;
use wasm_bindgen::JsError;

use fluoropose_page::error::sentence;
use fluoropose_page::traced::{filled, points_of};

/// Sets the pixels inside an outline (columns and rows by turns), and what its edges reach beyond it: another component's.
///
/// # Errors
/// The core's sentence about the outline.
pub(crate) fn hide(outline: &[f64], camera: &Camera, hidden: &mut [Word]) -> Result<(), JsError> {
    let (width, height) = (camera.width(), camera.height());
    let words = filled(&points_of(outline), width, height)?;
    let inside = Mask::new(&words, width, height).map_err(sentence)?;
    let mut hidden = MaskMut::new(hidden, width, height).map_err(sentence)?;
    beside::hide(&inside, &mut hidden);
    Ok(())
}

/// Calls `with` with a mask of the camera's frame, where there is one.
pub(crate) fn with_mask<T>(
    words: Option<&[Word]>,
    camera: &Camera,
    with: impl FnOnce(Option<&Mask<'_>>) -> Result<T, JsError>,
) -> Result<T, JsError> {
    let mask = words.map(|words| Mask::new(words, camera.width(), camera.height()));
    let mask = mask.transpose().map_err(sentence)?;
    with(mask.as_ref())
}
