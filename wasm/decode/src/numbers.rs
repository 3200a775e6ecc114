//! Pixels from numbers that no pixel holds as they are.

use crate::frame::Pixels;

/// What numbers there are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Range {
    /// The smallest and the largest of those that are finite.
    low: f64,
    high: f64,
    /// None is negative or more than 65535, and all are whole.
    fits: bool,
}

impl Range {
    /// `are_whole`: also where the luminance of colours is not.
    pub(crate) fn of(values: impl Iterator<Item = f64>, are_whole: bool) -> Self {
        let none = Self {
            low: f64::INFINITY,
            high: f64::NEG_INFINITY,
            fits: true,
        };
        values.fold(none, |range, value| {
            let is_whole = are_whole || value.fract() == 0.0;
            let fits = is_whole && (0.0..=65535.0).contains(&value);
            let [low, high] = match value.is_finite() {
                true => [range.low.min(value), range.high.max(value)],
                false => [range.low, range.high],
            };
            Self {
                low,
                high,
                fits: range.fits && fits,
            }
        })
    }
}

/// Whole numbers as they are where all fit 16 bits, else smallest to largest mapped linearly onto 0 to 65535, which is said.
pub(crate) fn in_16_bits(
    values: impl Iterator<Item = f64>,
    range: Range,
    notes: &mut Vec<String>,
) -> Pixels {
    let Range { low, high, fits } = range;
    if fits {
        return Pixels::U16(values.map(|value| value.round() as u16).collect());
    }
    let scale = match high > low {
        // Halves first: the difference of two finite numbers may be infinite.
        true => 65535.0 / 2.0 / (high / 2.0 - low / 2.0),
        false => 0.0,
    };
    notes.push(format!(
        "Pixels from {low} to {high} were mapped linearly to 0 to 65535."
    ));
    // A float to integer cast saturates and takes NaN to 0.
    Pixels::U16(values.map(|v| ((v - low) * scale).round() as u16).collect())
}
