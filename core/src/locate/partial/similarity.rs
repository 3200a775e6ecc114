//! Similarity transforms of the plane: a turn, a scale, a shift.

use crate::math::{atan2, sqrt};

/// `p -> factor * p + offset`, points as complex numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Similarity {
    pub(super) factor: [f64; 2],
    pub(super) offset: [f64; 2],
}

/// Product of two complex numbers.
pub(super) fn times(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

impl Similarity {
    /// Lengths grow by this.
    pub(super) fn scale(&self) -> f64 {
        let [a, b] = self.factor;
        sqrt(a * a + b * b)
    }

    /// Turn counter-clockwise, radians.
    pub(super) fn angle(&self) -> f64 {
        atan2(self.factor[1], self.factor[0])
    }
}
