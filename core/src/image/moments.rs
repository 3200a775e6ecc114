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
        let area = i128::from(self.area.max(1));
        let central = |second: u64, a: u64, b: u64| {
            let scaled = i128::from(second) * area - i128::from(a) * i128::from(b);
            scaled as f64 / (area as f64 * area as f64)
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
    (n, n * m / 2, n * (3 * m * m + n * n).saturating_sub(1) / 12)
}
