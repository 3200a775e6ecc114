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
pub(crate) fn noise<P: Pixel>(frame: &Frame<'_, P>) -> f64 {
    let mut shift = 0;
    loop {
        let (counts, all) = differences(frame, shift);
        let median = median_bin(&counts, all);
        // The last bin also counts all larger differences; if the median lies there, the bins must be wider.
        if median < (BINS - 1) as f64 || shift >= u16::BITS {
            // A whole number stands for the values that round to it.
            let median = median * f64::from(1u32 << shift) - 0.5;
            // A second difference has the variance 6, the median of a normal deviate's size is 0.6745.
            return (median / (0.6745 * fluoropose::math::sqrt(6.0))).max(ROUNDING);
        }
        shift += 4;
    }
}

/// How many second differences fall into each bin of `2^shift` grey values, and how many there are.
fn differences<P: Pixel>(frame: &Frame<'_, P>, shift: u32) -> ([u32; BINS], u32) {
    let mut counts = [0u32; BINS];
    let mut all = 0;
    for row in (0..frame.height()).step_by(EVERY) {
        for three in frame.row(row).windows(3) {
            let [a, b, c]: [u32; 3] = [three[0], three[1], three[2]].map(Into::into);
            // Collimators and saturated air show no noise.
            if a != b || b != c {
                let bin = ((a + c).abs_diff(2 * b) >> shift) as usize;
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
