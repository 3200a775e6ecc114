//! A picture of real numbers, and blurring it.

use rayon::prelude::*;

/// Values row by row.
#[derive(Clone)]
pub(super) struct Plane {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) values: Vec<f64>,
}

impl Plane {
    /// Convolved with a Gaussian of this standard deviation in pixels; the border is continued.
    pub(super) fn blurred(&self, sigma: f64) -> Self {
        if sigma <= 0.0 {
            return self.clone();
        }
        let kernel = kernel(sigma);
        let once = self.convolved_along_rows(&kernel).transposed();
        once.convolved_along_rows(&kernel).transposed()
    }

    /// Multiplied, value by value.
    pub(super) fn multiply(&mut self, other: &Self) {
        let pairs = self.values.iter_mut().zip(&other.values);
        pairs.for_each(|(value, other)| *value *= other);
    }

    /// Added, value by value.
    pub(super) fn add(&mut self, other: &Self) {
        let pairs = self.values.iter_mut().zip(&other.values);
        pairs.for_each(|(value, other)| *value += other);
    }

    /// Every value times a factor.
    pub(super) fn times(mut self, factor: f64) -> Self {
        self.values.iter_mut().for_each(|value| *value *= factor);
        self
    }

    /// Every value to a power.
    pub(super) fn power(&self, exponent: f64) -> Self {
        let values = self.values.par_iter();
        Self {
            values: values.map(|&value| libm::pow(value, exponent)).collect(),
            ..*self
        }
    }

    /// The mean of blocks of `factor` x `factor` values; what is left over at the far borders is dropped.
    pub(super) fn shrunk(&self, factor: usize) -> Self {
        let (width, height) = (self.width / factor, self.height / factor);
        let block = |index: usize| {
            let (row, column) = (index / width * factor, index % width * factor);
            let lines = (row..row + factor).map(|line| line * self.width + column);
            let sum: f64 = lines
                .flat_map(|from| &self.values[from..from + factor])
                .sum();
            sum / (factor * factor) as f64
        };
        Self {
            width,
            height,
            values: (0..width * height).map(block).collect(),
        }
    }

    /// The value at a place in continuous coordinates of this picture, bilinear between centres.
    pub(super) fn sampled(&self, column: f64, row: f64) -> f64 {
        let split = |place: f64, count: usize| {
            let from_centre = (place - 0.5).clamp(0.0, (count - 1) as f64);
            let low = (from_centre as usize).min(count.saturating_sub(2));
            (low, (low + 1).min(count - 1), from_centre - low as f64)
        };
        let (left, right, u) = split(column, self.width);
        let (top, bottom, v) = split(row, self.height);
        let at = |row: usize, column: usize| self.values[row * self.width + column];
        let above = at(top, left) * (1.0 - u) + at(top, right) * u;
        let below = at(bottom, left) * (1.0 - u) + at(bottom, right) * u;
        above * (1.0 - v) + below * v
    }

    fn convolved_along_rows(&self, kernel: &[f64]) -> Self {
        let reach = kernel.len() / 2;
        let mut values = vec![0.0; self.values.len()];
        values
            .par_chunks_mut(self.width)
            .zip(self.values.par_chunks(self.width))
            .for_each(|(out, line)| {
                for (column, value) in out.iter_mut().enumerate() {
                    let place = |k: usize| (column + k).saturating_sub(reach).min(line.len() - 1);
                    *value = kernel
                        .iter()
                        .enumerate()
                        .map(|(k, weight)| weight * line[place(k)])
                        .sum();
                }
            });
        Self { values, ..*self }
    }

    fn transposed(&self) -> Self {
        let (width, height) = (self.height, self.width);
        let mut values = vec![0.0; self.values.len()];
        values
            .par_chunks_mut(width)
            .enumerate()
            .for_each(|(row, out)| {
                for (column, value) in out.iter_mut().enumerate() {
                    *value = self.values[column * self.width + row];
                }
            });
        Self {
            width,
            height,
            values,
        }
    }
}

fn kernel(sigma: f64) -> Vec<f64> {
    let reach = (3.5 * sigma + 0.5) as i64;
    let weights: Vec<f64> = (-reach..=reach)
        .map(|k| libm::exp(-0.5 * (k as f64 / sigma) * (k as f64 / sigma)))
        .collect();
    let sum: f64 = weights.iter().sum();
    weights.iter().map(|weight| weight / sum).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point() -> Plane {
        let mut values = vec![0.0; 41 * 31];
        values[15 * 41 + 20] = 1.0;
        Plane {
            width: 41,
            height: 31,
            values,
        }
    }

    #[test]
    fn blur_keeps_the_sum_and_spreads_by_its_sigma_in_both_directions() {
        let blurred = point().blurred(2.0);
        let sum: f64 = blurred.values.iter().sum();
        assert!((sum - 1.0).abs() < 1e-9);
        let spread = |along: fn(usize) -> f64| -> f64 {
            blurred
                .values
                .iter()
                .enumerate()
                .map(|(k, v)| v * along(k) * along(k))
                .sum()
        };
        let across = spread(|k| (k % 41) as f64 - 20.0);
        let down = spread(|k| (k / 41) as f64 - 15.0);
        assert!(
            (across - 4.0).abs() < 0.1 && (down - 4.0).abs() < 0.1,
            "{across} {down}"
        );
    }

    #[test]
    fn a_ramp_survives_shrinking_and_sampling() {
        let values = (0..64 * 32).map(|k| (k % 64) as f64 + 0.5).collect();
        let small = Plane {
            width: 64,
            height: 32,
            values,
        }
        .shrunk(8);
        for column in [6.0, 20.0, 33.3, 58.0] {
            assert!((small.sampled(column / 8.0, 2.0) - column).abs() < 1e-9);
        }
    }
}
