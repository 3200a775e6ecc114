//! From intensity to grey: the display's curve, and edges enhanced after it.

use super::plane::Plane;
use libm::{log, sqrt};
use rayon::prelude::*;
use std::fmt;
use std::str::FromStr;

/// Grey of the open beam and grey levels for each factor of e in intensity.
const WHITE: f64 = 214.0;
const CONTRAST: f64 = 38.0;
/// Curves that are not logarithmic show what passes a knee, less than half of the open beam, in nearly all greys:
/// grey of no light, and of half of the open beam.
const BLACK: f64 = 10.0;
const BRIGHT: f64 = 240.0;
const BRIGHT_AT: f64 = 0.5;

/// The display's curve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Display {
    /// Equal factors of intensity are equal steps of grey.
    #[default]
    Logarithmic,
    /// Grey is proportional to intensity; the open beam is cut off.
    Linear,
    /// Grey is proportional to the root of intensity, whose noise is then alike everywhere.
    SquareRoot,
}

impl Display {
    /// Grey of an intensity; 1 is the open beam.
    fn of(self, intensity: f64) -> f64 {
        let reach = BRIGHT - BLACK;
        match self {
            Self::Logarithmic => WHITE + CONTRAST * log(intensity.max(1e-9)),
            Self::Linear => BLACK + reach * intensity / BRIGHT_AT,
            Self::SquareRoot => BLACK + reach * sqrt((intensity / BRIGHT_AT).max(0.0)),
        }
    }
}

impl fmt::Display for Display {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Logarithmic => "logarithmic",
            Self::Linear => "linear",
            Self::SquareRoot => "square-root",
        })
    }
}

impl FromStr for Display {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        [Self::Logarithmic, Self::Linear, Self::SquareRoot]
            .into_iter()
            .find(|display| display.to_string() == text)
            .ok_or_else(|| {
                format!("'{text}' is no display: use logarithmic, linear or square-root")
            })
    }
}

/// An unsharp mask: what a blurred copy lacks is added.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unsharp {
    /// How much of it.
    pub amount: f64,
    /// Standard deviation of the copy's blur, pixels.
    pub sigma_px: f64,
}

impl Unsharp {
    fn applied(self, shown: Plane) -> Plane {
        let blurred = shown.blurred(self.sigma_px);
        let pairs = shown.values.par_iter().zip(&blurred.values);
        let values = pairs
            .map(|(value, smooth)| value + self.amount * (value - smooth))
            .collect();
        Plane { values, ..shown }
    }
}

/// The 8-bit frame that a screen shows of intensities, each times `gain`.
pub(super) fn show(
    mut intensity: Plane,
    gain: f64,
    display: Display,
    unsharp: Option<Unsharp>,
) -> Vec<u8> {
    let values = intensity.values.par_iter_mut();
    values.for_each(|value| *value = display.of(*value * gain));
    let shown = match unsharp {
        Some(unsharp) => unsharp.applied(intensity),
        None => intensity,
    };
    let pixel = |&grey: &f64| (grey + 0.5).clamp(0.0, 255.0) as u8;
    shown.values.par_iter().map(pixel).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_are_known_by_their_names_and_meet_their_ends() {
        for display in [Display::Logarithmic, Display::Linear, Display::SquareRoot] {
            assert_eq!(display.to_string().parse(), Ok(display));
        }
        assert!("cubic".parse::<Display>().is_err());
        assert_eq!(Display::Logarithmic.of(1.0), WHITE);
        for display in [Display::Linear, Display::SquareRoot] {
            assert_eq!([display.of(0.0), display.of(BRIGHT_AT)], [BLACK, BRIGHT]);
        }
        let quarter = Display::SquareRoot.of(BRIGHT_AT / 4.0);
        assert_eq!(quarter, (BLACK + BRIGHT) / 2.0);
    }

    #[test]
    fn an_unsharp_mask_overshoots_on_both_sides_of_an_edge_and_leaves_plateaus() {
        let values = (0..64 * 8)
            .map(|k| if k % 64 < 32 { 0.1 } else { 0.3 })
            .collect();
        let step = Plane {
            width: 64,
            height: 8,
            values,
        };
        let unsharp = Unsharp {
            amount: 0.5,
            sigma_px: 3.0,
        };
        let shown = show(step, 1.0, Display::Linear, Some(unsharp));
        let [dark, bright] = [0.1, 0.3].map(|value| (Display::Linear.of(value) + 0.5) as u8);
        assert_eq!([shown[2], shown[61]], [dark, bright]);
        assert!(shown[31] < dark - 10 && shown[32] > bright + 10);
    }
}
