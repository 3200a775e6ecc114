//! The squares of pixels that a film is read in.
//!
//! Where pixels are finer than a film's blur, they hold noise and no edges: profiles end before the edge has, and what is near an outline
//! is looked for among grains. The mean of a square of pixels has as much of the edge and less of the noise. Which squares are right the
//! blur in them tells: in the file's own pixels noise passes for a sharp film.
//!
//! A film has one answer. Constants that were read in squares say so ([`super::FilmConstants::square_px`]), and whoever looks at a frame with
//! them gives it, and its camera, in such squares: [`crate::image::frame::Frame::reduce`], [`crate::camera::Camera::reduced`].
//! Poses are in millimetres, and are the same.

use super::model::MOST_BLUR;

/// Sides that are tried, one after the other, pixels of the file.
const TRIED: [usize; 2] = [2, 4];
/// A film is as well read in squares in whose sides it is blurred so much. In squares of two pixels films that are sharp to those have 0.8 to 1.0, one of
/// 1.03 was read a little worse, and nine of 1.1 to 1.8 better or as well: `tests/records/disguises.md`, "Pixels finer than the blur".
const ENOUGH_BLUR: f64 = 1.1;
/// Larger ones are tried where the blur is so many sides of those that are well: where they halve it to little more than is enough, trays are read worse.
const MORE_BLUR: f64 = 2.0;

/// Most blur that a film can be read with, standard deviation in pixels of its file: more than this many sides of the largest squares is taken for that.
pub const MOST_BLUR_PX: f64 = MOST_BLUR * TRIED[TRIED.len() - 1] as f64;

/// Finds the squares that a film is read in: profiles of frames with known poses are read in those that are [wanted](Self::wanted), and
/// what they tell is [taken](Self::take), until none are wanted.
#[derive(Clone, Copy, Debug)]
pub struct SquareChoice {
    /// How many of those that are tried are well.
    found: usize,
    is_over: bool,
}

impl SquareChoice {
    /// Of each component so many frames are read, the first whose pose is known.
    pub const FRAMES: usize = 3;

    /// Of a film whose blur nobody states, or of one with this blur, pixels of the file: then nothing is to be read.
    #[must_use]
    pub fn new(stated_blur_px: Option<f64>) -> Self {
        let mut choice = Self {
            found: 0,
            is_over: false,
        };
        if let Some(blur_px) = stated_blur_px {
            while let Some(side) = choice.wanted() {
                choice.take(Some(blur_px / side as f64));
            }
        }
        choice.is_over |= stated_blur_px.is_some();
        choice
    }

    /// The squares to read profiles in next, the side in pixels; `None` once it is known.
    #[must_use]
    pub fn wanted(&self) -> Option<usize> {
        TRIED.get(self.found).copied().filter(|_| !self.is_over)
    }

    /// Takes the blur that profiles in the squares wanted tell, in their sides; `None` where they tell nothing.
    pub fn take(&mut self, blur: Option<f64>) {
        match blur {
            Some(blur) if blur >= ENOUGH_BLUR => {
                self.found += 1;
                self.is_over = blur < MORE_BLUR;
            }
            _ => self.is_over = true,
        }
    }

    /// The side of the squares that are well so far, pixels; 1 is the file's own pixels.
    #[must_use]
    pub fn square_px(&self) -> usize {
        match self.found {
            0 => 1,
            found => TRIED[found - 1],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is found where blurs are these in squares of 2 and 4 pixels.
    fn chosen(blurs: [Option<f64>; 2]) -> usize {
        let mut choice = SquareChoice::new(None);
        let mut blurs = blurs.into_iter();
        while let Some(square) = choice.wanted() {
            assert!(square > choice.square_px());
            choice.take(blurs.next().flatten());
        }
        choice.square_px()
    }

    #[test]
    fn squares_are_as_large_as_the_blur_allows() {
        assert_eq!(chosen([Some(1.09), Some(2.0)]), 1);
        assert_eq!(chosen([Some(1.1), Some(2.0)]), 2);
        assert_eq!(chosen([Some(2.0), Some(1.09)]), 2);
        assert_eq!(chosen([Some(2.0), Some(1.1)]), 4);
    }

    #[test]
    fn what_tells_nothing_ends_the_choice() {
        assert_eq!(chosen([None, Some(2.0)]), 1);
        assert_eq!(chosen([Some(2.4), None]), 2);
    }

    #[test]
    fn a_blur_that_is_stated_is_not_asked_and_leads_to_the_same_squares() {
        for (blur, side) in [(1.5, 1), (2.1, 1), (2.2, 2), (3.9, 2), (4.3, 2), (4.4, 4)] {
            let choice = SquareChoice::new(Some(blur));
            assert_eq!(
                (choice.wanted(), choice.square_px()),
                (None, side),
                "{blur}"
            );
        }
    }
}
