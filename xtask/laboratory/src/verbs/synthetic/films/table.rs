//! Statistics of a kind of films, and the table.

use serde::Serialize;

use super::joint::JointBands;
use super::outcome::{Found, Outcome};
use crate::measure::accuracy::{Errors, mean, median_absolute, rms};
use crate::measure::coverage::Coverage;
use crate::verbs::synthetic::ranges::FAILURE_DEG;

/// A kind of films, a component and the way to its poses.
#[derive(Clone, Debug, Serialize)]
pub struct FilmRow {
    /// The kind of films, in words.
    pub films: String,
    /// `femur` or `tibia`.
    pub component: &'static str,
    /// How the poses were come by, in a word.
    pub way: &'static str,
    /// Films.
    pub frames: usize,
    /// Verdicts.
    pub good: usize,
    /// See `good`.
    pub doubtful: usize,
    /// Refused, or nothing found.
    pub none: usize,
    /// Of the poses that were not refused, those more than 4 degrees off: not in the errors below.
    pub failures: usize,
    /// Mean errors of the others, with their signs.
    pub bias: Errors,
    /// Root mean square errors of the others.
    pub rms: Errors,
    /// Root mean square errors of those called good, whatever they are off.
    pub good_rms: Errors,
    /// Median standard deviation of z that was told, mm.
    pub told_z_mm: f64,
    /// Poses more than three standard deviations off in depth or rotation, and called good.
    pub wrong_but_good: usize,
    /// Poses more than 2 degrees or 5 mm of depth off, and called good.
    pub far_but_good: usize,
    /// Of the poses not more than 4 degrees off, those whose regions hold the truth.
    pub inside: Coverage,
    /// Median time of a pose, ms.
    pub median_ms: f64,
    /// Of the second component, what its joint with the first one is known to.
    pub joint: Option<JointBands>,
}

impl FilmRow {
    pub(super) fn of(
        films: &str,
        [component, way]: [&'static str; 2],
        outcomes: &[Outcome],
    ) -> Self {
        let count = |word: &str| outcomes.iter().filter(|one| one.verdict == word).count();
        let all: Vec<&Found> = outcomes
            .iter()
            .filter_map(|one| one.found.as_ref())
            .collect();
        let right = |found: &&&Found| found.errors.geodesic_deg <= FAILURE_DEG;
        let kept: Vec<&Found> = all.iter().filter(right).copied().collect();
        let errors: Vec<Errors> = kept.iter().map(|found| found.errors).collect();
        let good = outcomes.iter().filter(|one| one.verdict == "good");
        let good: Vec<&Found> = good.filter_map(|one| one.found.as_ref()).collect();
        let good_errors: Vec<Errors> = good.iter().map(|found| found.errors).collect();
        let told: Vec<f64> = kept
            .iter()
            .filter_map(|found| Some(found.sd?.z_mm))
            .collect();
        let times: Vec<f64> = outcomes.iter().map(|one| one.ms).collect();
        Self {
            films: films.to_owned(),
            component,
            way,
            frames: outcomes.len(),
            good: count("good"),
            doubtful: count("doubtful"),
            none: count("none"),
            failures: all.len() - kept.len(),
            bias: Errors::summarise(&errors, mean),
            rms: Errors::summarise(&errors, rms),
            good_rms: Errors::summarise(&good_errors, rms),
            told_z_mm: median_absolute(&told),
            wrong_but_good: good.iter().filter(|found| found.wrong).count(),
            far_but_good: good.iter().filter(|found| found.far).count(),
            inside: Coverage::of(kept.iter().map(|found| (&found.errors, found.sd.as_ref()))),
            median_ms: median_absolute(&times),
            joint: None,
        }
    }
}

pub(super) fn print_heading() {
    println!(
        "{:<36} {:<5} {:<9} {:>6} {:>4} {:>5} {:>4} {:>6} | {:>6} {:>6} {:>6} {:>7} {:>6} | {:>6} {:>5} | {:<27} | {:<27} | {:>5}",
        "films",
        "part",
        "way",
        "frames",
        "good",
        "doubt",
        "none",
        ">4 deg",
        "z bias",
        "z RMS",
        "z told",
        "rot RMS",
        "xy RMS",
        "wrong*",
        "far**",
        "68 %: x, y, z, rot. z, x, y",
        "95 %: x, y, z, rot. z, x, y",
        "ms"
    );
}

pub(super) fn print(row: &FilmRow) {
    let (bias, rms) = (&row.bias, &row.rms);
    let [narrow, wide] = row.inside.words();
    println!(
        "{:<36} {:<5} {:<9} {:>6} {:>4} {:>5} {:>4} {:>6} | {:6.2} {:6.2} {:6.2} {:7.3} {:6.3} | {:>6} {:>5} | {:<27} | {:<27} | {:5.0}",
        row.films,
        row.component,
        row.way,
        row.frames,
        row.good,
        row.doubtful,
        row.none,
        row.failures,
        bias.z_mm,
        rms.z_mm,
        row.told_z_mm,
        rms.geodesic_deg,
        rms.x_mm.hypot(rms.y_mm),
        row.wrong_but_good,
        row.far_but_good,
        narrow,
        wide,
        row.median_ms
    );
    if let Some(joint) = &row.joint {
        println!("{}", joint.words());
    }
}

pub(super) fn print_legend() {
    println!(
        "mm and degrees, of poses at most 4 degrees off; told: the median standard deviation of z; wrong*: more than 3 standard \
deviations off in depth or rotation and called good; far**: more than 2 degrees or 5 mm of depth off and called good; 68 and 95 %: \
percent of poses whose region of that size holds the truth, number by number. Joints: percent whose band of one standard deviation holds the truth, and \
the root mean square of errors for that of the bands."
    );
}
