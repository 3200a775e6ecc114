//! A film's numbers at steps of flexion.

use fluoropose::Side;
use fluoropose::joint::numbers::NUMBERS;

use crate::film::{JointFilm, Step};

/// A joint's numbers at one flexion.
#[derive(Clone, Debug)]
pub struct Level {
    /// Flexion, degrees.
    pub flexion_deg: f64,
    /// In the order of [`COLUMNS`].
    pub steps: [Step; NUMBERS],
}

/// A film's numbers at the steps of its flexion: all that groups are made from, and little beside the film.
#[derive(Clone, Debug)]
pub struct FilmLevels {
    /// What the study is called.
    pub name: String,
    /// Which knee.
    pub side: Side,
    /// What a reader has to know of it, sentences.
    pub told: Vec<String>,
    /// Step by step.
    pub levels: Vec<Level>,
}

impl FilmLevels {
    /// Those of a film.
    #[must_use]
    pub fn of(film: &JointFilm) -> Self {
        Self {
            name: film.name.clone(),
            side: film.side,
            told: film.told(),
            levels: by_flexion(film),
        }
    }

    /// A number at one step; NaN where no phase passes it.
    pub(crate) fn mean(&self, number: usize, level_deg: f64) -> f64 {
        let mut levels = self.levels.iter();
        let found = levels.find(|level| level.flexion_deg == level_deg);
        found.map_or(f64::NAN, |level| level.steps[number].mean)
    }
}

/// The numbers of a film at each step of its flexion, from the phases that pass it, without doubtful frames.
#[must_use]
pub fn by_flexion(film: &JointFilm) -> Vec<Level> {
    let phases = film.phases();
    let levels = film.levels().into_iter();
    let level = |flexion_deg| Level {
        flexion_deg,
        steps: core::array::from_fn(|number| film.at(number, &phases, flexion_deg)),
    };
    levels.map(level).collect()
}
