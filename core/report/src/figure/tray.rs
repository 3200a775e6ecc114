//! The tray from above: a condyle line for each 10 degrees of flexion, and the centre of rotation.

use core::array;

use fluoropose::joint::numbers::{NUMBERS, place};
use fluoropose::joint::pivot::Pivot;

use super::course::{Course, LATERAL, MEDIAL};
use crate::drawing::{Anchor, BLACK, Colour, Drawing, Dress, Stroke};
use crate::film::JointFilm;
use crate::svg::short;

/// The panel's size, and what its words take of it.
const WIDTH: f64 = 320.0;
const HEIGHT: f64 = 250.0;

/// Frames whose lines are drawn where there are no steps.
const FRAMES: usize = 24;

/// From positions on the plate (anterior, medial; mm) to the drawing: anterior is up, and left and right are the patient's as the
/// tray is seen from above.
struct View {
    middle: [f64; 2],
    per_mm: f64,
    medial: f64,
}

impl View {
    fn of(film: &JointFilm, [left, top]: [f64; 2]) -> Self {
        let room = [
            (WIDTH - 40.0) / film.plate_width_mm,
            (HEIGHT - 70.0) / film.plate_depth_mm,
        ];
        Self {
            middle: [left + WIDTH / 2.0, top + HEIGHT / 2.0 - 14.0],
            per_mm: room[0].min(room[1]),
            medial: film.side.forward(),
        }
    }

    fn place(&self, [anterior, medial]: [f64; 2]) -> [f64; 2] {
        [
            self.middle[0] + self.medial * medial * self.per_mm,
            self.middle[1] - anterior * self.per_mm,
        ]
    }

    /// How far the panel reaches to either side of its middle.
    const REACH: [f64; 2] = [WIDTH / 2.0, HEIGHT / 2.0 - 16.0];

    fn holds(&self, at: [f64; 2]) -> bool {
        (0..2).all(|k| (at[k] - self.middle[k]).abs() < Self::REACH[k])
    }

    /// The nearest place that is in the panel.
    fn within(&self, at: [f64; 2]) -> [f64; 2] {
        array::from_fn(|k| {
            at[k].clamp(
                self.middle[k] - Self::REACH[k],
                self.middle[k] + Self::REACH[k],
            )
        })
    }
}

pub(super) fn draw(drawing: &mut Drawing, film: &JointFilm, course: &Course<'_>, at: [f64; 2]) {
    let foot = [at[0] + WIDTH / 2.0, at[1] + HEIGHT + 8.0];
    if !film.has_plate() {
        let told = "lowest points are not known: they need both models, and a tray";
        return drawing.words(foot, Anchor::Middle, 10.5, told);
    }
    let view = View::of(film, at);
    drawing.open("tray");
    let border: Vec<[f64; 2]> = film
        .plate_outline
        .iter()
        .filter(|point| point[0].is_finite())
        .map(|&point| view.place(point))
        .collect();
    if border.len() > 2 {
        let plate = Dress::filled(Colour::grey(0xf1));
        drawing.shape(&border, plate.within(Stroke::of(Colour::grey(0x88), 1.0)));
    }
    directions(drawing, film, &view);
    lines(drawing, film, course, &view);
    let pivot = film.pivot();
    if let Some(pivot) = pivot.filter(|pivot| !pivot.is_ill_conditioned()) {
        cross(drawing, &view, &pivot);
    }
    let outside = pivot
        .as_ref()
        .is_some_and(|pivot| !view.holds(view.place(place_of(pivot))));
    drawing.words(foot, Anchor::Middle, 10.5, told(pivot.as_ref()));
    if outside && pivot.is_some_and(|pivot| !pivot.is_ill_conditioned()) {
        let below = [foot[0], foot[1] + 14.0];
        drawing.words(below, Anchor::Middle, 10.5, "(outside the tray, not drawn)");
    }
    drawing.close();
}

