//! Grey values along a line across an edge, and the filter that finds the edge in them.

use crate::image::grey::Grey;
use crate::math::exp;

/// The grey value at `t` pixels along the unit vector `normal` from `place` (column, row): the sum over readings one pixel
/// apart along the tangent, the middle one on the normal, each multiplied by its weight. `None` where a reading lies beyond
/// the frame.
///
/// Weights that sum to 1 give a mean; the single weight 1 gives the reading on the normal itself.
pub fn grey_across(
    frame: &(impl Grey + ?Sized),
    place: [f64; 2],
    normal: [f64; 2],
    weights: &[f64],
    t: f64,
) -> Option<f64> {
    let mut sum = 0.0;
    for (weight, [column, row]) in across(place, normal, weights, t) {
        sum += weight * frame.at(column, row)?;
    }
    Some(sum)
}

/// Places one pixel apart along the tangent at `t` along the normal, each with its weight.
fn across(
    place: [f64; 2],
    [right, down]: [f64; 2],
    weights: &[f64],
    t: f64,
) -> impl Iterator<Item = (f64, [f64; 2])> {
    let (column, row) = (place[0] + t * right, place[1] + t * down);
    let middle = (weights.len() / 2) as f64;
    weights.iter().enumerate().map(move |(k, &weight)| {
        let along = k as f64 - middle;
        (weight, [column - along * down, row + along * right])
    })
}

/// What a reading along a normal found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NormalReading {
    /// The edge, at this distance in pixels along the outward normal; negative inwards.
    At(f64),
    /// No edge within the range.
    Nothing,
    /// What cannot be read, before any edge.
    Unknown,
}

/// Distance between readings along a normal, pixels.
pub const READING_STEP: f64 = 0.5;
/// Readings to each side at most: the longest range and the filter's reach.
const REACH: usize = 32;
/// Half width of the derivative's filter, readings.
pub(crate) const HALF_FILTER: usize = 6;

/// What [`gaussian_derivative`] gives of a Gaussian of one pixel.
pub(crate) const DERIVATIVE: ([f64; HALF_FILTER + 1], f64) = (
    [
        0.0,
        0.4412484512922977,
        0.6065306597126334,
        0.4869787010375246,
        0.2706705664732254,
        0.10984233405851855,
        0.033326989614726917,
    ],
    4.947101747703994,
);

/// How far beyond its range the filter of [`steepest_rise`] reads, pixels.
pub const FILTER_REACH: f64 = READING_STEP * HALF_FILTER as f64;

/// Where a profile rises most steeply, to a part of a reading, at most `range` pixels from `expected`: it is differentiated by
/// the derivative of a Gaussian (Canny, IEEE PAMI 8, 1986), and of its maxima of rising slope the one is taken that is greatest
/// after a Gaussian prior on the distance. `read` is given the number of the reading at `expected`, others being
/// [`READING_STEP`] apart, and writes the profile; `None` where a part of it is not known.
///
/// A frame and what is drawn of a model are read by this one procedure, so that what it does to a profile cancels.
pub fn steepest_rise(
    expected: f64,
    range: f64,
    read: impl FnOnce(usize, &mut [f64]) -> Option<()>,
) -> NormalReading {
    let half = ((range / READING_STEP) as usize).min(REACH - HALF_FILTER - 1);
    let reach = half + HALF_FILTER;
    let mut profile = [0.0; 2 * REACH + 1];
    let profile = &mut profile[..2 * reach + 1];
    if read(reach, profile).is_none() {
        return NormalReading::Unknown;
    }
    let mut slopes = [0.0; 2 * REACH + 1];
    let slopes = &mut slopes[..=2 * half];
    differentiate(profile, slopes);
    strongest(slopes, expected)
}

/// Slopes (per pixel, outwards) of a profile that is longer by the filter's reach on both sides. Loops run along the profile,
/// so that it is done several at a time without changing the order of any sum.
fn differentiate(profile: &[f64], slopes: &mut [f64]) {
    let (weights, norm) = DERIVATIVE;
    for (k, weight) in weights.iter().enumerate().skip(1) {
        let from = |first: usize| profile.get(first..).unwrap_or_default();
        let (before, after) = (from(HALF_FILTER - k), from(HALF_FILTER + k));
        for ((slope, before), after) in slopes.iter_mut().zip(before).zip(after) {
            *slope += weight * (after - before);
        }
    }
    slopes.iter_mut().for_each(|slope| *slope /= norm);
}

/// The maximum of rising slopes about `expected` that is greatest after the prior, to a part of a reading by a
/// parabola. There are as many readings on both sides.
pub(crate) fn strongest(slopes: &[f64], expected: f64) -> NormalReading {
    let half = slopes.len() / 2;
    let sigma = READING_STEP * half as f64 / 2.0;
    let mut best = (0.0, NormalReading::Nothing);
    for (k, three) in (1usize..).zip(slopes.windows(3)) {
        let &[before, slope, after] = three else {
            continue;
        };
        if slope <= 0.0 || slope < before || slope <= after {
            continue;
        }
        let t = READING_STEP * (k as f64 - half as f64);
        let score = slope * exp(-t * t / (2.0 * sigma * sigma));
        if score > best.0 {
            // Not flat: the slope is above the one after it.
            let part = 0.5 * (before - after) / (before - 2.0 * slope + after);
            best = (score, NormalReading::At(expected + t + READING_STEP * part));
        }
    }
    best.1
}

