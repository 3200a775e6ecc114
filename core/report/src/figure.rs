//! The figure that is published of a joint: four panels.
//!
//! Against flexion: anterior-posterior position of both condyles, axial rotation, abduction and lift-off, each with every frame, a
//! band of one standard deviation, and the values at steps of 10 degrees with their bars. And the tray from above.

mod course;
mod group;
mod tray;

use fluoropose::joint::numbers::place;

use crate::axes::Plot;
use crate::drawing::{Anchor, Colour, Drawing, Figure, Stroke};
use crate::film::JointFilm;
pub use group::group_figure;

use course::{Course, Ink, LATERAL, MEDIAL, PLAIN, Panel, doubtful_point};

/// Size in its own units, and its width in print: two columns of a journal.
const SIZE: [f64; 2] = [720.0, 664.0];
const WIDTH_MM: f64 = 180.0;
/// From where to where its columns of panels reach.
const LEFT: [f64; 2] = [64.0, 340.0];
const RIGHT: [f64; 2] = [432.0, 706.0];

/// The label of all panels.
const FLEXION: &str = "Flexion (\u{b0})";

/// The figure of a film.
#[must_use]
pub fn figure(film: &JointFilm) -> Figure {
    let mut drawing = Drawing::default();
    let course = Course::of(film);
    against_flexion(&mut drawing, |drawing, panel| course.panel(drawing, panel));
    doubts(&mut drawing, film, [RIGHT[0] + 14.0, 27.0]);
    letter(&mut drawing, "c", LEFT[0], 346.0);
    tray::draw(&mut drawing, film, &course, [LEFT[0] - 30.0, 358.0]);
    drawing.finish(SIZE, WIDTH_MM, format!("Joint motion of {}", film.name))
}

/// The panels a, b and d, which a film and a group have alike.
fn against_flexion(drawing: &mut Drawing, mut draw: impl FnMut(&mut Drawing, &Panel<'_>) -> Plot) {
    let mut panel = |drawing: &mut Drawing, across, up, numbers: &[(usize, Ink)], labels| {
        let panel = Panel {
            across,
            up,
            numbers,
            labels,
        };
        draw(drawing, &panel)
    };
    letter(drawing, "a", LEFT[0], 26.0);
    let condyles = [(place::MEDIAL_AP, MEDIAL), (place::LATERAL_AP, LATERAL)];
    let labels = [FLEXION, "AP position (mm, anterior +)"];
    panel(drawing, LEFT, [270.0, 40.0], &condyles, labels);
    legend(drawing, [LEFT[0] + 14.0, 27.0]);

    letter(drawing, "b", RIGHT[0], 26.0);
    let rotation = [(place::ROTATION, PLAIN)];
    let labels = [FLEXION, "Tibial rotation (\u{b0}, internal +)"];
    panel(drawing, RIGHT, [270.0, 40.0], &rotation, labels);

    letter(drawing, "d", RIGHT[0], 346.0);
    let abduction = [(place::ABDUCTION, PLAIN)];
    let labels = ["", "Abduction (\u{b0},\nabducted +)"];
    panel(drawing, RIGHT, [464.0, 360.0], &abduction, labels);
    let lift_off = [(place::LIFT_OFF, PLAIN)];
    let labels = [FLEXION, "Lift-off (mm,\nlateral +)"];
    let plot = panel(drawing, RIGHT, [606.0, 496.0], &lift_off, labels);
    thresholds(drawing, &plot);
}

fn letter(drawing: &mut Drawing, letter: &str, x: f64, y: f64) {
    drawing.bold([x - 52.0, y], 15.0, letter);
}

fn legend(drawing: &mut Drawing, [x, y]: [f64; 2]) {
    for (ink, word, x) in [(MEDIAL, "medial", x), (LATERAL, "lateral", x + 86.0)] {
        drawing.line(&[[x, y - 4.0], [x + 24.0, y - 4.0]], ink.stroke(1.2));
        ink.mark(drawing, [x + 12.0, y - 4.0], 3.4, "");
        drawing.words([x + 30.0, y], Anchor::Start, 11.0, word);
    }
}

/// What hollow points are, where there are any, and what is not drawn.
fn doubts(drawing: &mut Drawing, film: &JointFilm, [x, y]: [f64; 2]) {
    let impossible = film.impossible();
    let hollow = film
        .rows
        .iter()
        .any(|row| row.doubt.is_some() && row.is_possible());
    let mut words = Vec::new();
    if hollow {
        doubtful_point(drawing, [x + 4.0, y - 4.0], PLAIN, "");
        words.push("doubtful".to_owned());
    }
    if impossible > 0 {
        words.push(format!("not drawn, no knee does that: {impossible}"));
    }
    drawing.words([x + 12.0, y], Anchor::Start, 11.0, words.join("; "));
}

/// The thresholds of lift-off that are in use.
fn thresholds(drawing: &mut Drawing, plot: &Plot) {
    for threshold in [-1.0, 1.0] {
        if plot.y.low <= threshold && threshold <= plot.y.high {
            let y = plot.y.at(threshold);
            let dotted = Stroke::of(Colour::grey(0x77), 0.7).dashed(&[1.5, 2.5]);
            drawing.line(&[[plot.x.from, y], [plot.x.to, y]], dotted);
        }
    }
}
