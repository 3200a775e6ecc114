//! How well constants explain one profile.
//!
//! `J(D)(s) = A + B E(s - d) + C (s - d) E(s - d)`, with the film's intensity on the left and the drawn profile on the right.
//! `A`, `B` and `C` are linear and eliminated; the shift `d` is found by Gauss and Newton. Residuals are weighed by the
//! noise of counted quanta and brought back to grey values on the average, so that curvatures can be compared.

use super::model::{Drawn, at};
use super::profile::{FilmProfile, READINGS};
use crate::image::display::exp_quick;
use crate::math::solve_spd;

/// Residuals in grey values.
pub(super) type Residuals = [f32; READINGS];

/// Largest shift, pixels.
const MOST_SHIFT: f64 = 3.0;
/// Steps of the shift from where it was last.
const STEPS: usize = 6;
/// The shift is found to this, pixels: derivatives of what remains are taken by differences.
const EXACT: f64 = 2e-4;
/// Half the distance over which the drawn profile is differentiated, pixels.
const NEAR: f64 = 0.125;

/// What a display curve makes of a profile: intensities, and what differences of them weigh.
pub(super) struct Developed {
    intensity: Residuals,
    weight: Residuals,
}

impl Developed {
    /// Through a curve of this curvature. Grey values count from the brightest, so that nothing overflows.
    pub(super) fn of(profile: &FilmProfile, curvature: f64) -> Self {
        let brightest = profile.mean.iter().fold(f32::MIN, |most, &x| most.max(x));
        let mut developed = Self {
            intensity: [0.0; READINGS],
            weight: [1.0; READINGS],
        };
        let mut sum = 0.0;
        let readings = profile.mean.iter().zip(&profile.variance);
        for (k, (&mean, &variance)) in readings.enumerate() {
            let grey = f64::from(mean - brightest);
            if curvature == 0.0 {
                developed.intensity[k] = grey as f32;
                continue;
            }
            // Half of the exponent, because quanta are counted: noise grows with the root of the intensity.
            let root = exp_quick(0.5 * curvature * grey);
            // The mean of the exponential of what is spread like this.
            let more = 1.0 + curvature * curvature * f64::from(variance) / 2.0;
            developed.intensity[k] = ((root * root * more - 1.0) / curvature) as f32;
            developed.weight[k] = (1.0 / root) as f32;
            sum += grey;
        }
        // In grey values on the average, so that curvatures can be compared.
        let scale = exp_quick(-0.5 * curvature * sum / READINGS as f64) as f32;
        developed
            .weight
            .iter_mut()
            .for_each(|weight| *weight *= scale);
        developed
    }
}

/// What remains of a profile that is explained as well as possible.
pub(super) struct Explained {
    pub(super) residuals: Residuals,
    pub(super) shift: f64,
}

impl Explained {
    pub(super) fn squares(&self) -> f64 {
        f64::from(self.residuals.iter().map(|r| r * r).sum::<f32>())
    }
}

/// Explains a profile by a drawn one, from a shift nearby. `None` where nothing does: metal must darken.
pub(super) fn explain(
    profile: &FilmProfile,
    film: &Developed,
    drawn: &Drawn,
    start: f64,
) -> Option<Explained> {
    let mut shift = start;
    let mut best: Option<Explained> = None;
    for _ in 0..STEPS {
        let trial = Trial::at(profile, film, drawn, shift)?;
        if best
            .as_ref()
            .is_none_or(|best| trial.explained.squares() < best.squares())
        {
            best = Some(trial.explained);
        }
        let next = (shift + trial.step.clamp(-0.6, 0.6)).clamp(-MOST_SHIFT, MOST_SHIFT);
        if (next - shift).abs() < EXACT {
            break;
        }
        shift = next;
    }
    best
}

/// The shift, of all in steps of half a pixel, at which a profile is explained best.
pub(super) fn search(profile: &FilmProfile, film: &Developed, drawn: &Drawn) -> Option<Explained> {
    let tried = (-5..=5).filter_map(|k| {
        let trial = Trial::at(profile, film, drawn, 0.5 * f64::from(k))?;
        Some(trial.explained)
    });
    let best = tried.min_by(|a, b| a.squares().total_cmp(&b.squares()))?;
    explain(profile, film, drawn, best.shift)
}

struct Trial {
    explained: Explained,
    /// By how much the shift should grow.
    step: f64,
}

impl Trial {
    fn at(profile: &FilmProfile, film: &Developed, drawn: &Drawn, shift: f64) -> Option<Self> {
        let mut columns = [[0.0f64; 3]; READINGS];
        let mut slopes = [0.0f64; READINGS];
        let (mut normal, mut right) = ([[0.0; 3]; 3], [0.0; 3]);
        for (k, column) in columns.iter_mut().enumerate() {
            let along = FilmProfile::along(k) - shift;
            let place = along + f64::from(profile.outline);
            let passed = f64::from(at(drawn, place));
            slopes[k] = f64::from(at(drawn, place + NEAR) - at(drawn, place - NEAR)) / (2.0 * NEAR);
            let weight = f64::from(film.weight[k]);
            *column = [weight, weight * passed, weight * passed * along / 6.0];
            let wanted = weight * f64::from(film.intensity[k]);
            for (row, &a) in column.iter().enumerate() {
                right[row] += a * wanted;
                for (sum, &b) in normal[row].iter_mut().zip(column.iter()) {
                    *sum += a * b;
                }
            }
        }
        // Where everything passes the three are alike.
        (0..3).for_each(|k| normal[k][k] *= 1.0 + 1e-7);
        let solution = solve_spd(normal, right)?;
        if solution[1] <= 0.0 {
            return None;
        }
        let mut residuals = [0.0; READINGS];
        // The shift moves the profile against its slope; what the other three take up of that is left out.
        let mut with_shift = [[0.0; 4]; 4];
        let mut gains = [0.0; 4];
        for (k, column) in columns.iter().enumerate() {
            let model: f64 = column.iter().zip(&solution).map(|(a, b)| a * b).sum();
            let weight = f64::from(film.weight[k]);
            let residual = weight * f64::from(film.intensity[k]) - model;
            residuals[k] = residual as f32;
            let along = FilmProfile::along(k) - shift;
            let slope = -weight * slopes[k] * (solution[1] + solution[2] * along / 6.0);
            let column = [column[0], column[1], column[2], slope];
            for (row, &a) in column.iter().enumerate() {
                gains[row] += a * residual;
                for (sum, &b) in with_shift[row].iter_mut().zip(&column) {
                    *sum += a * b;
                }
            }
        }
        (0..4).for_each(|k| with_shift[k][k] *= 1.0 + 1e-6);
        let step = solve_spd(with_shift, gains).map_or(0.0, |solved| solved[3]);
        Some(Self {
            explained: Explained { residuals, shift },
            step,
        })
    }
}
