//! What a report is made from: models, poses, their covariances, what is doubtful, and the digests of all of these.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};
use fluoropose::Pose;
use fluoropose::mesh::OwnedModel;
use fluoropose_report::cell::plain;
use fluoropose_report::{Input, plus_minus};

use crate::files::{
    Component, FoundWith, PoseRows, Role, State, States, Study, Uncertain, covariances_beside,
    csv_fields, name_of, other_count, read, read_calibration, read_covariances, read_poses,
    read_poses_of, read_text, sha256,
};

/// A component with its poses.
pub struct Body {
    /// The component's name.
    pub name: String,
    /// Its axes, where a person states them.
    pub stated_axes: Option<String>,
    /// Its model.
    pub model: OwnedModel,
    /// What there is to say of the model's file.
    pub of_file: Vec<String>,
    /// Its poses, a row a frame.
    pub poses: Vec<Option<Pose>>,
    /// By frame, from 0, where they are known.
    pub uncertain: BTreeMap<usize, Uncertain>,
}

/// What a report is made from.
pub struct Sources {
    /// The femoral component.
    pub femur: Body,
    /// The tibial component.
    pub tibia: Body,
    /// Why a frame is doubtful, by its number from 0.
    pub doubts: BTreeMap<usize, String>,
    /// Whether the poses of both components come with verdicts.
    pub has_verdicts: bool,
    /// Why poses of a frame were doubtful that a person has accepted, by its number from 0.
    pub accepted: BTreeMap<usize, String>,
    /// Frames, from 0, in which a person has checked both poses.
    pub checked: BTreeSet<usize>,
    /// The constants of the film by which poses were found, in words: a component and what it is seen with.
    pub film: Vec<(String, String)>,
    /// What is another than the poses were found with, sentences.
    pub changed: Vec<String>,
    /// Where the poses come from, in words.
    pub whose: String,
    /// Files and their digests.
    pub inputs: Vec<Input>,
}

impl Sources {
    /// Reads what a study names, and the poses of a folder where one is given.
    ///
    /// # Errors
    /// For files that are missing, unreadable or do not belong together.
    pub fn read(file: &Path, study: &Study, poses: Option<&Path>) -> Result<Self> {
        study.check_files(None)?;
        let mut inputs = vec![
            digest("study", file)?,
            digest("calibration", &study.calibration)?,
        ];
        let body = |role| {
            let mut inputs = Vec::new();
            Body::read(study, role, poses, &mut inputs).map(|body| (body, inputs))
        };
        let (femur, tibia) = rayon::join(|| body(Role::Femur), || body(Role::Tibia));
        let ((mut femur, of_femur), (mut tibia, of_tibia)) = (femur?, tibia?);
        inputs.extend(of_femur.into_iter().chain(of_tibia));
        let (a, b) = (femur.poses.len(), tibia.poses.len());
        if a != b {
            bail!("there are {a} femoral and {b} tibial poses: both must be of the same film");
        }
        let states = match poses {
            Some(folder) => states(folder, [&femur, &tibia], &mut inputs)?,
            None => None,
        };
        let has_verdicts = states.is_some();
        let states = states.unwrap_or_default().all;
        let (mut doubts, mut checked) = (doubts(&states), checked(&states));
        let mut accepted = accepted(&states);
        if let Some(folder) = poses
            && let Some(rows) = PoseRows::of(folder, study.frames.as_deref())?
        {
            eprintln!("{}", rows.words(folder));
            femur.set_rows(&rows)?;
            tibia.set_rows(&rows)?;
            doubts = by_frame(doubts, &rows);
            accepted = by_frame(accepted, &rows);
            checked = checked
                .iter()
                .filter_map(|&row| rows.frame_of(row))
                .collect();
        }
        check_count(study, a)?;
        let film = film_of(poses, &mut inputs)?;
        let bodies = [&femur, &tibia].map(|body| (body.name.as_str(), body.model.as_model()));
        let with = FoundWith::of(&read_calibration(&study.calibration)?, bodies.into_iter());
        let changed = poses.map(|folder| with.changed_since(folder)).transpose()?;
        let whose = match poses {
            Some(folder) => format!("those of the folder {}", name_of(folder)),
            None => "the study's references".to_owned(),
        };
        Ok(Self {
            femur,
            tibia,
            doubts,
            has_verdicts,
            accepted,
            checked,
            film,
            changed: changed.unwrap_or_default(),
            whose,
            inputs,
        })
    }
}

