//! Files of the field, written: each number is the shortest that reads back as the same `f64`, NaN where there is none.

use std::fmt::Write as _;

use fluoropose::joint::COLUMNS;
use fluoropose::joint::numbers::{NUMBERS, place};
use fluoropose::pose::jts::{JTA_EULER_KINEMATICS, JTA_EULER_POSE};
use fluoropose::pose::{EulerPose, Pose};
use thiserror::Error;

use crate::cell::{in_heading, quoted};
use crate::film::{JointFilm, JointRow, ORIGINS};
use crate::group::Group;

/// Why a file cannot be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum WriteError {
    /// Time is its first column.
    #[error("this file needs times: state the frames a second")]
    NoTimes,
}

/// Thresholds of lift-off in use, mm.
const THRESHOLDS_MM: [f64; 2] = [0.7, 1.0];

/// What the heading of a table says.
fn heading(film: &JointFilm) -> Vec<String> {
    let filter = match film.cutoff_hz.zip(film.frames_per_s) {
        Some((cutoff, rate)) => format!(
            "filter: columns filtered_* are those of poses filtered by a zero-lag Butterworth filter of fourth order, {cutoff} Hz at {rate} frames a second, rotations on the group, each unbroken run by itself; all others are as found"
        ),
        None => "filter: none".to_owned(),
    };
    let mut lines = numbers_heading(film);
    lines.push("checked: 1 where a person has checked both poses as they are".to_owned());
    lines.push(filter);
    lines.extend(film.told().iter().map(|told| in_heading(told)));
    lines
}

/// What there is to say of the numbers, whatever columns stand beside them.
fn numbers_heading(film: &JointFilm) -> Vec<String> {
    let side = film.side;
    vec![
        format!("fluoropose {}, joint table version 1", env!("CARGO_PKG_VERSION")),
        format!("study: {}; knee: {side}; frames are numbered as in the film, from 1; NaN where a component has no pose", in_heading(&film.name)),
        "units: mm, degrees (deg), percent of the tray's anterior-posterior extent from its posterior border".to_owned(),
        "field_*: origin of the femoral component in the axes of the tibial one; flexion, abduction, internal rotation: tibia against femur, z-x-y, which is Grood and Suntay's sequence".to_owned(),
        "gs_*: shift of the tibial origin from the femoral one along the axes of Grood and Suntay 1983".to_owned(),
        format!("field_*, gs_*: {ORIGINS}"),
        "medial_*, lateral_*: lowest points of the femoral component above the tray's plate, from the plate's middle, anterior and medial positive; lift_off: lateral less medial height".to_owned(),
        format!("tray: {} mm deep, {} mm wide", film.plate_depth_mm, film.plate_width_mm),
    ]
}

/// The table of a film: every number of every frame, with standard deviations, the probability of lift-off, and what is doubtful.
#[must_use]
pub fn table(film: &JointFilm) -> String {
    let mut out = String::new();
    for line in heading(film) {
        let _ = writeln!(out, "# {line}");
    }
    let mut names = vec!["frame".to_owned(), "time_s".to_owned()];
    names.extend(COLUMNS.iter().map(|column| column.name.to_owned()));
    names.extend(COLUMNS.iter().map(|column| format!("sd_{}", column.name)));
    names.extend(THRESHOLDS_MM.map(|mm| format!("p_lift_off_over_{mm:.1}_mm")));
    if film.cutoff_hz.is_some() {
        names.extend(
            COLUMNS
                .iter()
                .map(|column| format!("filtered_{}", column.name)),
        );
    }
    names.extend(["checked", "doubt"].map(str::to_owned));
    let _ = writeln!(out, "{}", names.join(","));
    for row in &film.rows {
        table_row(&mut out, film, row);
    }
    out
}

