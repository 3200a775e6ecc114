//! The slope of the grey value along a sample's normal.

use super::Snap;
use super::track::{STATES, STEP};
use super::{Hand, Sample};
use fluoropose::image::frame::{Frame, Grey, Pixel};
use fluoropose::math::{exp, sqrt};

/// Half width of the derivative's filter, readings: three times its Gaussian.
const HALF_FILTER: usize = 6;
/// Width of the Gaussian whose derivative is taken, pixels (Canny, IEEE PAMI 8, 1986).
const BLUR: f64 = 1.0;
/// Weights of the readings along the line, one pixel apart.
const TANGENT: [f64; 3] = [0.25, 0.5, 0.25];
/// Slopes that are so many times what noise makes are edges.
const TIMES_NOISE: f64 = 4.0;

/// Reads slopes of a frame.
pub(super) struct Reader<'a, P> {
    frame: &'a Frame<'a, P>,
    weights: [f64; HALF_FILTER + 1],
    /// Slopes below are those of noise, grey values a pixel.
    least: f64,
    /// Places to each side of the line.
    half: usize,
    either: bool,
}

impl<'a, P: Pixel> Reader<'a, P> {
    pub(super) fn new(frame: &'a Frame<'a, P>, noise: f64, settings: &Snap) -> Self {
        let weights = weights();
        // The variances of the readings add up; those half a pixel apart share pixels and are about one.
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

    /// Writes the slope at each place along a sample's normal; 0 beyond the reach and beyond the frame, and where it
    /// falls instead of rising.
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
        let [right, down] = sample.normal;
        let (column, row) = (
            sample.vertex.at.column + t * right,
            sample.vertex.at.row + t * down,
        );
        let mut sum = 0.0;
        for (k, weight) in TANGENT.iter().enumerate() {
            let along = k as f64 - (TANGENT.len() / 2) as f64;
            sum += weight * self.frame.at(column - along * down, row + along * right)?;
        }
        Some(sum)
    }
}

/// The derivative of a Gaussian from its middle on: a slope of one comes out as one.
fn weights() -> [f64; HALF_FILTER + 1] {
    let mut weights = core::array::from_fn(|k| {
        let t = STEP * k as f64;
        t * exp(-t * t / (2.0 * BLUR * BLUR))
    });
    let pairs = weights.iter().enumerate();
    let norm: f64 = pairs
        .map(|(k, weight)| 2.0 * weight * STEP * k as f64)
        .sum();
    weights.iter_mut().for_each(|weight| *weight /= norm);
    weights
}
