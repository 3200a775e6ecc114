//! Many knees in groups, from tables by flexion: each knee's films first, then the knees of each group. [`crate::Group`] is one group
//! from whole films.

use std::fmt::Write as _;

use fluoropose::joint::COLUMNS;
use fluoropose::joint::group::{OverKnees, over_knees};
use fluoropose::joint::numbers::place;

use crate::film::Step;
use crate::levels::Level;
use crate::svg::{Anchor, Drawing, Plot, Scale};

/// A knee at steps of flexion.
#[derive(Clone, Debug)]
pub struct Knee {
    /// What it is called.
    pub name: String,
    /// At each step, the mean over its films and their standard deviation, and the number of films.
    pub levels: Vec<Level>,
}

/// Knees that belong together.
#[derive(Clone, Debug)]
pub struct Group {
    /// What they are called.
    pub name: String,
    /// The knees.
    pub knees: Vec<Knee>,
    /// At each step, the mean over the knees and the standard deviation between them, and the number of knees.
    pub levels: Vec<Level>,
}

impl Knee {
    /// A knee from the films of it. A knee counts once however many films it has.
    #[must_use]
    pub fn new(name: &str, films: &[Vec<Level>]) -> Self {
        Self {
            name: name.to_owned(),
            levels: means(films),
        }
    }
}

impl Group {
    /// A group from its knees.
    #[must_use]
    pub fn new(name: &str, knees: Vec<Knee>) -> Self {
        let levels: Vec<Vec<Level>> = knees.iter().map(|knee| knee.levels.clone()).collect();
        Self {
            name: name.to_owned(),
            levels: means(&levels),
            knees,
        }
    }
}

/// At each flexion that any has: mean and standard deviation (of n - 1; NaN for one) over those that have the number there.
fn means(all: &[Vec<Level>]) -> Vec<Level> {
    let mut flexions: Vec<f64> = all
        .iter()
        .flatten()
        .map(|level| level.flexion_deg)
        .collect();
    flexions.sort_by(f64::total_cmp);
    flexions.dedup();
    let level = |flexion_deg: f64| {
        let of = |levels: &Vec<Level>| {
            levels
                .iter()
                .find(|level| level.flexion_deg == flexion_deg)
                .cloned()
        };
        let levels: Vec<Level> = all.iter().filter_map(of).collect();
        let step = |number: usize| {
            let values = levels.iter().map(|level| level.steps[number].mean);
            mean(&values.filter(|value| value.is_finite()).collect::<Vec<_>>())
        };
        Level {
            flexion_deg,
            steps: core::array::from_fn(step),
        }
    };
    flexions.into_iter().map(level).collect()
}

fn mean(values: &[f64]) -> Step {
    let OverKnees { mean, deviation, n } = over_knees(values.chunks(1));
    Step { mean, deviation, n }
}

/// A row for each group, knee (empty for the group itself) and step.
#[must_use]
pub fn table(groups: &[Group]) -> String {
    let mut out = String::from("group,knee,at_flexion_deg");
    for column in &COLUMNS {
        let _ = write!(out, ",{0},sd_{0},n_{0}", column.name);
    }
    out.push('\n');
    for group in groups {
        let knees = group
            .knees
            .iter()
            .map(|knee| (knee.name.as_str(), &knee.levels));
        for (knee, levels) in knees.chain([("", &group.levels)]) {
            for level in levels {
                let _ = write!(
                    out,
                    "{},{},{}",
                    quoted(&group.name),
                    quoted(knee),
                    level.flexion_deg
                );
                for Step { mean, deviation, n } in &level.steps {
                    let _ = write!(out, ",{mean},{deviation},{n}");
                }
                out.push('\n');
            }
        }
    }
    out
}

fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('"', "\"\""))
}

/// Size in its own units, and width in print: two columns of a journal.
const SIZE: [f64; 2] = [720.0, 640.0];
const WIDTH_MM: f64 = 180.0;
/// Told apart by dashes too, for print without colours.
const INKS: [(&str, &str); 4] = [
    ("#00755e", ""),
    ("#a0428c", "5 3"),
    ("#a05a00", "1.5 2.5"),
    ("#333", "8 3 2 3"),
];
const PANELS: [(usize, &str); 4] = [
    (place::MEDIAL_AP, "Medial AP position (mm, anterior +)"),
    (place::LATERAL_AP, "Lateral AP position (mm, anterior +)"),
    (place::ROTATION, "Tibial rotation (\u{b0}, internal +)"),
    (place::ABDUCTION, "Abduction (\u{b0})"),
];

/// The groups against flexion as SVG: means, and bands of one standard deviation between knees.
#[must_use]
pub fn figure(groups: &[Group]) -> String {
    let mut drawing = Drawing::default();
    for (panel, (number, label)) in PANELS.into_iter().enumerate() {
        let (column, row) = (panel % 2, panel / 2);
        let left = 64.0 + 368.0 * column as f64;
        let top = 50.0 + 300.0 * row as f64;
        let reach = |axis: fn(&Level, usize) -> [f64; 2]| {
            let levels = groups.iter().flat_map(|group| &group.levels);
            levels
                .flat_map(move |level| axis(level, number))
                .collect::<Vec<f64>>()
        };
        let flexions = reach(|level, _| [level.flexion_deg; 2]);
        let values = reach(|level, number| band(&level.steps[number]));
        let plot = Plot {
            x: Scale::over(flexions.into_iter(), 7.0, left, left + 274.0),
            y: Scale::over(values.into_iter(), 5.0, top + 220.0, top),
        };
        plot.axes(&mut drawing, ["Flexion (\u{b0})", label], true);
        for (group, ink) in groups.iter().zip(INKS.iter().cycle()) {
            curve(&mut drawing, &plot, group, number, *ink);
        }
    }
    legend(&mut drawing, groups);
    drawing.finish(SIZE, WIDTH_MM, "Joint motion of groups of knees")
}

