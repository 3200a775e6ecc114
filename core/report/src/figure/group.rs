//! The same four panels over a group of knees.

use fluoropose::joint::group::OverKnees;
use fluoropose::joint::numbers::place;

use super::course::{Ink, Panel};
use super::{FLEXION, LEFT, RIGHT, SIZE, WIDTH_MM, against_flexion, letter};
use crate::axes::{Plot, Scale};
use crate::count::counted;
use crate::drawing::{Anchor, Colour, Drawing, Figure, Stroke};
use crate::group::Group;

/// The figure of a group: mean and standard deviation over knees at steps of 10 degrees of flexion that two knees or more reach, and
/// each knee as a thin line.
#[must_use]
pub fn group_figure(group: &Group) -> Figure {
    let mut drawing = Drawing::default();
    let course = Course {
        group,
        levels: group.levels(),
    };
    against_flexion(&mut drawing, |drawing, panel| course.panel(drawing, panel));
    let words = counts(group);
    drawing.words([RIGHT[1], 27.0], Anchor::End, 11.0, words);
    letter(&mut drawing, "c", LEFT[0], 346.0);
    course.counts(&mut drawing, [606.0, 360.0]);
    drawing.finish(SIZE, WIDTH_MM, format!("Joint motion of {}", group.name))
}

fn counts(group: &Group) -> String {
    let knees = counted(group.knees().len(), "knee");
    format!("{knees}, {}", counted(group.films().count(), "film"))
}

struct Course<'g> {
    group: &'g Group,
    levels: Vec<f64>,
}

impl Course<'_> {
    fn panel(&self, drawing: &mut Drawing, panel: &Panel<'_>) -> Plot {
        let Panel {
            across: [left, right],
            up: [bottom, top],
            numbers,
            labels,
        } = *panel;
        let means: Vec<Vec<OverKnees>> = numbers
            .iter()
            .map(|&(number, _)| {
                self.levels
                    .iter()
                    .map(|&level| self.group.at(number, level))
                    .collect()
            })
            .collect();
        let spread = |one: &OverKnees| {
            if one.deviation.is_finite() {
                one.deviation
            } else {
                0.0
            }
        };
        let bands = means
            .iter()
            .flatten()
            .flat_map(|one| [one.mean - spread(one), one.mean + spread(one)]);
        let knees = (0..self.group.knees().len())
            .flat_map(|knee| {
                numbers
                    .iter()
                    .flat_map(move |&(number, _)| self.knee(knee, number))
            })
            .map(|[_, value]| value);
        let marks = ((bottom - top) / 42.0).clamp(2.0, 6.0);
        let plot = Plot {
            x: Scale::over(self.levels.iter().copied(), 7.0, left, right),
            y: Scale::over(bands.chain(knees), marks, bottom, top),
        };
        plot.axes(drawing, labels, !labels[0].is_empty());
        for (&(number, ink), means) in numbers.iter().zip(&means) {
            self.knees(drawing, &plot, number, ink);
            self.mean(drawing, &plot, means, ink);
        }
        plot
    }

    /// A knee's own means at the levels, NaN where it has none.
    fn knee(&self, knee: usize, number: usize) -> impl Iterator<Item = [f64; 2]> {
        self.levels.iter().map(move |&level| {
            let values = self.group.of_knee(knee, number, level);
            [level, over(&values)]
        })
    }

    fn knees(&self, drawing: &mut Drawing, plot: &Plot, number: usize, ink: Ink) {
        drawing.open("knees");
        let stroke = ink.stroke(0.8).fainter(0.5);
        for knee in 0..self.group.knees().len() {
            let points: Vec<[f64; 2]> = self
                .knee(knee, number)
                .map(|[x, y]| plot.place(x, y))
                .collect();
            lines(drawing, &points, stroke);
            // A single step has no line.
            let known = |at: Option<&[f64; 2]>| at.is_some_and(|[_, y]| y.is_finite());
            for (at, &point) in points.iter().enumerate() {
                let before = at.checked_sub(1).and_then(|before| points.get(before));
                if known(Some(&point)) && !known(before) && !known(points.get(at + 1)) {
                    ink.mark(drawing, point, 2.0, &self.group.knees()[knee].name);
                }
            }
        }
        drawing.close();
    }

    fn mean(&self, drawing: &mut Drawing, plot: &Plot, means: &[OverKnees], ink: Ink) {
        drawing.open("mean");
        let points = self.levels.iter().zip(means);
        // One knee is no group.
        let mean = |one: &OverKnees| if one.n > 1 { one.mean } else { f64::NAN };
        let points: Vec<[f64; 2]> = points.map(|(&x, one)| plot.place(x, mean(one))).collect();
        lines(drawing, &points, ink.stroke(1.6));
        for (&level, one) in self.levels.iter().zip(means) {
            if one.n > 1 {
                let title = format!("{:.2}, n = {}", one.mean, one.n);
                ink.step(drawing, plot, [level, one.mean, one.deviation], &title);
            }
        }
        drawing.close();
    }

    /// How many knees each step has.
    fn counts(&self, drawing: &mut Drawing, [bottom, top]: [f64; 2]) {
        let n = |level: f64| self.group.at(place::FLEXION, level).n as f64;
        let counts: Vec<f64> = self.levels.iter().map(|&level| n(level)).collect();
        let plot = Plot {
            x: Scale::over(self.levels.iter().copied(), 7.0, LEFT[0], LEFT[1]),
            y: Scale::over(counts.iter().copied().chain([0.0]), 5.0, bottom, top),
        };
        plot.axes(drawing, [FLEXION, "Knees"], true);
        for (&level, &count) in self.levels.iter().zip(&counts) {
            let [x, y] = plot.place(level, count);
            let bar = Stroke::of(Colour::grey(0x77), 5.0);
            drawing.line(&[[x, bottom], [x, y]], bar);
            drawing.words([x, y - 4.0], Anchor::Middle, 10.5, count);
        }
    }
}

fn over(values: &[f64]) -> f64 {
    fluoropose::joint::group::over_knees([values]).mean
}

/// Lines through what is known, none across a gap.
fn lines(drawing: &mut Drawing, points: &[[f64; 2]], stroke: Stroke) {
    for run in points
        .split(|[_, y]| !y.is_finite())
        .filter(|run| run.len() > 1)
    {
        drawing.line(run, stroke);
    }
}