/// The states of both components in a folder of poses, where it has them.
///
/// # Errors
/// For tables of other poses.
fn states(folder: &Path, bodies: [&Body; 2], inputs: &mut Vec<Input>) -> Result<Option<States>> {
    let poses = bodies.map(|body| (body.name.as_str(), body.poses.as_slice()));
    let states = States::beside(folder, &poses)?;
    for table in states.iter().flat_map(|states| &states.tables) {
        inputs.push(digest("verdicts of poses", table)?);
    }
    Ok(states)
}

/// What is told of frames, by their rows: of two components both.
fn told(rows: impl Iterator<Item = (usize, String)>) -> BTreeMap<usize, String> {
    let mut all: BTreeMap<usize, String> = BTreeMap::new();
    for (row, words) in rows {
        let told = all.entry(row).or_default();
        if !told.is_empty() {
            told.push_str("; ");
        }
        told.push_str(&words);
    }
    all
}

/// Why frames are not good.
fn doubts(states: &[State]) -> BTreeMap<usize, String> {
    let words = |one: &State| format!("{} {}: {}", one.component, one.state, one.because);
    let bad = states.iter().filter(|one| !one.is_good());
    told(bad.map(|one| (one.row, words(one))))
}

/// Why poses were doubtful that a person accepted.
fn accepted(states: &[State]) -> BTreeMap<usize, String> {
    let words = |one: &State| Some((one.row, format!("{}: {}", one.component, one.accepted()?)));
    told(states.iter().filter_map(words))
}

/// The rows in which a person has checked the poses of both components.
fn checked(states: &[State]) -> BTreeSet<usize> {
    let mut once = BTreeSet::new();
    let all = states.iter().filter(|one| one.is_checked);
    all.map(|one| one.row)
        .filter(|&row| !once.insert(row))
        .collect()
}

fn by_frame<T>(of_rows: BTreeMap<usize, T>, rows: &PoseRows) -> BTreeMap<usize, T> {
    let frame = |(row, one)| Some((rows.frame_of(row)?, one));
    of_rows.into_iter().filter_map(frame).collect()
}

/// The constants of the film by which poses were found, where their folder has them.
fn film_of(poses: Option<&Path>, inputs: &mut Vec<Input>) -> Result<Vec<(String, String)>> {
    let constants = poses.map(|folder| folder.join("film.csv"));
    let Some(table) = constants.filter(|table| table.is_file()) else {
        return Ok(Vec::new());
    };
    inputs.push(digest("constants of the film", &table)?);
    Ok(constants_of_film(&read_text(&table)?))
}

/// What [`crate::verbs::track`] wrote of a film; rows that are none of it are passed over.
fn constants_of_film(table: &str) -> Vec<(String, String)> {
    let row = |line: &str| {
        let fields = csv_fields(line);
        let [name, numbers @ ..] = fields.as_slice() else {
            return None;
        };
        let numbers: Vec<f64> = numbers.iter().flat_map(|one| one.parse()).collect();
        let [
            curvature,
            sd_curvature,
            blur,
            sd_blur,
            attenuation,
            sd_attenuation,
            ..,
        ] = numbers[..]
        else {
            return None;
        };
        let words = format!(
            "display bent by {} a grey value, blur {} px, metal {} a mm",
            plus_minus(curvature, sd_curvature, 4),
            plus_minus(blur, sd_blur, 2),
            plus_minus(attenuation, sd_attenuation, 2)
        );
        Some((plain(name).to_owned(), words))
    };
    table.lines().skip(1).filter_map(row).collect()
}

