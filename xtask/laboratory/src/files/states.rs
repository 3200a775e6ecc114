//! What is known of the poses of a folder: `track.csv`, or tables of `pose --report`, one a component.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};
use fluoropose::Pose;
use fluoropose::pose::{EulerPose, geodesic_deg};
use fluoropose_report::cell::plain;

use super::text::{csv_fields, read_text};

/// Poses are one where their places are so near, mm, and
const ONE_MM: f64 = 0.01;
/// their turns, degrees: tables are rounded.
const ONE_DEG: f64 = 0.01;

/// Before the reason why a pose was doubtful that a person has checked, in the page's table; the second in tables of before.
const ACCEPTED: [&str; 2] = [
    "a person checked it; it was doubtful: ",
    "a person accepted it; it was doubtful: ",
];

/// The columns of a pose.
const NUMBERS: [&str; 6] = [
    "x_mm",
    "y_mm",
    "z_mm",
    "z_rot_deg",
    "x_rot_deg",
    "y_rot_deg",
];

/// What is known of a pose.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct State {
    /// The frame's row in the poses, from 0.
    pub row: usize,
    /// The component's name.
    pub component: String,
    /// What became of the frame, in a word.
    pub state: String,
    /// How far the pose is to be trusted: `good`, `doubtful` or `none`.
    pub verdict: String,
    /// Why.
    pub because: String,
    /// Whether a person has checked it.
    pub is_checked: bool,
}

impl State {
    /// Whether the pose is called good.
    pub fn is_good(&self) -> bool {
        self.verdict == "good"
    }

    /// Why it was doubtful, where a person accepted it.
    pub fn accepted(&self) -> Option<&str> {
        let said = |words: &&str| self.because.strip_prefix(*words);
        ACCEPTED.iter().find_map(said)
    }
}

/// The states of a folder's poses, and the tables that tell them.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct States {
    /// One for each pose at least.
    pub all: Vec<State>,
    /// What was read.
    pub tables: Vec<PathBuf>,
}

impl States {
    /// Of the poses of these components as they stand in a folder's files, COMPONENT.jts each; `None` where no table tells them of all.
    ///
    /// # Errors
    /// For a table of other poses, whose verdicts say nothing of these.
    pub fn beside(folder: &Path, bodies: &[(&str, &[Option<Pose>])]) -> Result<Option<Self>> {
        let of_film = folder.join("track.csv");
        let is_of_film = of_film.is_file();
        let mut states = Self::default();
        for (name, poses) in bodies {
            let table = match is_of_film {
                true => of_film.clone(),
                false => folder.join(format!("{name}.csv")),
            };
            if !table.is_file() {
                return Ok(None);
            }
            let own = (!is_of_film).then_some(*name);
            let rows = of_table(&read_text(&table)?, own);
            let Some(rows) = rows.with_context(|| format!("in {}", table.display()))? else {
                return Ok(None);
            };
            let own = judged(rows, name, poses).with_context(|| {
                format!(
                    "{} is not of the poses of {name}.jts: write both anew, or take the table away, and they count as poses without verdicts",
                    table.display()
                )
            })?;
            states.all.extend(own);
            if !states.tables.contains(&table) {
                states.tables.push(table);
            }
        }
        Ok(Some(states))
    }
}

/// A row of a table, with the pose that it is of where the table tells poses.
struct Row {
    state: State,
    pose: Option<Option<Pose>>,
}

/// The rows of a table; those of one that names no components are all of `own`. `None` where it has no verdicts.
///
/// # Errors
/// For a row that names no frame.
fn of_table(table: &str, own: Option<&str>) -> Result<Option<Vec<Row>>> {
    let mut lines = table.lines();
    let heading = csv_fields(lines.next().unwrap_or_default());
    let column = |name: &str| heading.iter().position(|one| one == name);
    let [Some(frame), Some(verdict)] = ["frame", "verdict"].map(column) else {
        return Ok(None);
    };
    let numbers: Option<Vec<usize>> = NUMBERS.into_iter().map(column).collect();
    let [component, state, because, checked] =
        ["component", "state", "because", "checked"].map(column);
    let row = |line: &str| {
        let fields = csv_fields(line);
        let cell = |at: usize| fields.get(at).map_or("", String::as_str);
        let text = |at: Option<usize>| at.map_or("", |at| plain(cell(at)));
        let number = cell(frame).parse::<usize>().ok();
        let number = number.and_then(|number| number.checked_sub(1));
        let component = own.or(component.map(|at| plain(cell(at))));
        let (row, component) = number
            .zip(component)
            .context("a row names no frame, from 1, or no component")?;
        let known = |at: &Vec<usize>| {
            let six: Vec<f64> = at.iter().flat_map(|&at| cell(at).parse()).collect();
            let six = six.first_chunk::<6>().copied();
            six.map(|six| Pose::from(EulerPose::from(six)))
        };
        let state = State {
            row,
            component: component.to_owned(),
            state: text(state.or(Some(verdict))).to_owned(),
            verdict: cell(verdict).to_owned(),
            because: text(because).to_owned(),
            is_checked: text(checked) == "1",
        };
        let pose = numbers.as_ref().map(known);
        Ok(Row { state, pose })
    };
    lines.map(row).collect::<Result<_>>().map(Some)
}

