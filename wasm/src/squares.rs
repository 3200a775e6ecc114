//! Frames in the squares of pixels that their film is read in (the core's `SquareChoice`).

use fluoropose::camera::Camera;
use fluoropose::film::FilmModel;
use fluoropose::image::grey::Grey;
use fluoropose::image::mask::{Mask, Word};
use fluoropose::refine::{CameraView, Target};
use fluoropose_page::error::sentence;
use fluoropose_page::frame_image::FrameImage;
use wasm_bindgen::JsError;

use crate::hidden::with_mask;

/// Side of the squares that go with what is known of a film, pixels.
pub(crate) fn square_px(film: Option<&FilmModel>) -> usize {
    film.map_or(1, |film| film.constants.square_px)
}

/// The same of the film of what a camera saw.
pub(crate) fn side_of(view: &CameraView<'_>) -> usize {
    match view.target {
        Target::Image(image) => square_px(image.film.as_ref()),
        Target::Silhouette(_) => 1,
    }
}

/// What is known of a film, where that is of the frame's own pixels: who looks for poses in those has nothing of another.
pub(crate) fn of_pixels(film: Option<FilmModel>) -> Option<FilmModel> {
    film.filter(|film| film.constants.square_px <= 1)
}

/// Calls `with` with a frame, its camera and the mask of its unknown pixels, in squares with sides of so many pixels.
///
/// # Errors
/// The core's sentence where no square fits, and those of `with`.
pub(crate) fn look_in_squares<T>(
    side: usize,
    frame: &FrameImage,
    camera: &Camera,
    unknown: Option<&[Word]>,
    with: impl FnOnce(&dyn Grey, &Camera, Option<&Mask<'_>>) -> Result<T, JsError>,
) -> Result<T, JsError> {
    if side <= 1 {
        return frame.look(|frame| with_mask(unknown, camera, |mask| with(frame, camera, mask)));
    }
    let squares = frame.reduced(side)?;
    let seen = camera.reduced(side).map_err(sentence)?;
    let unknown = with_mask(unknown, camera, |mask| {
        Ok(mask.map(|mask| mask.reduced(side).2))
    })?;
    squares.look(|frame| with_mask(unknown.as_deref(), &seen, |mask| with(frame, &seen, mask)))
}
