//! The constants of a film, from profiles across the outlines of its components.
//!
//! Only the shape of profiles counts: where each lies along its normal is left free, so nothing is circular with the depths of
//! the poses that they were read at. What is minimised is `sum log(1 + RSS / 4)` over profiles, by Gauss and Newton with
//! weights made anew, from several curvatures, because there are local minima.

use core::fmt;

use heapless::Vec;

use super::fit::{Developed, Explained, Residuals, explain, search};
use super::model::{
    CONSTANTS, Drawn, FilmConstants, FilmModel, LEAST_BLUR, MOST_BLUR, blurred, transmission,
};
use super::profile::FilmProfile;
use crate::math::{exp, inverse_spd, ln, solve_spd, sqrt};

/// Most components of a film.
pub const MOST_COMPONENTS: usize = 4;

/// Contrast times curvature, the logarithm of the blur, and those of the attenuations.
const UNKNOWNS: usize = 2 + MOST_COMPONENTS;
const CURVATURE: usize = 0;
const BLUR: usize = 1;

type Vector = [f64; UNKNOWNS];
type Matrix = [[f64; UNKNOWNS]; UNKNOWNS];

/// Curvatures to start from, for each contrast, and logarithms of attenuations.
const STARTS: [f64; 8] = [-0.3, 0.3, 0.9, 1.5, 2.2, 3.0, 4.0, 5.5];
const ATTENUATIONS: [f64; 2] = [-1.8, -0.4];
/// What is expected of logarithms before anything was read, and its standard deviation: wide, for what data do not tell, as
/// the attenuation of metal that lets nothing pass.
const EXPECTED_BLUR: [f64; 2] = [-0.1, 0.8];
const EXPECTED_ATTENUATION: [f64; 2] = [-1.2, 1.0];
/// Changes over which derivatives are taken.
const CHANGE: f64 = 0.03;
/// Square of the residual, grey values, from which on a profile counts less.
const SCALE: f64 = 4.0;
/// At least so many profiles tell anything.
const LEAST_PROFILES: usize = 40;
/// Profiles that starts are compared on.
const FEW: usize = 320;
/// Consecutive profiles that err alike.
const TOGETHER: usize = 8;
/// A frame whose profiles cost more than this many times the mean of the better half of a component's frames is left out: its
/// pose may be wrong.
const COSTLY: f64 = 1.4;
/// Curvature for each contrast from which on it must be confirmed: an unsharp mask on a linear film looks alike, but not the
/// same to components of other thickness.
const DOUBTED: f64 = 1.2;
/// Curvatures of single components, for each contrast, that differ by no more than this part, agree.
const AGREE: f64 = 0.3;
/// Errors that formal ones do not know of: for the physics left out. Of the curvature for each contrast, and of logarithms.
const LEAST_DEVIATION: [f64; 3] = [0.06, 0.05, 0.1];
/// The same of the curvature where no two components tell it alike.
const UNTOLD_DEVIATION: f64 = 0.6;

/// What is known of a display.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DisplayKnowledge {
    /// The profiles tell it.
    Told,
    /// They do not: components contradict each other, or there is one alone, and an unsharp mask may pass for a curve. The
    /// film is taken to be linear.
    Untold,
}

/// The constants of a film and how sure they are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilmEstimate {
    /// Those of the film.
    pub constants: FilmConstants,
    /// Attenuation of each component's metal, per mm.
    pub attenuation: [f64; MOST_COMPONENTS],
    /// Covariance of the curvature, the logarithm of the blur, and those of the attenuations.
    pub covariance: [[f64; UNKNOWNS]; UNKNOWNS],
    /// What is known of the display.
    pub display: DisplayKnowledge,
    /// Typical difference between the grey values beside metal and behind it.
    pub contrast: f64,
    /// Profiles that were believed.
    pub profiles: usize,
    /// Root mean square of what remains unexplained of them, grey values.
    pub residual: f64,
}

