//! Polynomials of two variables, their fit by least squares, and the residual of each point in a fit without it.

use fluoropose::math::{inverse_spd, sqrt};

/// Number of terms of a polynomial of order [`MAX_ORDER`].
pub const TERMS: usize = 21;
/// The highest order, that is the greatest sum of both exponents.
pub const MAX_ORDER: u8 = 5;

/// Number of terms of a polynomial of an order. The terms of a lower order are the first terms of a higher one.
#[must_use]
pub fn terms_of(order: u8) -> usize {
    let order = usize::from(order.min(MAX_ORDER));
    (order + 1) * (order + 2) / 2
}

/// All monomials at a point: 1, x, y, x^2, x y, y^2, x^3 and so on.
#[must_use]
pub fn monomials(x: f64, y: f64) -> [f64; TERMS] {
    let mut out = [1.0; TERMS];
    let mut first = 0;
    for degree in 1..=usize::from(MAX_ORDER) {
        let next = first + degree;
        for k in 0..degree {
            out[next + k] = out[first + k] * x;
        }
        out[next + degree] = out[next - 1] * y;
        first = next;
    }
    out
}

/// The derivatives of the monomials by x and by y.
#[must_use]
pub fn slopes(x: f64, y: f64) -> [[f64; TERMS]; 2] {
    let values = monomials(x, y);
    let mut out = [[0.0; TERMS]; 2];
    let mut first = 0;
    for degree in 1..=usize::from(MAX_ORDER) {
        let next = first + degree;
        for k in 0..degree {
            // x^(degree - k) y^k, and x^(degree - 1 - k) y^(k + 1).
            out[0][next + k] = (degree - k) as f64 * values[first + k];
            out[1][next + k + 1] = (k + 1) as f64 * values[first + k];
        }
        first = next;
    }
    out
}

/// The scalar product of coefficients and monomials.
#[must_use]
pub fn sum(coefficients: &[f64; TERMS], terms: &[f64; TERMS]) -> f64 {
    coefficients.iter().zip(terms).map(|(a, b)| a * b).sum()
}

/// The normal equations of a least-squares fit of two values over the same points.
#[derive(Clone)]
pub struct Fit {
    order: u8,
    normal: [[f64; TERMS]; TERMS],
    sides: [[f64; TERMS]; 2],
}

/// A solved fit.
#[derive(Clone)]
pub struct Solved {
    /// Coefficients of the first and of the second value, zero beyond the order.
    pub coefficients: [[f64; TERMS]; 2],
    inverse: [[f64; TERMS]; TERMS],
    terms: usize,
}

impl Fit {
    /// A fit of an order, at most [`MAX_ORDER`], without points.
    #[must_use]
    pub fn new(order: u8) -> Self {
        Self {
            order: order.min(MAX_ORDER),
            normal: [[0.0; TERMS]; TERMS],
            sides: [[0.0; TERMS]; 2],
        }
    }

    /// Adds a point and the two values there.
    pub fn add(&mut self, x: f64, y: f64, values: [f64; 2]) {
        let terms = monomials(x, y);
        let count = terms_of(self.order);
        for (row, a) in self.normal.iter_mut().zip(&terms).take(count) {
            for (sum, b) in row.iter_mut().zip(&terms).take(count) {
                *sum += a * b;
            }
        }
        for (side, value) in self.sides.iter_mut().zip(values) {
            for (sum, a) in side.iter_mut().zip(&terms).take(count) {
                *sum += a * value;
            }
        }
    }

    /// The least-squares coefficients; `None` where the points do not determine them.
    #[must_use]
    pub fn solve(&self) -> Option<Solved> {
        let terms = terms_of(self.order);
        let mut normal = self.normal;
        // A unit diagonal keeps the terms beyond the order at zero, as their right sides are zero.
        for (k, row) in normal.iter_mut().enumerate().skip(terms) {
            row[k] = 1.0;
        }
        let largest = (0..terms).map(|k| normal[k][k]).fold(0.0, f64::max);
        let inverse = inverse_spd(&normal)?;
        // If the variance of a term is this many times that of the best determined one, rounding determines it, not the points.
        let worst = (0..terms).map(|k| inverse[k][k]).fold(0.0, f64::max);
        if worst * largest >= 1e11 || worst.is_nan() {
            return None;
        }
        let solve = |side: &[f64; TERMS]| core::array::from_fn(|k| sum(&inverse[k], side));
        Some(Solved {
            coefficients: [solve(&self.sides[0]), solve(&self.sides[1])],
            inverse,
            terms,
        })
    }
}

