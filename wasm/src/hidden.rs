//! Pixels of a frame whose edges are not the component's: the joint's other one lies there.

use fluoropose::camera::Camera;
use fluoropose::image::contour::{Outline, Point};
use fluoropose::image::mask::{Mask, MaskMut, Word, words_needed};
use fluoropose_tracing::morphology::widen;
use wasm_bindgen::JsError;

use fluoropose_page::error::sentence;

/// Round the other component, pixels: its edges are as wide as the detector's blur.
pub(crate) const MARGIN: usize = 4;

/// Sets the pixels inside an outline (columns and rows by turns), and some round it: another component's.
///
/// # Errors
/// The core's sentence about the outline.
pub(crate) fn hide(outline: &[f64], camera: &Camera, hidden: &mut [Word]) -> Result<(), JsError> {
    let (width, height) = (camera.width(), camera.height());
    let pairs = outline.as_chunks().0.iter();
    let points: Vec<Point> = pairs
        .map(|&[column, row]| Point::new(column, row))
        .collect();
    let outline = Outline::new(&points, width, height).map_err(sentence)?;
    let mut words = vec![0; words_needed(width, height)];
    let mut mask = MaskMut::new(&mut words, width, height).map_err(sentence)?;
    mask.fill_outline(&outline);
    let mut hidden = MaskMut::new(hidden, width, height).map_err(sentence)?;
    widen(&mask.into_mask(), MARGIN, &mut hidden);
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
