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
    let mut hidden = MaskMut::onto(hidden, width, height).map_err(sentence)?;
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

#[cfg(test)]
mod tests {
    use super::*;
    use fluoropose::image::mask::words_needed;

    #[test]
    fn what_was_hidden_before_stays_hidden() {
        let camera = Camera::from_principal_distance(64, 64, 1000.0, 0.5, [0.0; 2]).unwrap();
        let mut words = vec![0; words_needed(64, 64)];
        let square = |x: f64| [x, 20.0, x + 6.0, 20.0, x + 6.0, 26.0, x, 26.0];
        for x in [10.0, 40.0] {
            assert!(hide(&square(x), &camera, &mut words).is_ok());
        }
        // Six pixels, and four to each side of them.
        let hidden = Mask::new(&words, 64, 64).unwrap();
        assert_eq!(hidden.area(), 2 * 14 * 14);
    }
}
