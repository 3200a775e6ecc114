//! Area, centroid and second moments of a silhouette, in whole numbers.
//!
//! Running sums in floating point lose the orientation of shapes that are nearly round; sums of
//! integers lose nothing, and only their result is rounded.

use core::ops::Range;

use crate::image::contour::Point;
use crate::image::mask::Mask;

/// Sums over the pixels of a silhouette, exact. Coordinates are pixel indices.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Moments {
    /// Number of pixels.
    pub area: u64,
    /// Sum of columns.
    pub column: u64,
    /// Sum of rows.
    pub row: u64,
    /// Sum of squared columns.
    pub column_column: u64,
    /// Sum of column times row.
    pub column_row: u64,
    /// Sum of squared rows.
    pub row_row: u64,
}

impl Moments {
    /// Centroid in continuous image coordinates (a pixel's centre is its index + 0.5).
    #[must_use]
    pub fn centroid(&self) -> Point {
        let area = self.area.max(1) as f64;
        Point {
            column: self.column as f64 / area + 0.5,
            row: self.row as f64 / area + 0.5,
        }
    }

    /// Adds a run of pixels of a row.
    pub(super) fn add_run(&mut self, row: usize, run: &Range<usize>) {
        let y = row as u64;
        let (n, columns, squares) = run_sums(run.start as u64, run.end as u64);
        self.area += n;
        self.column += columns;
        self.row += y * n;
        self.column_column += squares;
        self.column_row += y * columns;
        self.row_row += y * y * n;
    }

    /// Those of the same pixels so many columns and rows further right and down: of a part of a frame, in the frame.
    #[must_use]
    pub fn moved(&self, columns: usize, rows: usize) -> Self {
        let (x, y) = (columns as u64, rows as u64);
        Self {
            area: self.area,
            column: self.column + x * self.area,
            row: self.row + y * self.area,
            column_column: self.column_column + 2 * x * self.column + x * x * self.area,
            column_row: self.column_row + x * self.row + y * self.column + x * y * self.area,
            row_row: self.row_row + 2 * y * self.row + y * y * self.area,
        }
    }

    /// Central second moments divided by the area (column-column, column-row, row-row), in
    /// square pixels. The difference is taken in integers; only its result is rounded.
    #[must_use]
    pub fn covariance(&self) -> [f64; 3] {
        let area = self.area.max(1);
        let squared = area as f64 * area as f64;
        let central = |second: u64, a: u64, b: u64| {
            let products = [[second, area], [a, b]].map(|[a, b]| i128::from(a) * i128::from(b));
            nearest(products[0] - products[1]) / squared
        };
        [
            central(self.column_column, self.column, self.column),
            central(self.column_row, self.column, self.row),
            central(self.row_row, self.row, self.row),
        ]
    }
}

impl Mask<'_> {
    /// Area and first and second moments, exact: each run of pixels adds closed-form sums.
    #[must_use]
    pub fn moments(&self) -> Moments {
        let mut sum = Moments::default();
        for row in self.rows() {
            for run in self.runs(row) {
                sum.add_run(row, &run);
            }
        }
        sum
    }
}

/// Number, sum and sum of squares of the integers from `a` up to and without `b`: with `m` twice their mean,
/// `n`, `n m / 2` and `n (3 m^2 + n^2 - 1) / 12`.
fn run_sums(a: u64, b: u64) -> (u64, u64, u64) {
    let (n, m) = (b - a, (a + b).saturating_sub(1));
    let twelve_times = n * (3 * m * m + n * n).saturating_sub(1);
    (n, n * m / 2, third(twelve_times / 4))
}

/// Of a multiple of three: a product by the inverse of 3 modulo 2^64, as no microcontroller divides 64 bits.
fn third(number: u64) -> u64 {
    number.wrapping_mul(0xaaaa_aaaa_aaaa_aaab)
}

/// The nearest floating-point number.
fn nearest(number: i128) -> f64 {
    // To 64 bits, of which the lowest tells whether any behind it was set: rounding asks no more.
    let (mut bits, mut exponent) = (number.unsigned_abs(), 0);
    while bits >> u64::BITS != 0 {
        bits = bits >> 1 | bits & 1;
        exponent += 1;
    }
    let size = bits as u64 as f64 * f64::from_bits((1023 + exponent) << 52);
    if number < 0 { -size } else { size }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::mask::{MaskMut, words_needed};
    use proptest::prelude::*;

    properties! {
        #[test]
        fn whole_numbers_are_rounded_as_the_language_does(number in any::<i128>(), shift in 0u32..128, below in 0u32..128, off in -2..=2i128) {
            for number in [number >> shift, (number >> shift << below).wrapping_add(off), off] {
                prop_assert_eq!(nearest(number).to_bits(), (number as f64).to_bits(), "{}", number);
            }
        }

        /// By their pixels one by one, of a mask and of the same one further right and down.
        #[test]
        fn moments_are_those_of_the_pixels(
            pixels in proptest::collection::vec((0..70usize, 0..12usize), 1..60),
            right in 0..200usize, down in 0..50usize,
        ) {
            let mut words = std::vec![0; words_needed(70, 12)];
            let mut mask = MaskMut::new(&mut words, 70, 12).expect("fits");
            pixels.iter().for_each(|&(column, row)| mask.set(column, row, true));
            let mask = mask.into_mask();
            let all = (0..70).flat_map(|column| (0..12).map(move |row| (column, row)));
            let set: std::vec::Vec<[u64; 2]> = all
                .filter(|&(column, row)| mask.get(column, row))
                .map(|(column, row)| [column as u64, row as u64])
                .collect();
            let naive = |right: u64, down: u64| {
                set.iter().map(|[x, y]| [x + right, y + down]).fold(Moments::default(), |sum, [x, y]| Moments {
                    area: sum.area + 1,
                    column: sum.column + x,
                    row: sum.row + y,
                    column_column: sum.column_column + x * x,
                    column_row: sum.column_row + x * y,
                    row_row: sum.row_row + y * y,
                })
            };
            let moments = mask.moments();
            prop_assert_eq!(moments, naive(0, 0));
            let moved = moments.moved(right, down);
            prop_assert_eq!(moved, naive(right as u64, down as u64));
            // Middles of pixels, and squares about their mean, wherever they lie.
            let count = set.len() as f64;
            let mean = [0, 1].map(|k| set.iter().map(|at| at[k] as f64 + 0.5).sum::<f64>() / count);
            let about = |a: usize, b: usize| {
                let products = set.iter().map(|at| (at[a] as f64 + 0.5 - mean[a]) * (at[b] as f64 + 0.5 - mean[b]));
                products.sum::<f64>() / count
            };
            let Point { column, row } = moments.centroid();
            prop_assert!((column - mean[0]).abs() < 1e-9 && (row - mean[1]).abs() < 1e-9);
            let expected = [about(0, 0), about(0, 1), about(1, 1)];
            let found = moments.covariance();
            prop_assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9 * (1.0 + b.abs())));
            prop_assert_eq!(moved.covariance(), found);
        }

        #[test]
        fn sums_of_a_run_are_those_of_its_pixels(a in 0u64..70_000, n in 0u64..300) {
            let naive = (a..a + n).fold((0, 0, 0), |sum, at| (sum.0 + 1, sum.1 + at, sum.2 + at * at));
            prop_assert_eq!(run_sums(a, a + n), naive);
        }
    }
}