/// Which way is which, and a scale of 10 mm.
fn directions(drawing: &mut Drawing, film: &JointFilm, view: &View) {
    let (half_depth, half_width) = (film.plate_depth_mm / 2.0, film.plate_width_mm / 2.0);
    let [x, y] = view.place([half_depth, 0.0]);
    drawing.words([x, y - 7.0], Anchor::Middle, 11.0, "anterior");
    for (word, sign) in [("medial", 1.0), ("lateral", -1.0)] {
        let [x, _] = view.place([0.0, sign * half_width]);
        let out = if x > view.middle[0] { 13.0 } else { -5.0 };
        drawing.upwards([x + out, view.middle[1]], 11.0, word);
    }
    let [x, y] = view.place([-half_depth, 0.0]);
    let (y, half) = (y + 20.0, 5.0 * view.per_mm);
    drawing.line(&[[x - half, y], [x + half, y]], Stroke::of(BLACK, 1.6));
    drawing.words([x + half + 6.0, y + 4.0], Anchor::Start, 11.0, "10 mm");
}

/// A condyle line: its flexion, and its medial and lateral end on the plate.
type Line = (f64, [f64; 2], [f64; 2]);

/// At steps of flexion; frame by frame where no step is passed. Those of the frames are thinner.
fn lines(drawing: &mut Drawing, film: &JointFilm, course: &Course<'_>, view: &View) {
    let mut drawn = steps(film, course);
    let is_by_steps = !drawn.is_empty();
    if !is_by_steps {
        drawn = frames(film);
    }
    let Some((&(low, ..), &(high, ..))) = drawn.first().zip(drawn.last()) else {
        return;
    };
    let (width, size) = if is_by_steps { (1.5, 2.8) } else { (0.8, 1.8) };
    let span = (high - low).max(1.0);
    for (level, medial, lateral) in &mut drawn {
        (*medial, *lateral) = (view.place(*medial), view.place(*lateral));
        let colour = ramp((*level - low) / span);
        drawing.line(&[*medial, *lateral], Stroke::of(colour, width));
        drawing.point(*medial, size, Dress::filled(MEDIAL.colour), "");
        drawing.square(*lateral, 0.9 * size, Dress::filled(LATERAL.colour));
    }
    if !is_by_steps {
        let at = [view.middle[0], view.middle[1] - View::REACH[1] - 10.0];
        let told = "no step of 10\u{b0} without doubt: each line is a frame";
        drawing.words(at, Anchor::Middle, 10.5, told);
    }
    flexions(drawing, &drawn);
}

fn steps(film: &JointFilm, course: &Course<'_>) -> Vec<Line> {
    let line = |&level: &f64| {
        let at = |number| film.at(number, &course.phases, level).mean;
        line_of(level, at)
    };
    course.levels.iter().filter_map(line).collect()
}

/// Those that are not doubtful, from the least to the most flexion, at most [`FRAMES`] of them.
fn frames(film: &JointFilm) -> Vec<Line> {
    let trusted = film.rows.iter().filter(|row| row.doubt.is_none());
    let numbers = trusted.filter_map(|row| Some(row.joint?.numbers));
    let line = |numbers: [f64; NUMBERS]| {
        let flexion = numbers[place::FLEXION];
        line_of(flexion.round(), |number| numbers[number])
    };
    let mut all: Vec<Line> = numbers.filter_map(line).collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    let each = all.len().div_ceil(FRAMES).max(1);
    all.into_iter().step_by(each).collect()
}

/// None where a number is not known.
fn line_of(flexion: f64, at: impl Fn(usize) -> f64) -> Option<Line> {
    let medial = [place::MEDIAL_AP, place::MEDIAL_ACROSS].map(&at);
    let lateral = [place::LATERAL_AP, place::LATERAL_ACROSS].map(&at);
    let known = [flexion].into_iter().chain(medial).chain(lateral);
    let is_known = known.into_iter().all(f64::is_finite);
    is_known.then_some((flexion, medial, lateral))
}