fn table_row(out: &mut String, film: &JointFilm, row: &JointRow) {
    let none = [f64::NAN; NUMBERS];
    let time = seconds(film, row).unwrap_or(f64::NAN);
    let _ = write!(out, "{},{time}", row.number);
    let numbers = row.joint.map_or(none, |joint| joint.numbers);
    let deviations = row.joint.and_then(|joint| joint.deviations).unwrap_or(none);
    let probability = |mm| row.joint.and_then(|joint| joint.lift_off_probability(mm));
    let probabilities = THRESHOLDS_MM.map(|mm| probability(mm).map_or(f64::NAN, millionths));
    let filtered = film.cutoff_hz.map(|_| row.filtered.unwrap_or(none));
    let all = numbers.into_iter().chain(deviations).chain(probabilities);
    for number in all.chain(filtered.into_iter().flatten()) {
        let _ = write!(out, ",{number}");
    }
    let doubt = quoted(row.doubt.as_deref().unwrap_or_default());
    let _ = writeln!(out, ",{},{doubt}", u8::from(row.checked));
}

/// A probability in millionths: what is less likely would be a hundred zeros and some digits that nobody knows.
fn millionths(probability: f64) -> f64 {
    (1e6 * probability).round() / 1e6
}

/// The first frame of the film is at time 0.
fn seconds(film: &JointFilm, row: &JointRow) -> Option<f64> {
    let rate = film.frames_per_s?;
    Some((row.number as f64 - 1.0) / rate)
}

/// OpenSim's `.mot`: time first, then all numbers. It has no column of words: its heading says which rows are doubtful, and why.
///
/// # Errors
/// [`WriteError::NoTimes`].
pub fn mot(film: &JointFilm) -> Result<String, WriteError> {
    let mut out = String::new();
    let name = film.name.replace(char::is_control, " ");
    let (rows, columns) = (film.rows.len(), NUMBERS + 1);
    let _ = write!(
        out,
        "{name}\nversion=1\nnRows={rows}\nnColumns={columns}\ninDegrees=yes\n"
    );
    let told = film.told().into_iter().chain(doubts_by_time(film));
    let told = told.map(|told| in_heading(&told));
    for line in numbers_heading(film).into_iter().chain(told) {
        let _ = writeln!(out, "# {line}");
    }
    let names: Vec<&str> = COLUMNS.iter().map(|column| column.name).collect();
    let _ = write!(out, "endheader\ntime\t{}\n", names.join("\t"));
    for row in &film.rows {
        let time = seconds(film, row).ok_or(WriteError::NoTimes)?;
        let _ = write!(out, "{time}");
        for number in row.joint.map_or([f64::NAN; NUMBERS], |joint| joint.numbers) {
            let _ = write!(out, "\t{number}");
        }
        out.push('\n');
    }
    Ok(out)
}

fn doubts_by_time(film: &JointFilm) -> impl Iterator<Item = String> {
    film.doubts().filter_map(|(row, doubt)| {
        let (time, frame) = (seconds(film, row)?, row.number);
        Some(format!("doubtful: time {time}, frame {frame}: {doubt}"))
    })
}

/// That of a film, or of several in whose order rows stand.
fn heading_of(films: &[&JointFilm]) -> Vec<String> {
    if let [film] = films {
        return heading(film);
    }
    let mut lines = vec![
        format!(
            "fluoropose {}, joint table version 1",
            env!("CARGO_PKG_VERSION")
        ),
        format!("field_*, gs_*: {ORIGINS}"),
    ];
    for (row, film) in films.iter().enumerate() {
        let (row, name) = (row + 1, in_heading(&film.name));
        lines.push(format!("row {row}: study: {name}; knee: {}", film.side));
        let told = film.told().into_iter();
        lines.extend(told.map(|told| in_heading(&format!("row {row}: {told}"))));
    }
    lines
}

/// One number over the film at 0 to 100 percent, for each film a row of 101: what statistical parametric mapping takes.
#[must_use]
pub fn matrix(films: &[&JointFilm], number: usize) -> String {
    let mut out = String::new();
    let name = COLUMNS.get(number).map_or("", |column| column.name);
    for line in heading_of(films) {
        let _ = writeln!(out, "# {line}");
    }
    let _ = writeln!(
        out,
        "# {name}: a row a film, 101 points from its first to its last frame with a number, doubtful ones included, linear between frames, NaN beside missing ones"
    );
    for film in films {
        let points: Vec<String> = film.cycle(number).iter().map(f64::to_string).collect();
        let _ = writeln!(out, "{}", points.join(","));
    }
    out
}