impl FilmEstimate {
    /// What the film makes of a component.
    #[must_use]
    pub fn model(&self, component: usize) -> FilmModel {
        let component = component.min(MOST_COMPONENTS - 1);
        let of = [CURVATURE, BLUR, 2 + component];
        FilmModel {
            constants: self.constants,
            attenuation: self.attenuation[component],
            covariance: of.map(|row| of.map(|column| self.covariance[row][column])),
        }
    }
}

/// As a person would say it, without a full stop.
impl fmt::Display for FilmEstimate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let FilmConstants { curvature, blur_px } = self.constants;
        match (self.display, curvature * self.contrast) {
            (DisplayKnowledge::Untold, _) => {
                f.write_str("film taken to be linear, because its frames do not tell")?;
            }
            (_, curved) if curved < 0.5 => f.write_str("nearly linear film")?,
            (_, curved) if curved < 1.0 => f.write_str("film between linear and logarithmic")?,
            _ => write!(
                f,
                "logarithmic film, {:.0} grey values for a factor of e",
                1.0 / curvature
            )?,
        }
        write!(f, ", blur {blur_px:.1} px")
    }
}

/// Estimates the constants of a film from profiles of `components` components: the same film, any frames. The profiles of a
/// frame and component stand together, in order along the outline where that is known. `None` where they do not tell.
#[must_use]
pub fn estimate(profiles: &mut [FilmProfile], components: usize) -> Option<FilmEstimate> {
    let contrast = contrast(profiles)?;
    profiles.iter_mut().for_each(|profile| profile.used = true);
    let mut fit = Fit {
        profiles,
        components: components.min(MOST_COMPONENTS),
        contrast,
        only: None,
        every: 1,
        hold: false,
    };
    let mut at = fit.begin()?;
    fit.improve(&mut at, 8)?;
    if fit.leave_out_costly(&at) {
        fit.improve(&mut at, 6)?;
    }
    let display = fit.confirmed(&mut at)?;
    let sums = fit.look(&at, true)?;
    if sums.count < LEAST_PROFILES {
        return None;
    }
    let mut covariance = sums.covariance()?;
    let least = |k: usize| match (k, display) {
        (CURVATURE, DisplayKnowledge::Untold) => UNTOLD_DEVIATION,
        _ => LEAST_DEVIATION[k.min(2)],
    };
    (0..UNKNOWNS).for_each(|k| covariance[k][k] += least(k) * least(k));
    for (k, row) in covariance.iter_mut().enumerate() {
        for (other, value) in row.iter_mut().enumerate() {
            *value /= if k == CURVATURE { contrast } else { 1.0 };
            *value /= if other == CURVATURE { contrast } else { 1.0 };
        }
    }
    Some(FilmEstimate {
        constants: constants(&at, contrast),
        attenuation: core::array::from_fn(|component| exp(at[2 + component])),
        covariance,
        display,
        contrast,
        profiles: sums.count,
        residual: sqrt(sums.squares / (sums.count * super::profile::READINGS) as f64),
    })
}

fn constants(at: &Vector, contrast: f64) -> FilmConstants {
    FilmConstants {
        curvature: at[CURVATURE] / contrast,
        blur_px: exp(at[BLUR]),
    }
}

/// The mean difference between grey values beside metal and behind it; `None` where metal is not darker.
fn contrast(profiles: &[FilmProfile]) -> Option<f64> {
    let dark = profiles
        .iter()
        .map(FilmProfile::contrast)
        .filter(|&x| x > 0.0);
    let (count, sum) = dark.fold((0, 0.0), |(count, sum), x| (count + 1, sum + f64::from(x)));
    let enough = count >= LEAST_PROFILES && 2 * count > profiles.len();
    enough.then(|| sum / f64::from(count as u32))
}

/// Profiles and which of them are looked at.
struct Fit<'p> {
    profiles: &'p mut [FilmProfile],
    components: usize,
    contrast: f64,
    /// One component alone.
    only: Option<u8>,
    /// One of this many profiles.
    every: usize,
    /// Whether the curvature stays as it is.
    hold: bool,
}

