//! Symmetric positive definite systems by Cholesky's method: Golub and Van Loan, *Matrix Computations*, section 4.2. One function for
//! matrices of all sizes, because a microcontroller would have it for each.

use super::basic::sqrt;

/// A square matrix, row by row.
struct Square<'a> {
    numbers: &'a mut [f64],
    size: usize,
}

impl Square<'_> {
    /// A number; 0 outside.
    fn at(&self, row: usize, column: usize) -> f64 {
        let number = self.numbers.get(row * self.size + column);
        number.copied().unwrap_or_default()
    }

    fn set(&mut self, row: usize, column: usize, value: f64) {
        if let Some(number) = self.numbers.get_mut(row * self.size + column) {
            *number = value;
        }
    }

    /// Replaces the lower triangle by its factor; `None` where the matrix is not positive definite.
    #[inline(never)]
    fn factor(&mut self) -> Option<()> {
        for column in 0..self.size {
            for k in 0..column {
                let own = self.at(column, k);
                for row in column..self.size {
                    let left = self.at(row, column) - self.at(row, k) * own;
                    self.set(row, column, left);
                }
            }
            let diagonal = self.at(column, column);
            if diagonal.is_nan() || diagonal <= 0.0 {
                return None;
            }
            let pivot = sqrt(diagonal);
            for row in column..self.size {
                self.set(row, column, self.at(row, column) / pivot);
            }
        }
        Some(())
    }

    /// Replaces `b` by the `x` of `a * x = b`, where the lower triangle is the factor of `a`.
    #[inline(never)]
    fn solve(&self, b: &mut [f64]) {
        for row in 0..self.size {
            let known = (0..row).map(|k| (k, self.at(row, k)));
            replace(b, row, known, self.at(row, row));
        }
        for row in (0..self.size).rev() {
            let known = (row + 1..self.size).map(|k| (k, self.at(k, row)));
            replace(b, row, known, self.at(row, row));
        }
    }
}

/// Subtracts products with numbers of `b` that are known from one that is not, and divides.
#[inline(always)]
fn replace(b: &mut [f64], row: usize, known: impl Iterator<Item = (usize, f64)>, diagonal: f64) {
    let own = b.get(row).copied().unwrap_or_default();
    let left = known.fold(own, |left, (k, factor)| {
        left - factor * b.get(k).copied().unwrap_or_default()
    });
    if let Some(number) = b.get_mut(row) {
        *number = left / diagonal;
    }
}

/// Solves the symmetric positive definite system `a * x = b`.
///
/// Returns `None` where `a` is not positive definite.
#[must_use]
pub fn solve_spd<const N: usize>(mut a: [[f64; N]; N], mut b: [f64; N]) -> Option<[f64; N]> {
    let mut square = Square {
        numbers: a.as_flattened_mut(),
        size: N,
    };
    square.factor()?;
    square.solve(&mut b);
    Some(b)
}

/// [`solve_spd`] of a few numbers, to the last bit: compiled for each size, for whoever solves a hundred thousand times.
#[inline(always)]
pub(crate) fn solve_few<const N: usize>(mut a: [[f64; N]; N], mut b: [f64; N]) -> Option<[f64; N]> {
    for column in 0..N {
        for k in 0..column {
            let own = a[column][k];
            for row in &mut a[column..] {
                row[column] -= row[k] * own;
            }
        }
        let diagonal = a[column][column];
        if diagonal.is_nan() || diagonal <= 0.0 {
            return None;
        }
        let pivot = sqrt(diagonal);
        for row in &mut a[column..] {
            row[column] /= pivot;
        }
    }
    for row in 0..N {
        for k in 0..row {
            b[row] -= a[row][k] * b[k];
        }
        b[row] /= a[row][row];
    }
    for row in (0..N).rev() {
        for k in row + 1..N {
            b[row] -= a[k][row] * b[k];
        }
        b[row] /= a[row][row];
    }
    Some(b)
}

