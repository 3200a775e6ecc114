//! Normal equations of the constants, and how their slope varies between stretches of outline.

use super::unknowns::{Matrix, UNKNOWNS, Vector};
use crate::film::fit::Residuals;
use crate::math::inverse_spd;

/// What was found at some constants.
pub(super) struct Sums {
    pub(super) normal: Matrix,
    pub(super) right: Vector,
    /// Covariance of the right side.
    pub(super) spread: Matrix,
    pub(super) cost: f64,
    pub(super) squares: f64,
    pub(super) count: usize,
}

impl Sums {
    /// Of estimates: a sandwich of what is known about the minimum and how its slope varies between stretches of outline.
    pub(super) fn covariance(&self) -> Option<Matrix> {
        let bread = inverse_spd(&self.normal)?;
        let mut product = [[0.0; UNKNOWNS]; UNKNOWNS];
        for (row, out) in product.iter_mut().enumerate() {
            for (column, value) in out.iter_mut().enumerate() {
                for a in 0..UNKNOWNS {
                    for b in 0..UNKNOWNS {
                        *value += bread[row][a] * self.spread[a][b] * bread[b][column];
                    }
                }
            }
        }
        Some(product)
    }

    /// Leaves an unknown where it is.
    pub(super) fn hold(&mut self, unknown: usize) {
        for matrix in [&mut self.normal, &mut self.spread] {
            matrix[unknown] = [0.0; UNKNOWNS];
            matrix.iter_mut().for_each(|row| row[unknown] = 0.0);
        }
        self.right[unknown] = 0.0;
        self.normal[unknown][unknown] = 1.0;
    }

    /// Adds a stretch of profiles that err alike.
    pub(super) fn close(&mut self, group: &mut Vector) {
        for (row, &a) in group.iter().enumerate() {
            for (sum, &b) in self.spread[row].iter_mut().zip(group.iter()) {
                *sum += a * b;
            }
        }
        *group = [0.0; UNKNOWNS];
    }
}

pub(super) fn product(a: &Residuals, b: &Residuals) -> f64 {
    f64::from(a.iter().zip(b).map(|(a, b)| a * b).sum::<f32>())
}
