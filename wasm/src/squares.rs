//! Frames in the squares of pixels that their film is read in (the core's `SquareChoice`).

use fluoropose::camera::Camera;
use fluoropose::film::FilmModel;
use fluoropose::image::grey::Grey;
use fluoropose::image::mask::{Mask, MaskMut, Word, words_needed};
use fluoropose_page::error::sentence;
use fluoropose_page::frame_image::FrameImage;
use wasm_bindgen::JsError;

use crate::hidden::with_mask;

/// Side of the squares that go with what is known of a film, pixels.
pub(crate) fn square_px(film: Option<&FilmModel>) -> usize {
    film.map_or(1, |film| film.constants.square_px)
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
        Ok(mask.map(|mask| reduced(mask, side)))
    })?;
    squares.look(|frame| with_mask(unknown.as_deref(), &seen, |mask| with(frame, &seen, mask)))
}

/// The squares of which a pixel is set.
fn reduced(mask: &Mask<'_>, side: usize) -> Vec<Word> {
    let (width, height) = (mask.width() / side, mask.height() / side);
    let mut words = vec![0; words_needed(width, height)];
    if let Ok(mut squares) = MaskMut::new(&mut words, width, height) {
        for row in 0..height * side {
            for column in (0..width * side).filter(|&column| mask.get(column, row)) {
                squares.set(column / side, row / side, true);
            }
        }
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_is_unknown_where_a_pixel_of_it_is() {
        let mut words = vec![0; words_needed(7, 5)];
        let mut mask = MaskMut::new(&mut words, 7, 5).unwrap();
        for (column, row) in [(1, 0), (4, 3), (6, 1), (0, 4)] {
            mask.set(column, row, true);
        }
        let squares = reduced(&mask.as_mask(), 2);
        let squares = Mask::new(&squares, 3, 2).unwrap();
        let set = |number: usize| squares.get(number % 3, number / 3);
        let found: Vec<usize> = (0..6).filter(|&number| set(number)).collect();
        assert_eq!(found, [0, 5]);
    }
}
