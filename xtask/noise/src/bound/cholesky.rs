//! The Cholesky factor of a covariance of some hundreds of rows.

/// The lower half of a symmetric matrix, or a lower triangular one: row `i` has `i + 1` numbers.
pub(super) type Lower = Vec<Vec<f64>>;

/// The lower triangular `L` with `L L'` the matrix; `None` where that is not positive definite.
pub(super) struct Cholesky(Lower);

impl Cholesky {
    /// Factors a matrix in place, row by row (Banachiewicz).
    pub(super) fn of(mut matrix: Lower) -> Option<Self> {
        for row in 0..matrix.len() {
            let (above, rest) = matrix.split_at_mut(row);
            let current = rest.first_mut()?;
            for (column, upper) in above.iter().enumerate() {
                let known = dot(&current[..column], &upper[..column]);
                current[column] = (current[column] - known) / upper[column];
            }
            let left = current[row] - dot(&current[..row], &current[..row]);
            if left.is_nan() || left <= 0.0 {
                return None;
            }
            current[row] = left.sqrt();
        }
        Some(Self(matrix))
    }

    /// `L^-1 B` for a matrix `B` of as many rows: what has the covariance `L L'` becomes white.
    pub(super) fn whitened<const K: usize>(&self, rows: &[[f64; K]]) -> Vec<[f64; K]> {
        let mut white: Vec<[f64; K]> = Vec::with_capacity(rows.len());
        for (row, factor) in rows.iter().zip(&self.0) {
            let (&pivot, before) = factor.split_last().unwrap_or((&1.0, &[]));
            let mut left = *row;
            for (weight, known) in before.iter().zip(&white) {
                for (value, known) in left.iter_mut().zip(known) {
                    *value -= weight * known;
                }
            }
            white.push(left.map(|value| value / pivot));
        }
        white
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    /// A positive definite matrix: `A A'` of random numbers, and something on the diagonal.
    fn matrix(side: usize, random: &mut ChaCha8Rng) -> Lower {
        let mut number = || f64::from(random.next_u32()) / f64::from(u32::MAX) - 0.5;
        let a: Vec<Vec<f64>> = (0..side)
            .map(|_| (0..side).map(|_| number()).collect())
            .collect();
        let value = |row: usize, column: usize| {
            let ridge = if row == column { 0.01 } else { 0.0 };
            (0..side).map(|k| a[row][k] * a[column][k]).sum::<f64>() + ridge
        };
        (0..side)
            .map(|row| (0..=row).map(|column| value(row, column)).collect())
            .collect()
    }

    /// Gauss's elimination with pivots, of a full matrix and one right side.
    fn solved(matrix: &Lower, right: &[f64]) -> Vec<f64> {
        let side = right.len();
        let at = |r: usize, c: usize| if r >= c { matrix[r][c] } else { matrix[c][r] };
        let mut rows: Vec<Vec<f64>> = (0..side)
            .map(|r| (0..side).map(|c| at(r, c)).chain([right[r]]).collect())
            .collect();
        for step in 0..side {
            let pivot = (step..side)
                .max_by(|&a, &b| rows[a][step].abs().total_cmp(&rows[b][step].abs()))
                .unwrap();
            rows.swap(step, pivot);
            for row in (0..side).filter(|&row| row != step) {
                let factor = rows[row][step] / rows[step][step];
                let from = rows[step].clone();
                for (value, from) in rows[row].iter_mut().zip(&from) {
                    *value -= factor * from;
                }
            }
        }
        (0..side).map(|k| rows[k][side] / rows[k][k]).collect()
    }

    #[test]
    fn the_factor_times_its_transpose_is_the_matrix_and_whitening_is_solving() {
        let mut random = ChaCha8Rng::seed_from_u64(7);
        for side in [1, 2, 3, 10, 57] {
            let matrix = matrix(side, &mut random);
            let factor = Cholesky::of(matrix.clone()).unwrap();
            for (values, row) in matrix.iter().zip(&factor.0) {
                for (value, column) in values.iter().zip(&factor.0) {
                    let product = dot(row, column);
                    assert!((product - value).abs() < 1e-12);
                }
            }
            // b' C^-1 b by both ways.
            let right: Vec<f64> = (0..side).map(|k| (k as f64).sin() + 0.5).collect();
            let white = factor.whitened(&right.iter().map(|&b| [b]).collect::<Vec<_>>());
            let ours: f64 = white.iter().map(|[w]| w * w).sum();
            let naive = dot(&right, &solved(&matrix, &right));
            assert!((ours - naive).abs() < 1e-8 * naive.abs(), "{ours} {naive}");
        }
    }

    #[test]
    fn what_is_not_positive_definite_has_no_factor() {
        assert!(Cholesky::of(vec![vec![1.0], vec![2.0, 1.0]]).is_none());
        assert!(Cholesky::of(vec![vec![0.0]]).is_none());
        assert!(Cholesky::of(vec![vec![f64::NAN]]).is_none());
        assert!(Cholesky::of(Vec::new()).is_some());
    }
}
