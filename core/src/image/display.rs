//! How intensities were shown as grey values, and back.
//!
//! A film may be shown linearly, logarithmically or by anything in between, and which is rarely written in the file. One
//! number is enough to undo what bends an edge: `J(D) = (exp(k D) - 1) / k` is proportional to the intensity, but for a
//! constant, where `D = a + ln(I) / k`, and is `D` itself for `k = 0`.

use crate::math::round;

/// The curve that makes grey values proportional to intensity again, up to a factor and a constant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DisplayCurve {
    curvature: f64,
    sign: f64,
}

impl DisplayCurve {
    /// Grey values as they are: the display of a detector that was shown linearly.
    pub const LINEAR: Self = Self {
        curvature: 0.0,
        sign: 1.0,
    };

    /// The curve of `curvature`, one divided by grey values; 0 is linear, and a display with `g` grey values for each factor
    /// of e has `1 / g`. Where the picture is `inverted`, what absorbs is bright.
    #[must_use]
    pub fn new(curvature: f64, inverted: bool) -> Self {
        Self {
            curvature,
            sign: if inverted { -1.0 } else { 1.0 },
        }
    }

    /// What is proportional to the intensity, up to a constant, of a grey value.
    #[must_use]
    #[inline]
    pub fn linear(&self, grey: f64) -> f64 {
        let grey = self.sign * grey;
        if self.curvature == 0.0 {
            return grey;
        }
        (exp_quick(self.curvature * grey) - 1.0) / self.curvature
    }

    /// The grey value of a picture that is not inverted.
    #[must_use]
    pub fn upright(&self, grey: f64) -> f64 {
        self.sign * grey
    }

    /// Whether nothing is to be undone but an inversion.
    #[must_use]
    pub fn is_straight(&self) -> bool {
        self.curvature == 0.0
    }
}

/// A display curve made ready for many pixels: what it makes of the grey values of a byte is kept, and by how much larger intensities are for each
/// 256 grey values more, so that pixels of 16 bits cost no exponential each.
#[derive(Clone, Copy, Debug)]
pub struct QuickCurve {
    curve: DisplayCurve,
    bytes: [f64; 256],
    factors: [f64; 256],
    /// One divided by the curvature: a division for each pixel takes longer.
    inverse: f64,
}

impl From<DisplayCurve> for QuickCurve {
    fn from(curve: DisplayCurve) -> Self {
        let step = 256.0 * curve.curvature * curve.sign;
        Self {
            curve,
            bytes: core::array::from_fn(|grey| curve.linear(grey as f64)),
            factors: core::array::from_fn(|high| exp_quick(step * high as f64)),
            inverse: 1.0 / curve.curvature,
        }
    }
}

impl QuickCurve {
    /// [`DisplayCurve::linear`] of a pixel.
    #[must_use]
    #[inline]
    pub fn linear(&self, grey: u32) -> f64 {
        match self.bytes.get(grey as usize) {
            Some(&linear) => linear,
            None => self.of_more(grey),
        }
    }

    /// The same of more than a byte: `exp(k (256 h + l)) - 1` is `exp(256 k h) (exp(k l) - 1) + exp(256 k h) - 1`.
    #[inline]
    fn of_more(&self, grey: u32) -> f64 {
        let (high, low) = ((grey >> 8) as usize, (grey & 0xff) as usize);
        match (self.factors.get(high), self.bytes.get(low)) {
            (Some(factor), Some(linear)) if !self.is_straight() => {
                factor * linear + (factor - 1.0) * self.inverse
            }
            _ => self.curve.linear(f64::from(grey)),
        }
    }

    fn is_straight(&self) -> bool {
        self.curve.is_straight()
    }

    /// The curve that it stands for.
    #[must_use]
    pub fn curve(&self) -> &DisplayCurve {
        &self.curve
    }
}

/// The exponential, to some 1e-9 of its value, several times as fast as that of the library: one for each pixel that is read.
/// Beyond the exponents of normal numbers it is cut.
#[inline]
pub(crate) fn exp_quick(x: f64) -> f64 {
    let doublings = (x * core::f64::consts::LOG2_E).clamp(-1000.0, 1000.0);
    // Beside this number there are whole numbers alone.
    const WHOLE: f64 = 6_755_399_441_055_744.0;
    let whole = (doublings + WHOLE) - WHOLE;
    debug_assert!((whole - round(doublings)).abs() <= 1.0);
    let y = (doublings - whole) * core::f64::consts::LN_2;
    // Taylor's series at |y| of at most 0.35.
    let series = 1.0
        + y * (1.0
            + y / 2.0
                * (1.0
                    + y / 3.0
                        * (1.0 + y / 4.0 * (1.0 + y / 5.0 * (1.0 + y / 6.0 * (1.0 + y / 7.0))))));
    f64::from_bits(((whole as i64 + 1023) as u64) << 52) * series
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    properties! {
        #[test]
        fn the_quick_exponential_is_that_of_the_library(x in -300.0..300.0f64) {
            prop_assert!((exp_quick(x) / libm::exp(x) - 1.0).abs() < 1e-8);
        }

        #[test]
        fn a_logarithmic_display_is_undone(intensity in 0.02..1.0f64, inverted in any::<bool>()) {
            let shown = |intensity: f64| {
                let grey = 214.0 + 38.0 * libm::log(intensity);
                if inverted { -grey } else { grey }
            };
            let curve = DisplayCurve::new(1.0 / 38.0, inverted);
            let part = (curve.linear(shown(intensity)) - curve.linear(shown(0.01)))
                / (curve.linear(shown(1.0)) - curve.linear(shown(0.01)));
            prop_assert!((part - (intensity - 0.01) / 0.99).abs() < 1e-6);
        }
    }

    #[test]
    fn what_is_kept_is_what_the_curve_makes_of_it() {
        for (curvature, inverted) in [(0.0, true), (0.02, false), (0.004, true)] {
            let curve = DisplayCurve::new(curvature, inverted);
            let quick = QuickCurve::from(curve);
            for grey in [0, 1, 117, 255] {
                assert_eq!(quick.linear(grey), curve.linear(f64::from(grey)));
            }
        }
    }

    properties! {
        #[test]
        fn pixels_of_more_than_a_byte_are_as_the_curve_has_them(
            grey in 0..=u16::MAX, contrast in -6.0..6.0f64, straight in any::<bool>(), inverted in any::<bool>(),
        ) {
            // Of all grey values, not of those of a byte.
            let curvature = if straight { 0.0 } else { contrast / f64::from(u16::MAX) };
            let curve = DisplayCurve::new(curvature, inverted);
            let (quick, one) = (QuickCurve::from(curve).linear(grey.into()), curve.linear(grey.into()));
            prop_assert!((quick - one).abs() <= 1e-6 * one.abs() + 1e-6, "{} {}", quick, one);
            prop_assert!(QuickCurve::from(curve).linear(1 << 20).is_finite());
        }
    }

    #[test]
    fn a_linear_display_is_left_as_it_is() {
        assert_eq!(DisplayCurve::LINEAR.linear(117.0), 117.0);
        let nearly = DisplayCurve::new(1e-7, false).linear(117.0);
        assert!((nearly - 117.0).abs() < 0.01, "{nearly}");
        assert_eq!(DisplayCurve::new(0.0, true).linear(117.0), -117.0);
    }
}
