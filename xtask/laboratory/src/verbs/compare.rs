//! Verb `compare`: poses of a followed film against its reference poses, or against other poses.

use std::fmt;
use std::path::{Path, PathBuf};

use anyhow::{Result, ensure};
use fluoropose::math::{Vector3, dot, norm, scale, subtract};
use fluoropose::pose::{Pose, geodesic_deg};
use serde::Serialize;

use crate::files::{
    Component, PoseRows, States, Study, check_outputs, read_poses, read_poses_of, write_json,
};
use crate::measure::accuracy::{in_front, median_absolute};
use crate::options::study_files;

/// A pose that is farther off is wrong: degrees,
const WRONG_DEG: f64 = 5.0;
/// or mm in the picture's plane.
const WRONG_MM: f64 = 5.0;

/// What stands in the rows, for the verbs that print them.
pub const COLUMNS: &str = "deg is the angle of the rotation between a pose and the reference's; in plane and depth are how far the middle of the model's box is off across and along the \
ray to it, the median of all that were found; wrong and good counts frames more than 5 degrees or 5 mm in plane off whose verdict is good.";

/// Options of `compare`.
#[derive(clap::Args)]
#[command(
    after_help = format!("A row for each component that has a reference: {COLUMNS} Frames that are wrong and good are listed below. The files of the poses are \
those that `track` writes, COMPONENT.jts each; track.csv beside them, or tables of `pose --report` as COMPONENT.csv, tell verdicts. Without these all poses count as good, and that is said.\n\n\
Example:\n  cargo xtask compare --study study.toml --poses tracked\n  \
cargo xtask compare --study study.toml --poses tracked --with by-hand")
)]
pub struct Args {
    /// Study file, or its folder
    #[arg(long, value_parser = study_files())]
    study: PathBuf,
    /// Folder that `track` wrote to
    #[arg(long, value_name = "DIR")]
    poses: PathBuf,
    /// Folder of other poses, COMPONENT.jts each, in place of the study's references
    #[arg(long, value_name = "DIR")]
    with: Option<PathBuf>,
    /// Write the rows as JSON
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

/// Runs the verb.
///
/// # Errors
/// For files that are missing, unreadable or do not belong together.
pub fn run(args: Args) -> Result<()> {
    check_outputs(&[("--json", args.json.as_deref())], [Some(&*args.study)])?;
    // What there is to say of its keys is said: a misspelt one leaves its component out.
    Study::read(&args.study)?;
    let rows = compare(&args.study, &args.poses, args.with.as_deref())?;
    ensure!(
        !rows.is_empty(),
        "no component of {} has reference poses to compare with; name their file as reference in its [[component]], or a folder of poses by --with",
        args.study.display()
    );
    println!("{HEADING}");
    for row in &rows {
        println!("{row}");
    }
    for told in rows.iter().filter_map(Row::told) {
        println!("{told}");
    }
    write_json(args.json.as_deref(), &rows)
}

/// A component of a followed film against its reference.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The component's name.
    pub component: String,
    /// Frames with a reference.
    pub frames: usize,
    /// Of those that were found, degrees; NaN where none was.
    pub median_deg: f64,
    /// The largest of them.
    pub largest_deg: f64,
    /// Poses called doubtful.
    pub doubtful: usize,
    /// Frames without a pose.
    pub none: usize,
    /// The largest error of a pose called good, degrees.
    pub largest_good_deg: f64,
    /// Median distance in the picture's plane, mm.
    pub in_plane_mm: f64,
    /// Median distance along the view, mm.
    pub depth_mm: f64,
    /// Frames, from 1, whose pose is wrong and called good.
    pub wrong_and_good: Vec<usize>,
}

/// The head of the table of rows.
pub const HEADING: &str = "| component | frames | median deg | largest deg | doubtful | none | largest good deg | in plane mm | depth mm | wrong and good |\n\
| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |";

impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let number = |value: f64| match value.is_finite() {
            true => format!("{value:.2}"),
            false => "-".to_owned(),
        };
        write!(
            f,
            "| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |",
            self.component,
            self.frames,
            number(self.median_deg),
            number(self.largest_deg),
            self.doubtful,
            self.none,
            number(self.largest_good_deg),
            number(self.in_plane_mm),
            number(self.depth_mm),
            self.wrong_and_good.len()
        )
    }
}

impl Row {
    /// Which frames are wrong and called good.
    #[must_use]
    pub fn told(&self) -> Option<String> {
        let frames: Vec<String> = self.wrong_and_good.iter().map(usize::to_string).collect();
        let frames = frames.join(", ");
        (!frames.is_empty()).then(|| {
            format!(
                "{}: wrong and called good in frames {frames}",
                self.component
            )
        })
    }

    fn of(component: &str, middle: &Vector3, reference: &[Option<Pose>], found: &[Found]) -> Self {
        let mut row = Self {
            component: component.to_owned(),
            frames: 0,
            median_deg: f64::NAN,
            largest_deg: f64::NAN,
            doubtful: 0,
            none: 0,
            largest_good_deg: f64::NAN,
            in_plane_mm: f64::NAN,
            depth_mm: f64::NAN,
            wrong_and_good: Vec::new(),
        };
        let mut offs = Vec::new();
        for (frame, (reference, found)) in reference.iter().zip(found).enumerate() {
            let Some(reference) = reference else { continue };
            row.frames += 1;
            let Some(pose) = found.pose else {
                row.none += 1;
                continue;
            };
            let off = Off::of(&pose, &in_front(reference, middle), middle);
            row.doubtful += usize::from(!found.is_good);
            if found.is_good {
                row.largest_good_deg = row.largest_good_deg.max(off.deg);
                if off.is_wrong() {
                    row.wrong_and_good.push(frame + 1);
                }
            }
            offs.push(off);
        }
        let median =
            |value: fn(&Off) -> f64| median_absolute(&offs.iter().map(value).collect::<Vec<_>>());
        row.median_deg = median(|off| off.deg);
        row.largest_deg = offs.iter().map(|off| off.deg).fold(f64::NAN, f64::max);
        row.in_plane_mm = median(|off| off.in_plane_mm);
        row.depth_mm = median(|off| off.depth_mm);
        row
    }
}

