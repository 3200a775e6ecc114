//! Grey from colour.
//!
//! Weights of ITU-R BT.601 (0.299, 0.587, 0.114) in thousandths, rounded to nearest: a grey stored as three equal
//! channels comes back exactly.

/// What the three components of a compressed image are, where the image itself does not say.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ComponentColours {
    /// Red, green, blue.
    Rgb,
    /// Luminance first, then two colour differences.
    LuminanceFirst,
}

const RED: u32 = 299;
const GREEN: u32 = 587;
const BLUE: u32 = 114;

/// Luminance of one pixel of up to 16 bits a channel. The largest sum is 65 535 500, far inside `u32`.
pub(crate) fn luminance(red: u16, green: u16, blue: u16) -> u16 {
    let sum = RED * u32::from(red) + GREEN * u32::from(green) + BLUE * u32::from(blue);
    // At most 65535 because the weights add to 1000.
    ((sum + 500) / 1000) as u16
}

/// The same of numbers of any size.
pub(crate) fn weighted(colours: [f64; 3]) -> f64 {
    let weights = [RED, GREEN, BLUE].map(|weight| f64::from(weight) / 1000.0);
    weights
        .iter()
        .zip(colours)
        .map(|(weight, colour)| weight * colour)
        .sum()
}

/// Interleaved 8-bit pixels of `channels` samples, of which the first three are red, green and blue, or the
/// first is grey where there are fewer than three. Further samples (transparency) are left out.
pub(crate) fn grey_from_u8(samples: &[u8], channels: usize) -> Vec<u8> {
    if channels == 1 {
        return samples.to_vec();
    }
    samples
        .chunks_exact(channels)
        .map(|pixel| match *pixel {
            [r, g, b, ..] => luminance(r.into(), g.into(), b.into()) as u8,
            [grey, ..] => grey,
            [] => 0,
        })
        .collect()
}

/// The same for 16-bit samples.
pub(crate) fn grey_from_u16(samples: impl Iterator<Item = u16>, channels: usize) -> Vec<u16> {
    let mut samples = samples;
    let mut grey = Vec::with_capacity(samples.size_hint().0 / channels.max(1));
    while let Some(first) = samples.next() {
        if channels >= 3 {
            let (Some(green), Some(blue)) = (samples.next(), samples.next()) else {
                break;
            };
            grey.push(luminance(first, green, blue));
            samples.by_ref().take(channels - 3).for_each(drop);
        } else {
            grey.push(first);
            samples.by_ref().take(channels - 1).for_each(drop);
        }
    }
    grey
}