/// What was found at some constants.
struct Sums {
    normal: Matrix,
    right: Vector,
    /// Covariance of the right side.
    spread: Matrix,
    cost: f64,
    squares: f64,
    count: usize,
}

impl Sums {
    /// Of estimates: a sandwich of what is known about the minimum and how its slope varies between stretches of outline.
    fn covariance(&self) -> Option<Matrix> {
        let bread = inverse_spd(&self.normal)?;
        let mut product = [[0.0; UNKNOWNS]; UNKNOWNS];
        for (row, out) in product.iter_mut().enumerate() {
            for (column, value) in out.iter_mut().enumerate() {
                for a in 0..UNKNOWNS {
                    for b in 0..UNKNOWNS {
                        *value += bread[row][a] * self.spread[a][b] * bread[b][column];
                    }
                }
            }
        }
        Some(product)
    }
}

impl Fit<'_> {
    fn expected(number: usize) -> Option<[f64; 2]> {
        match number {
            CURVATURE => None,
            BLUR => Some(EXPECTED_BLUR),
            _ => Some(EXPECTED_ATTENUATION),
        }
    }

    /// The best of several curvatures and attenuations, on some of the profiles; between curvatures by a parabola.
    fn begin(&mut self) -> Option<Vector> {
        self.every = (self.profiles.len() / FEW).max(1);
        self.hold = true;
        let mut tried: Vec<(f64, Vector), { STARTS.len() }> = Vec::new();
        for curvature in STARTS {
            let from = ATTENUATIONS.iter().filter_map(|&attenuation| {
                let mut at = [attenuation; UNKNOWNS];
                (at[CURVATURE], at[BLUR]) = (curvature, EXPECTED_BLUR[0]);
                self.find_shifts(&at);
                let cost = self.improve(&mut at, 8)?;
                Some((cost, at))
            });
            let best = from.min_by(|a, b| a.0.total_cmp(&b.0));
            // There is room.
            let _ = best.map(|best| tried.push(best));
        }
        (self.every, self.hold) = (1, false);
        let (_, at) = tried.into_iter().min_by(|a, b| a.0.total_cmp(&b.0))?;
        self.find_shifts(&at);
        Some(at)
    }

    fn drawn(&self, profile: &FilmProfile, at: &Vector) -> Drawn {
        let passed = transmission(&profile.paths, exp(at[2 + usize::from(profile.component)]));
        blurred(&passed, exp(at[BLUR]))
    }

    fn is_wanted(&self, number: usize, profile: &FilmProfile) -> bool {
        profile.used
            && number.is_multiple_of(self.every)
            && usize::from(profile.component) < self.components
            && self.only.is_none_or(|only| only == profile.component)
    }

    /// Looks for the shift of every profile.
    fn find_shifts(&mut self, at: &Vector) {
        for number in 0..self.profiles.len() {
            let profile = &self.profiles[number];
            if self.is_wanted(number, profile) {
                let film = Developed::of(profile, at[CURVATURE] / self.contrast);
                let found = search(profile, &film, &self.drawn(profile, at));
                self.profiles[number].shift = found.map_or(0.0, |found| found.shift as f32);
            }
        }
    }

    /// Steps of Levenberg and Marquardt; gives the cost for each profile.
    fn improve(&mut self, at: &mut Vector, steps: usize) -> Option<f64> {
        let mut seen = self.look(at, true)?;
        let mut damping = 1e-2;
        for _ in 0..steps {
            let mut normal = seen.normal;
            (0..UNKNOWNS).for_each(|k| normal[k][k] *= 1.0 + damping);
            let step = solve_spd(normal, seen.right)?;
            let mut next = *at;
            for (k, value) in next.iter_mut().enumerate() {
                *value += step[k].clamp(-0.8, 0.8);
            }
            next[CURVATURE] = next[CURVATURE].clamp(-1.0, 8.0);
            next[BLUR] = next[BLUR].clamp(ln(LEAST_BLUR), ln(MOST_BLUR));
            let there = self.look(&next, true)?;
            if there.cost < seen.cost {
                let settled = step.iter().all(|x| x.abs() < 2e-3);
                (*at, seen) = (next, there);
                damping *= 0.2;
                if settled {
                    break;
                }
            } else {
                damping *= 10.0;
                if damping > 1e3 {
                    break;
                }
            }
        }
        Some(seen.cost / seen.count as f64)
    }

    /// What is seen at some constants, with derivatives where they are `wanted`.
    fn look(&mut self, at: &Vector, wanted: bool) -> Option<Sums> {
        let mut sums = Sums {
            normal: [[0.0; UNKNOWNS]; UNKNOWNS],
            right: [0.0; UNKNOWNS],
            spread: [[0.0; UNKNOWNS]; UNKNOWNS],
            cost: 0.0,
            squares: 0.0,
            count: 0,
        };
        let (mut group, mut in_group) = ([0.0; UNKNOWNS], 0);
        for number in 0..self.profiles.len() {
            let profile = &self.profiles[number];
            if !self.is_wanted(number, profile) {
                continue;
            }
            let Some((explained, slopes)) = self.explained(profile, at, wanted) else {
                sums.cost += ln(1.0 + 400.0 / SCALE);
                continue;
            };
            let squares = explained.squares();
            let component = 2 + usize::from(profile.component);
            self.profiles[number].shift = explained.shift as f32;
            sums.cost += ln(1.0 + squares / SCALE);
            sums.squares += squares;
            sums.count += 1;
            let weight = 1.0 / (SCALE + squares);
            let of = [CURVATURE, BLUR, component];
            for (a, &row) in of.iter().enumerate() {
                let pull = -weight * product(&slopes[a], &explained.residuals);
                sums.right[row] += pull;
                group[row] += pull;
                for (b, &column) in of.iter().enumerate() {
                    sums.normal[row][column] += weight * product(&slopes[a], &slopes[b]);
                }
            }
            in_group += 1;
            if in_group == TOGETHER {
                sums.close(&mut group);
                in_group = 0;
            }
        }
        sums.close(&mut group);
        self.expect(at, &mut sums);
        (sums.count >= LEAST_PROFILES / 2).then_some(sums)
    }

    /// Adds what is expected of the unknowns before anything is read.
    fn expect(&self, at: &Vector, sums: &mut Sums) {
        for (k, value) in at.iter().enumerate() {
            if let Some([mean, deviation]) = Self::expected(k) {
                let weight = 1.0 / (deviation * deviation);
                let off = value - mean;
                sums.normal[k][k] += weight;
                sums.spread[k][k] += weight;
                sums.right[k] -= weight * off;
                sums.cost += weight * off * off / 2.0;
            }
        }
        if self.hold {
            for matrix in [&mut sums.normal, &mut sums.spread] {
                matrix[CURVATURE] = [0.0; UNKNOWNS];
                matrix.iter_mut().for_each(|row| row[CURVATURE] = 0.0);
            }
            sums.right[CURVATURE] = 0.0;
            sums.normal[CURVATURE][CURVATURE] = 1.0;
        } else {
            sums.normal[CURVATURE][CURVATURE] += 1e-3;
        }
    }

    /// A profile explained, and how its residuals change with curvature, blur and attenuation.
    fn explained(
        &self,
        profile: &FilmProfile,
        at: &Vector,
        wanted: bool,
    ) -> Option<(Explained, [Residuals; CONSTANTS])> {
        let film = Developed::of(profile, at[CURVATURE] / self.contrast);
        let start = f64::from(profile.shift);
        let explained = explain(profile, &film, &self.drawn(profile, at), start)?;
        let mut slopes = [[0.0; super::profile::READINGS]; CONSTANTS];
        if wanted {
            let of = [CURVATURE, BLUR, 2 + usize::from(profile.component)];
            for (slopes, number) in slopes.iter_mut().zip(of) {
                let mut near = *at;
                near[number] += CHANGE;
                let other = match number {
                    CURVATURE => {
                        let film = Developed::of(profile, near[CURVATURE] / self.contrast);
                        explain(profile, &film, &self.drawn(profile, at), explained.shift)?
                    }
                    _ => explain(profile, &film, &self.drawn(profile, &near), explained.shift)?,
                };
                for (k, slope) in slopes.iter_mut().enumerate() {
                    *slope = (other.residuals[k] - explained.residuals[k]) / CHANGE as f32;
                }
            }
        }
        Some((explained, slopes))
    }

    /// Leaves frames out whose profiles are explained worse than those of the others; whether there are any.
    fn leave_out_costly(&mut self, at: &Vector) -> bool {
        let mut any = false;
        for component in 0..self.components as u8 {
            let mut costs: Vec<(u16, f64), 256> = Vec::new();
            for number in 0..self.profiles.len() {
                let profile = &self.profiles[number];
                if profile.component != component || costs.is_full() {
                    continue;
                }
                if costs
                    .last()
                    .is_none_or(|&(frame, _)| frame != profile.frame)
                {
                    let cost = self.cost_of(profile.frame, component, at);
                    // There is room.
                    let _ = costs.push((profile.frame, cost));
                }
            }
            let mut sorted: Vec<f64, 256> = costs.iter().map(|&(_, cost)| cost).collect();
            sorted.sort_unstable_by(f64::total_cmp);
            let half = &sorted[..sorted.len().div_ceil(2)];
            let limit = COSTLY * half.iter().sum::<f64>() / half.len().max(1) as f64;
            for profile in self.profiles.iter_mut() {
                let costly = |&(frame, cost): &(u16, f64)| frame == profile.frame && cost > limit;
                if profile.component == component && costs.iter().any(costly) {
                    profile.used = false;
                    any = true;
                }
            }
        }
        any
    }

    /// The mean cost of the profiles of a frame and component.
    fn cost_of(&self, frame: u16, component: u8, at: &Vector) -> f64 {
        let wanted =
            |profile: &&FilmProfile| profile.frame == frame && profile.component == component;
        let (mut sum, mut count) = (0.0, 0.0f64);
        for profile in self.profiles.iter().filter(wanted) {
            let squares = self.explained(profile, at, false);
            sum += ln(1.0 + squares.map_or(400.0, |(explained, _)| explained.squares()) / SCALE);
            count += 1.0;
        }
        sum / count.max(1.0)
    }

    /// Whether the curvature is believed: a small one is, and a large one where two components tell it alike. Else the film
    /// is taken to be linear.
    fn confirmed(&mut self, at: &mut Vector) -> Option<DisplayKnowledge> {
        if at[CURVATURE] < DOUBTED {
            return Some(DisplayKnowledge::Told);
        }
        let mut told: Vec<f64, MOST_COMPONENTS> = Vec::new();
        for component in 0..self.components as u8 {
            self.only = Some(component);
            let mut alone = *at;
            if self.improve(&mut alone, 6).is_some() {
                // There is room.
                let _ = told.push(alone[CURVATURE]);
            }
        }
        self.only = None;
        let [least, most] = told.iter().fold([f64::MAX, f64::MIN], |[least, most], &x| {
            [least.min(x), most.max(x)]
        });
        if told.len() >= 2 && most - least <= AGREE * most {
            self.find_shifts(at);
            return Some(DisplayKnowledge::Told);
        }
        (at[CURVATURE], self.hold) = (0.0, true);
        self.find_shifts(at);
        self.improve(at, 8)?;
        Some(DisplayKnowledge::Untold)
    }
}

impl Sums {
    /// Adds a stretch of profiles that err alike.
    fn close(&mut self, group: &mut Vector) {
        for (row, &a) in group.iter().enumerate() {
            for (sum, &b) in self.spread[row].iter_mut().zip(group.iter()) {
                *sum += a * b;
            }
        }
        *group = [0.0; UNKNOWNS];
    }
}

fn product(a: &Residuals, b: &Residuals) -> f64 {
    f64::from(a.iter().zip(b).map(|(a, b)| a * b).sum::<f32>())
}

#[cfg(test)]
mod tests;