/// The derivative of a Gaussian (Canny, IEEE PAMI 8, 1986) of `width` pixels, for readings `step` pixels apart: its
/// weights from the middle on to one side, and their norm.
///
/// The slope at reading `m`, grey values a pixel, is the sum over `k` of
/// `weights[k] * (reading[m + k] - reading[m - k])`, divided by the norm.
#[must_use]
pub fn gaussian_derivative<const N: usize>(width: f64, step: f64) -> ([f64; N], f64) {
    let mut norm = 0.0;
    let weights = core::array::from_fn(|k| {
        let t = step * k as f64;
        let weight = t * exp(-t * t / (2.0 * width * width));
        // A slope of one must come out as one.
        norm += 2.0 * weight * t;
        weight
    });
    (weights, norm)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::frame::Frame;

    #[test]
    fn the_filter_that_is_kept_is_the_derivative_of_a_gaussian() {
        assert_eq!(DERIVATIVE, gaussian_derivative(1.0, READING_STEP));
    }

    #[test]
    fn the_slope_of_a_ramp_is_found_across_it_and_along_it_there_is_none() {
        // Three grey values a pixel to the right.
        let pixels: [u16; 400] = core::array::from_fn(|k| 3 * (k % 20) as u16);
        let frame = Frame::new(&pixels, 20, 20, 20).expect("fits");
        let (weights, norm) = gaussian_derivative::<7>(1.0, 0.5);
        let slope = |normal: [f64; 2]| {
            let grey = |t: f64| {
                grey_across(&frame, [10.2, 9.7], normal, &[0.25, 0.5, 0.25], t).expect("inside")
            };
            let pairs = weights.iter().enumerate().map(|(k, weight)| {
                let t = 0.5 * k as f64;
                weight * (grey(t) - grey(-t))
            });
            pairs.sum::<f64>() / norm
        };
        assert!((slope([1.0, 0.0]) - 3.0).abs() < 1e-9);
        assert!(slope([0.0, 1.0]).abs() < 1e-9);
        assert!((slope([-0.6, 0.8]) + 1.8).abs() < 1e-9);
        assert_eq!(
            grey_across(&frame, [10.0, 10.0], [1.0, 0.0], &[1.0], 10.0),
            None
        );
    }

    #[test]
    fn places_across_lie_a_pixel_apart_along_the_tangent() {
        for angle in [0.0, 0.4, 1.9, -2.6] {
            let (sin, cos) = libm::sincos(angle);
            let (place, normal, tangent) = ([40.0, 31.5], [cos, sin], [-sin, cos]);
            for (t, weights) in [
                (2.5, &[0.25, 0.5, 0.125][..]),
                (-1.0, &[1.0]),
                (0.0, &[0.5; 5]),
            ] {
                let places: std::vec::Vec<_> = across(place, normal, weights, t).collect();
                assert_eq!(places.len(), weights.len());
                for (k, (weight, [column, row])) in places.into_iter().enumerate() {
                    let away = [column - place[0], row - place[1]];
                    let along = |unit: [f64; 2]| away[0] * unit[0] + away[1] * unit[1];
                    assert_eq!(weight, weights[k]);
                    assert!((along(normal) - t).abs() < 1e-12);
                    let beside = k as f64 - (weights.len() / 2) as f64;
                    assert!((along(tangent) - beside).abs() < 1e-12);
                }
            }
        }
    }

    /// A parabola of slopes around a reading, zero beyond those beside it.
    fn peak(slopes: &mut [f64], at: usize, part: f64, height: f64) {
        for (k, slope) in (at - 1..=at + 1).zip([-1.0, 0.0, 1.0]) {
            slopes[k] = height * (1.0 - (slope - part) * (slope - part) / 4.0);
        }
    }

    #[test]
    fn the_strongest_slope_lies_where_its_parabola_is_greatest() {
        for (at, part) in [(10, 0.0), (10, 0.3), (4, -0.45), (17, 0.25)] {
            let mut slopes = [0.0; 21];
            peak(&mut slopes, at, part, 7.0);
            let NormalReading::At(found) = strongest(&slopes, 2.0) else {
                panic!("there is one");
            };
            let expected = 2.0 + READING_STEP * (at as f64 - 10.0 + part);
            assert!((found - expected).abs() < 1e-12, "{found} {expected}");
        }
        for falling in [[0.0; 21], [-1.0; 21], core::array::from_fn(|k| -(k as f64))] {
            assert_eq!(strongest(&falling, 2.0), NormalReading::Nothing);
        }
        // A rise up to the last reading has no maximum.
        let rising: [f64; 21] = core::array::from_fn(|k| k as f64);
        assert_eq!(strongest(&rising, 2.0), NormalReading::Nothing);
    }

    /// The prior is a Gaussian whose standard deviation is half of the range to one side.
    #[test]
    fn a_slope_farther_off_counts_for_less() {
        let (near, far) = (12usize, 3usize);
        let off = |at: usize| READING_STEP * (at as f64 - 10.0);
        let sigma = READING_STEP * 10.0 / 2.0;
        let prior = |at: usize| libm::exp(-0.5 * libm::pow(off(at) / sigma, 2.0));
        let even = prior(near) / prior(far);
        for (factor, expected) in [(0.999, near), (1.001, far)] {
            let mut slopes = [0.0; 21];
            peak(&mut slopes, near, 0.0, 5.0);
            peak(&mut slopes, far, 0.0, 5.0 * even * factor);
            let found = strongest(&slopes, 0.0);
            assert_eq!(found, NormalReading::At(off(expected)), "{factor}");
        }
        // As far off on one side as on the other, the first.
        let mut slopes = [0.0; 21];
        peak(&mut slopes, 6, 0.0, 5.0);
        peak(&mut slopes, 14, 0.0, 5.0);
        assert_eq!(strongest(&slopes, 0.0), NormalReading::At(-2.0));
    }
}
