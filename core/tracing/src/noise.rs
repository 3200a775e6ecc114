//! How noisy a frame is.

use fluoropose::image::frame::{Frame, Pixel};

/// Bins of second differences.
const BINS: usize = 1024;
/// One row in this number of rows is read.
const EVERY: usize = 3;
/// The standard deviation that rounding to whole grey values leaves: 1 / sqrt(12).
const ROUNDING: f64 = 0.29;

/// The standard deviation of a pixel's noise in grey values, at least that of rounding.
///
/// It is the median of the absolute second differences along rows: edges are few, and slopes have no second difference
/// (after Immerkaer, *Fast noise variance estimation*, CVIU 64, 1996).
///
/// Frames of fewer bits that are kept in more have grey values that are multiples of a step: it is measured in steps.
pub(crate) fn noise<P: Pixel>(frame: &Frame<'_, P>) -> f64 {
    let step = step(frame);
    let mut shift = 0;
    loop {
        let (counts, all) = differences(frame, step, shift);
        let median = median_bin(&counts, all);
        // The last bin also counts all larger differences; if the median lies there, the bins must be wider.
        if median < (BINS - 1) as f64 || shift >= u16::BITS {
            // A whole number stands for the values that round to it.
            let median = median * f64::from(1u32 << shift) - 0.5;
            // A second difference has the variance 6, the median of a normal deviate's size is 0.6745.
            let steps = (median / (0.6745 * fluoropose::math::sqrt(6.0))).max(ROUNDING);
            return f64::from(step) * steps;
        }
        shift += 4;
    }
}

/// The greatest number of grey values of which all differences between neighbours in a row are multiples; 1 without any difference.
fn step<P: Pixel>(frame: &Frame<'_, P>) -> u32 {
    let mut step = 0;
    for row in (0..frame.height()).step_by(EVERY) {
        for two in frame.row(row).windows(2) {
            let [a, b]: [u32; 2] = [two[0], two[1]].map(Into::into);
            let mut rest = a.abs_diff(b);
            while rest != 0 {
                (step, rest) = (rest, step % rest);
            }
            if step == 1 {
                return 1;
            }
        }
    }
    step.max(1)
}

/// How many second differences fall into each bin of `2^shift` steps, and how many there are.
fn differences<P: Pixel>(frame: &Frame<'_, P>, step: u32, shift: u32) -> ([u32; BINS], u32) {
    let mut counts = [0u32; BINS];
    let mut all = 0;
    for row in (0..frame.height()).step_by(EVERY) {
        for three in frame.row(row).windows(3) {
            let [a, b, c]: [u32; 3] = [three[0], three[1], three[2]].map(Into::into);
            // Collimators and saturated air show no noise.
            if a != b || b != c {
                let bin = (((a + c).abs_diff(2 * b) / step) >> shift) as usize;
                counts[bin.min(BINS - 1)] += 1;
                all += 1;
            }
        }
    }
    (counts, all)
}

/// The bin below which half of the counts lie, to a fraction of a bin.
fn median_bin(counts: &[u32], all: u32) -> f64 {
    let mut below = 0;
    for (bin, &count) in counts.iter().enumerate() {
        if 2 * (below + count) >= all && count > 0 {
            let part = (f64::from(all) / 2.0 - f64::from(below)) / f64::from(count);
            return bin as f64 + part;
        }
        below += count;
    }
    0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::SyntheticFrame;

    #[test]
    fn the_noise_put_in_comes_out() {
        for sigma in [2.0, 8.0, 40.0, 1500.0] {
            let mut drawn = SyntheticFrame::new(160, 120, 30_000.0);
            drawn.disc([80.0, 60.0], 30.0, 20_000.0);
            drawn.add_noise(sigma, 5);
            let pixels = drawn.sixteen_bit();
            let found = noise(&Frame::new(&pixels, 160, 120, 160).expect("fits"));
            assert!((found / sigma - 1.0).abs() < 0.1, "{found} for {sigma}");
        }
    }

    /// Eight bits that are kept in sixteen, or twelve of them, have steps of many grey values: what rounding leaves is a part of these.
    #[test]
    fn in_other_units_a_frame_has_as_many_times_the_noise() {
        for sigma in [0.0, 0.2, 0.5, 1.0, 3.0] {
            let mut drawn = SyntheticFrame::new(160, 120, 150.0);
            drawn.disc([80.0, 60.0], 30.0, 90.0);
            drawn.add_noise(sigma, 7);
            let pixels = drawn.sixteen_bit();
            let own = noise(&Frame::new(&pixels, 160, 120, 160).expect("fits"));
            for (times, more) in [(1, 300), (16, 0), (256, 0), (257, 255), (3, 1)] {
                let pixels: std::vec::Vec<u16> =
                    pixels.iter().map(|grey| times * grey + more).collect();
                let found = noise(&Frame::new(&pixels, 160, 120, 160).expect("fits"));
                let ratio = found / (f64::from(times) * own);
                assert!((ratio - 1.0).abs() < 1e-9, "{ratio} times {times}, {sigma}");
            }
        }
    }

    #[test]
    fn half_of_what_is_counted_lies_below_the_median() {
        assert_eq!(median_bin(&[3, 1, 0, 4], 8), 2.0);
        assert_eq!(median_bin(&[3, 0, 4, 1], 8), 2.25);
        assert_eq!(median_bin(&[0, 0], 0), 0.0);
    }

    #[test]
    fn a_frame_of_one_grey_has_the_noise_of_rounding() {
        let frame = Frame::new(&[7u8; 64], 8, 8, 8).expect("fits");
        assert_eq!(noise(&frame), ROUNDING);
    }
}
