//! How much noise an outline has.

use serde::Serialize;

use super::disturb::DisturbanceOptions;

/// Variance of a rounded number, square pixels: uniform over one pixel.
const ROUNDED: f64 = 1.0 / 12.0;

/// The noise of an outline.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Noise {
    /// Variance of the white part for one pixel of outline, square pixels.
    pub white_px2: f64,
    /// Standard deviation of the correlated part, pixels.
    pub jitter_px: f64,
    /// Its correlation length, pixels.
    pub correlation_px: f64,
}

impl Noise {
    /// The noise of a mask whose pixels say where the outline is, and nothing else.
    pub const ROUNDING: Self = Self {
        white_px2: ROUNDED,
        jitter_px: 0.0,
        correlation_px: 0.0,
    };

    /// The noise of a mask that was disturbed after it had been drawn `factor` times as finely as
    /// the frame. Jitter takes the outline from one drawing and draws it again: it is
    /// rounded twice, first to `1 / factor` pixel.
    pub fn of(options: &DisturbanceOptions, factor: usize) -> Self {
        if options.jitter == 0.0 {
            return Self::ROUNDING;
        }
        // Variance and length of a fine pixel: 1 / factor^2 and 1 / factor.
        let fine = 1.0 / (factor * factor * factor) as f64;
        Self {
            white_px2: ROUNDED * (1.0 + fine),
            jitter_px: options.jitter,
            correlation_px: options.correlation,
        }
    }
}
