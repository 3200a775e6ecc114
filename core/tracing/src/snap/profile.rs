//! The slope of the grey value along a sample's normal.

use super::sample::{STATES, STEP, Sample, Snap};
use crate::side::Hand;
use fluoropose::image::frame::{Frame, Pixel};
use fluoropose::image::profile::{gaussian_derivative, grey_across};
use fluoropose::math::sqrt;

/// Half width of the filter in readings: three times the width of its Gaussian.
const HALF_FILTER: usize = 6;
/// Width of the Gaussian whose derivative is the filter, pixels.
const BLUR: f64 = 1.0;
/// Weights of the readings along the line, one pixel apart.
const TANGENT: [f64; 3] = [0.25, 0.5, 0.25];
/// A slope is an edge from this multiple of the slopes that noise makes.
const TIMES_NOISE: f64 = 4.0;

/// Reads slopes of a frame.
pub(super) struct Reader<'a, P> {
    frame: &'a Frame<'a, P>,
    weights: [f64; HALF_FILTER + 1],
    /// Smaller slopes are those of noise, grey values a pixel.
    least: f64,
    /// Places to each side of the line.
    half: usize,
    either: bool,
}

impl<'a, P: Pixel> Reader<'a, P> {
    pub(super) fn new(frame: &'a Frame<'a, P>, noise: f64, settings: &Snap) -> Self {
        // Divided by the norm here, once: dividing each slope instead, as `fluoropose::refine` does, rounds differently.
        let (weights, norm) = gaussian_derivative::<{ HALF_FILTER + 1 }>(BLUR, STEP);
        let weights = weights.map(|weight| weight / norm);
        // The variances of readings one pixel apart add up. Two readings half a pixel apart share pixels and count as one.
        let along: f64 = TANGENT.iter().map(|w| w * w).sum();
        let across: f64 = weights.iter().map(|w| 2.0 * w * w).sum();
        Self {
            frame,
            weights,
            least: TIMES_NOISE * noise * sqrt(2.0 * along * across),
            half: ((settings.reach / STEP) as usize).min(STATES / 2),
            either: !settings.closed && settings.hand == Hand::Either,
        }
    }

    /// The least slope that is an edge.
    pub(super) fn least(&self) -> f64 {
        self.least
    }

    /// Writes the slope at each place along a sample's normal. It is 0 beyond the reach, beyond the frame, and where the
    /// grey value falls instead of rising.
    pub(super) fn slopes(&self, sample: &Sample, slopes: &mut [f32]) {
        const READINGS: usize = STATES + 2 * HALF_FILTER;
        let mut readings = [None; READINGS];
        let middle = READINGS / 2;
        let reach = self.half + HALF_FILTER;
        for (k, reading) in readings.iter_mut().enumerate() {
            if k.abs_diff(middle) <= reach {
                *reading = self.reading(sample, STEP * (k as f64 - middle as f64));
            }
        }
        for (state, slope) in slopes.iter_mut().enumerate() {
            let within = state.abs_diff(STATES / 2) <= self.half;
            let rise = self
                .slope(&readings, state + HALF_FILTER)
                .filter(|_| within);
            let rise = rise.unwrap_or_default();
            *slope = if self.either {
                rise.abs()
            } else {
                rise.max(0.0)
            } as f32;
        }
    }

    fn slope(&self, readings: &[Option<f64>], at: usize) -> Option<f64> {
        let mut sum = 0.0;
        for (k, weight) in self.weights.iter().enumerate().skip(1) {
            let after = readings.get(at + k).copied().flatten()?;
            let before = at
                .checked_sub(k)
                .and_then(|k| readings.get(k).copied().flatten())?;
            sum += weight * (after - before);
        }
        Some(sum)
    }

    /// The grey value at a distance along the normal, averaged along the line.
    fn reading(&self, sample: &Sample, t: f64) -> Option<f64> {
        let place = [sample.vertex.at.column, sample.vertex.at.row];
        grey_across(self.frame, place, sample.normal, &TANGENT, t)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::side::Inside;
    use crate::synthetic::SyntheticFrame;
    use crate::vertex::Vertex;
    use fluoropose::image::contour::Point;
    use std::vec::Vec;

    /// Of many places of a frame that is noise alone: a fourth of the least slope of an edge.
    #[test]
    fn an_edge_is_so_many_times_as_steep_as_noise() {
        const NOISE: f64 = 200.0;
        let mut drawn = SyntheticFrame::new(200, 200, 20_000.0);
        drawn.add_noise(NOISE, 5);
        let pixels = drawn.sixteen_bit();
        let frame = Frame::new(&pixels, 200, 200, 200).expect("fits");
        let settings = Snap {
            closed: false,
            hand: Hand::Either,
            inside: Inside::Dark,
            reach: 4.0,
            tolerance: 0.1,
        };
        let reader = Reader::new(&frame, NOISE, &settings);
        let mut slopes = Vec::new();
        for (column, row) in (20..180)
            .step_by(9)
            .flat_map(|column| (20..180).map(move |row| (column, row)))
        {
            let mut all = [0f32; STATES];
            let sample = Sample {
                vertex: Vertex::new(Point::new(column as f64 + 0.5, row as f64 + 0.5)),
                normal: [1.0, 0.0],
                ..Sample::default()
            };
            reader.slopes(&sample, &mut all);
            slopes.push(f64::from(all[STATES / 2]));
            assert!(
                all[..STATES / 2 - 8].iter().all(|&slope| slope == 0.0),
                "beyond the reach"
            );
            assert!(all[STATES / 2 - 8] > 0.0 && all[STATES / 2 + 8] > 0.0);
        }
        let mean = slopes.iter().map(|slope| slope * slope).sum::<f64>() / slopes.len() as f64;
        let ratio = reader.least() / (TIMES_NOISE * sqrt(mean));
        assert!((ratio - 1.0).abs() < 0.15, "{ratio}");
    }
}
