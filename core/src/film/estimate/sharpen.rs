//! Whether the edges of a film were enhanced, and how.
//!
//! An unsharp mask on a linear film and a curved display without one look much alike: both are asked, and edges are taken to be
//! enhanced only where that leaves clearly less.

use super::solver::{FEW, Fit};
use super::unknowns::{AMOUNT, CURVATURE, MOST_COMPONENTS, RADIUS, Vector};
use crate::film::profile::FilmProfile;
use crate::film::sharpening::MetalContrast;
use crate::math::ln;

/// Enhanced edges are believed where profiles cost no more than this part of what they cost without. On synthetic films it is at
/// most 0.9 where edges were enhanced, 0.98 and more where they were not.
const WORTH: f64 = 0.94;
/// And where they are enhanced by this at least.
const LEAST_AMOUNT: f64 = 0.1;
/// An amount and a radius (pixels) to start from, and by how much logarithms of attenuations are less than without.
const START: [f64; 2] = [0.4, 2.5];
const THINNER: f64 = 0.5;

impl Fit<'_> {
    /// Takes edges to be enhanced where that explains the profiles better.
    pub(super) fn sharpen(&mut self, at: &mut Vector) -> Option<()> {
        self.every = (self.profiles.len() / FEW).max(1);
        let plain = self.improve(at, 0)?;
        let held = self.hold;
        self.sharpened = true;
        let mut best: Option<(f64, Vector)> = None;
        for curvature in [0.0, at[CURVATURE]] {
            let Some(found) = self.sharpened_from(at, curvature, held) else {
                continue;
            };
            if best.is_none_or(|best| found.0 < best.0) {
                best = Some(found);
            }
        }
        self.every = 1;
        let worth =
            best.filter(|&(cost, near)| cost < WORTH * plain && near[AMOUNT] > LEAST_AMOUNT);
        self.sharpened = worth.is_some();
        if let Some((_, near)) = worth {
            *at = near;
        }
        self.find_shifts(at);
        if self.sharpened {
            self.improve(at, 5)?;
        }
        Some(())
    }

    /// What enhanced edges cost from a curvature, and the unknowns there.
    fn sharpened_from(&mut self, at: &Vector, curvature: f64, held: bool) -> Option<(f64, Vector)> {
        let mut near = *at;
        near[CURVATURE] = curvature;
        near.iter_mut()
            .skip(2)
            .take(MOST_COMPONENTS)
            .for_each(|attenuation| *attenuation -= THINNER);
        (near[AMOUNT], near[RADIUS]) = (START[0], ln(START[1]));
        self.find_shifts(&near);
        self.hold = true;
        let first = self.improve(&mut near, 4);
        self.hold = held;
        first?;
        let cost = self.improve(&mut near, 8)?;
        Some((cost, near))
    }

    /// Whether a linear display explains the profiles clearly worse, even with enhanced edges.
    pub(super) fn beats_linear(&mut self, at: &mut Vector) -> bool {
        self.every = (self.profiles.len() / FEW).max(1);
        let own = self.improve(at, 0);
        let (sharpened, held) = (self.sharpened, self.hold);
        self.sharpened = true;
        let linear = self.sharpened_from(at, 0.0, true);
        (self.every, self.sharpened, self.hold) = (1, sharpened, held);
        self.find_shifts(at);
        let beats = |(own, (linear, _)): (f64, (f64, Vector))| own < WORTH * linear;
        own.zip(linear).is_some_and(beats)
    }

    /// What the profiles of a component show beside metal and behind it.
    pub(super) fn metal(&self, component: usize, at: &Vector) -> MetalContrast {
        let is_of =
            |profile: &&FilmProfile| profile.used && usize::from(profile.component) == component;
        let drawing = self.drawing(at);
        let (mut grey, mut passed, mut count) = (0.0, 0.0, 0.0);
        for profile in self.profiles.iter().filter(is_of) {
            grey += f64::from(profile.contrast());
            passed += f64::from(profile.inside(&drawing.before_sharpening(profile)));
            count += 1.0;
        }
        match count > 0.0 {
            true => MetalContrast {
                grey: grey / count,
                passed: passed / count,
            },
            false => MetalContrast::default(),
        }
    }
}
