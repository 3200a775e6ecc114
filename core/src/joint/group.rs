//! Numbers of several knees together: first each knee by itself, then all of them.

use crate::math::sqrt;

/// A number over a group of knees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OverKnees {
    /// Mean of the knees' means; NaN without a knee.
    pub mean: f64,
    /// Standard deviation between the knees' means; NaN for fewer than two.
    pub deviation: f64,
    /// Knees that have the number.
    pub n: usize,
}

/// A number over knees, each with its films' numbers, NaN for a film that has none. A knee of many films counts as much as a knee of one:
/// films of one knee are no independent sample of knees.
#[must_use]
pub fn over_knees<'v>(knees: impl IntoIterator<Item = &'v [f64]>) -> OverKnees {
    let (mut n, mut mean, mut squares) = (0, 0.0, 0.0);
    for value in knees.into_iter().filter_map(mean_of) {
        n += 1;
        let off: f64 = value - mean;
        mean += off / n as f64;
        squares += off * (value - mean);
    }
    OverKnees {
        mean: if n > 0 { mean } else { f64::NAN },
        deviation: if n > 1 {
            sqrt(squares / (n - 1) as f64)
        } else {
            f64::NAN
        },
        n,
    }
}

/// The mean of what is known.
fn mean_of(values: &[f64]) -> Option<f64> {
    let known = || values.iter().filter(|value| value.is_finite());
    let count = known().count();
    (count > 0).then(|| known().sum::<f64>() / count as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Worked by hand: knees of 2, 4 (three films: 3, 4, 5) and 9; their mean is 5, their squares 9 + 1 + 16 over 2.
    #[test]
    fn a_knee_counts_once_however_many_films_it_has() {
        let knees: [&[f64]; 4] = [&[2.0], &[3.0, 4.0, 5.0], &[f64::NAN], &[9.0, f64::NAN]];
        let found = over_knees(knees);
        assert_eq!((found.mean, found.n), (5.0, 3));
        assert!((found.deviation - sqrt(13.0)).abs() < 1e-12);
        let films = [2.0, 3.0, 4.0, 5.0, 9.0];
        let pooled = over_knees(films.iter().map(core::slice::from_ref));
        assert!((pooled.mean - 4.6).abs() < 1e-12 && pooled.n == 5);
    }

    #[test]
    fn one_knee_has_no_spread_and_none_no_mean() {
        let one = over_knees([&[1.0, 3.0][..]]);
        assert_eq!((one.mean, one.n, one.deviation.is_nan()), (2.0, 1, true));
        let none = over_knees([&[f64::NAN][..], &[][..]]);
        assert!(none.mean.is_nan() && none.n == 0);
    }
}
