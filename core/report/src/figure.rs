//! The figure that is published of a joint: four panels.
//!
//! Against flexion: anterior-posterior position of both condyles, axial rotation, abduction and lift-off, each with every frame, a
//! band of one standard deviation, and the values at steps of 10 degrees with their bars. And the tray from above.

mod course;
mod group;
mod tray;

use fluoropose::joint::numbers::place;

use crate::film::JointFilm;
use crate::svg::{Anchor, Drawing, Plot};
pub use group::group_figure;

use course::{Course, LATERAL, MEDIAL, PLAIN, doubtful_point};

/// Size in its own units, and its width in print: two columns of a journal.
const SIZE: [f64; 2] = [720.0, 664.0];
const WIDTH_MM: f64 = 180.0;
/// From where to where its columns of panels reach.
const LEFT: [f64; 2] = [64.0, 340.0];
const RIGHT: [f64; 2] = [432.0, 706.0];

/// The figure of a film as SVG.
#[must_use]
pub fn figure(film: &JointFilm) -> String {
    let mut drawing = Drawing::default();
    let course = Course::of(film);
    let (left, right) = (LEFT, RIGHT);
    let label = "Flexion (\u{b0})";

    letter(&mut drawing, "a", left[0], 26.0);
    let condyles = [(place::MEDIAL_AP, MEDIAL), (place::LATERAL_AP, LATERAL)];
    let axis = "AP position (mm, anterior +)";
    course.panel(&mut drawing, left, [270.0, 40.0], &condyles, [label, axis]);
    legend(&mut drawing, [left[0] + 14.0, 27.0]);
    doubts(&mut drawing, film, [right[0] + 14.0, 27.0]);

    letter(&mut drawing, "b", right[0], 26.0);
    let rotation = [(place::ROTATION, PLAIN)];
    let axis = "Tibial rotation (\u{b0}, internal +)";
    course.panel(&mut drawing, right, [270.0, 40.0], &rotation, [label, axis]);

    letter(&mut drawing, "c", left[0], 346.0);
    tray::draw(&mut drawing, film, &course, [left[0] - 30.0, 358.0]);

    letter(&mut drawing, "d", right[0], 346.0);
    let abduction = [(place::ABDUCTION, PLAIN)];
    let axis = "Abduction (\u{b0})";
    course.panel(&mut drawing, right, [464.0, 360.0], &abduction, ["", axis]);
    let lift_off = [(place::LIFT_OFF, PLAIN)];
    let axis = "Lift-off (mm)";
    let plot = course.panel(
        &mut drawing,
        right,
        [606.0, 496.0],
        &lift_off,
        [label, axis],
    );
    thresholds(&mut drawing, &plot);

    drawing.finish(SIZE, WIDTH_MM, &format!("Joint motion of {}", film.name))
}

fn letter(drawing: &mut Drawing, letter: &str, x: f64, y: f64) {
    let bold = "font-weight=\"bold\"";
    drawing.words_with([x - 52.0, y], Anchor::Start, 15.0, bold, letter);
}

fn legend(drawing: &mut Drawing, [x, y]: [f64; 2]) {
    for (ink, word, x) in [(MEDIAL, "medial", x), (LATERAL, "lateral", x + 86.0)] {
        drawing.line(&[[x, y - 4.0], [x + 24.0, y - 4.0]], &ink.stroke(1.2));
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
            let dotted = "stroke=\"#777\" stroke-width=\"0.7\" stroke-dasharray=\"1.5 2.5\"";
            drawing.line(&[[plot.x.from, y], [plot.x.to, y]], dotted);
        }
    }
}
