//! A smooth function through a few values at whole-number or other knots.

/// Knots `(x, y)` in rising order of `x`, joined by a cubic with continuous slope.
pub(crate) struct Table(pub(crate) &'static [(f64, f64)]);

impl Table {
    /// The value at `x`; beyond the first and last knot the end value.
    pub(crate) fn at(&self, x: f64) -> f64 {
        let knots = self.0;
        let last = knots.len() - 1;
        if x <= knots[0].0 {
            return knots[0].1;
        }
        if x >= knots[last].0 {
            return knots[last].1;
        }
        let k = (0..last).find(|&k| x < knots[k + 1].0).unwrap_or(last - 1);
        let width = knots[k + 1].0 - knots[k].0;
        let t = (x - knots[k].0) / width;
        let (t2, t3) = (t * t, t * t * t);
        (2.0 * t3 - 3.0 * t2 + 1.0) * knots[k].1
            + (t3 - 2.0 * t2 + t) * width * self.slope(k)
            + (3.0 * t2 - 2.0 * t3) * knots[k + 1].1
            + (t3 - t2) * width * self.slope(k + 1)
    }

    /// Slope at a knot: of the chord between its neighbours, zero at both ends.
    fn slope(&self, k: usize) -> f64 {
        if k == 0 || k + 1 == self.0.len() {
            return 0.0;
        }
        let ((x0, y0), (x1, y1)) = (self.0[k - 1], self.0[k + 1]);
        (y1 - y0) / (x1 - x0)
    }
}

/// Rises from 0 at `x <= 0` to 1 at `x >= 1` without a kink.
pub(crate) fn smooth_step(x: f64) -> f64 {
    let t = x.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Linear from `a` at 0 to `b` at 1.
pub(crate) fn mix(a: f64, b: f64, t: f64) -> f64 {
    a + (b - a) * t
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn table_meets_its_knots_and_holds_the_ends() {
        let table = Table(&[(0.0, 1.0), (1.0, 3.0), (2.5, 2.0)]);
        for (x, y) in [(-1.0, 1.0), (0.0, 1.0), (1.0, 3.0), (2.5, 2.0), (9.0, 2.0)] {
            assert!((table.at(x) - y).abs() < 1e-12, "at {x}");
        }
    }

    #[test]
    fn table_has_no_jump() {
        let table = Table(&[(0.0, 1.0), (1.0, 3.0), (2.5, 2.0)]);
        for k in 0..2500 {
            let x = k as f64 / 1000.0;
            assert!((table.at(x + 1e-3) - table.at(x)).abs() < 5e-3);
        }
    }
}
