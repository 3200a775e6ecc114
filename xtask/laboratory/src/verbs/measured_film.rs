//! A film whose truth is known, followed and compared with it.

use std::fmt;
use std::path::Path;
use std::sync::Arc;

use anyhow::Result;
use serde::Serialize;

use super::compare::{self, compare};
use super::track::{Click, Request, track};
use crate::progress::Stop;

/// A component of such a film.
#[derive(Serialize)]
pub(super) struct Row {
    seed: u64,
    #[serde(flatten)]
    film: Words,
    clicks: usize,
    /// Processor time of the whole film, seconds; where the system does not tell it, nothing.
    cpu_s: Option<f64>,
    #[serde(flatten)]
    errors: compare::Row,
}

/// What is known of a film, in words.
#[derive(Clone, Serialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Words {
    Disguise(String),
    Film(String),
}

impl fmt::Display for Words {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (Self::Disguise(words) | Self::Film(words)) = self;
        f.write_str(words)
    }
}

/// The head of the table of rows.
pub(super) const HEADING: &str = "| seed | CPU s | component | frames | median deg | largest deg | doubtful | none | largest good deg | in plane mm | depth mm | wrong and good | film |\n\
| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |";

impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let time = self
            .cpu_s
            .map_or("-".to_owned(), |time| format!("{time:.0}"));
        write!(
            f,
            "| {} | {time} {} {} |",
            self.seed, self.errors, self.film
        )?;
        self.errors
            .told()
            .map_or(Ok(()), |told| write!(f, "\n{told}"))
    }
}

/// Follows the film in a folder from clicks, or from nothing, and prints its rows.
///
/// # Errors
/// Those of [`track`] and [`compare`].
pub(super) fn follow(
    folder: &Path,
    clicks: Vec<Click>,
    seed: u64,
    film: &Words,
) -> Result<Vec<Row>> {
    let study = folder.join("study.toml");
    let out = folder.join("tracked");
    let (begin, count) = (cpu_s(), clicks.len());
    track(&Request {
        study: study.clone(),
        out: out.clone(),
        clicks,
        fixed: Vec::new(),
        polarity: None,
        interpolate: 0,
        anew: true,
        listener: Arc::new(|_| ()),
        stop: Stop::default(),
    })?;
    let cpu_s = cpu_s().zip(begin).map(|(end, begin)| end - begin);
    let row = |errors| Row {
        seed,
        film: film.clone(),
        clicks: count,
        cpu_s,
        errors,
    };
    let rows: Vec<Row> = compare(&study, &out, None)?.into_iter().map(row).collect();
    rows.iter().for_each(|row| println!("{row}"));
    Ok(rows)
}

/// Processor time of this process so far, as Linux tells it.
fn cpu_s() -> Option<f64> {
    /// Clock ticks in a second, as the kernel tells them to programs.
    const TICKS: f64 = 100.0;
    let stat = std::fs::read_to_string("/proc/self/stat").ok()?;
    // The program's name may hold blanks; numbers follow it, of which the 12th and 13th are the program's time and the system's for it.
    let (_, numbers) = stat.rsplit_once(')')?;
    let ticks = numbers
        .split_whitespace()
        .skip(11)
        .take(2)
        .map(str::parse::<f64>);
    Some(ticks.sum::<Result<f64, _>>().ok()? / TICKS)
}
