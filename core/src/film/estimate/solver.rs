//! The search for the constants: from several starts, by Levenberg and Marquardt.

use heapless::Vec;

use super::drawing::Drawing;
use super::equations::{Sums, product};
use super::unknowns::{
    AMOUNT, BLUR, CURVATURE, LEAST_PROFILES, MOST_COMPONENTS, OF_A_PROFILE, RADIUS, UNKNOWNS,
    Vector,
};
use crate::film::fit::{Developed, Explained, Residuals, explain, search};
use crate::film::given::GivenFilm;
use crate::film::model::{LEAST_BLUR, MOST_BLUR};
use crate::film::profile::{FilmProfile, READINGS};
use crate::film::sharpening::{MOST_AMOUNT, RADII};
use crate::math::{ln, solve_spd};

/// Curvatures to start from, for each contrast, and logarithms of attenuations.
const STARTS: [f64; 8] = [-0.3, 0.3, 0.9, 1.5, 2.2, 3.0, 4.0, 5.5];
pub(super) const ATTENUATIONS: [f64; 2] = [-1.8, -0.4];
/// What is expected of logarithms before anything was read, and its standard deviation: wide, for what data do not tell, as
/// the attenuation of metal that lets nothing pass.
const EXPECTED_BLUR: [f64; 2] = [-0.1, 0.8];
pub(super) const EXPECTED_ATTENUATION: [f64; 2] = [-1.2, 1.0];
const EXPECTED_AMOUNT: [f64; 2] = [0.0, 0.8];
pub(super) const EXPECTED_RADIUS: [f64; 2] = [1.0, 0.6];
/// Changes over which derivatives are taken.
const CHANGE: f64 = 0.03;
/// Residual of a profile, as a part of the contrast, from which on it counts less: films are shown in any units.
/// Two of 8-bit grey values on films of contrasts between 30 and 100.
const NOISE: f64 = 0.035;
/// What a profile costs that nothing explains.
pub(super) const UNEXPLAINED: f64 = 4.6;
/// Profiles that starts are compared on.
pub(super) const FEW: usize = 320;
/// Consecutive profiles that err alike.
const TOGETHER: usize = 8;

pub(super) fn ln_of_blur(blur_px: f64) -> f64 {
    ln(blur_px.clamp(LEAST_BLUR, MOST_BLUR))
}

/// Profiles and which of them are looked at.
pub(super) struct Fit<'p> {
    pub(super) profiles: &'p mut [FilmProfile],
    pub(super) components: usize,
    pub(super) contrast: f64,
    /// One component alone.
    pub(super) only: Option<u8>,
    /// One of this many profiles.
    pub(super) every: usize,
    /// Whether the curvature stays as it is.
    pub(super) hold: bool,
    /// Whether edges are taken to be enhanced.
    pub(super) sharpened: bool,
    /// What is not estimated.
    pub(super) given: GivenFilm,
}

