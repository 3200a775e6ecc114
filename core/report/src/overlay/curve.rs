//! A curve over the film with its axis, and where it is now.

use fluoropose::joint::numbers::place;

use super::inks::{QUIET, TEXT};
use crate::axes::Scale;
use crate::drawing::{Anchor, Colour, Drawing, Dress, Stroke};
use crate::film::JointFilm;

const RULE: Colour = Colour([0x33, 0x37, 0x3c]);
const ONLY: Colour = Colour([0xd8, 0xdb, 0xde]);
/// Medial and lateral, on dark.
const MEDIAL: Colour = Colour([0x2f, 0xc7, 0x9f]);
const LATERAL: Colour = Colour([0xe2, 0x8f, 0xd0]);

/// A number over the film.
struct Line {
    colour: Colour,
    /// Beside the curve's title; empty where there is one line alone.
    label: &'static str,
    values: Vec<f64>,
    deviations: Vec<f64>,
}

/// Numbers of a kind over the film, and where they are drawn.
pub(super) struct Curve {
    title: &'static str,
    lines: Vec<Line>,
    pub(super) x: Scale,
    pub(super) y: Scale,
    /// The first and the last frame.
    ends: [String; 2],
    /// Left, right and height of its title.
    above: [f64; 3],
    unit: f64,
}

/// The curves that the published figure has, one below the other in an area from left to right and top to bottom.
pub(super) fn of(film: &JointFilm, across: [f64; 2], down: [f64; 2], unit: f64) -> Vec<Curve> {
    let line = |number, colour, label| Line {
        colour,
        label,
        values: film.possible(film.values(number)),
        deviations: film.deviations(number),
    };
    let only = |number| vec![line(number, ONLY, "")];
    let condyles = vec![
        line(place::MEDIAL_AP, MEDIAL, "medial"),
        line(place::LATERAL_AP, LATERAL, "lateral"),
    ];
    let all = [
        ("Flexion (\u{b0})", only(place::FLEXION)),
        ("Internal rotation (\u{b0})", only(place::ROTATION)),
        ("Lowest AP (mm)", condyles),
        ("Lift-off (mm)", only(place::LIFT_OFF)),
    ];
    let each = (down[1] - down[0]) / all.len() as f64;
    let frames = film.rows.len();
    let curve = |(at, (title, lines)): (usize, (&'static str, Vec<Line>))| {
        let top = down[0] + at as f64 * each;
        let bottom = top + each - 2.5 * unit;
        Curve {
            title,
            x: Scale {
                low: 0.0,
                high: frames.max(2) as f64 - 1.0,
                from: across[0] + 7.0 * unit,
                to: across[1],
                step: 1.0,
            },
            y: Scale::between(reach(&lines), 4.0, bottom, top + 4.0 * unit),
            lines,
            ends: [film.rows.first(), film.rows.last()]
                .map(|row| row.map_or(String::new(), |row| row.number.to_string())),
            above: [across[0], across[1], top + 2.4 * unit],
            unit,
        }
    };
    all.into_iter().enumerate().map(curve).collect()
}

/// From the least number to the most, with a margin, as the page's film has it; what hardly changes is drawn flat.
fn reach(lines: &[Line]) -> [f64; 2] {
    let values = lines.iter().flat_map(|line| &line.values);
    let known: Vec<f64> = values.copied().filter(|value| value.is_finite()).collect();
    let (low, high) = known
        .iter()
        .fold((f64::MAX, f64::MIN), |(low, high), &value| {
            (low.min(value), high.max(value))
        });
    if known.is_empty() {
        return [0.0, 1.0];
    }
    let (middle, half) = ((low + high) / 2.0, (0.6 * (high - low)).max(1.0));
    [middle - half, middle + half]
}

impl Curve {
    /// What all pictures have of it.
    pub(super) fn draw(&self, drawing: &mut Drawing) {
        let [left, _, above] = self.above;
        drawing.tinted(
            [left, above],
            Anchor::Start,
            2.0 * self.unit,
            TEXT,
            self.title,
        );
        for (value, text) in self.y.marks() {
            let y = self.y.at(value);
            let rule = Stroke::of(RULE, 0.12 * self.unit);
            drawing.line(&[[self.x.from, y], [self.x.to, y]], rule);
            let at = [self.x.from - self.unit, y + 0.6 * self.unit];
            drawing.tinted(at, Anchor::End, 1.7 * self.unit, QUIET, &text);
        }
        let below = self.y.from + 1.9 * self.unit;
        for (x, anchor, text) in [
            (self.x.from, Anchor::Start, &self.ends[0]),
            (self.x.to, Anchor::End, &self.ends[1]),
        ] {
            drawing.tinted([x, below], anchor, 1.6 * self.unit, QUIET, text);
        }
        for line in &self.lines {
            self.run(drawing, line);
        }
    }

    /// A band of one standard deviation below the line; nothing across a gap.
    fn run(&self, drawing: &mut Drawing, line: &Line) {
        let mut first = 0;
        for run in line.values.split(|value| !value.is_finite()) {
            let edge = |sign: f64| -> Vec<[f64; 2]> {
                let at = |(k, value): (usize, &f64)| {
                    let deviation = line.deviations[first + k];
                    let deviation = if deviation.is_finite() {
                        deviation
                    } else {
                        0.0
                    };
                    let y = self.y.at(value + sign * deviation);
                    [
                        self.x.at((first + k) as f64),
                        y.clamp(self.y.to, self.y.from),
                    ]
                };
                run.iter().enumerate().map(at).collect()
            };
            let mut around = edge(1.0);
            around.extend(edge(-1.0).into_iter().rev());
            drawing.shape(&around, Dress::faint(line.colour, 0.22));
            match edge(0.0)[..] {
                // A frame by itself has no length.
                [alone] => {
                    drawing.point(alone, 0.25 * self.unit, Dress::filled(line.colour), "");
                }
                ref points => drawing.line(points, Stroke::of(line.colour, 0.25 * self.unit)),
            }
            first += run.len() + 1;
        }
    }

    /// Where the film is, and the numbers there, in the colours of their lines.
    pub(super) fn here(&self, drawing: &mut Drawing, index: usize) {
        let x = self.x.at(index as f64);
        let now = Stroke::of(QUIET, 0.12 * self.unit);
        drawing.line(&[[x, self.y.to], [x, self.y.from]], now);
        let [_, mut right, above] = self.above;
        for line in self.lines.iter().rev() {
            let value = line.values.get(index).copied().unwrap_or(f64::NAN);
            let text = match value.is_finite() {
                // Not minus nothing.
                true if value.abs() < 0.05 => "0.0".to_owned(),
                true => format!("{value:.1}").replace('-', "\u{2212}"),
                false => "\u{2013}".to_owned(),
            };
            let text = format!("{} {text}", line.label);
            let size = 2.0 * self.unit;
            drawing.tinted([right, above], Anchor::End, size, line.colour, text.trim());
            right -= 0.55 * size * (text.chars().count() + 2) as f64;
            if value.is_finite() {
                let dot = Dress::filled(line.colour);
                drawing.point([x, self.y.at(value)], 0.7 * self.unit, dot, "");
            }
        }
    }
}
