//! A film's numbers at steps of flexion, as a table that is written and read again.

use std::fmt::Write as _;

use fluoropose::joint::COLUMNS;
use fluoropose::joint::numbers::NUMBERS;
use thiserror::Error;

use crate::film::{JointFilm, Step};

/// A joint's numbers at one flexion.
#[derive(Clone, Debug)]
pub struct Level {
    /// Flexion, degrees.
    pub flexion_deg: f64,
    /// In the order of [`COLUMNS`].
    pub steps: [Step; NUMBERS],
}

/// Why a text is no such table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum LevelsError {
    /// Another first line.
    #[error("this is no table of numbers by flexion of this version")]
    Heading,
    /// A row of another length, or with words.
    #[error("line {0} of the table by flexion does not hold a number in each column")]
    Row(usize),
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

fn heading() -> String {
    let mut line = "at_flexion_deg".to_owned();
    for column in &COLUMNS {
        let _ = write!(line, ",{0},sd_{0},n_{0}", column.name);
    }
    line
}

/// A row a step; each number with the standard deviation carried from the poses and the number of phases that pass the step.
#[must_use]
pub fn table(levels: &[Level]) -> String {
    let mut out = heading();
    out.push('\n');
    for level in levels {
        let _ = write!(out, "{}", level.flexion_deg);
        for step in &level.steps {
            let _ = write!(out, ",{},{},{}", step.mean, step.deviation, step.n);
        }
        out.push('\n');
    }
    out
}

/// Reads such a table.
///
/// # Errors
/// [`LevelsError`] names the line.
pub fn read(text: &str) -> Result<Vec<Level>, LevelsError> {
    let mut lines = text.lines().enumerate();
    let first = lines.next().map(|(_, line)| line.trim_end());
    if first != Some(heading().as_str()) {
        return Err(LevelsError::Heading);
    }
    lines
        .map(|(index, line)| row(line).ok_or(LevelsError::Row(index + 1)))
        .collect()
}

fn row(line: &str) -> Option<Level> {
    let numbers: Option<Vec<f64>> = line
        .trim_end()
        .split(',')
        .map(|field| field.parse().ok())
        .collect();
    let numbers = numbers?;
    let (flexion_deg, rest) = numbers.split_first()?;
    let (steps, over) = rest.as_chunks::<3>();
    let steps: &[[f64; 3]; NUMBERS] = steps.try_into().ok().filter(|_| over.is_empty())?;
    Some(Level {
        flexion_deg: *flexion_deg,
        steps: steps.map(|[mean, deviation, n]| Step {
            mean,
            deviation,
            n: n as usize,
        }),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_reads_back_to_the_last_bit() {
        let step = |k: usize| Step {
            mean: (k as f64) / 7.0 - 1.0,
            deviation: if k == 3 { f64::NAN } else { 0.1 / 3.0 },
            n: k,
        };
        let level = |flexion_deg| Level {
            flexion_deg,
            steps: core::array::from_fn(step),
        };
        let levels = [level(-10.0), level(0.0)];
        let text = table(&levels);
        assert_eq!(table(&read(&text).unwrap()), text);
        assert_eq!(read("frame\n").err(), Some(LevelsError::Heading));
        let short = text.rsplit_once(',').unwrap().0;
        assert_eq!(read(short).err(), Some(LevelsError::Row(3)));
    }
}