/// How far a pose is off.
struct Off {
    deg: f64,
    in_plane_mm: f64,
    depth_mm: f64,
}

impl Off {
    fn of(found: &Pose, reference: &Pose, middle: &Vector3) -> Self {
        let (there, known) = (found.transform(middle), reference.transform(middle));
        let ray = scale(&known, 1.0 / norm(&known));
        let off = subtract(&there, &known);
        let depth_mm = dot(&off, &ray);
        Self {
            deg: geodesic_deg(&found.rotation, &reference.rotation),
            in_plane_mm: norm(&subtract(&off, &scale(&ray, depth_mm))),
            depth_mm: depth_mm.abs(),
        }
    }

    fn is_wrong(&self) -> bool {
        self.deg > WRONG_DEG || self.in_plane_mm > WRONG_MM
    }
}

/// A frame of a component as it was found.
#[derive(Clone, Copy)]
struct Found {
    pose: Option<Pose>,
    is_good: bool,
}

/// Compares what `track` wrote to a folder with a study's references, or with the poses of another folder.
///
/// # Errors
/// For files that are missing, unreadable or do not belong together.
pub fn compare(study: &Path, poses: &Path, with: Option<&Path>) -> Result<Vec<Row>> {
    let study = Study::read_quietly(study)?;
    let frames = study.frames.as_deref();
    let file = |folder: &Path, name: &str| folder.join(format!("{name}.jts"));
    let mut bodies = Vec::new();
    for component in &study.components {
        let name = component.name.as_str();
        let other = with.map(|with| file(with, name));
        if let Some(reference) = other.or_else(|| component.reference.clone()) {
            let rows = read_poses(&file(poses, name))?;
            bodies.push((component, read_poses_of(&reference, frames)?, rows));
        }
    }
    let named: Vec<_> = bodies
        .iter()
        .map(|(component, _, rows)| (component.name.as_str(), rows.as_slice()))
        .collect();
    let states = States::beside(poses, &named)?;
    if states.is_none() && !bodies.is_empty() {
        eprintln!(
            "nothing in {} tells verdicts: its poses all count as good",
            poses.display()
        );
    }
    let order = PoseRows::of(poses, frames)?;
    if let Some(order) = &order {
        eprintln!("{}", order.words(poses));
    }
    let rows = bodies.iter().map(|(component, reference, rows)| {
        let found = found(&component.name, rows, states.as_ref());
        // As references are read: by the frames that their rows are of.
        let in_order = order.as_ref().map(|order| order.rows(&found)).transpose()?;
        of_component(component, reference, &in_order.unwrap_or(found))
    });
    rows.collect()
}

/// The poses of a component as their verdicts have them; without any all are good.
fn found(name: &str, poses: &[Option<Pose>], states: Option<&States>) -> Vec<Found> {
    let mut found: Vec<Found> = poses
        .iter()
        .map(|&pose| Found {
            pose,
            is_good: states.is_none(),
        })
        .collect();
    let own = states.iter().flat_map(|states| &states.all);
    for state in own.filter(|state| state.component == name) {
        found[state.row].is_good = state.is_good();
    }
    found
}

fn of_component(component: &Component, reference: &[Option<Pose>], found: &[Found]) -> Result<Row> {
    let name = &component.name;
    let (known, there) = (reference.len(), found.len());
    ensure!(
        known == there,
        "{name}: {there} poses and {known} references: both must be of the same frames"
    );
    let middle = component.read_model()?.as_model().bounds().centre;
    Ok(Row::of(name, &middle, reference, found))
}

#[cfg(test)]
mod tests {
    use fluoropose::pose::EulerPose;

    use super::*;

    fn pose(x: f64, z: f64, turn: f64) -> Pose {
        EulerPose::from([x, 0.0, z, turn, 0.0, 0.0]).into()
    }

    #[test]
    fn errors_are_counted_and_what_is_wrong_and_good_is_listed() {
        let known = pose(0.0, -1000.0, 0.0);
        let found = [
            (0.0, -1003.0, 1.0, true),
            (6.0, -1000.0, 0.0, true),
            (0.0, -1000.0, 9.0, false),
        ];
        let mut found: Vec<Found> = found
            .into_iter()
            .map(|(x, z, turn, is_good)| Found {
                pose: Some(pose(x, z, turn)),
                is_good,
            })
            .collect();
        found.push(Found {
            pose: None,
            is_good: false,
        });
        let row = Row::of("femur", &[0.0; 3], &[Some(known); 4], &found);
        assert_eq!((row.frames, row.doubtful, row.none), (4, 1, 1));
        assert_eq!(row.wrong_and_good, [2]);
        assert!((row.largest_deg - 9.0).abs() < 1e-9 && (row.largest_good_deg - 1.0).abs() < 1e-9);
        assert!((row.median_deg - 1.0).abs() < 1e-9);
        assert!(row.told().unwrap().ends_with("frames 2"));
    }
}
