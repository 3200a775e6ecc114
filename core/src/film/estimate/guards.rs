//! What is not believed: frames that fit worse than the others, and a curved display that one component alone tells of
//! where enhanced edges would explain it as well.

use heapless::Vec;

use super::solver::{Drawings, Fit, UNEXPLAINED};
use super::unknowns::{CURVATURE, DisplayKnowledge, MOST_COMPONENTS, UNKNOWNS, Vector};
use crate::film::profile::FilmProfile;

/// A frame whose profiles cost more than this many times the mean of the better half of a component's frames is left out: its
/// pose may be wrong.
const COSTLY: f64 = 1.4;
/// So many frames of a component, spread over all of a film, tell what profiles of the better half cost.
const COMPARED: usize = 256;
/// Curvature for each contrast from which on it must be confirmed: an unsharp mask on a linear film looks alike, but not the
/// same to components of other thickness.
pub(super) const DOUBTED: f64 = 1.2;
/// Curvatures of single components, for each contrast, that differ by no more than this part, agree.
const AGREE: f64 = 0.3;

impl Fit<'_> {
    /// Leaves frames out whose profiles are explained worse than those of the others; whether there are any.
    pub(super) fn leave_out_costly(&mut self, at: &Vector) -> bool {
        let drawings = Drawings::alone(self, at);
        let components = 0..self.components as u8;
        let any = components.map(|component| self.leave_out_costly_of(component, &drawings));
        // Of each of them, whatever was left out before.
        any.fold(false, |any, one| any | one)
    }

    fn leave_out_costly_of(&mut self, component: u8, drawings: &Drawings) -> bool {
        let frames = self.frames_of(component).count();
        let every = frames.div_ceil(COMPARED).max(1);
        let compared = self.frames_of(component).step_by(every);
        let costs: Vec<f64, COMPARED> = compared
            .map(|profiles| self.cost_of(profiles, drawings))
            .collect();
        let mut sorted = costs.clone();
        sorted.sort_unstable_by(f64::total_cmp);
        let half = &sorted[..sorted.len().div_ceil(2)];
        let limit = COSTLY * half.iter().sum::<f64>() / half.len().max(1) as f64;
        let (mut any, mut from, mut number) = (false, 0, 0);
        while let Some(profiles) = self.frame_from(from) {
            let to = from + profiles.len();
            if profiles[0].component == component {
                let known = costs.get(number / every).filter(|_| number % every == 0);
                let cost = known.copied();
                if cost.unwrap_or_else(|| self.cost_of(profiles, drawings)) > limit {
                    let costly = self.profiles[from..to].iter_mut();
                    costly.for_each(|profile| profile.used = false);
                    any = true;
                }
                number += 1;
            }
            from = to;
        }
        any
    }

    /// The profiles of each frame of a component: they stand together.
    fn frames_of(&self, component: u8) -> impl Iterator<Item = &[FilmProfile]> {
        let frames = self.profiles.chunk_by(FilmProfile::is_of_frame);
        frames.filter(move |profiles| profiles[0].component == component)
    }

    /// Those of the frame and component that begins at a number.
    fn frame_from(&self, number: usize) -> Option<&[FilmProfile]> {
        let rest = self.profiles.get(number..)?;
        rest.chunk_by(FilmProfile::is_of_frame).next()
    }

    /// The mean cost of profiles.
    fn cost_of(&self, profiles: &[FilmProfile], drawings: &Drawings) -> f64 {
        let cost = |profile: &FilmProfile| {
            let explained = self.explained(profile, drawings);
            explained.map_or(UNEXPLAINED, |(explained, _)| self.cost(explained.squares()))
        };
        profiles.iter().map(cost).sum::<f64>() / (profiles.len() as f64).max(1.0)
    }

    /// Whether the curvature is believed: a small one is, and a large one where two components tell it alike, or one alone tells it
    /// from enhanced edges. Where components contradict each other the film is taken to be linear; where one alone does not tell,
    /// to be in the middle between that and what it tells.
    pub(super) fn confirmed(&mut self, at: &mut Vector) -> Option<Confirmed> {
        if self.given.display.is_some() {
            return Some(Confirmed::by(DisplayKnowledge::Stated));
        }
        if at[CURVATURE] < DOUBTED {
            return Some(Confirmed::by(DisplayKnowledge::Told));
        }
        let told = self.told_by_each(at);
        let [least, most] = told.iter().fold([f64::MAX, f64::MIN], |[least, most], &x| {
            [least.min(x), most.max(x)]
        });
        if told.len() >= 2 && most - least <= AGREE * most {
            self.find_shifts(at);
            return Some(Confirmed::by(DisplayKnowledge::Told));
        }
        if told.len() < 2 && self.beats_linear(at) {
            return Some(Confirmed::by(DisplayKnowledge::Told));
        }
        let curved = *at;
        self.hold_curvature(0.0, at)?;
        if told.len() >= 2 {
            return Some(Confirmed::by(DisplayKnowledge::Untold));
        }
        let half = core::array::from_fn(|k| (curved[k] - at[k]) / 2.0);
        self.hold_curvature(half[CURVATURE], at)?;
        Some(Confirmed {
            display: DisplayKnowledge::Either,
            half,
        })
    }

    /// The curvature that each component tells by itself, where it does.
    fn told_by_each(&mut self, at: &Vector) -> Vec<f64, MOST_COMPONENTS> {
        let mut told = Vec::new();
        for component in 0..self.components as u8 {
            self.only = Some(component);
            let mut alone = *at;
            if self.improve(&mut alone, 6).is_some() {
                // There is room.
                let _ = told.push(alone[CURVATURE]);
            }
        }
        self.only = None;
        told
    }

    fn hold_curvature(&mut self, curvature: f64, at: &mut Vector) -> Option<()> {
        (at[CURVATURE], self.hold) = (curvature, true);
        self.find_shifts(at);
        self.improve(at, 8).map(|_| ())
    }
}

/// What is known of the display, and half of what lies between the films that it may be.
pub(super) struct Confirmed {
    pub(super) display: DisplayKnowledge,
    pub(super) half: Vector,
}

impl Confirmed {
    fn by(display: DisplayKnowledge) -> Self {
        Self {
            display,
            half: [0.0; UNKNOWNS],
        }
    }
}
