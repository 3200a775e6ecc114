//! Several knees together.

use fluoropose::joint::course::FLEXION_STEP_DEG;
use fluoropose::joint::group::{OverKnees, over_knees};

use crate::levels::FilmLevels;

/// A knee with its films: the same implant in the same person.
#[derive(Clone, Debug)]
pub struct Knee {
    /// What it is called.
    pub name: String,
    /// Its films.
    pub films: Vec<FilmLevels>,
}

impl Knee {
    /// What is wrong with films of one knee, a sentence without its full stop: they are of both sides of a body.
    #[must_use]
    pub fn fault(&self) -> Option<String> {
        let (first, others) = self.films.split_first()?;
        let other = others.iter().find(|film| film.side != first.side)?;
        Some(format!(
            "the knee {} would be a {} one in the film {} and a {} one in {}",
            self.name, first.side, first.name, other.side, other.name
        ))
    }
}

/// Knees that are published together.
#[derive(Clone, Debug)]
pub struct Group {
    /// What it is called.
    pub name: String,
    knees: Vec<Knee>,
}

impl Group {
    /// Of knees with their films.
    #[must_use]
    pub fn new(name: String, knees: Vec<Knee>) -> Self {
        Self { name, knees }
    }

    /// The knees.
    #[must_use]
    pub fn knees(&self) -> &[Knee] {
        &self.knees
    }

    /// The films, knee by knee.
    pub fn films(&self) -> impl Iterator<Item = &FilmLevels> {
        self.knees.iter().flat_map(|knee| &knee.films)
    }

    /// What a reader has to know of its films, each sentence with the knee and the film that it is of.
    #[must_use]
    pub fn told(&self) -> Vec<String> {
        let of_film = |knee: &str, film: &FilmLevels| {
            let place = format!("knee {knee}, {}", film.name);
            let told = film.told.iter();
            told.map(|told| format!("{place}: {told}"))
                .collect::<Vec<_>>()
        };
        let knees = self.knees.iter();
        let films = knees.flat_map(|knee| knee.films.iter().map(|film| (knee.name.as_str(), film)));
        films.flat_map(|(knee, film)| of_film(knee, film)).collect()
    }

    /// The flexions that any film passes within a phase, degrees.
    #[must_use]
    pub fn levels(&self) -> Vec<f64> {
        let all = self.films().flat_map(|film| &film.levels);
        let steps = all.map(|level| (level.flexion_deg / FLEXION_STEP_DEG).round() as i64);
        let steps: std::collections::BTreeSet<i64> = steps.collect();
        steps
            .into_iter()
            .map(|step| step as f64 * FLEXION_STEP_DEG)
            .collect()
    }

    /// A number of one knee at one flexion: that of each of its films, which is the mean over the film's phases.
    #[must_use]
    pub fn of_knee(&self, knee: usize, number: usize, level_deg: f64) -> Vec<f64> {
        let films = self.knees[knee].films.iter();
        films.map(|film| film.mean(number, level_deg)).collect()
    }

    /// The mean over the films of one knee at one flexion, with their standard deviation and number.
    #[must_use]
    pub fn over_films(&self, knee: usize, number: usize, level_deg: f64) -> OverKnees {
        over_knees(self.of_knee(knee, number, level_deg).chunks(1))
    }

    /// A number of the group at one flexion: each knee first, then all. Nothing is extrapolated, so `n` may differ from step to step.
    #[must_use]
    pub fn at(&self, number: usize, level_deg: f64) -> OverKnees {
        let knees = 0..self.knees.len();
        let values: Vec<Vec<f64>> = knees
            .map(|knee| self.of_knee(knee, number, level_deg))
            .collect();
        over_knees(values.iter().map(Vec::as_slice))
    }
}
