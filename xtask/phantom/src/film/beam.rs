//! The beam's spectrum: lines that metal and tissue attenuate differently, so that what passes grows harder.
//!
//! Intensity is the sum over lines of what passes of each. That is no closed form of the path, and on purpose: the core's
//! film model has one, and is measured against this.

use libm::{exp, log, pow, sqrt};

/// Places of the lines, in standard deviations of the logarithm of the attenuation.
const PLACES: [f64; 7] = [-3.3, -2.2, -1.1, 0.0, 1.1, 2.2, 3.3];
/// Tissue's attenuation varies over the spectrum by this power of metal's.
const TISSUE: f64 = 0.35;

/// A line of the spectrum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Line {
    /// Part of the beam's intensity.
    pub(super) weight: f64,
    /// Metal's attenuation as a multiple of its mean.
    pub(super) metal: f64,
    /// Tissue's.
    pub(super) tissue: f64,
}

/// The lines of a beam over which metal's attenuation has this relative variance; one line where there is none.
pub(super) fn lines(variance: f64) -> Vec<Line> {
    if variance <= 0.0 {
        return vec![Line {
            weight: 1.0,
            metal: 1.0,
            tissue: 1.0,
        }];
    }
    let spread = sqrt(log(1.0 + variance));
    let weights = PLACES.map(|place| exp(-0.5 * place * place));
    let whole: f64 = weights.iter().sum();
    let factors = PLACES.map(|place| exp(spread * place));
    let mean = |factors: &[f64; 7]| -> f64 {
        let sum: f64 = factors.iter().zip(weights).map(|(f, w)| f * w).sum();
        sum / whole
    };
    let tissues = factors.map(|factor| pow(factor, TISSUE));
    let (metal, tissue) = (mean(&factors), mean(&tissues));
    (0..PLACES.len())
        .map(|k| Line {
            weight: weights[k] / whole,
            metal: factors[k] / metal,
            tissue: tissues[k] / tissue,
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_beam_has_the_variance_asked_for_and_grows_harder() {
        assert_eq!(lines(0.0).len(), 1);
        let beam = lines(0.25);
        let sum = |of: &dyn Fn(&Line) -> f64| -> f64 {
            beam.iter().map(|line| line.weight * of(line)).sum()
        };
        assert!((sum(&|_| 1.0) - 1.0).abs() < 1e-12);
        assert!((sum(&|line| line.metal) - 1.0).abs() < 1e-12);
        assert!((sum(&|line| line.tissue) - 1.0).abs() < 1e-12);
        let variance = sum(&|line| line.metal * line.metal) - 1.0;
        assert!((variance - 0.25).abs() < 0.03, "{variance}");
        // Attenuation for each mm of titanium falls with the path.
        let slope = |path: f64| -log(sum(&|line| exp(-0.2 * line.metal * path))) / path;
        assert!((slope(0.01) - 0.2).abs() < 1e-3);
        assert!(slope(10.0) < 0.18 && slope(20.0) < slope(10.0));
    }
}
