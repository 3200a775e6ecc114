//! Stationary Gaussian noise along a closed curve.

use rand::Rng;
use std::f64::consts::TAU;

use fluoropose::image::contour::Point;

use super::curve::Curve;

/// The noise's autocorrelation: `exp(-d^2 / (2 l^2))` of the way `d` along the curve, made cyclic
/// by adding up the ways round and divided by its value at 0. For a curve longer than some `l`
/// the difference to the plain formula is nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Correlation {
    /// `l`, pixels.
    pub length: f64,
}

/// Beyond this many correlation lengths nothing is left: exp(-8^2 / 2) is 1e-14.
const REACH: f64 = 8.0;

impl Correlation {
    /// Correlation of the noise at two places a way `distance` apart on a closed curve of the
    /// length `round`.
    pub fn at(&self, distance: f64, round: f64) -> f64 {
        let turns = (REACH * self.length / round).ceil();
        let short = distance - round * (distance / round).round();
        let sum = |way: f64| -> f64 {
            let of = |turn: f64| (way + turn * round) / self.length;
            (-turns as i64..=turns as i64)
                .map(|turn| of(turn as f64))
                .map(|t| libm::exp(-t * t / 2.0))
                .sum()
        };
        sum(short) / sum(0.0)
    }
}

/// One drawing of the noise on a closed curve: a sum of waves that fit into it a whole number of
/// times, with independent Gaussian amplitudes of the variances of the spectrum. Exact at every
/// place, not only on a grid (Shinozuka and Deodatis, Appl. Mech. Rev. 44, 1991).
pub struct Waves {
    amplitudes: Vec<[f64; 2]>,
    round: f64,
}

impl Waves {
    /// Draws noise of the standard deviation `deviation` for a curve of the length `round`.
    pub fn draw(
        deviation: f64,
        correlation: Correlation,
        round: f64,
        random: &mut impl Rng,
    ) -> Self {
        let step = TAU * correlation.length / round;
        let count = (REACH / step).ceil() as usize;
        // Both directions of a wave count; the constant has one.
        let share = |wave: usize| {
            let t = step * wave as f64;
            libm::exp(-t * t / 2.0) * if wave == 0 { 1.0 } else { 2.0 }
        };
        let sum: f64 = (0..=count).map(share).sum();
        let amplitudes = (0..=count)
            .map(|wave| deviation * libm::sqrt(share(wave) / sum))
            .map(|size| [size * normal(random), size * normal(random)])
            .collect();
        Self { amplitudes, round }
    }

    /// The noise at a way along the curve.
    pub fn at(&self, along: f64) -> f64 {
        let (sine, cosine) = libm::sincos(TAU * along / self.round);
        // Each wave's phase is one step further: a product instead of a sine.
        let (mut s, mut c, mut value) = (0.0, 1.0, 0.0);
        for [cosine_part, sine_part] in &self.amplitudes {
            value += cosine_part * c + sine_part * s;
            (s, c) = (s * cosine + c * sine, c * cosine - s * sine);
        }
        value
    }

    /// The vertices of a curve, each moved along its normal by the noise there.
    pub fn displaced(&self, curve: &Curve) -> Vec<Point> {
        let vertices = curve.points.iter().zip(&curve.normals).zip(&curve.along);
        vertices
            .map(|((point, normal), &along)| {
                let noise = self.at(along);
                Point::new(
                    point.column + noise * normal[0],
                    point.row + noise * normal[1],
                )
            })
            .collect()
    }
}

/// A normally distributed number (Box and Muller).
fn normal(random: &mut impl Rng) -> f64 {
    let unit = |bits: u32| (f64::from(bits) + 0.5) / 4_294_967_296.0;
    let (radius, angle) = (unit(random.next_u32()), unit(random.next_u32()));
    libm::sqrt(-2.0 * libm::log(radius)) * libm::cos(TAU * angle)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    /// Products of the noise at two places, averaged over many drawings.
    fn covariance(round: f64, length: f64, ways: &[f64]) -> Vec<f64> {
        let drawings = 4000;
        let mut random = ChaCha8Rng::seed_from_u64(3);
        let mut sums = vec![0.0; ways.len()];
        for _ in 0..drawings {
            let waves = Waves::draw(1.5, Correlation { length }, round, &mut random);
            let first = waves.at(0.3 * round);
            for (sum, way) in sums.iter_mut().zip(ways) {
                *sum += first * waves.at(0.3 * round + way);
            }
        }
        sums.iter().map(|sum| sum / f64::from(drawings)).collect()
    }

    #[test]
    fn the_noise_has_the_deviation_and_the_correlation_that_were_asked_for() {
        let ways = [0.0, 5.0, 10.0, 20.0, 40.0, -10.0, 800.0];
        let found = covariance(800.0, 10.0, &ways);
        let shape = |t: f64| 2.25 * libm::exp(-t * t / 2.0);
        let wanted = [0.0, 0.5, 1.0, 2.0, 4.0, 1.0, 0.0].map(shape);
        for (found, wanted) in found.iter().zip(wanted) {
            // Four standard errors of a product's mean: at most 4 * 2.25 * sqrt(2 / 4000).
            assert!((found - wanted).abs() < 0.2, "{found} {wanted}");
        }
    }

    #[test]
    fn on_a_short_curve_the_correlation_is_cyclic() {
        let correlation = Correlation { length: 10.0 };
        let ways = [0.0, 8.0, 15.0, 22.0];
        for (way, found) in ways.iter().zip(covariance(30.0, 10.0, &ways)) {
            let wanted = 2.25 * correlation.at(*way, 30.0);
            assert!((found - wanted).abs() < 0.2, "{found} {wanted}");
        }
        assert!((correlation.at(8.0, 30.0) - correlation.at(22.0, 30.0)).abs() < 1e-12);
        assert!((correlation.at(10.0, 900.0) - libm::exp(-0.5)).abs() < 1e-12);
        assert_eq!(correlation.at(0.0, 30.0), 1.0);
    }
}