/// One standard deviation to either side of the mean.
fn band(step: &Step) -> [f64; 2] {
    let deviation = if step.deviation.is_finite() {
        step.deviation
    } else {
        0.0
    };
    [step.mean - deviation, step.mean + deviation]
}

fn curve(
    drawing: &mut Drawing,
    plot: &Plot,
    group: &Group,
    number: usize,
    (colour, dashes): (&str, &str),
) {
    let known = group
        .levels
        .iter()
        .filter(|level| level.steps[number].mean.is_finite());
    let known: Vec<&Level> = known.collect();
    let edge = |side: usize| {
        known
            .iter()
            .map(move |level| plot.place(level.flexion_deg, band(&level.steps[number])[side]))
    };
    let around: Vec<[f64; 2]> = edge(0).chain(edge(1).rev()).collect();
    drawing.shape(&around, &format!("fill=\"{colour}\" fill-opacity=\"0.14\""));
    let middle: Vec<[f64; 2]> = known
        .iter()
        .map(|level| plot.place(level.flexion_deg, level.steps[number].mean))
        .collect();
    drawing.line(
        &middle,
        &format!("stroke=\"{colour}\" stroke-width=\"1.4\" stroke-dasharray=\"{dashes}\""),
    );
    for (level, at) in known.iter().zip(&middle) {
        let step = &level.steps[number];
        let between = match step.deviation.is_finite() {
            true => format!(" \u{b1} {:.2}", step.deviation),
            false => String::new(),
        };
        let title = format!(
            "{}, {}\u{b0}: {:.2}{between}, n = {}",
            group.name, level.flexion_deg, step.mean, step.n
        );
        drawing.point(*at, 2.4, &format!("fill=\"{colour}\""), &title);
    }
}

fn legend(drawing: &mut Drawing, groups: &[Group]) {
    let mut x = 64.0;
    for (group, (colour, dashes)) in groups.iter().zip(INKS.iter().cycle()) {
        drawing.line(
            &[[x, 24.0], [x + 24.0, 24.0]],
            &format!("stroke=\"{colour}\" stroke-width=\"1.4\" stroke-dasharray=\"{dashes}\""),
        );
        let words = format!("{} (n = {})", group.name, group.knees.len());
        drawing.words([x + 30.0, 28.0], Anchor::Start, 11.0, &words);
        x += 54.0 + 6.2 * words.chars().count() as f64;
    }
}

#[cfg(test)]
mod tests {
    use fluoropose::joint::numbers::NUMBERS;

    use super::*;

    fn film(flexions: &[f64], value: f64) -> Vec<Level> {
        let level = |&flexion_deg: &f64| Level {
            flexion_deg,
            steps: [Step {
                mean: value,
                deviation: 0.1,
                n: 1,
            }; NUMBERS],
        };
        flexions.iter().map(level).collect()
    }

    #[test]
    fn a_knee_counts_once_however_many_films_it_has() {
        let twice = Knee::new("a", &[film(&[0.0, 10.0], 1.0), film(&[0.0], 3.0)]);
        let once = Knee::new("b", &[film(&[10.0, 20.0], 5.0)]);
        assert_eq!(
            (twice.levels[0].steps[0].mean, twice.levels[0].steps[0].n),
            (2.0, 2)
        );
        let group = Group::new("all", vec![twice, once]);
        let means: Vec<(f64, f64, usize)> = group
            .levels
            .iter()
            .map(|level| (level.flexion_deg, level.steps[5].mean, level.steps[5].n))
            .collect();
        assert_eq!(means, [(0.0, 2.0, 1), (10.0, 3.0, 2), (20.0, 5.0, 1)]);
        assert!((group.levels[1].steps[5].deviation - 8f64.sqrt()).abs() < 1e-12);
        assert!(group.levels[0].steps[5].deviation.is_nan());
        let rows = table(std::slice::from_ref(&group));
        assert_eq!(rows.lines().count(), 1 + 2 + 2 + 3);
        assert!(rows.contains("\n\"all\",\"\",10,3,"));
        let drawn = figure(&[group]);
        assert!(
            drawn.contains("all (n = 2)") && !drawn.contains("NaN,"),
            "{drawn}"
        );
    }

    #[test]
    fn a_number_that_one_knee_lacks_is_the_others() {
        let mut lacking = film(&[0.0], 1.0);
        lacking[0].steps[0].mean = f64::NAN;
        let group = Group::new(
            "g",
            vec![
                Knee::new("a", &[lacking]),
                Knee::new("b", &[film(&[0.0], 4.0)]),
            ],
        );
        assert_eq!(
            (group.levels[0].steps[0].mean, group.levels[0].steps[0].n),
            (4.0, 1)
        );
        assert_eq!(group.levels[0].steps[1].mean, 2.5);
    }
}