impl Body {
    fn set_rows(&mut self, rows: &PoseRows) -> Result<()> {
        self.poses = rows.rows(&self.poses)?;
        self.uncertain = by_frame(std::mem::take(&mut self.uncertain), rows);
        Ok(())
    }

    fn read(
        study: &Study,
        role: Role,
        poses: Option<&Path>,
        inputs: &mut Vec<Input>,
    ) -> Result<Self> {
        let word = match role {
            Role::Femur => "femoral",
            Role::Tibia => "tibial",
        };
        let component = study.components.iter().find(|one| one.role() == Some(role));
        let component =
            component.with_context(|| format!("{} names no {word} component", study.name))?;
        let file = pose_file(component, poses).with_context(|| {
            format!(
                "{} has no reference poses: name a folder of poses with --poses, or its reference in the study",
                component.name
            )
        })?;
        inputs.push(digest(&format!("{word} model"), &component.model)?);
        inputs.push(digest(&format!("{word} poses"), &file)?);
        let beside = covariances_beside(&file);
        let uncertain = match poses.is_some() && beside.is_file() {
            true => {
                inputs.push(digest(&format!("{word} covariances"), &beside)?);
                read_covariances(&read_text(&beside)?)
                    .with_context(|| format!("in {}", beside.display()))?
            }
            false => BTreeMap::new(),
        };
        let (model, remarks) = component.read_model_and_remarks()?;
        let told = |remark| format!("{}: {remark}", component.model.display());
        let poses = match poses {
            // Its covariances are put to the frames with them.
            Some(_) => read_poses(&file)?,
            None => read_poses_of(&file, study.frames.as_deref())?,
        };
        if let Some((&last, _)) = uncertain.last_key_value() {
            ensure!(
                last < poses.len(),
                "{} has a frame {}, and {} has {} poses",
                beside.display(),
                last + 1,
                file.display(),
                poses.len()
            );
        }
        Ok(Self {
            name: component.name.clone(),
            stated_axes: component.axes.clone(),
            model,
            of_file: remarks.into_iter().map(told).collect(),
            poses,
            uncertain,
        })
    }
}

/// Refuses poses of another number than there are frames, where these are at hand: nothing tells which row is whose then.
fn check_count(study: &Study, rows: usize) -> Result<()> {
    let frames = study.frames.as_deref();
    if let Some((folder, count)) = frames.and_then(|at| Some((at, other_count(at, rows)?))) {
        bail!(
            "{}: there are {count} frames and {rows} poses: both must be of the same film, a row for each frame, NaN where there is no pose",
            folder.display()
        );
    }
    Ok(())
}

fn pose_file(component: &Component, poses: Option<&Path>) -> Option<PathBuf> {
    match poses {
        Some(folder) => Some(folder.join(format!("{}.jts", component.name))),
        None => component.reference.clone(),
    }
}

fn digest(what: &str, file: &Path) -> Result<Input> {
    Ok(Input {
        what: what.to_owned(),
        name: name_of(file),
        sha256: sha256(&read(file)?),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_told_of_both_components_stands_in_one_line() {
        let state = |row, component: &str, verdict: &str, because: &str| State {
            row,
            component: component.to_owned(),
            state: "followed".to_owned(),
            verdict: verdict.to_owned(),
            because: because.to_owned(),
            is_checked: row == 1 || component == "femur",
        };
        let accepted_it = "a person accepted it; it was doubtful: a jump";
        let states = [
            state(0, "femur", "good", accepted_it),
            // As the page says it now.
            state(
                0,
                "tibia",
                "good",
                &accepted_it.replace("accepted", "checked"),
            ),
            state(1, "femur", "doubtful", "a rim"),
            state(1, "tibia", "none", "no edge"),
        ];
        let one = |row, words: &str| BTreeMap::from([(row, words.to_owned())]);
        assert_eq!(accepted(&states), one(0, "femur: a jump; tibia: a jump"));
        assert_eq!(
            doubts(&states),
            one(1, "femur followed: a rim; tibia followed: no edge")
        );
        assert_eq!(checked(&states), BTreeSet::from([1]));
    }
}
