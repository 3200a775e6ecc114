//! Eigenvalues and eigenvectors of a symmetric 3 x 3 matrix.

use crate::math::{IDENTITY, Matrix3, sqrt, transpose};

/// Sweeps over the three off-diagonal pairs. Convergence is quadratic; six reach rounding.
const SWEEPS: usize = 8;

/// Eigenvalues, largest first, and the unit eigenvectors as the rows of a matrix. Reads the upper
/// triangle alone.
///
/// Jacobi's rotations: Golub and Van Loan, *Matrix Computations*, section 8.5.
#[must_use]
pub(crate) fn eigen_symmetric(matrix: &Matrix3) -> ([f64; 3], Matrix3) {
    let mut a = *matrix;
    let mut columns = IDENTITY;
    for _ in 0..SWEEPS {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            rotate(&mut a, &mut columns, p, q);
        }
    }
    let mut order = [0, 1, 2];
    order.sort_unstable_by(|&i, &j| a[j][j].total_cmp(&a[i][i]));
    let rows = transpose(&columns);
    (order.map(|k| a[k][k]), order.map(|k| rows[k]))
}

/// Turns in the plane of axes `p < q` such that `a[p][q]` becomes zero.
fn rotate(a: &mut Matrix3, columns: &mut Matrix3, p: usize, q: usize) {
    if a[p][q] == 0.0 {
        return;
    }
    let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
    let sign = if theta < 0.0 { -1.0 } else { 1.0 };
    // The smaller of the two angles; zero where theta is beyond what a float holds.
    let tangent = sign / (theta.abs() + sqrt(theta * theta + 1.0));
    let cosine = 1.0 / sqrt(tangent * tangent + 1.0);
    let sine = tangent * cosine;
    let change = tangent * a[p][q];
    a[p][p] -= change;
    a[q][q] += change;
    a[p][q] = 0.0;
    let r = 3 - p - q;
    let (rp, rq) = (upper(p, r), upper(q, r));
    let (first, second) = (a[rp.0][rp.1], a[rq.0][rq.1]);
    a[rp.0][rp.1] = cosine * first - sine * second;
    a[rq.0][rq.1] = sine * first + cosine * second;
    for row in columns {
        let (first, second) = (row[p], row[q]);
        row[p] = cosine * first - sine * second;
        row[q] = sine * first + cosine * second;
    }
}

/// Row and column of an entry in the upper triangle.
fn upper(i: usize, j: usize) -> (usize, usize) {
    (i.min(j), i.max(j))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{apply, dot, multiply};
    use crate::pose::rotation_zxy;
    use proptest::prelude::*;

    properties! {
        #[test]
        fn a_turned_diagonal_is_found_again(
            values in prop::array::uniform3(-10.0..10.0f64),
            z in -180.0..180.0f64, x in -90.0..90.0f64, y in -180.0..180.0f64
        ) {
            let turn = rotation_zxy(z, x, y);
            let mut diagonal = [[0.0; 3]; 3];
            for (k, value) in values.iter().enumerate() {
                diagonal[k][k] = *value;
            }
            let matrix = multiply(&multiply(&turn, &diagonal), &transpose(&turn));
            let (found, axes) = eigen_symmetric(&matrix);
            let mut sorted = values;
            sorted.sort_unstable_by(|a, b| b.total_cmp(a));
            for k in 0..3 {
                prop_assert!((found[k] - sorted[k]).abs() < 1e-12);
                let image = apply(&matrix, &axes[k]);
                for (image, axis) in image.iter().zip(axes[k]) {
                    prop_assert!((image - found[k] * axis).abs() < 1e-11);
                }
                for j in 0..3 {
                    let expected = if j == k { 1.0 } else { 0.0 };
                    prop_assert!((dot(&axes[j], &axes[k]) - expected).abs() < 1e-12);
                }
            }
        }
    }

    #[test]
    fn a_diagonal_is_only_sorted() {
        let (values, axes) = eigen_symmetric(&[[1.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 3.0]]);
        assert_eq!(values, [3.0, 3.0, 1.0]);
        assert_eq!(axes[2], [1.0, 0.0, 0.0]);
        let (zero, axes) = eigen_symmetric(&[[0.0; 3]; 3]);
        assert_eq!((zero, axes), ([0.0; 3], IDENTITY));
    }
}
