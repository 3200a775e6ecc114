//! From transmission to a grey frame: collimator, blur, scatter, quantum noise, display.

use super::plane::Plane;
use libm::{cos, exp, hypot, log, sqrt};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

/// Blur of the focal spot and of the detector, standard deviations in pixels.
const FOCAL_BLUR: f64 = 0.35;
const DETECTOR_BLUR: f64 = 0.6;
/// Scatter: its share of the primary beam and how far it spreads (pixels).
const SCATTER_SHARE: f64 = 0.055;
const SCATTER_SPREAD: f64 = 72.0;
/// Scatter is worked out on a picture this many times smaller.
const SCATTER_GRID: usize = 16;
/// Quanta that a pixel counts in the open beam.
const QUANTA: f64 = 1900.0;
/// Display: grey of the open beam and grey levels for each factor of e in intensity.
const WHITE: f64 = 214.0;
const CONTRAST: f64 = 38.0;
/// The round collimator's radius as a part of the frame's half width, and the softness of its edge in pixels.
const COLLIMATOR: f64 = 0.985;
const COLLIMATOR_EDGE: f64 = 2.5;

/// Turns transmission into the 8-bit frame that a screen shows.
pub(super) fn develop(transmission: Plane, seed: u64, frame: u64) -> Vec<u8> {
    let round = Collimator::of(&transmission);
    let mut beam = transmission.blurred(FOCAL_BLUR);
    let width = beam.width;
    beam.values
        .par_iter_mut()
        .enumerate()
        .for_each(|(index, value)| {
            *value *= round.beam(index / width, index % width);
        });
    let scatter = beam
        .shrunk(SCATTER_GRID)
        .blurred(SCATTER_SPREAD / SCATTER_GRID as f64);
    let counted = counted(&beam, &scatter, &round, seed, frame).blurred(DETECTOR_BLUR);
    counted
        .values
        .par_iter()
        .map(|&intensity| shown(intensity))
        .collect()
}

/// The round window that the beam comes through.
struct Collimator {
    centre: [f64; 2],
    radius: f64,
}

impl Collimator {
    fn of(picture: &Plane) -> Self {
        let centre = [picture.width, picture.height].map(|count| count as f64 / 2.0);
        Self {
            centre,
            radius: COLLIMATOR * centre[0].min(centre[1]),
        }
    }

    fn distance(&self, row: usize, column: usize) -> f64 {
        hypot(
            column as f64 + 0.5 - self.centre[0],
            row as f64 + 0.5 - self.centre[1],
        )
    }

    /// Strength of the open beam: a little weaker towards the window's edge.
    fn beam(&self, row: usize, column: usize) -> f64 {
        let part = (self.distance(row, column) / self.radius).min(1.0);
        1.0 - 0.16 * part * part
    }

    /// What the window lets through.
    fn open(&self, row: usize, column: usize) -> f64 {
        let beyond = self.distance(row, column) - self.radius;
        1.0 / (1.0 + exp(beyond / (COLLIMATOR_EDGE / 4.0)))
    }
}

/// Adds scatter and counts quanta: Poisson noise, in its normal approximation (lit pixels count dozens or more).
fn counted(beam: &Plane, scatter: &Plane, round: &Collimator, seed: u64, frame: u64) -> Plane {
    let mut values = vec![0.0; beam.values.len()];
    let grid = SCATTER_GRID as f64;
    values
        .par_chunks_mut(beam.width)
        .enumerate()
        .for_each(|(row, out)| {
            let mut random = ChaCha8Rng::seed_from_u64(seed);
            random.set_stream(frame << 32 | row as u64);
            for (column, value) in out.iter_mut().enumerate() {
                let haze = scatter.sampled((column as f64 + 0.5) / grid, (row as f64 + 0.5) / grid);
                let primary = beam.values[row * beam.width + column];
                let quanta = QUANTA * round.open(row, column) * (primary + SCATTER_SHARE * haze);
                *value = (quanta + sqrt(quanta) * normal(&mut random)).max(0.0) / QUANTA;
            }
        });
    Plane { values, ..*beam }
}

/// A normally distributed number (Box and Muller).
fn normal(random: &mut impl Rng) -> f64 {
    let unit = |bits: u32| (f64::from(bits) + 0.5) / 4_294_967_296.0;
    let (radius, angle) = (unit(random.next_u32()), unit(random.next_u32()));
    sqrt(-2.0 * log(radius)) * cos(std::f64::consts::TAU * angle)
}

fn shown(intensity: f64) -> u8 {
    (WHITE + CONTRAST * log(intensity.max(1e-9)) + 0.5).clamp(0.0, 255.0) as u8
}