impl Solved {
    /// Both values at a point.
    #[must_use]
    pub fn at(&self, x: f64, y: f64) -> [f64; 2] {
        let terms = monomials(x, y);
        [
            sum(&self.coefficients[0], &terms),
            sum(&self.coefficients[1], &terms),
        ]
    }

    /// 1 minus the leverage of a point, 0 to 1. The residual of a point divided by it is the residual of the point in a fit
    /// without it (Allen, *The relationship between variable selection and data augmentation and a method for prediction*,
    /// Technometrics 16, 1974: PRESS, exact for linear least squares).
    #[must_use]
    pub fn one_minus_leverage(&self, x: f64, y: f64) -> f64 {
        let terms = monomials(x, y);
        let rows = self.inverse.iter().zip(&terms).take(self.terms);
        let leverage: f64 = rows
            .map(|(row, a)| {
                let inner: f64 = row
                    .iter()
                    .zip(&terms)
                    .take(self.terms)
                    .map(|(v, b)| v * b)
                    .sum();
                a * inner
            })
            .sum();
        (1.0 - leverage).clamp(1e-9, 1.0)
    }
}

/// Square root of the mean of squares; 0 for none.
pub(crate) fn root_mean_square(squares: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = squares.fold((0.0, 0usize), |(sum, count), value| {
        (sum + value, count + 1)
    });
    sqrt(sum / count.max(1) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn monomials_are_in_order_and_slopes_are_theirs() {
        let (x, y) = (0.7, -0.4);
        let values = monomials(x, y);
        let mut k = 0;
        for degree in 0..=5 {
            for power in 0..=degree {
                let expected = f64::powi(x, degree - power) * f64::powi(y, power);
                assert!((values[k] - expected).abs() < 1e-15, "term {k}");
                k += 1;
            }
        }
        assert_eq!(k, TERMS);
        assert_eq!([1, 2, 3, 4, 5].map(terms_of), [3, 6, 10, 15, 21]);
        let step = 1e-6;
        let [by_x, by_y] = slopes(x, y);
        for k in 0..TERMS {
            let right = (monomials(x + step, y)[k] - monomials(x - step, y)[k]) / (2.0 * step);
            let down = (monomials(x, y + step)[k] - monomials(x, y - step)[k]) / (2.0 * step);
            assert!(
                (by_x[k] - right).abs() < 1e-9 && (by_y[k] - down).abs() < 1e-9,
                "term {k}"
            );
        }
    }

    fn points() -> impl Iterator<Item = (f64, f64)> {
        (0..64).map(|k| {
            (
                f64::from(k % 8) / 4.0 - 0.875,
                f64::from(k / 8) / 4.0 - 0.875,
            )
        })
    }

    #[test]
    fn a_polynomial_is_recovered() {
        let truth: [f64; TERMS] = core::array::from_fn(|k| 1.0 / (k as f64 + 2.0));
        let mut fit = Fit::new(5);
        for (x, y) in points() {
            let value = sum(&truth, &monomials(x, y));
            fit.add(x, y, [value, -value]);
        }
        let solved = fit.solve().expect("determined");
        for (k, value) in truth.iter().enumerate() {
            let [first, second] = solved.coefficients.map(|all| all[k]);
            assert!((first - value).abs() < 1e-9, "term {k}");
            assert!((second + value).abs() < 1e-9, "term {k}");
        }
    }

    #[test]
    fn residuals_divided_by_one_minus_leverage_are_those_of_a_fit_without_the_point() {
        let noise = |k: usize| ((k * 7919) % 101) as f64 / 101.0;
        let all = || points().enumerate().map(|(k, (x, y))| (x, y, noise(k)));
        let mut fit = Fit::new(3);
        all().for_each(|(x, y, v)| fit.add(x, y, [v, 0.0]));
        let whole = fit.solve().expect("determined");
        for (skipped, (x, y, v)) in all().enumerate() {
            let mut without = Fit::new(3);
            for (k, (x, y, v)) in all().enumerate() {
                if k != skipped {
                    without.add(x, y, [v, 0.0]);
                }
            }
            let left_out = v - without.solve().expect("determined").at(x, y)[0];
            let formula = (v - whole.at(x, y)[0]) / whole.one_minus_leverage(x, y);
            assert!((left_out - formula).abs() < 1e-9);
        }
    }

    #[test]
    fn points_on_a_line_determine_nothing() {
        let mut fit = Fit::new(3);
        for k in 0..50 {
            let x = f64::from(k) / 50.0;
            fit.add(x, 2.0 * x, [x, x]);
        }
        assert!(fit.solve().is_none());
        assert!(Fit::new(3).solve().is_none());
    }
}