/// The numbers of a group at steps of flexion: mean and standard deviation over knees, each knee first, and how many there are.
#[must_use]
pub fn group_table(group: &Group) -> String {
    let mut out = format!(
        "# fluoropose {}, group table version 1\n",
        env!("CARGO_PKG_VERSION")
    );
    let name = in_heading(&group.name);
    let _ = writeln!(
        out,
        "# group: {name}; mean and standard deviation over knees, of each knee the mean of its films, of each film that of its monotonic phases; without doubtful frames, nothing extrapolated; of one knee there is no standard deviation, and its mean is its own"
    );
    for knee in group.knees() {
        let films: Vec<&str> = knee.films.iter().map(|film| film.name.as_str()).collect();
        let line = format!("# knee {}: {}", knee.name, films.join(", "));
        let _ = writeln!(out, "{}", in_heading(&line));
    }
    let _ = writeln!(out, "# field_*, gs_*: {ORIGINS}");
    for told in group.told() {
        let _ = writeln!(out, "# {}", in_heading(&told));
    }
    let mut names = vec!["flexion_step_deg".to_owned(), "n".to_owned()];
    names.extend(COLUMNS.iter().flat_map(|column| {
        [
            format!("mean_{}", column.name),
            format!("sd_{}", column.name),
        ]
    }));
    let _ = writeln!(out, "{}", names.join(","));
    for level in group.levels() {
        let _ = write!(out, "{level},{}", group.at(place::FLEXION, level).n);
        for number in 0..NUMBERS {
            let one = group.at(number, level);
            let _ = write!(out, ",{},{}", one.mean, one.deviation);
        }
        out.push('\n');
    }
    out
}

/// `.jtak`: a row a frame; `NOT_OPTIMIZED` begins that of a frame without a pose.
#[must_use]
pub fn jtak(poses: &[Option<Pose>]) -> String {
    let mut out = format!("{JTA_EULER_KINEMATICS}\n{EULER_COLUMNS}");
    for pose in poses {
        match pose {
            Some(pose) => euler_row(&mut out, pose),
            None => out.push_str("NOT_OPTIMIZED,\t0,\t0,\t0,\t0,\t0,\t0,\n"),
        }
    }
    out
}

/// `.jtap`: one pose.
#[must_use]
pub fn jtap(pose: &Pose) -> String {
    let mut out = format!("{JTA_EULER_POSE}\n{EULER_COLUMNS}");
    euler_row(&mut out, pose);
    out
}

const EULER_COLUMNS: &str = "X_TRAN\t\tY_TRAN\t\tZ_TRAN\t\tZ_ROT\t\tX_ROT\t\tY_ROT\n";

fn euler_row(out: &mut String, pose: &Pose) {
    let numbers: [f64; 6] = EulerPose::from(*pose).into();
    let numbers = numbers.map(|number| number.to_string());
    let _ = writeln!(out, "{},", numbers.join(",\t"));
}

/// `.tra`: a row a frame, the bodies side by side, each 16 numbers of `camera_from_model` row by row; NaN where there is no pose.
/// It has no heading.
#[must_use]
pub fn tra(bodies: &[&[Option<Pose>]]) -> String {
    let frames = bodies.iter().map(|body| body.len()).max().unwrap_or(0);
    let mut out = String::new();
    for frame in 0..frames {
        let numbers = bodies.iter().flat_map(|body| {
            let pose = body.get(frame).copied().flatten();
            pose.map_or([f64::NAN; 16], |pose| homogeneous(&pose))
        });
        let numbers: Vec<String> = numbers.map(|number| number.to_string()).collect();
        let _ = writeln!(out, "{}", numbers.join(","));
    }
    out
}

fn homogeneous(pose: &Pose) -> [f64; 16] {
    let (r, t) = (&pose.rotation, &pose.translation);
    core::array::from_fn(|k| match (k / 4, k % 4) {
        (3, 3) => 1.0,
        (3, _) => 0.0,
        (row, 3) => t[row],
        (row, column) => r[row][column],
    })
}

#[cfg(test)]
mod tests {
    use super::millionths;

    #[test]
    fn probabilities_have_six_places() {
        let written = [1e-120, 0.25, 1.0 / 3.0, 1.0].map(|part| millionths(part).to_string());
        assert_eq!(written, ["0", "0.25", "0.333333", "1"]);
        assert!(millionths(f64::NAN).is_nan());
    }
}
