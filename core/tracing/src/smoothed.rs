//! A frame without the noise of single pixels, in 16 bits whatever it came in.

use fluoropose::image::frame::{Frame, Pixel};
use fluoropose::memory::{TooLittleMemory, check_length};

/// Weights of the smoothing kernel along one axis; they sum to 16. A binomial: about a Gaussian of 1 pixel.
const WEIGHTS: [u32; 5] = [1, 4, 6, 4, 1];
const HALF: usize = WEIGHTS.len() / 2;

/// Values of a [`Smoothed`] for one grey value of its frame. It is a power of two, the greatest with which all values fit
/// into 16 bits: averaging gains fractions of a grey value, and as many of them as possible are kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scale {
    /// Sums of grey values with weights that sum to 256 are shifted right by this number of bits.
    shift: u32,
}

impl Scale {
    /// The scale for frames whose greatest grey value is `greatest`.
    #[must_use]
    pub fn of(greatest: u32) -> Self {
        let bits = u32::BITS - greatest.leading_zeros();
        Self {
            shift: bits.saturating_sub(8),
        }
    }

    /// Smoothed values for one grey value.
    #[must_use]
    pub fn per_grey(self) -> f64 {
        256.0 / f64::from(1u32 << self.shift.min(16))
    }
}

/// The greatest grey value of a frame.
#[must_use]
pub fn greatest<P: Pixel>(frame: &Frame<'_, P>) -> u32 {
    let rows = (0..frame.height()).map(|row| frame.row(row).iter().copied().max());
    rows.flatten().max().unwrap_or_default().into()
}

/// A frame smoothed by a binomial kernel of 5 x 5 pixels, over borrowed values, row by row without gaps.
#[derive(Clone, Copy, Debug)]
pub struct Smoothed<'a> {
    cells: &'a [u16],
    width: usize,
    height: usize,
    scale: Scale,
}

impl<'a> Smoothed<'a> {
    /// Smooths a frame into `cells`, one value for each of its pixels. Beyond its border a frame is continued by its
    /// nearest pixel.
    ///
    /// # Errors
    /// [`TooLittleMemory`] where there are fewer cells than pixels.
    pub fn new<P: Pixel>(
        frame: &Frame<'_, P>,
        cells: &'a mut [u16],
    ) -> Result<Self, TooLittleMemory> {
        let scale = Scale::of(greatest(frame));
        check_length("cells", frame.width() * frame.height(), cells.len())?;
        for row in 0..frame.height() {
            smooth_row(frame, scale, row, cells);
        }
        Self::from_cells(cells, frame.width(), frame.height(), scale)
    }

    /// A frame of `width` x `height` pixels whose values were smoothed before, at this scale.
    ///
    /// # Errors
    /// [`TooLittleMemory`] where there are fewer cells than pixels.
    pub fn from_cells(
        cells: &'a [u16],
        width: usize,
        height: usize,
        scale: Scale,
    ) -> Result<Self, TooLittleMemory> {
        let needed = width.saturating_mul(height);
        check_length("cells", needed, cells.len())?;
        Ok(Self {
            cells: cells.get(..needed).unwrap_or_default(),
            width,
            height,
            scale,
        })
    }

    /// Columns.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    #[must_use]
    pub fn height(&self) -> usize {
        self.height
    }

    /// Smoothed values for one grey value.
    #[must_use]
    pub fn scale(&self) -> Scale {
        self.scale
    }

    /// One row; empty below the frame.
    #[must_use]
    pub fn row(&self, row: usize) -> &'a [u16] {
        let start = row.saturating_mul(self.width);
        self.cells
            .get(start..start + self.width)
            .unwrap_or_default()
    }

    /// The value at a column and row; zero outside.
    #[must_use]
    pub fn at(&self, column: usize, row: usize) -> u16 {
        self.row(row).get(column).copied().unwrap_or_default()
    }
}

/// Writes one row of the smoothed frame to its place.
pub(super) fn smooth_row<P: Pixel>(
    frame: &Frame<'_, P>,
    scale: Scale,
    row: usize,
    cells: &mut [u16],
) {
    let width = frame.width();
    let Some(out) = cells.get_mut(row * width..(row + 1) * width) else {
        return;
    };
    let last = frame.height() - 1;
    let above = |k: usize| frame.row((row + k).saturating_sub(HALF).min(last));
    let rows: [&[P]; WEIGHTS.len()] = core::array::from_fn(above);
    let down = |column: usize| -> u32 {
        let weighted = rows.iter().zip(WEIGHTS);
        weighted
            .map(|(row, weight)| weight * row[column].into())
            .sum()
    };
    let half = (1 << scale.shift) >> 1;
    // The window of column sums moves along, so that each sum is computed once.
    let at = |column: usize| down(column.min(width - 1));
    let mut window = [at(0), at(0), at(0), at(1), at(2)];
    for (column, value) in out.iter_mut().enumerate() {
        let sum: u32 = window.iter().zip(WEIGHTS).map(|(v, w)| v * w).sum();
        *value = ((sum + half) >> scale.shift).min(u32::from(u16::MAX)) as u16;
        window.rotate_left(1);
        window[WEIGHTS.len() - 1] = at(column + HALF + 1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn naive<P: Pixel>(frame: &Frame<'_, P>, column: usize, row: usize) -> u32 {
        let mut sum = 0;
        for (i, down) in WEIGHTS.iter().enumerate() {
            for (k, right) in WEIGHTS.iter().enumerate() {
                let c = column as isize + k as isize - 2;
                let r = row as isize + i as isize - 2;
                let grey: u32 = frame.nearest(c, r).into();
                sum += down * right * grey;
            }
        }
        sum
    }

    proptest! {
        #[test]
        fn each_value_is_the_weighted_mean_of_its_neighbours(
            pixels in proptest::collection::vec(any::<u16>(), 63), bits in 1..=16u32, width in 1..=9usize
        ) {
            let pixels: std::vec::Vec<u16> = pixels.iter().map(|p| p >> (16 - bits)).collect();
            let frame = Frame::new(&pixels, width, 7, width).expect("fits");
            let mut cells = std::vec![0; 7 * width];
            let smoothed = Smoothed::new(&frame, &mut cells).expect("fits");
            let per_grey = smoothed.scale().per_grey();
            for row in 0..7 {
                for column in 0..width {
                    let mean = f64::from(naive(&frame, column, row)) / 256.0;
                    let got = f64::from(smoothed.at(column, row)) / per_grey;
                    prop_assert!((got - mean).abs() <= 0.5 / per_grey + 1e-9, "{got} {mean}");
                }
            }
        }
    }

    #[test]
    fn eight_bits_lose_nothing() {
        let pixels: [u8; 63] = core::array::from_fn(|k| (k * 83 % 256) as u8);
        let frame = Frame::new(&pixels, 9, 7, 9).expect("fits");
        let mut cells = [0; 63];
        let smoothed = Smoothed::new(&frame, &mut cells).expect("fits");
        for row in 0..7 {
            for column in 0..9 {
                assert_eq!(
                    u32::from(smoothed.at(column, row)),
                    naive(&frame, column, row)
                );
            }
        }
    }
}