impl Fit<'_> {
    /// The square of a residual, squared grey values, from which on a profile counts less.
    fn noise(&self) -> f64 {
        (NOISE * self.contrast) * (NOISE * self.contrast)
    }

    /// What a profile costs of which so much remains, squared grey values.
    pub(super) fn cost(&self, squares: f64) -> f64 {
        ln(1.0 + squares / self.noise())
    }

    fn expected(number: usize) -> Option<[f64; 2]> {
        match number {
            CURVATURE => None,
            BLUR => Some(EXPECTED_BLUR),
            AMOUNT => Some(EXPECTED_AMOUNT),
            RADIUS => Some(EXPECTED_RADIUS),
            _ => Some(EXPECTED_ATTENUATION),
        }
    }

    /// The best of several curvatures and attenuations, on some of the profiles.
    pub(super) fn begin(&mut self) -> Option<Vector> {
        self.every = (self.profiles.len() / FEW).max(1);
        self.hold = true;
        let mut tried: Vec<(f64, Vector), { STARTS.len() }> = Vec::new();
        let [least, most] = self.given.range();
        let blur = self.given.blur_px.map_or(EXPECTED_BLUR[0], ln_of_blur);
        let mut last = None;
        for curvature in STARTS.map(|curvature| curvature.clamp(least, most)) {
            if last.replace(curvature) == Some(curvature) {
                continue;
            }
            let from = ATTENUATIONS.iter().filter_map(|&attenuation| {
                let mut at = [attenuation; UNKNOWNS];
                (at[CURVATURE], at[BLUR]) = (curvature, blur);
                (at[AMOUNT], at[RADIUS]) = (0.0, EXPECTED_RADIUS[0]);
                self.find_shifts(&at);
                let cost = self.improve(&mut at, 8)?;
                Some((cost, at))
            });
            let best = from.min_by(|a, b| a.0.total_cmp(&b.0));
            // There is room.
            let _ = best.map(|best| tried.push(best));
        }
        (self.every, self.hold) = (1, least >= most);
        let (_, at) = tried.into_iter().min_by(|a, b| a.0.total_cmp(&b.0))?;
        self.find_shifts(&at);
        Some(at)
    }

    /// What constants make of profiles.
    pub(super) fn drawing(&self, at: &Vector) -> Drawing {
        Drawing::of(at, self.contrast, self.sharpened)
    }

    /// The unknowns that a profile depends on.
    fn of_profile(&self, profile: &FilmProfile) -> Vec<usize, OF_A_PROFILE> {
        let all = [
            CURVATURE,
            BLUR,
            2 + usize::from(profile.component),
            AMOUNT,
            RADIUS,
        ];
        let known = if self.sharpened { all.len() } else { 3 };
        all.into_iter().take(known).collect()
    }

    fn is_wanted(&self, number: usize, profile: &FilmProfile) -> bool {
        profile.used
            && number.is_multiple_of(self.every)
            && usize::from(profile.component) < self.components
            && self.only.is_none_or(|only| only == profile.component)
    }

    /// Looks for the shift of every profile.
    pub(super) fn find_shifts(&mut self, at: &Vector) {
        let drawing = self.drawing(at);
        for number in 0..self.profiles.len() {
            let profile = &self.profiles[number];
            if self.is_wanted(number, profile) {
                let film = Developed::of(profile, drawing.curvature);
                let found = search(profile, &film, &drawing.of_profile(profile));
                self.profiles[number].shift = found.map_or(0.0, |found| found.shift as f32);
            }
        }
    }

    /// Steps of Levenberg and Marquardt; gives the cost for each profile.
    pub(super) fn improve(&mut self, at: &mut Vector, steps: usize) -> Option<f64> {
        let mut seen = self.look(at)?;
        let mut damping = 1e-2;
        for _ in 0..steps {
            let mut normal = seen.normal;
            (0..UNKNOWNS).for_each(|k| normal[k][k] *= 1.0 + damping);
            let step = solve_spd(normal, seen.right)?;
            let mut next = *at;
            for (k, value) in next.iter_mut().enumerate() {
                *value += step[k].clamp(-0.8, 0.8);
            }
            let [least, most] = self.given.range();
            next[CURVATURE] = next[CURVATURE].clamp(least, most);
            next[BLUR] = next[BLUR].clamp(ln(LEAST_BLUR), ln(MOST_BLUR));
            next[AMOUNT] = next[AMOUNT].clamp(0.0, MOST_AMOUNT);
            next[RADIUS] = next[RADIUS].clamp(ln(RADII[0]), ln(RADII[1]));
            let there = self.look(&next)?;
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

    /// What is seen at some constants.
    pub(super) fn look(&mut self, at: &Vector) -> Option<Sums> {
        let mut sums = Sums {
            normal: [[0.0; UNKNOWNS]; UNKNOWNS],
            right: [0.0; UNKNOWNS],
            spread: [[0.0; UNKNOWNS]; UNKNOWNS],
            cost: 0.0,
            squares: 0.0,
            count: 0,
        };
        let drawings = Drawings::of(self, at);
        let (mut group, mut in_group) = ([0.0; UNKNOWNS], 0);
        for number in 0..self.profiles.len() {
            let profile = &self.profiles[number];
            if !self.is_wanted(number, profile) {
                continue;
            }
            let Some((explained, slopes)) = self.explained(profile, &drawings) else {
                sums.cost += UNEXPLAINED;
                continue;
            };
            let squares = explained.squares();
            let of = self.of_profile(profile);
            self.profiles[number].shift = explained.shift as f32;
            sums.cost += self.cost(squares);
            sums.squares += squares;
            sums.count += 1;
            let weight = 1.0 / (self.noise() + squares);
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
                // As of profiles, the right side is half of its slope.
                sums.cost += weight * off * off;
            }
        }
        sums.normal[CURVATURE][CURVATURE] += 1e-3;
        for unknown in (0..UNKNOWNS).filter(|&unknown| self.is_held(unknown)) {
            sums.hold(unknown);
        }
    }

    /// Whether an unknown stays as it is.
    fn is_held(&self, unknown: usize) -> bool {
        match unknown {
            CURVATURE => self.hold,
            BLUR => self.given.blur_px.is_some(),
            AMOUNT | RADIUS => !self.sharpened,
            _ => false,
        }
    }

    /// A profile explained, and how its residuals change with each unknown that it depends on and of which drawings have a change.
    pub(super) fn explained(
        &self,
        profile: &FilmProfile,
        drawings: &Drawings,
    ) -> Option<(Explained, [Residuals; OF_A_PROFILE])> {
        let own = &drawings.own;
        let film = Developed::of(profile, own.curvature);
        let start = f64::from(profile.shift);
        let before = own.before_sharpening(profile);
        let drawn = own.enhanced(profile, before);
        let explained = explain(profile, &film, &drawn, start)?;
        let mut slopes = [[0.0; READINGS]; OF_A_PROFILE];
        for (slopes, number) in slopes.iter_mut().zip(self.of_profile(profile)) {
            let Some(near) = &drawings.near[number] else {
                continue;
            };
            let other = match number {
                CURVATURE => {
                    let film = Developed::of(profile, near.curvature);
                    let drawn = near.enhanced(profile, before);
                    explain(profile, &film, &drawn, explained.shift)?
                }
                AMOUNT | RADIUS => {
                    let drawn = near.enhanced(profile, before);
                    explain(profile, &film, &drawn, explained.shift)?
                }
                _ => {
                    let drawn = near.of_profile(profile);
                    explain(profile, &film, &drawn, explained.shift)?
                }
            };
            for (k, slope) in slopes.iter_mut().enumerate() {
                *slope = (other.residuals[k] - explained.residuals[k]) / CHANGE as f32;
            }
        }
        Some((explained, slopes))
    }
}

/// What some constants make of profiles, and what those make of them in which one is changed a little: none of one that is held.
pub(super) struct Drawings {
    own: Drawing,
    near: [Option<Drawing>; UNKNOWNS],
}

impl Drawings {
    pub(super) fn of(fit: &Fit<'_>, at: &Vector) -> Self {
        let of_components = 2 + fit.components..2 + MOST_COMPONENTS;
        let near = |number| {
            if fit.is_held(number) || of_components.contains(&number) {
                return None;
            }
            let mut near = *at;
            near[number] += CHANGE;
            Some(fit.drawing(&near))
        };
        Self {
            own: fit.drawing(at),
            near: core::array::from_fn(near),
        }
    }

    /// Without changes.
    pub(super) fn alone(fit: &Fit<'_>, at: &Vector) -> Self {
        Self {
            own: fit.drawing(at),
            near: [const { None }; UNKNOWNS],
        }
    }
}
