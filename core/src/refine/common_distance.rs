//! What residuals say of a distance that lies between all edges of a film and the outline.
//!
//! Nobody fits it, because depth looks nearly like it. As a seventh parameter it would have the information that the pose's six leave of it (Frisch and
//! Waugh, *Econometrica* 1, 1933), `h = sum(l c c) - b' A^-1 b` with `A = sum(l J J')` and `b = sum(l J c)`, and would be seen as
//! `g = sum(l c psi) - b' A^-1 sum(l J psi)`. Let `k` be the mean of `psi'`, by which what is seen of an error is less than the error (Huber, *Robust
//! Statistics*, 6.3), and `N` the variance of `psi`, times the length of outline that errs alike. Then a distance that is normal with mean 0 and variance 1 before
//! anything is seen, in units of `c`, has the variance `v = N / (N + k k h)` and the mean `m = k g / (N + k k h)` afterwards. A pose that was found
//! without it is off by it as a whole, in the mean square by `v + m m`.

use crate::math::sqrt;
use crate::pose::covariance::Matrix6;

/// Sums over samples, all of which the distance moves alike.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct CommonDistance {
    /// `sum(l c c)`
    own: f64,
    /// `sum(l c psi)`
    seen: f64,
    /// `sum(l J psi)`
    pulled: [f64; 6],
}

/// How residuals err.
#[derive(Clone, Copy, Debug)]
pub(super) struct Errors {
    /// `N`: variance of `psi`, times the length of outline that errs alike; square pixels times pixels.
    pub noise: f64,
    /// `k`: the mean of `psi'`.
    pub curvature: f64,
}

impl CommonDistance {
    /// Adds a sample of `length` pixels whose residual pulls by `psi`, and which the usual distance would move by `common` pixels.
    pub(super) fn add(&mut self, length: f64, jacobian: &[f32; 6], common: f64, psi: f64) {
        self.own += length * common * common;
        self.seen += length * common * psi;
        for (sum, &a) in self.pulled.iter_mut().zip(jacobian) {
            *sum += length * f64::from(a) * psi;
        }
    }

    /// Root mean square of the distance by what was seen, in usual ones. `answer` is `A^-1 b`, `pull` is `b`.
    pub(super) fn left(&self, answer: &[f64; 6], pull: &[f64; 6], errors: Errors) -> f64 {
        let Errors { noise, curvature } = errors;
        let held = curvature * curvature * (self.own - dot(pull, answer)).max(0.0);
        let variance = noise / (noise + held);
        let seen = self.seen - dot(answer, &self.pulled);
        let mean = curvature * seen / (noise + held);
        match variance.is_finite() && mean.is_finite() {
            true => sqrt(variance + mean * mean),
            false => 1.0,
        }
    }
}

/// A matrix times a vector.
pub(super) fn times(matrix: &Matrix6, vector: &[f64; 6]) -> [f64; 6] {
    matrix.map(|row| dot(&row, vector))
}

fn dot(a: &[f64; 6], b: &[f64; 6]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::inverse_spd;
    use proptest::prelude::*;
    use std::vec::Vec;

    /// Six waves along an outline, and what is common to all of it.
    fn row(at: usize) -> [f32; 7] {
        let along = at as f32 / 20.0;
        let wave = |k: f32| libm::sinf(k * along + k) + 0.3;
        [
            wave(1.0),
            wave(1.7),
            wave(2.9),
            wave(3.3),
            wave(4.1),
            wave(5.3),
            0.1,
        ]
    }

    /// The distance's mean and variance from all seven parameters together, the pose free and the distance as usual, by Gauss's elimination.
    fn by_seven(residuals: &[f64], noise: f64) -> (f64, f64) {
        let mut system = [[0.0f64; 9]; 7];
        for (at, residual) in residuals.iter().enumerate() {
            let row = row(at).map(f64::from);
            for (equation, a) in system.iter_mut().zip(&row) {
                (0..7).for_each(|k| equation[k] += a * row[k]);
                equation[7] += a * residual;
            }
        }
        system[6][6] += noise;
        // The seventh column of the inverse beside it.
        system[6][8] = 1.0;
        for pivot in 0..7 {
            let of = system[pivot].map(|value| value / system[pivot][pivot]);
            system[pivot] = of;
            for (other, equation) in system.iter_mut().enumerate() {
                let factor = equation[pivot];
                if other != pivot {
                    (0..9).for_each(|k| equation[k] -= factor * of[k]);
                }
            }
        }
        (system[6][7], noise * system[6][8])
    }

    properties! {
        #[test]
        fn the_distance_is_that_of_a_fit_of_seven_parameters(
            residuals in proptest::collection::vec(-0.5f64..0.5, 40..200), noise in 0.001f64..0.1, common in -0.3f64..0.3, curvature in 0.2f64..1.0,
        ) {
            let residuals: Vec<f64> = residuals.iter().map(|residual| residual + common).collect();
            let (mut told, mut information, mut pull) = (CommonDistance::default(), [[0.0; 6]; 6], [0.0; 6]);
            for (at, &residual) in residuals.iter().enumerate() {
                let [a, b, c, d, e, f, usual] = row(at);
                let jacobian = [a, b, c, d, e, f];
                told.add(1.0, &jacobian, usual.into(), curvature * residual);
                for (row, a) in jacobian.map(f64::from).into_iter().enumerate() {
                    (0..6).for_each(|k| information[row][k] += a * f64::from(jacobian[k]));
                    pull[row] += a * f64::from(usual);
                }
            }
            let answer = times(&inverse_spd(&information).expect("six waves"), &pull);
            // What is seen of errors is less than they are, and so is their noise.
            let (mean, variance) = by_seven(&residuals, noise);
            let wanted = (variance + mean * mean).sqrt();
            let seen = Errors { noise: curvature * curvature * noise, curvature };
            prop_assert!((told.left(&answer, &pull, seen) / wanted - 1.0).abs() < 1e-6);
        }
    }

    #[test]
    fn what_residuals_do_not_show_is_as_usual() {
        let with = |noise| Errors {
            noise,
            curvature: 1.0,
        };
        let mut told = CommonDistance::default();
        assert_eq!(
            told.left(&[0.0; 6], &[0.0; 6], with(0.0)),
            1.0,
            "nothing was seen"
        );
        // All of it is what the first parameter does.
        (0..50).for_each(|_| told.add(1.0, &[1.0, 0.0, 0.0, 0.0, 0.0, 0.0], 0.1, 0.0));
        let (answer, pull) = (
            [0.1, 0.0, 0.0, 0.0, 0.0, 0.0],
            [5.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        );
        assert!((told.left(&answer, &pull, with(0.01)) - 1.0).abs() < 1e-12);
        // None of it: fifty pixels of length that do not show a usual distance exclude it.
        assert!(told.left(&[0.0; 6], &[0.0; 6], with(0.01)) < 0.15);
    }
}
