//! From transmission to a grey frame: window, blur, scatter, quantum noise, display.

use super::display::show;
use super::field::Window;
use super::physics::Physics;
use super::plane::Plane;
use libm::{cos, log, sqrt};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

/// Scatter is worked out on a picture this many times smaller.
const SCATTER_GRID: usize = 16;
/// Quanta that a pixel counts in the open beam at the usual exposure.
const QUANTA: f64 = 1900.0;

/// Turns transmission into the 8-bit frame that a screen shows.
pub(super) fn develop(transmission: Plane, physics: &Physics, seed: u64, frame: u64) -> Vec<u8> {
    let window = Window::of(&transmission, physics.field);
    let mut beam = transmission.blurred(physics.blur.focal_px);
    let width = beam.width;
    beam.values
        .par_iter_mut()
        .enumerate()
        .for_each(|(index, value)| {
            *value *= window.beam(index / width, index % width);
        });
    let counted = counted(&beam, physics, &window, seed, frame);
    let counted = counted.blurred(physics.blur.detector_px);
    let gain = physics.scatter.gain();
    show(counted, gain, physics.display, physics.unsharp)
}

/// Adds scatter and counts quanta: Poisson noise, in its normal approximation (lit pixels count dozens or more).
fn counted(beam: &Plane, physics: &Physics, window: &Window, seed: u64, frame: u64) -> Plane {
    let scatter = &physics.scatter;
    let haze = beam
        .shrunk(SCATTER_GRID)
        .blurred(scatter.spread_px / SCATTER_GRID as f64);
    let glare = scatter.glare * haze.values.iter().sum::<f64>() / haze.values.len() as f64;
    let open = QUANTA * physics.exposure.0;
    let mut values = vec![0.0; beam.values.len()];
    let grid = SCATTER_GRID as f64;
    values
        .par_chunks_mut(beam.width)
        .enumerate()
        .for_each(|(row, out)| {
            let mut random = ChaCha8Rng::seed_from_u64(seed);
            random.set_stream(frame << 32 | row as u64);
            for (column, value) in out.iter_mut().enumerate() {
                let haze = haze.sampled((column as f64 + 0.5) / grid, (row as f64 + 0.5) / grid);
                let primary = beam.values[row * beam.width + column];
                let light = primary + scatter.share * haze + glare;
                let quanta = open * window.open(row, column) * light;
                *value = (quanta + sqrt(quanta) * normal(&mut random)).max(0.0) / open;
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
