//! Numbers of a film drawn against its flexion.

use fluoropose::joint::COLUMNS;
use fluoropose::joint::course::{JUMP_DEG, Phase};
use fluoropose::joint::numbers::place;

use crate::axes::{Plot, Scale};
use crate::drawing::{Colour, Drawing, Dress, Stroke, WHITE};
use crate::film::JointFilm;

/// More frames than this are drawn as lines alone.
const MANY: usize = 150;

/// How one number is drawn: told apart by shape and dashes as well, for print without colours.
#[derive(Clone, Copy)]
pub(super) struct Ink {
    pub(super) colour: Colour,
    dashed: bool,
    square: bool,
}

/// Green and purple differ for colour-blind people too, and are no component's colours.
pub(super) const MEDIAL: Ink = Ink {
    colour: Colour([0x00, 0x75, 0x5e]),
    dashed: false,
    square: false,
};
pub(super) const LATERAL: Ink = Ink {
    colour: Colour([0xa0, 0x42, 0x8c]),
    dashed: true,
    square: true,
};
pub(super) const PLAIN: Ink = Ink {
    colour: Colour::grey(0x33),
    dashed: false,
    square: false,
};

impl Ink {
    pub(super) fn stroke(&self, width: f64) -> Stroke {
        let whole = Stroke::of(self.colour, width);
        if self.dashed {
            whole.dashed(&[5.0, 3.0])
        } else {
            whole
        }
    }

    /// A mark at a flexion, with a bar of one standard deviation to either side where that is known.
    pub(super) fn step(
        &self,
        drawing: &mut Drawing,
        plot: &Plot,
        [flexion, mean, deviation]: [f64; 3],
        title: &str,
    ) {
        let [x, y] = plot.place(flexion, mean);
        if deviation.is_finite() {
            let ends = [-1.0, 1.0].map(|sign| plot.y.at(mean + sign * deviation));
            let bar = Stroke::of(self.colour, 1.0);
            drawing.line(&[[x, ends[0]], [x, ends[1]]], bar);
            for end in ends {
                drawing.line(&[[x - 3.0, end], [x + 3.0, end]], bar);
            }
        }
        self.mark(drawing, [x, y], 3.6, title);
    }

    /// A mark on a place.
    pub(super) fn mark(&self, drawing: &mut Drawing, at: [f64; 2], size: f64, title: &str) {
        let fill = Dress::filled(self.colour);
        if self.square {
            drawing.square(at, 0.88 * size, fill);
        } else {
            drawing.point(at, size, fill, title);
        }
    }
}

/// A frame that counts for nothing.
pub(super) fn doubtful_point(drawing: &mut Drawing, at: [f64; 2], ink: Ink, title: &str) {
    let dress = Dress::filled(WHITE).within(Stroke::of(ink.colour, 0.7));
    drawing.point(at, 2.2, dress, title);
}

/// Some numbers against flexion, and where they are drawn.
#[derive(Clone, Copy)]
pub(super) struct Panel<'p> {
    /// From the left to the right.
    pub(super) across: [f64; 2],
    /// From the bottom to the top.
    pub(super) up: [f64; 2],
    /// What is drawn.
    pub(super) numbers: &'p [(usize, Ink)],
    /// Below and beside it.
    pub(super) labels: [&'p str; 2],
}

/// A film against its flexion.
pub(super) struct Course<'f> {
    pub(super) film: &'f JointFilm,
    pub(super) phases: Vec<Phase>,
    pub(super) levels: Vec<f64>,
    flexion: Vec<f64>,
}

impl<'f> Course<'f> {
    pub(super) fn of(film: &'f JointFilm) -> Self {
        Self {
            film,
            phases: film.phases(),
            levels: film.levels(),
            flexion: film.possible(film.values(place::FLEXION)),
        }
    }

