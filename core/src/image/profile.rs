//! Grey values along a line across an edge, and the filter that finds the edge in them.

use crate::image::frame::Grey;
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
    let [right, down] = normal;
    let (column, row) = (place[0] + t * right, place[1] + t * down);
    let mut sum = 0.0;
    for (k, weight) in weights.iter().enumerate() {
        let along = k as f64 - (weights.len() / 2) as f64;
        sum += weight * frame.at(column - along * down, row + along * right)?;
    }
    Some(sum)
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
}