/// The states of a component: of each pose there is one.
///
/// # Errors
/// Where they are of other poses, or of fewer.
fn judged(rows: Vec<Row>, name: &str, poses: &[Option<Pose>]) -> Result<Vec<State>> {
    let mut lacking: Vec<bool> = poses.iter().map(Option::is_some).collect();
    let own = rows.into_iter().filter(|row| row.state.component == name);
    let mut states = Vec::new();
    for Row { state, pose } in own {
        let Some(known) = poses.get(state.row) else {
            let count = poses.len();
            bail!("it has a frame {}, they are {count}", state.row + 1);
        };
        ensure!(
            pose.is_none_or(|pose| is_one(pose, *known)),
            "its frame {} has another pose",
            state.row + 1
        );
        lacking[state.row] = false;
        states.push(state);
    }
    if let Some(row) = lacking.iter().position(|&lacks| lacks) {
        bail!("it has no row of frame {}", row + 1);
    }
    Ok(states)
}

fn is_one(told: Option<Pose>, known: Option<Pose>) -> bool {
    let (Some(told), Some(known)) = (told, known) else {
        return told.is_none() && known.is_none();
    };
    let mut places = told.translation.iter().zip(&known.translation);
    places.all(|(a, b)| (a - b).abs() <= ONE_MM)
        && geodesic_deg(&told.rotation, &known.rotation) <= ONE_DEG
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILM: &str = "frame,component,state,verdict,because,x_mm,y_mm,z_mm,z_rot_deg,x_rot_deg,y_rot_deg,checked\n\
        1,\"femur\",fixed,good,\"a person accepted it; it was doubtful: jump, 2 mm\",0.5,-2.001,-900,10,0,-180,1\n\
        1,\"tibia\",untrackable,none,\"no edge\",,,,,,,0\n\
        2,\"femur\",untrackable,none,\"no edge\",,,,,,,0\n";

    fn pose(x: f64, turn: f64) -> Option<Pose> {
        Some(EulerPose::from([x, -2.0, -900.0, 10.0, 0.0, turn]).into())
    }

    fn read(table: &str, own: Option<&str>, poses: &[Option<Pose>]) -> Result<Vec<State>> {
        judged(of_table(table, own)?.expect("verdicts"), "femur", poses)
    }

    #[test]
    fn a_table_of_a_film_tells_what_became_of_each_pose() {
        let states = read(FILM, None, &[pose(0.5, 180.0), None]).unwrap();
        let told: Vec<_> = states.iter().map(|one| (one.row, one.is_good())).collect();
        assert_eq!(told, [(0, true), (1, false)]);
        assert_eq!(states[0].accepted(), Some("jump, 2 mm"));
        assert!(states[0].is_checked && !states[1].is_checked);
        assert_eq!(
            (states[1].state.as_str(), states[1].accepted()),
            ("untrackable", None)
        );
    }

    #[test]
    fn a_table_of_one_component_is_all_its_own() {
        let table = "frame,file,verdict,because\n1,a.png,good,\"it lies, on what was seen\"\n2,b.png,none,\"no outline\"\n";
        let states = read(table, Some("femur"), &[pose(0.0, 0.0), None]).unwrap();
        assert_eq!(states[0].because, "it lies, on what was seen");
        assert_eq!(
            (states[1].state.as_str(), states[1].verdict.as_str()),
            ("none", "none")
        );
    }

    #[test]
    fn tables_of_other_poses_are_refused() {
        let right = pose(0.5, 180.0);
        for (poses, why) in [
            (&[pose(0.6, 180.0), None][..], "frame 1 has another"),
            (&[pose(0.5, 179.9), None], "frame 1 has another"),
            (&[right, right], "frame 2 has another"),
            (&[None, None], "frame 1 has another"),
            (&[right], "has a frame 2"),
            (&[right, None, right], "no row of frame 3"),
        ] {
            let said = read(FILM, None, poses).expect_err(why).to_string();
            assert!(said.contains(why), "{said}");
        }
        assert!(of_table("frame,verdict\n0,good\n", Some("femur")).is_err());
        assert!(of_table("frame,verdict\n1,good\n", None).is_err());
        assert!(of_table("frame\n1\n", None).unwrap().is_none());
    }
}
