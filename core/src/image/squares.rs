//! Frames in squares of pixels: as much of a picture that is softer than its pixels, and less noise.

#[cfg(feature = "alloc")]
use alloc::vec::Vec;

use super::frame::{Frame, FrameError, Pixel};
#[cfg(feature = "alloc")]
use super::mask::{Mask, MaskMut, Word, words_needed};

impl<P: Pixel> Frame<'_, P> {
    /// Columns and rows of the frame in squares of `side` x `side` pixels: those at the end that fill none are left out. A side of 0 counts as 1.
    #[must_use]
    pub fn reduced_size(&self, side: usize) -> (usize, usize) {
        (self.width() / side.max(1), self.height() / side.max(1))
    }

    /// Writes the frame in squares of `side` x `side` pixels ([`Self::reduced_size`]) row by row: of each the mean of its grey values, to the nearest.
    ///
    /// # Errors
    /// [`FrameError::Empty`] where no square fits, [`FrameError::BufferTooShort`] where they do not fit `squares`.
    pub fn reduce(&self, side: usize, squares: &mut [P]) -> Result<(), FrameError> {
        let side = side.max(1);
        let (width, height) = self.reduced_size(side);
        if width == 0 || height == 0 {
            return Err(FrameError::Empty { width, height });
        }
        let (needed, given) = (width.saturating_mul(height), squares.len());
        if given < needed {
            return Err(FrameError::BufferTooShort { needed, given });
        }
        let count = side as u64 * side as u64;
        for (row, squares) in squares.chunks_exact_mut(width).take(height).enumerate() {
            for (column, square) in squares.iter_mut().enumerate() {
                let columns = side * column..side * (column + 1);
                let of_row = |row| self.row(row).get(columns.clone()).unwrap_or_default();
                let rows = (side * row..side * (row + 1)).map(of_row);
                let sum: u64 = rows.flatten().map(|&pixel| u64::from(pixel.into())).sum();
                // A mean is no more than the greatest.
                *square = P::from_u32(((sum + count / 2) / count) as u32);
            }
        }
        Ok(())
    }

    /// The same in memory of its own.
    ///
    /// # Errors
    /// [`FrameError::Empty`] where no square fits.
    #[cfg(feature = "alloc")]
    pub fn reduced(&self, side: usize) -> Result<Vec<P>, FrameError> {
        let (width, height) = self.reduced_size(side);
        let mut squares = alloc::vec![P::default(); width * height];
        self.reduce(side, &mut squares)?;
        Ok(squares)
    }
}

#[cfg(feature = "alloc")]
impl Mask<'_> {
    /// Columns, rows and words of the mask in squares of `side` x `side` pixels: those of which a pixel is set. A side of 0 counts as 1.
    #[must_use]
    pub fn reduced(&self, side: usize) -> (usize, usize, Vec<Word>) {
        let side = side.max(1);
        let (width, height) = (self.width() / side, self.height() / side);
        let mut words = alloc::vec![0; words_needed(width, height)];
        if let Ok(mut squares) = MaskMut::new(&mut words, width, height) {
            for row in 0..height * side {
                for column in (0..width * side).filter(|&column| self.get(column, row)) {
                    squares.set(column / side, row / side, true);
                }
            }
        }
        (width, height, words)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::vec::Vec;

    #[test]
    fn squares_that_do_not_fit_are_refused() {
        let pixels = [0_u8; 24];
        let frame = Frame::new(&pixels, 5, 4, 6).expect("fits");
        let mut squares = [0; 4];
        assert_eq!(frame.reduced_size(0), (5, 4));
        #[cfg(feature = "alloc")]
        assert_eq!(frame.reduced(0).map(|all| all.len()), Ok(20));
        assert_eq!(
            frame.reduce(5, &mut squares),
            Err(FrameError::Empty {
                width: 1,
                height: 0
            })
        );
        let short = frame.reduce(2, &mut squares[..3]);
        let (needed, given) = (4, 3);
        assert_eq!(short, Err(FrameError::BufferTooShort { needed, given }));
    }

    #[cfg(feature = "alloc")]
    #[test]
    fn a_square_is_set_where_a_pixel_of_it_is() {
        let mut words = std::vec![0; words_needed(7, 5)];
        let mut mask = MaskMut::new(&mut words, 7, 5).expect("fits");
        for (column, row) in [(1, 0), (4, 3), (6, 1), (0, 4)] {
            mask.set(column, row, true);
        }
        let (width, height, squares) = mask.as_mask().reduced(2);
        let squares = Mask::new(&squares, width, height).expect("fits");
        let set = |number: &usize| squares.get(number % 3, number / 3);
        let found: Vec<usize> = (0..6).filter(set).collect();
        assert_eq!((width, height, &found[..]), (3, 2, &[0, 5][..]));
    }

    properties! {
        #[test]
        fn squares_are_means_of_their_pixels(
            grey in proptest::collection::vec(any::<u16>(), 9 * 12), side in 1..5usize,
        ) {
            let bytes: Vec<u8> = grey.iter().map(|&grey| grey as u8).collect();
            let (columns, rows) = (11 / side, 9 / side);
            let mut words = std::vec![0; columns * rows];
            let mut few = std::vec![0; columns * rows];
            let frame = Frame::new(&grey, 11, 9, 12).expect("fits");
            prop_assert_eq!(frame.reduced_size(side), (columns, rows));
            frame.reduce(side, &mut words).expect("fits");
            Frame::new(&bytes, 11, 9, 12).expect("fits").reduce(side, &mut few).expect("fits");
            for number in 0..columns * rows {
                let corner = number / columns * side * 12 + number % columns * side;
                let place = |k: usize| corner + k / side * 12 + k % side;
                let count = side * side;
                let mean = |value: &dyn Fn(usize) -> f64| {
                    let sum: f64 = (0..count).map(|k| value(place(k))).sum();
                    libm::floor(sum / count as f64 + 0.5)
                };
                prop_assert_eq!(f64::from(words[number]), mean(&|at| f64::from(grey[at])));
                prop_assert_eq!(f64::from(few[number]), mean(&|at| f64::from(bytes[at])));
            }
        }
    }
}
