//! Pin-cushion and other smooth distortion of a picture as a polynomial in two variables.
//!
//! The polynomial takes a place in the picture as it is to where it lies in the straight picture; the way back is
//! Newton's method on the same polynomial, so frames and contours are corrected alike.

use super::GridError;
use super::polynomial::{TERMS, monomials, slopes, sum};
use fluoropose::math::sqrt;

/// Numbers in which a correction is stored: order, width, height, centre, scale, and both polynomials.
pub const NUMBERS: usize = 6 + 2 * TERMS;

/// A correction of distortion for frames of one size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distortion {
    pub(super) order: u8,
    pub(super) size: (usize, usize),
    /// What the polynomials count from, px, and their unit: the middle of the beads and how far they reach.
    pub(super) centre: [f64; 2],
    pub(super) scale: f64,
    pub(super) coefficients: [[f64; TERMS]; 2],
}

impl Distortion {
    /// The correction that stored numbers tell of.
    ///
    /// # Errors
    /// [`GridError::Correction`] where they are too few, not finite, of an unknown order or size, or turn the middle of
    /// the frame inside out.
    pub fn from_numbers(numbers: &[f64]) -> Result<Self, GridError> {
        let numbers: &[f64; NUMBERS] = numbers
            .try_into()
            .map_err(|_| GridError::Correction("there are not as many as a correction has"))?;
        if !numbers
            .iter()
            .all(|value| value.is_finite() && value.abs() < 1e6)
        {
            return Err(GridError::Correction("one of them is not a usable number"));
        }
        let [order, width, height, column, row, scale, coefficients @ ..] = *numbers;
        let whole = |value: f64, most: f64| {
            (1.0..=most).contains(&value) && value == fluoropose::math::floor(value)
        };
        if !whole(order, 5.0) || !whole(width, 65_535.0) || !whole(height, 65_535.0) {
            return Err(GridError::Correction("order or frame size is not possible"));
        }
        if scale < 1.0 {
            return Err(GridError::Correction("the scale is below one pixel"));
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
            false => Err(GridError::Correction(
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

    /// Columns and rows of the frames that it is for.
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

    /// Where a place (column, row) of the picture lies once it is straight, px.
    #[must_use]
    pub fn straight(&self, at: [f64; 2]) -> [f64; 2] {
        let [x, y] = self.normalised(at);
        let terms = monomials(x, y);
        self.denormalised([
            sum(&self.coefficients[0], &terms),
            sum(&self.coefficients[1], &terms),
        ])
    }

    /// Where a place of the straight picture is in the picture as it was taken, px; `None` where the polynomial has no
    /// such place near by, as may be far outside the beads.
    #[must_use]
    pub fn bent(&self, straight: [f64; 2]) -> Option<[f64; 2]> {
        self.bent_from(straight, straight)
    }

    /// The same from a guess.
    pub(super) fn bent_from(&self, straight: [f64; 2], guess: [f64; 2]) -> Option<[f64; 2]> {
        let target = self.normalised(straight);
        let mut at = self.normalised(guess);
        for _ in 0..STEPS {
            let terms = monomials(at[0], at[1]);
            let miss = [
                sum(&self.coefficients[0], &terms) - target[0],
                sum(&self.coefficients[1], &terms) - target[1],
            ];
            let [[a, b], [c, d]] = self.slope(at);
            let determinant = a * d - b * c;
            // Beyond this the polynomial folds the picture over.
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

    /// Rows of the derivative at a normalised place.
    fn slope(&self, at: [f64; 2]) -> [[f64; 2]; 2] {
        let [by_x, by_y] = slopes(at[0], at[1]);
        self.coefficients
            .map(|value| [sum(&value, &by_x), sum(&value, &by_y)])
    }

    /// By how much the correction enlarges an area about a place.
    pub(super) fn growth(&self, at: [f64; 2]) -> f64 {
        let [[a, b], [c, d]] = self.slope(self.normalised(at));
        a * d - b * c
    }

    /// The greatest distance by which a pixel within the radius of the beads is moved, px, on a coarse grid.
    #[must_use]
    pub fn largest_shift_px(&self) -> f64 {
        let mut largest: f64 = 0.0;
        for k in 0..=32 {
            for l in 0..=32 {
                let unit = [f64::from(k) / 16.0 - 1.0, f64::from(l) / 16.0 - 1.0];
                if unit[0] * unit[0] + unit[1] * unit[1] <= 1.0 {
                    let at = self.denormalised(unit);
                    let [column, row] = self.straight(at);
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
/// A step below this, in radii of the plate, ends them.
const CLOSE: f64 = 1e-10;
