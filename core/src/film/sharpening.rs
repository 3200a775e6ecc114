//! Edges that were enhanced after the display's curve, by an unsharp mask: what a blurred copy of the grey values lacks is
//! added to them.
//!
//! Through a linear display the same happens to intensities. Through one of curvature `k` grey values are `ln(s + E) / k` where
//! metal lets `E` of the direct light pass and `s` comes from elsewhere, so that the enhanced edge, read through the curve, is
//! `(1 + E / s) exp(amount (L - G L))` with `L = ln(1 + E / s)`: both are one formula, in which `1 / s` is 0 for a linear display.
//! How much `s` is, the grey values beside metal and behind it tell.

use super::drawn::{Drawn, Gaussian};
use super::lines::STEP;
use crate::image::display::exp_quick;
use crate::math::{exp, ln};

/// An unsharp mask.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sharpening {
    /// How much of what the copy lacks is added; 0 is none.
    pub amount: f64,
    /// Standard deviation of the copy's blur, pixels.
    pub radius_px: f64,
}

/// Radii that are told apart, pixels.
pub(super) const RADII: [f64; 2] = [0.7, 8.0];
/// Largest amount that is looked for.
pub(super) const MOST_AMOUNT: f64 = 3.0;
/// The copy's blur reaches so many places of a line: 20 pixels.
const REACH: usize = 80;
/// Exponents of a contrast: brightness outside of metal is at most some hundred times that behind it.
const EXPONENTS: [f64; 2] = [-2.0, 6.0];
/// At least this part of what comes from elsewhere is no metal's.
const LEAST_VEIL: f64 = 0.05;
/// Direct light over what comes from elsewhere: less is a linear display, and it is never so much below zero.
const LINEAR: f64 = 1e-3;
const LEAST_OVER_VEIL: f64 = -0.8;

/// What a component's profiles show beside metal and behind it, in the mean.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MetalContrast {
    /// Grey values by which it is brighter outside.
    pub grey: f64,
    /// The part of the direct light that passes where grey values were read inside.
    pub passed: f64,
}

impl MetalContrast {
    /// Direct light as a multiple of what comes from elsewhere, through a display of this curvature; 0 of a linear one.
    pub(super) fn over_veil(&self, curvature: f64) -> f64 {
        let [least, most] = EXPONENTS;
        let ratio = exp((curvature * self.grey).clamp(least, most));
        let over = (ratio - 1.0) / (1.0 - ratio * self.passed).max(LEAST_VEIL);
        over.max(LEAST_OVER_VEIL)
    }
}

impl Sharpening {
    /// A blurred profile as it seems, read through the display's curve, once its edge is enhanced.
    pub(super) fn of(&self, drawn: &Drawn, over_veil: f64) -> Drawn {
        match UnsharpMask::of(self) {
            Some(mask) => mask.on(drawn, over_veil),
            None => *drawn,
        }
    }
}

/// Enhanced edges made ready for many lines.
pub(super) struct UnsharpMask {
    amount: f64,
    copy: Gaussian<REACH>,
}

impl UnsharpMask {
    /// `None` where nothing is added.
    pub(super) fn of(sharpening: &Sharpening) -> Option<Self> {
        let [least, most] = RADII;
        let width = sharpening.radius_px.clamp(least, most) / STEP;
        (sharpening.amount != 0.0).then(|| Self {
            amount: sharpening.amount,
            copy: Gaussian::of(width as f32, (3.0 * width) as usize + 1),
        })
    }

    /// A blurred profile as it seems, read through the display's curve, once its edge is enhanced.
    pub(super) fn on(&self, drawn: &Drawn, over_veil: f64) -> Drawn {
        let is_linear = over_veil.abs() < LINEAR;
        let grey = match is_linear {
            true => *drawn,
            false => drawn.map(|x| (ln(1.0 + over_veil * f64::from(x)) / over_veil) as f32),
        };
        let smooth = self.copy.convolved(&grey);
        core::array::from_fn(|k| {
            let added = self.amount * f64::from(grey[k] - smooth[k]);
            let drawn = f64::from(drawn[k]);
            let shown = match is_linear {
                true => drawn + added,
                false => {
                    ((1.0 + over_veil * drawn) * exp_quick(over_veil * added) - 1.0) / over_veil
                }
            };
            shown as f32
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::lines::{INNER, POINTS};
    use proptest::prelude::*;

    /// Intensity behind a soft edge.
    fn edge() -> Drawn {
        core::array::from_fn(|k| {
            let along = STEP * k as f64 - INNER;
            (0.1 + 0.9 / (1.0 + libm::exp(-1.5 * along))) as f32
        })
    }

    /// Oracle: an unsharp mask of grey values, by the definition.
    fn enhanced(grey: &[f64; POINTS], sharpening: &Sharpening) -> [f64; POINTS] {
        let width = sharpening.radius_px / STEP;
        core::array::from_fn(|k| {
            let (mut sum, mut weights) = (0.0, 0.0);
            for j in -200..=200i32 {
                let off = f64::from(j) / width;
                let weight = libm::exp(-0.5 * off * off);
                let at = (k as i32 + j).clamp(0, POINTS as i32 - 1) as usize;
                sum += weight * grey[at];
                weights += weight;
            }
            grey[k] + sharpening.amount * (grey[k] - sum / weights)
        })
    }

    properties! {
        /// Up to a factor and a constant, which nobody knows of a film: here they are known.
        #[test]
        fn grey_values_are_enhanced_whatever_the_display(
            amount in 0.0..2.0f64, radius_px in 0.8..5.0f64, veil in 0.1..2.0f64, curvature in 0.005..0.05f64,
        ) {
            let sharpening = Sharpening { amount, radius_px };
            let edge = edge();
            let grey = edge.map(|x| libm::log(veil + f64::from(x)) / curvature);
            let shown = enhanced(&grey, &sharpening);
            let found = sharpening.of(&edge, 1.0 / veil);
            for (found, shown) in found.iter().zip(&shown) {
                let wanted = libm::exp(curvature * shown) - veil;
                prop_assert!((f64::from(*found) - wanted).abs() < 0.01 * (1.0 + wanted.abs()), "{} {}", found, wanted);
            }
        }

        #[test]
        fn what_comes_from_elsewhere_is_told_by_both_sides(veil in 0.1..2.0f64, passed in 0.0..0.3f64, curvature in 0.005..0.05f64) {
            let grey = (libm::log(veil + 1.0) - libm::log(veil + passed)) / curvature;
            let over = MetalContrast { grey, passed }.over_veil(curvature);
            prop_assert!((over * veil - 1.0).abs() < 1e-6, "{} {}", over, veil);
        }
    }

    #[test]
    fn a_linear_display_is_the_limit_of_curved_ones() {
        let sharpening = Sharpening {
            amount: 0.8,
            radius_px: 3.0,
        };
        let (linear, curved) = (sharpening.of(&edge(), 0.0), sharpening.of(&edge(), 2e-3));
        let most = linear.iter().zip(&curved);
        let most = most.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(most < 2e-3, "{most}");
        let wanted = enhanced(&edge().map(f64::from), &sharpening);
        let off = linear.iter().zip(&wanted);
        let off = off
            .map(|(a, b)| (f64::from(*a) - b).abs())
            .fold(0.0, f64::max);
        assert!(off < 3e-3, "{off}");
        assert_eq!(Sharpening::default().of(&edge(), 0.7), edge());
        let contrast = MetalContrast {
            grey: 60.0,
            passed: 0.1,
        };
        assert_eq!(contrast.over_veil(0.0), 0.0);
    }
}