/// The first and the last one's, beyond all lateral ends: lines lie over each other's.
fn flexions(drawing: &mut Drawing, drawn: &[Line]) {
    let across = drawn.iter().map(|(.., lateral)| lateral[0]);
    let (left, right) = across.fold((f64::INFINITY, f64::NEG_INFINITY), |(left, right), x| {
        (left.min(x), right.max(x))
    });
    let mut ends: Vec<_> = [drawn.first(), drawn.last()]
        .into_iter()
        .flatten()
        .collect();
    if drawn.len() == 1 {
        ends.pop();
    }
    let apart = apart(
        &ends
            .iter()
            .map(|(.., lateral)| lateral[1])
            .collect::<Vec<_>>(),
    );
    for (&&(level, medial, lateral), y) in ends.iter().zip(apart) {
        let (x, anchor) = if lateral[0] < medial[0] {
            (left - 7.0, Anchor::End)
        } else {
            (right + 7.0, Anchor::Start)
        };
        let text = format!("{}\u{b0}", short(level));
        drawing.words([x, y + 4.0], anchor, 10.5, text);
    }
}

/// Heights of two labels, moved away from each other as far as they would cover each other.
fn apart(heights: &[f64]) -> Vec<f64> {
    const LINE: f64 = 11.0;
    let &[first, last] = heights else {
        return heights.to_vec();
    };
    let missing = (LINE - (last - first).abs()).max(0.0) / 2.0;
    let up = if first <= last { missing } else { -missing };
    vec![first - up, last + up]
}

/// From light to dark with flexion, so that it can be read without colours.
fn ramp(part: f64) -> Colour {
    let mix = |from: f64, to: f64| (from + (to - from) * part).round() as u8;
    Colour([mix(236.0, 60.0), mix(170.0, 20.0), mix(60.0, 60.0)])
}

fn place_of(pivot: &Pivot) -> [f64; 2] {
    [pivot.anterior_mm, pivot.medial_mm]
}

/// The centre with its standard deviations; where it lies outside, the words alone tell it.
fn cross(drawing: &mut Drawing, view: &View, pivot: &Pivot) {
    let at = place_of(pivot);
    if !view.holds(view.place(at)) {
        return;
    }
    const INK: Stroke = Stroke::of(BLACK, 1.4);
    for k in 0..2 {
        let end = |sign: f64| {
            let mut end = at;
            end[k] += sign * pivot.deviation_mm[k].max(0.8);
            view.within(view.place(end))
        };
        drawing.line(&[end(-1.0), end(1.0)], INK);
    }
    drawing.point(
        view.place(at),
        4.5,
        Dress::hollow(INK),
        "centre of rotation",
    );
}

/// The centre in words.
fn told(pivot: Option<&Pivot>) -> String {
    let Some(pivot) = pivot else {
        return "no centre of rotation: too few condyle lines".to_owned();
    };
    // Told as a range it would be 0.0 degrees, which is not what the lines do.
    if pivot.rotation_deg < 0.05 {
        return "no centre of rotation: the condyle lines turn by no more than their own errors"
            .to_owned();
    }
    if pivot.is_ill_conditioned() {
        return format!(
            "no centre of rotation: the condyle lines turn by {:.1}\u{b0} only",
            pivot.rotation_deg
        );
    }
    let toward = |value: f64, [plus, minus]: [&str; 2], deviation: f64| {
        let word = if value < 0.0 { minus } else { plus };
        format!("{:.1} \u{b1} {deviation:.1} mm {word}", value.abs())
    };
    let [along, across] = pivot.deviation_mm;
    format!(
        "centre of rotation {}, {}",
        toward(pivot.anterior_mm, ["anterior", "posterior"], along),
        toward(pivot.medial_mm, ["medial", "lateral"], across)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_that_err_by_as_much_as_they_turn_are_not_said_to_stand_still() {
        let pivot = |rotation_deg| Pivot {
            anterior_mm: 0.0,
            medial_mm: 0.0,
            deviation_mm: [9.0; 2],
            rotation_deg,
            condition: 30.0,
            n: 12,
        };
        assert!(told(Some(&pivot(0.0))).ends_with("by no more than their own errors"));
        assert!(told(Some(&pivot(1.3))).ends_with("turn by 1.3\u{b0} only"));
    }
}
