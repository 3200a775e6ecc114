//! How well constants explain one profile.
//!
//! `J(D)(s) = A + B E(s - d) + C (s - d) E(s - d)`, with the film's intensity on the left and the drawn profile on the right.
//! `A`, `B` and `C` are linear and eliminated; the shift `d` is found by Gauss and Newton. Residuals are weighed by the
//! noise of counted quanta and brought back to grey values on the average, so that curvatures can be compared.

use super::lines::{INNER, POINTS, STEP};
use super::model::Drawn;
use super::profile::{FIRST_READING, FilmProfile, READING_STEP, READINGS};
use crate::image::display::exp_quick;
use crate::math::{floor, solve_few};

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
        let step = trial.step(profile, drawn).clamp(-0.6, 0.6);
        if best
            .as_ref()
            .is_none_or(|best| trial.explained.squares() < best.squares())
        {
            best = Some(trial.explained);
        }
        let next = (shift + step).clamp(-MOST_SHIFT, MOST_SHIFT);
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

/// What is drawn where a profile is read, if its outline lies at `outline` pixels from the line's origin: [`at`] of each place. Readings
/// are whole places apart, so all of them lie alike between two.
fn read(drawn: &Drawn, outline: f64) -> Residuals {
    const APART: usize = (READING_STEP / STEP) as usize;
    const LENGTH: usize = APART * READINGS;
    let first = (outline + FIRST_READING + INNER) / STEP;
    let first = first.clamp(-(LENGTH as f64), (POINTS + LENGTH) as f64);
    let low = floor(first);
    let part = (first - low) as f32;
    let low = low as isize;
    let there = |place: isize| drawn[place.clamp(0, POINTS as isize - 1) as usize];
    let near: [f32; LENGTH] = match usize::try_from(low)
        .ok()
        .and_then(|low| drawn.get(low..)?.first_chunk())
    {
        Some(near) => *near,
        None => core::array::from_fn(|k| there(low + k as isize)),
    };
    core::array::from_fn(|k| {
        let (a, b) = (near[APART * k], near[APART * k + 1]);
        a + part * (b - a)
    })
}

/// A shift tried, and what the fit of three numbers at it leaves behind for a better one.
struct Trial<'t> {
    explained: Explained,
    film: &'t Developed,
    columns: [[f64; 3]; READINGS],
    /// The lower triangle of their products.
    normal: [[f64; 3]; 3],
    solution: [f64; 3],
}

impl<'t> Trial<'t> {
    fn at(profile: &FilmProfile, film: &'t Developed, drawn: &Drawn, shift: f64) -> Option<Self> {
        let mut columns = [[0.0f64; 3]; READINGS];
        let (mut normal, mut right) = ([[0.0; 3]; 3], [0.0; 3]);
        let passed = read(drawn, f64::from(profile.outline) - shift);
        for (k, column) in columns.iter_mut().enumerate() {
            let along = FilmProfile::along(k) - shift;
            let passed = f64::from(passed[k]);
            let weight = f64::from(film.weight[k]);
            *column = [weight, weight * passed, weight * passed * along / 6.0];
            let wanted = weight * f64::from(film.intensity[k]);
            for (row, &a) in column.iter().enumerate() {
                right[row] += a * wanted;
                // Solvers read the lower triangle alone.
                for (sum, &b) in normal[row].iter_mut().zip(&column[..=row]) {
                    *sum += a * b;
                }
            }
        }
        // Where everything passes the three are alike.
        let mut firm = normal;
        (0..3).for_each(|k| firm[k][k] *= 1.0 + 1e-7);
        let solution = solve_few(firm, right)?;
        if solution[1] <= 0.0 {
            return None;
        }
        let mut residuals = [0.0; READINGS];
        for (k, residual) in residuals.iter_mut().enumerate() {
            *residual = left(film, &columns[k], &solution, k) as f32;
        }
        Some(Self {
            explained: Explained { residuals, shift },
            film,
            columns,
            normal,
            solution,
        })
    }

    /// By how much the shift should grow.
    fn step(&self, profile: &FilmProfile, drawn: &Drawn) -> f64 {
        let (shift, solution) = (self.explained.shift, &self.solution);
        let read = |more| read(drawn, f64::from(profile.outline) - shift + more);
        let (before, after) = (read(-NEAR), read(NEAR));
        // The shift moves the profile against its slope; what the other three take up of that is left out.
        let (mut last, mut gains) = ([0.0; 4], [0.0; 4]);
        for (k, column) in self.columns.iter().enumerate() {
            let residual = left(self.film, column, solution, k);
            let weight = f64::from(self.film.weight[k]);
            let along = FilmProfile::along(k) - shift;
            let slope = f64::from(after[k] - before[k]) / (2.0 * NEAR);
            let slope = -weight * slope * (solution[1] + solution[2] * along / 6.0);
            let column = [column[0], column[1], column[2], slope];
            for (gain, &a) in gains.iter_mut().zip(&column) {
                *gain += a * residual;
            }
            for (sum, &b) in last.iter_mut().zip(&column) {
                *sum += slope * b;
            }
        }
        let [a, b, c] = self.normal.map(|[x, y, z]| [x, y, z, 0.0]);
        let mut with_shift = [a, b, c, last];
        (0..4).for_each(|k| with_shift[k][k] *= 1.0 + 1e-6);
        solve_few(with_shift, gains).map_or(0.0, |solved| solved[3])
    }
}

/// What a fit leaves of a reading, by its weight.
fn left(film: &Developed, column: &[f64; 3], solution: &[f64; 3], reading: usize) -> f64 {
    let model: f64 = column.iter().zip(solution).map(|(a, b)| a * b).sum();
    f64::from(film.weight[reading]) * f64::from(film.intensity[reading]) - model
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::model::at;
    use proptest::prelude::*;

    properties! {
        #[test]
        fn what_is_drawn_is_read_place_by_place(
            values in proptest::collection::vec(-1.0..1.0f32, POINTS), outline in -60.0..60.0f64,
        ) {
            let drawn: Drawn = core::array::from_fn(|k| values[k]);
            for (k, value) in read(&drawn, outline).into_iter().enumerate() {
                let one = at(&drawn, outline + FilmProfile::along(k));
                prop_assert!((value - one).abs() < 1e-4, "{} {} {}", k, value, one);
            }
        }
    }
}