    /// Draws a panel.
    pub(super) fn panel(&self, drawing: &mut Drawing, panel: &Panel<'_>) -> Plot {
        let Panel {
            across: [left, right],
            up: [bottom, top],
            numbers,
            labels,
        } = *panel;
        let reach = numbers.iter().flat_map(|&(number, _)| {
            let deviations = self.film.deviations(number).into_iter();
            let values = self.film.possible(self.film.values(number));
            let both = values.into_iter().zip(deviations);
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
        let fill = Dress::faint(ink.colour, 0.14);
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
                drawing.shape(&around, fill);
            }
        }
        self.alone(drawing, plot, number, ink);
    }

    /// A bar of one standard deviation to either side of frames that no band reaches: they stand between doubtful ones.
    fn alone(&self, drawing: &mut Drawing, plot: &Plot, number: usize, ink: &Ink) {
        let (values, deviations) = (self.film.values(number), self.film.deviations(number));
        let stroke = Stroke::of(ink.colour, 2.0).fainter(0.25);
        for (k, row) in self.film.rows.iter().enumerate() {
            let in_band = self
                .phases
                .iter()
                .any(|phase| (phase.first..=phase.last).contains(&k) && phase.first < phase.last);
            if in_band || row.doubt.is_some() || !deviations[k].is_finite() {
                continue;
            }
            let end = |sign: f64| plot.place(self.flexion[k], values[k] + sign * deviations[k]);
            drawing.line(&[end(-1.0), end(1.0)], stroke);
        }
    }

    /// Every frame: a thin line through unbroken runs, and a point, hollow where it is doubtful.
    fn frames(&self, drawing: &mut Drawing, plot: &Plot, number: usize, ink: &Ink) {
        let values = self.film.possible(self.film.values(number));
        drawing.open("frames");
        let places: Vec<[f64; 2]> = (0..values.len())
            .map(|k| plot.place(self.flexion[k], values[k]))
            .collect();
        let stroke = ink.stroke(0.9).fainter(0.75);
        for run in self.runs(&values, number) {
            drawing.line(&places[run], stroke);
        }
        let many = values.len() > MANY;
        for ((row, place), value) in self.film.rows.iter().zip(&places).zip(&values) {
            let doubtful = row.doubt.is_some();
            if !place[1].is_finite() || (many && !doubtful) {
                continue;
            }
            let title = format!("frame {}: {value:.2}", row.number);
            if doubtful {
                doubtful_point(drawing, *place, *ink, &title);
            } else {
                drawing.point(*place, 1.3, Dress::filled(ink.colour), &title);
            }
        }
        drawing.close();
    }

    /// Frames in a row that have a number and between which neither flexion nor another angle jumps.
    fn runs(&self, values: &[f64], number: usize) -> Vec<std::ops::Range<usize>> {
        let most = match COLUMNS[number].unit {
            "deg" => JUMP_DEG,
            _ => f64::INFINITY,
        };
        let joined = |at: usize| {
            let jump = |values: &[f64]| (values[at] - values[at - 1]).abs();
            // A difference to what is not a number is not small.
            jump(&self.flexion) <= JUMP_DEG && jump(values) <= most
        };
        let mut runs = Vec::new();
        let mut first = 0;
        for at in 1..=values.len() {
            if at == values.len() || !joined(at) {
                if at - first > 1 {
                    runs.push(first..at);
                }
                first = at;
            }
        }
        runs
    }

    /// The values at steps of flexion, with bars of one standard deviation.
    fn steps(&self, drawing: &mut Drawing, plot: &Plot, number: usize, ink: &Ink) {
        drawing.open("steps");
        for &level in &self.levels {
            let step = self.film.at(number, &self.phases, level);
            if step.n == 0 {
                continue;
            }
            let title = format!("{level}\u{b0}: {:.2}", step.mean);
            ink.step(drawing, plot, [level, step.mean, step.deviation], &title);
        }
        drawing.close();
    }
}
