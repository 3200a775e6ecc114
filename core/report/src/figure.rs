//! The figure that is published of a joint: four panels.
//!
//! Against flexion: anterior-posterior position of both condyles, axial rotation, abduction and lift-off, each with every frame, a
//! band of one standard deviation, and the values at steps of 10 degrees with their bars. And the tray from above.

mod tray;

use fluoropose::joint::course::Phase;
use fluoropose::joint::numbers::place;

use crate::film::JointFilm;
use crate::svg::{Anchor, Drawing, Plot, Scale};

/// Size in its own units, and its width in print: two columns of a journal.
const SIZE: [f64; 2] = [720.0, 664.0];
const WIDTH_MM: f64 = 180.0;

/// More frames than this are drawn as lines alone.
const MANY: usize = 150;

/// How one number is drawn: told apart by shape and dashes as well, for print without colours.
#[derive(Clone, Copy)]
pub(crate) struct Ink {
    colour: &'static str,
    dashed: bool,
    square: bool,
}

/// Green and purple differ for colour-blind people too, and are no component's colours.
pub(crate) const MEDIAL: Ink = Ink {
    colour: "#00755e",
    dashed: false,
    square: false,
};
pub(crate) const LATERAL: Ink = Ink {
    colour: "#a0428c",
    dashed: true,
    square: true,
};
const PLAIN: Ink = Ink {
    colour: "#333",
    dashed: false,
    square: false,
};

/// The figure of a film as SVG.
#[must_use]
pub fn figure(film: &JointFilm) -> String {
    let mut drawing = Drawing::default();
    let course = Course::of(film);
    let left = [64.0, 340.0];
    let right = [432.0, 706.0];
    let label = "Flexion (\u{b0})";

    letter(&mut drawing, "a", left[0], 26.0);
    let condyles = [(place::MEDIAL_AP, MEDIAL), (place::LATERAL_AP, LATERAL)];
    let axis = "AP position (mm, anterior +)";
    course.panel(&mut drawing, left, [270.0, 40.0], &condyles, [label, axis]);
    legend(&mut drawing, [left[0] + 14.0, 27.0]);

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

impl Ink {
    fn stroke(&self, width: f64) -> String {
        let dashes = if self.dashed {
            " stroke-dasharray=\"5 3\""
        } else {
            ""
        };
        format!(
            "stroke=\"{}\" stroke-width=\"{width}\"{dashes}",
            self.colour
        )
    }

    /// A mark on a place.
    fn mark(&self, drawing: &mut Drawing, at: [f64; 2], size: f64, title: &str) {
        let fill = format!("fill=\"{}\"", self.colour);
        if self.square {
            drawing.square(at, 0.88 * size, &fill);
        } else {
            drawing.point(at, size, &fill, title);
        }
    }
}

/// A film against its flexion.
pub(crate) struct Course<'f> {
    pub(crate) film: &'f JointFilm,
    pub(crate) phases: Vec<Phase>,
    pub(crate) levels: Vec<f64>,
    flexion: Vec<f64>,
}

impl<'f> Course<'f> {
    fn of(film: &'f JointFilm) -> Self {
        Self {
            film,
            phases: film.phases(),
            levels: film.levels(),
            flexion: film.values(place::FLEXION),
        }
    }

    /// Some numbers against flexion, between `[left, right]` and `[bottom, top]`.
    fn panel(
        &self,
        drawing: &mut Drawing,
        [left, right]: [f64; 2],
        [bottom, top]: [f64; 2],
        numbers: &[(usize, Ink)],
        labels: [&str; 2],
    ) -> Plot {
        let reach = numbers.iter().flat_map(|&(number, _)| {
            let deviations = self.film.deviations(number).into_iter();
            let both = self.film.values(number).into_iter().zip(deviations);
            both.flat_map(|(value, deviation)| {
                let deviation = if deviation.is_finite() {
                    deviation
                } else {
                    0.0
                };
                [value - deviation, value + deviation]
            })
        });
        let marks = ((bottom - top) / 42.0).clamp(2.0, 6.0);
        let plot = Plot {
            x: Scale::over(self.flexion.iter().copied(), 7.0, left, right),
            y: Scale::over(reach, marks, bottom, top),
        };
        plot.axes(drawing, labels, !labels[0].is_empty());
        for (number, ink) in numbers {
            self.band(drawing, &plot, *number, ink);
        }
        for (number, ink) in numbers {
            self.frames(drawing, &plot, *number, ink);
            self.steps(drawing, &plot, *number, ink);
        }
        plot
    }

    /// One standard deviation to either side, phase by phase.
    fn band(&self, drawing: &mut Drawing, plot: &Plot, number: usize, ink: &Ink) {
        let (values, deviations) = (self.film.values(number), self.film.deviations(number));
        let fill = format!("fill=\"{}\" fill-opacity=\"0.14\"", ink.colour);
        for phase in &self.phases {
            let edge = |sign: f64| -> Vec<[f64; 2]> {
                let known = (phase.first..=phase.last).filter(|&k| deviations[k].is_finite());
                known
                    .map(|k| plot.place(self.flexion[k], values[k] + sign * deviations[k]))
                    .collect()
            };
            let mut around = edge(1.0);
            around.extend(edge(-1.0).into_iter().rev());
            if around.len() > 3 {
                drawing.shape(&around, &fill);
            }
        }
    }

    /// Every frame: a thin line through unbroken runs, and a point, hollow where it is doubtful.
    fn frames(&self, drawing: &mut Drawing, plot: &Plot, number: usize, ink: &Ink) {
        let values = self.film.values(number);
        drawing.open("frames");
        let places: Vec<[f64; 2]> = (0..values.len())
            .map(|k| plot.place(self.flexion[k], values[k]))
            .collect();
        let stroke = format!("{} stroke-opacity=\"0.75\"", ink.stroke(0.9));
        for run in places.split(|place| !place[1].is_finite()) {
            if run.len() > 1 {
                drawing.line(run, &stroke);
            }
        }
        let many = values.len() > MANY;
        for ((row, place), value) in self.film.rows.iter().zip(&places).zip(&values) {
            let doubtful = row.doubt.is_some();
            if !place[1].is_finite() || (many && !doubtful) {
                continue;
            }
            let fill = if doubtful { "#fff" } else { ink.colour };
            let dress = format!(
                "fill=\"{fill}\" stroke=\"{}\" stroke-width=\"0.7\"",
                ink.colour
            );
            let title = format!("frame {}: {value:.2}", row.number);
            drawing.point(*place, if doubtful { 2.2 } else { 1.3 }, &dress, &title);
        }
        drawing.close();
    }

    /// The values at steps of flexion, with bars of one standard deviation.
    fn steps(&self, drawing: &mut Drawing, plot: &Plot, number: usize, ink: &Ink) {
        drawing.open("steps");
        for &level in &self.levels {
            let step = self.film.at(number, &self.phases, level);
            if step.n == 0 {
                continue;
            }
            let [x, y] = plot.place(level, step.mean);
            if step.deviation.is_finite() {
                let ends = [-1.0, 1.0].map(|sign| plot.y.at(step.mean + sign * step.deviation));
                let bar = format!("stroke=\"{}\" stroke-width=\"1\"", ink.colour);
                drawing.line(&[[x, ends[0]], [x, ends[1]]], &bar);
                for end in ends {
                    drawing.line(&[[x - 3.0, end], [x + 3.0, end]], &bar);
                }
            }
            ink.mark(
                drawing,
                [x, y],
                3.6,
                &format!("{level}\u{b0}: {:.2}", step.mean),
            );
        }
        drawing.close();
    }
}
