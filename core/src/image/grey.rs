//! Grey values between pixels' centres, whatever pixels they are of, one by one and along lines.

use super::display::QuickCurve;

/// Places on a straight line, as far apart as `step`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StraightLine {
    /// A place on it, continuous image coordinates, pixels.
    pub origin: [f64; 2],
    /// Unit vector along it, to the right and downwards.
    pub direction: [f64; 2],
    /// What is added to each of its places, pixels: a line beside another has the same places there.
    pub aside: [f64; 2],
    /// How far from the origin the place with the number `middle` is, pixels.
    pub expected: f64,
    /// Its number.
    pub middle: usize,
    /// Distance between places, pixels.
    pub step: f64,
}

impl StraightLine {
    /// A place by its number.
    #[must_use]
    #[inline]
    pub fn place(&self, number: usize) -> [f64; 2] {
        // Numbers of 32 bits become floating point in one instruction.
        let from_middle = f64::from(number as i32) - f64::from(self.middle as i32);
        let t = self.expected + self.step * from_middle;
        [0, 1].map(|k| self.origin[k] + t * self.direction[k] + self.aside[k])
    }
}

/// Something with grey values between its pixels' centres: a [`super::frame::Frame`] of any pixel type.
pub trait Grey {
    /// Columns and rows.
    fn size(&self) -> (usize, usize);

    /// Grey value at continuous image coordinates, linear between the four nearest centres;
    /// `None` beyond the outermost centres.
    fn at(&self, column: f64, row: f64) -> Option<f64>;

    /// The same of what a curve makes of each pixel: the mean of intensities is not the intensity of the mean grey value.
    fn at_through(&self, column: f64, row: f64, curve: &QuickCurve) -> Option<f64>;

    /// Adds `weight` times [`Self::at_through`] at the places of a line to `sums`, one for each place from 0; `None` where one of
    /// the places is beyond the outermost centres, and the sums are good for nothing then.
    fn add_along(
        &self,
        line: &StraightLine,
        curve: &QuickCurve,
        weight: f64,
        sums: &mut [f64],
    ) -> Option<()>;
}

impl<G: Grey + ?Sized> Grey for &G {
    fn size(&self) -> (usize, usize) {
        (**self).size()
    }

    fn at(&self, column: f64, row: f64) -> Option<f64> {
        (**self).at(column, row)
    }

    fn at_through(&self, column: f64, row: f64, curve: &QuickCurve) -> Option<f64> {
        (**self).at_through(column, row, curve)
    }

    fn add_along(
        &self,
        line: &StraightLine,
        curve: &QuickCurve,
        weight: f64,
        sums: &mut [f64],
    ) -> Option<()> {
        (**self).add_along(line, curve, weight, sums)
    }
}
