//! Pin-cushion and other smooth distortion of a frame as a polynomial in two variables.
//!
//! The polynomial maps a place in the frame as taken to its place in the undistorted frame. The way back is Newton's method
//! on the same polynomial, so that frames and contours are corrected alike.

use crate::error::DistortionError;
use crate::polynomial::{TERMS, monomials, slopes, sum};
use fluoropose::math::{floor, sqrt};

/// Number of numbers in which a correction is stored: order, width, height, centre (column, row), scale, and the
/// coefficients of both polynomials.
pub const NUMBERS: usize = 6 + 2 * TERMS;

/// A correction of distortion for frames of one size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distortion {
    pub(crate) order: u8,
    pub(crate) size: (usize, usize),
    /// Origin of the polynomials, px: the middle of the beads.
    pub(crate) centre: [f64; 2],
    /// Unit of the polynomials, px: the greatest distance of a bead from the middle.
    pub(crate) scale: f64,
    pub(crate) coefficients: [[f64; TERMS]; 2],
}

impl Distortion {
    /// The correction in stored numbers.
    ///
    /// # Errors
    /// [`DistortionError::Correction`] where they are not [`NUMBERS`], not finite or too large, of an impossible order, size
    /// or scale, or turn the middle of the frame inside out.
    pub fn from_numbers(numbers: &[f64]) -> Result<Self, DistortionError> {
        let numbers: &[f64; NUMBERS] = numbers.try_into().map_err(|_| {
            DistortionError::Correction("there are not as many as a correction has")
        })?;
        if !numbers
            .iter()
            .all(|value| value.is_finite() && value.abs() < 1e6)
        {
            return Err(DistortionError::Correction(
                "one of them is not a usable number",
            ));
        }
        let [order, width, height, column, row, scale, coefficients @ ..] = *numbers;
        let whole = |value: f64, most: f64| (1.0..=most).contains(&value) && value == floor(value);
        if !whole(order, 5.0) || !whole(width, 65_535.0) || !whole(height, 65_535.0) {
            return Err(DistortionError::Correction(
                "order or frame size is not possible",
            ));
        }
        if scale < 1.0 {
            return Err(DistortionError::Correction("the scale is below one pixel"));
        }
        let mut both = [[0.0; TERMS]; 2];
        for (target, source) in both.as_flattened_mut().iter_mut().zip(coefficients) {
            *target = source;
        }
        let correction = Self {
            order: order as u8,
            size: (width as usize, height as usize),
            centre: [column, row],
            scale,
            coefficients: both,
        };
        match correction.growth([width / 2.0, height / 2.0]) > 0.01 {
            true => Ok(correction),
            false => Err(DistortionError::Correction(
                "they turn the middle of the frame inside out",
            )),
        }
    }

    /// The numbers to store.
    #[must_use]
    pub fn numbers(&self) -> [f64; NUMBERS] {
        let head = [
            f64::from(self.order),
            self.size.0 as f64,
            self.size.1 as f64,
            self.centre[0],
            self.centre[1],
            self.scale,
        ];
        let mut out = [0.0; NUMBERS];
        for (target, value) in out
            .iter_mut()
            .zip(head.iter().chain(self.coefficients.as_flattened()))
        {
            *target = *value;
        }
        out
    }

    /// Order of the polynomials.
    #[must_use]
    pub fn order(&self) -> u8 {
        self.order
    }

    /// Columns and rows of the frames that it corrects.
    #[must_use]
    pub fn size(&self) -> (usize, usize) {
        self.size
    }

    fn normalised(&self, at: [f64; 2]) -> [f64; 2] {
        [
            (at[0] - self.centre[0]) / self.scale,
            (at[1] - self.centre[1]) / self.scale,
        ]
    }

    fn denormalised(&self, at: [f64; 2]) -> [f64; 2] {
        [
            self.centre[0] + self.scale * at[0],
            self.centre[1] + self.scale * at[1],
        ]
    }

    /// The place in the undistorted frame of a place (column, row) in the frame as taken, px.
    #[must_use]
    pub fn undistorted(&self, at: [f64; 2]) -> [f64; 2] {
        let [x, y] = self.normalised(at);
        let terms = monomials(x, y);
        self.denormalised([
            sum(&self.coefficients[0], &terms),
            sum(&self.coefficients[1], &terms),
        ])
    }

    /// The place in the frame as taken of a place (column, row) in the undistorted frame, px; `None` where Newton's method
    /// finds none, as may happen far outside of the beads.
    #[must_use]
    pub fn distorted(&self, undistorted: [f64; 2]) -> Option<[f64; 2]> {
        self.distorted_from(undistorted, undistorted)
    }

    /// The same from a guess.
    pub(crate) fn distorted_from(
        &self,
        undistorted: [f64; 2],
        guess: [f64; 2],
    ) -> Option<[f64; 2]> {
        let target = self.normalised(undistorted);
        let mut at = self.normalised(guess);
        for _ in 0..STEPS {
            let terms = monomials(at[0], at[1]);
            let miss = [
                sum(&self.coefficients[0], &terms) - target[0],
                sum(&self.coefficients[1], &terms) - target[1],
            ];
            let [[a, b], [c, d]] = self.slope(at);
            let determinant = a * d - b * c;
            // Here the polynomial folds the frame over.
            if determinant.is_nan() || determinant < 0.01 {
                return None;
            }
            let step = [
                (d * miss[0] - b * miss[1]) / determinant,
                (a * miss[1] - c * miss[0]) / determinant,
            ];
            at = [at[0] - step[0], at[1] - step[1]];
            if step[0].abs() + step[1].abs() < CLOSE {
                return Some(self.denormalised(at));
            }
        }
        None
    }

    /// The Jacobian matrix at a normalised place.
    fn slope(&self, at: [f64; 2]) -> [[f64; 2]; 2] {
        let [by_x, by_y] = slopes(at[0], at[1]);
        self.coefficients
            .map(|value| [sum(&value, &by_x), sum(&value, &by_y)])
    }

    /// The factor by which the correction enlarges an area around a place.
    pub(crate) fn growth(&self, at: [f64; 2]) -> f64 {
        let [[a, b], [c, d]] = self.slope(self.normalised(at));
        a * d - b * c
    }

    /// The greatest distance by which a pixel within the radius of the beads is moved, px, over 33 x 33 places.
    #[must_use]
    pub fn largest_shift_px(&self) -> f64 {
        let mut largest: f64 = 0.0;
        for k in 0..=32 {
            for l in 0..=32 {
                let unit = [f64::from(k) / 16.0 - 1.0, f64::from(l) / 16.0 - 1.0];
                if unit[0] * unit[0] + unit[1] * unit[1] <= 1.0 {
                    let at = self.denormalised(unit);
                    let [column, row] = self.undistorted(at);
                    let (right, down) = (column - at[0], row - at[1]);
                    largest = largest.max(sqrt(right * right + down * down));
                }
            }
        }
        largest
    }
}

/// Newton steps: two or three suffice inside the beads.
const STEPS: usize = 20;
/// A step below this, in units of the radius of the plate, ends them.
const CLOSE: f64 = 1e-10;