/// Inverse of a symmetric positive definite matrix, column by column; symmetric to the last bit.
///
/// Returns `None` where `a` is not positive definite.
#[must_use]
pub fn inverse_spd<const N: usize>(a: &[[f64; N]; N]) -> Option<[[f64; N]; N]> {
    let (mut factor, mut columns) = (*a, [[0.0; N]; N]);
    let mut square = Square {
        numbers: factor.as_flattened_mut(),
        size: N,
    };
    square.factor()?;
    let mut inverse = Square {
        numbers: columns.as_flattened_mut(),
        size: N,
    };
    inverse.fill_with_inverse(&square);
    Some(columns)
}

impl Square<'_> {
    /// The inverse of what `factor` is the factor of.
    #[inline(never)]
    fn fill_with_inverse(&mut self, factor: &Square<'_>) {
        let size = self.size.max(1);
        for (k, column) in self.numbers.chunks_mut(size).enumerate() {
            if let Some(one) = column.get_mut(k) {
                *one = 1.0;
            }
            factor.solve(column);
        }
        for row in 0..self.size {
            for column in 0..row {
                let mean = (self.at(row, column) + self.at(column, row)) / 2.0;
                self.set(row, column, mean);
                self.set(column, row, mean);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::apply;
    use proptest::prelude::*;

    /// Oracle: [`solve_few`], which takes the numbers by rows and columns, and for each column of an inverse from the beginning.
    fn check<const N: usize>(numbers: &[f64]) -> Result<(), TestCaseError> {
        let root: [[f64; N]; N] =
            core::array::from_fn(|row| core::array::from_fn(|column| numbers[row * N + column]));
        // Positive definite but for the last number, which may make it another matrix.
        let mut a: [[f64; N]; N] = core::array::from_fn(|row| {
            core::array::from_fn(|column| (0..N).map(|k| root[row][k] * root[column][k]).sum())
        });
        a[N - 1][N - 1] += numbers[N * N];
        let b: [f64; N] = core::array::from_fn(|k| numbers[N * N + k]);
        prop_assert_eq!(solve_spd(a, b), solve_few(a, b));
        let columns: Option<std::vec::Vec<[f64; N]>> = (0..N)
            .map(|k| solve_few(a, core::array::from_fn(|row| f64::from(u8::from(row == k)))))
            .collect();
        let inverse = inverse_spd(&a);
        prop_assert_eq!(inverse.is_some(), columns.is_some());
        for (inverse, columns) in inverse.iter().zip(&columns) {
            for (row, numbers) in inverse.iter().enumerate() {
                for (column, &number) in numbers.iter().enumerate() {
                    let mean = (columns[row][column] + columns[column][row]) / 2.0;
                    prop_assert_eq!(number, mean);
                }
            }
        }
        Ok(())
    }

    properties! {
        #[test]
        fn solutions_and_inverses_have_the_bits_of_the_naive_way(
            numbers in proptest::collection::vec(-2.0..2.0f64, 60)
        ) {
            check::<1>(&numbers)?;
            check::<2>(&numbers)?;
            check::<3>(&numbers)?;
            check::<4>(&numbers)?;
            check::<6>(&numbers)?;
            check::<7>(&numbers)?;
        }
    }

    #[test]
    fn cholesky_solves_what_it_was_given() {
        let a = [[4.0, 2.0, 0.4], [2.0, 5.0, 1.0], [0.4, 1.0, 3.0]];
        let x = [1.0, -2.0, 3.0];
        let b = apply(&a, &x);
        for solved in [solve_spd(a, b), solve_few(a, b)] {
            let solved = solved.expect("positive definite");
            for (got, want) in solved.iter().zip(&x) {
                assert!((got - want).abs() < 1e-12);
            }
        }
        assert!(solve_spd([[1.0, 2.0], [2.0, 1.0]], [1.0, 1.0]).is_none());
        assert!(solve_spd([[f64::NAN]], [1.0]).is_none());
    }
}
