//! Where a grey frame has the edge that a model's outline predicts.
//!
//! A profile is read along the outline's normal, averaged a little along its tangent, and
//! differentiated by the derivative of a Gaussian (Canny, IEEE PAMI 8, 1986). Of its maxima of
//! the right sign the one is taken that is strongest after a Gaussian prior on the distance.

use super::border::{BorderPixel, NormalReading};
use super::view::{ImageTarget, Polarity};
use crate::image::profile::{gaussian_derivative, grey_across};
use crate::math::exp;

/// Distance between readings along the normal, pixels.
const STEP: f64 = 0.5;
/// Readings to each side of the outline at most: the longest range and the filter's reach.
const REACH: usize = 32;
/// Weights of the readings along the tangent, one pixel apart: sixteenths.
const TANGENT: [f64; 5] = [1.0 / 16.0, 4.0 / 16.0, 6.0 / 16.0, 4.0 / 16.0, 1.0 / 16.0];
/// Half width of the derivative's filter, readings.
const HALF_FILTER: usize = 6;
/// Width of the Gaussian whose derivative is taken, pixels.
const BLUR: f64 = 1.0;

/// The edge nearest to expectation on the normal of a sample: `expected` pixels from the middle
/// of its pixel, at most `range` from there.
pub(super) fn edge(
    image: &ImageTarget<'_>,
    sample: &BorderPixel,
    expected: f64,
    range: f64,
) -> NormalReading {
    let half = ((range / STEP) as usize).min(REACH - HALF_FILTER - 1);
    let mut profile = [0.0; 2 * REACH + 1];
    let reach = half + HALF_FILTER;
    for (index, value) in profile.iter_mut().take(2 * reach + 1).enumerate() {
        let t = expected + STEP * (index as f64 - reach as f64);
        match reading(image, sample, t) {
            Some(grey) => *value = grey,
            None => return NormalReading::Unknown,
        }
    }
    let mut slopes = [0.0; 2 * REACH + 1];
    differentiate(&profile, &mut slopes[..=2 * half]);
    if image.polarity == Polarity::BrightImplant {
        slopes.iter_mut().for_each(|slope| *slope = -*slope);
    }
    strongest(&slopes[..=2 * half], half, expected)
}

/// Grey value at a distance along a sample's normal, averaged along its tangent. `None` where
/// one of the pixels is unknown or beyond the frame.
fn reading(image: &ImageTarget<'_>, sample: &BorderPixel, t: f64) -> Option<f64> {
    let (place, normal) = (sample.place(), sample.normal.map(f64::from));
    let [column, row] = [0, 1].map(|axis| place[axis] + t * normal[axis]);
    if let Some(unknown) = image.unknown
        && column >= 0.0
        && row >= 0.0
        && unknown.get(column as usize, row as usize)
    {
        return None;
    }
    grey_across(image.frame, place, normal, &TANGENT, t)
}

/// Slopes (per pixel, outwards) of a profile that is longer by the filter's reach on both sides.
fn differentiate(profile: &[f64], slopes: &mut [f64]) {
    let (weights, norm) = gaussian_derivative::<{ HALF_FILTER + 1 }>(BLUR, STEP);
    for (index, slope) in slopes.iter_mut().enumerate() {
        let middle = index + HALF_FILTER;
        let pairs =
            (1..=HALF_FILTER).map(|k| weights[k] * (profile[middle + k] - profile[middle - k]));
        *slope = pairs.sum::<f64>() / norm;
    }
}

/// The maximum of rising slopes that is greatest after the prior, to a part of a reading by a
/// parabola.
fn strongest(slopes: &[f64], half: usize, expected: f64) -> NormalReading {
    let sigma = STEP * half as f64 / 2.0;
    let mut best = (0.0, NormalReading::Nothing);
    for k in 1..slopes.len().saturating_sub(1) {
        let (before, slope, after) = (slopes[k - 1], slopes[k], slopes[k + 1]);
        if slope <= 0.0 || slope < before || slope <= after {
            continue;
        }
        let t = STEP * (k as f64 - half as f64);
        let score = slope * exp(-t * t / (2.0 * sigma * sigma));
        if score > best.0 {
            // Not flat: the slope is above the one after it.
            let part = 0.5 * (before - after) / (before - 2.0 * slope + after);
            best = (score, NormalReading::At(expected + t + STEP * part));
        }
    }
    best.1
}
