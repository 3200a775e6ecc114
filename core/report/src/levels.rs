//! A film's numbers at steps of flexion.

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
