//! Several groups of knees beside each other, as a table and as a figure.

use std::fmt::Write as _;

use fluoropose::joint::COLUMNS;
use fluoropose::joint::group::OverKnees;
use fluoropose::joint::numbers::{NUMBERS, place};

use crate::axes::{Plot, Scale};
use crate::cell::quoted;
use crate::drawing::{Anchor, Colour, Drawing, Dress, Figure, Stroke};
use crate::group::Group;
use crate::plus_minus::plus_minus;

/// In place of a knee, in rows of its group.
const OF_THE_GROUP: &str = "mean of the group";

/// A row for each group, knee and step, and after the knees of a group its own.
#[must_use]
pub fn table(groups: &[Group]) -> String {
    let mut out = String::from("group,knee,at_flexion_deg");
    for column in &COLUMNS {
        let _ = write!(out, ",{0},sd_{0},n_{0}", column.name);
    }
    out.push('\n');
    for group in groups {
        let levels = group.levels();
        let names = group.knees().iter().map(|knee| knee.name.as_str());
        for (knee, name) in names.enumerate() {
            let at = |number, level| group.over_films(knee, number, level);
            rows(&mut out, [&group.name, name], &levels, at);
        }
        let at = |number, level| group.at(number, level);
        rows(&mut out, [&group.name, OF_THE_GROUP], &levels, at);
    }
    out
}

/// A row for each step at which there is any number.
fn rows(out: &mut String, names: [&str; 2], levels: &[f64], at: impl Fn(usize, f64) -> OverKnees) {
    let names = names.map(quoted).join(",");
    for &level in levels {
        let numbers: Vec<OverKnees> = (0..NUMBERS).map(|number| at(number, level)).collect();
        if numbers.iter().all(|one| one.n == 0) {
            continue;
        }
        let _ = write!(out, "{names},{level}");
        for OverKnees { mean, deviation, n } in numbers {
            let _ = write!(out, ",{mean},{deviation},{n}");
        }
        out.push('\n');
    }
}

/// Size in its own units, and width in print: two columns of a journal.
const SIZE: [f64; 2] = [720.0, 640.0];
const WIDTH_MM: f64 = 180.0;
/// Told apart by dashes too, for print without colours.
const INKS: [Stroke; 4] = [
    Stroke::of(Colour([0x00, 0x75, 0x5e]), 1.4),
    Stroke::of(Colour([0xa0, 0x42, 0x8c]), 1.4).dashed(&[5.0, 3.0]),
    Stroke::of(Colour([0xa0, 0x5a, 0x00]), 1.4).dashed(&[1.5, 2.5]),
    Stroke::of(Colour::grey(0x33), 1.4).dashed(&[8.0, 3.0, 2.0, 3.0]),
];
const PANELS: [(usize, &str); 4] = [
    (place::MEDIAL_AP, "Medial AP position (mm, anterior +)"),
    (place::LATERAL_AP, "Lateral AP position (mm, anterior +)"),
    (place::ROTATION, "Tibial rotation (\u{b0}, internal +)"),
    (place::ABDUCTION, "Abduction (\u{b0}, abducted +)"),
];

/// The groups against flexion: means, and bands of one standard deviation between knees.
#[must_use]
pub fn figure(groups: &[Group]) -> Figure {
    let mut drawing = Drawing::default();
    for (panel, (number, label)) in PANELS.into_iter().enumerate() {
        let (column, row) = (panel % 2, panel / 2);
        let left = 64.0 + 368.0 * column as f64;
        let top = 50.0 + 300.0 * row as f64;
        let curves: Vec<Vec<Point>> = groups.iter().map(|group| curve(group, number)).collect();
        let points = || curves.iter().flatten();
        let flexions = points().map(|&(flexion, _)| flexion);
        let values = points().flat_map(|(_, mean)| band(mean));
        let plot = Plot {
            x: Scale::over(flexions, 7.0, left, left + 274.0),
            y: Scale::over(values, 5.0, top + 220.0, top),
        };
        plot.axes(&mut drawing, ["Flexion (\u{b0})", label], true);
        for ((group, points), ink) in groups.iter().zip(&curves).zip(INKS.iter().cycle()) {
            draw(&mut drawing, &plot, (&group.name, points), *ink);
        }
    }
    legend(&mut drawing, groups);
    drawing.finish(SIZE, WIDTH_MM, "Joint motion of groups of knees".to_owned())
}

/// A flexion, degrees, and the mean there.
type Point = (f64, OverKnees);

/// Where a group has a number.
fn curve(group: &Group, number: usize) -> Vec<Point> {
    let levels = group.levels().into_iter();
    let points = levels.map(|level| (level, group.at(number, level)));
    points.filter(|(_, mean)| mean.n > 0).collect()
}

/// One standard deviation to either side of the mean.
fn band(step: &OverKnees) -> [f64; 2] {
    let deviation = if step.deviation.is_finite() {
        step.deviation
    } else {
        0.0
    };
    [step.mean - deviation, step.mean + deviation]
}

fn draw(drawing: &mut Drawing, plot: &Plot, (name, points): (&str, &[Point]), ink: Stroke) {
    let edge = |side: usize| {
        let places = points.iter();
        places.map(move |(flexion, mean)| plot.place(*flexion, band(mean)[side]))
    };
    let around: Vec<[f64; 2]> = edge(0).chain(edge(1).rev()).collect();
    drawing.shape(&around, Dress::faint(ink.colour, 0.14));
    let middle = points.iter();
    let middle: Vec<[f64; 2]> = middle
        .map(|(flexion, mean)| plot.place(*flexion, mean.mean))
        .collect();
    drawing.line(&middle, ink);
    for ((flexion, mean), at) in points.iter().zip(&middle) {
        let mean_of = match mean.deviation.is_finite() {
            true => plus_minus(mean.mean, mean.deviation, 2),
            false => format!("{:.2}", mean.mean),
        };
        let title = format!("{name}, {flexion}\u{b0}: {mean_of}, n = {}", mean.n);
        drawing.point(*at, 2.4, Dress::filled(ink.colour), &title);
    }
}

fn legend(drawing: &mut Drawing, groups: &[Group]) {
    let mut x = 64.0;
    for (group, ink) in groups.iter().zip(INKS.iter().cycle()) {
        drawing.line(&[[x, 24.0], [x + 24.0, 24.0]], *ink);
        let words = format!("{} (n = {})", group.name, group.knees().len());
        drawing.words([x + 30.0, 28.0], Anchor::Start, 11.0, &words);
        x += 54.0 + 6.2 * words.chars().count() as f64;
    }
}
