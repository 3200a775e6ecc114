//! What a report is made from: models, poses, their covariances, what is doubtful, and the digests of all of these.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};
use fluoropose::Pose;
use fluoropose::mesh::OwnedModel;
use fluoropose::pose::covariance::PoseCovariance;
use fluoropose_report::cell::{plain, quoted};
use fluoropose_report::{Input, plus_minus};

use crate::files::{
    Component, PoseRows, Role, Study, csv_fields, name_of, read, read_poses, read_poses_of,
    read_text, sha256,
};

/// A component with its poses.
pub struct Body {
    /// The component's name.
    pub name: String,
    /// Its axes, where a person states them.
    pub stated_axes: Option<String>,
    /// Its model.
    pub model: OwnedModel,
    /// Its poses, a row a frame.
    pub poses: Vec<Option<Pose>>,
    /// By frame, from 0, where they are known.
    pub uncertain: BTreeMap<usize, Uncertain>,
}

/// How uncertain a pose is.
#[derive(Clone, Copy, Debug)]
pub struct Uncertain {
    /// Its covariance.
    pub covariance: PoseCovariance,
    /// What a step of each of the film's constants does to it; `None` in files from before it was written.
    pub film_steps: Option<[[f64; 6]; 2]>,
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
        let states = states.unwrap_or_default();
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
        let film = film_of(poses, &mut inputs)?;
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
            whose,
            inputs,
        })
    }
}

/// The table of states in a folder of poses: what `track` and the page write, or what `pose --report` writes of both components, as COMPONENT.csv.
///
/// # Errors
/// For tables of other poses.
fn states(folder: &Path, bodies: [&Body; 2], inputs: &mut Vec<Input>) -> Result<Option<String>> {
    let table = folder.join("track.csv");
    if table.is_file() {
        inputs.push(digest("states of the frames", &table)?);
        return Ok(Some(read_text(&table)?));
    }
    let mut all = String::from("frame,component,state,verdict,because\n");
    for Body { name, poses, .. } in bodies {
        let table = folder.join(format!("{name}.csv"));
        let rows = match table.is_file() {
            true => rows_of_report(name, poses, &read_text(&table)?)
                .with_context(|| format!("in {}", table.display()))?,
            false => None,
        };
        let Some(rows) = rows else { return Ok(None) };
        inputs.push(digest(&format!("verdicts of the {name}"), &table)?);
        all.push_str(&rows);
    }
    Ok(Some(all))
}

/// Poses are one where their places are so near, mm: tables are rounded.
const ONE_MM: f64 = 0.01;

/// The rows of a table of `pose --report` as those of `track.csv`; `None` where it is no such table.
///
/// # Errors
/// Where it is of other poses, whose verdicts say nothing of these.
fn rows_of_report(name: &str, poses: &[Option<Pose>], table: &str) -> Result<Option<String>> {
    let mut lines = table.lines();
    let heading = csv_fields(lines.next().unwrap_or_default());
    let place = |name: &str| heading.iter().position(|one| one == name);
    let names = ["frame", "verdict", "because", "x_mm", "y_mm", "z_mm"];
    let places: Option<Vec<usize>> = names.into_iter().map(place).collect();
    let Some(places) = places else {
        return Ok(None);
    };
    let lines: Vec<&str> = lines.collect();
    ensure!(
        lines.len() == poses.len(),
        "{} frames, but {name}.jts has {}",
        lines.len(),
        poses.len()
    );
    let mut rows = String::new();
    for (line, pose) in lines.into_iter().zip(poses) {
        let fields = csv_fields(line);
        let cell = |k: usize| fields.get(places[k]).map_or("", String::as_str);
        let told: Vec<f64> = (3..6).flat_map(|k| cell(k).parse()).collect();
        let known = pose.map_or(Vec::new(), |pose| pose.translation.to_vec());
        let mut off = told.iter().zip(&known).map(|(a, b)| (a - b).abs());
        ensure!(
            told.len() == known.len() && off.all(|off| off <= ONE_MM),
            "frame {} has another pose than {name}.jts: write both anew, as `pose --out {name}.jts --report {name}.csv` does",
            cell(0)
        );
        let (frame, verdict, because) = (cell(0), cell(1), quoted(cell(2)));
        let _ = writeln!(
            rows,
            "{frame},{},{verdict},{verdict},{because}",
            quoted(name)
        );
    }
    Ok(Some(rows))
}

/// Before the reason why a pose was doubtful that a person accepted, in the page's table of states.
const ACCEPTED: &str = "a person accepted it; it was doubtful: ";

/// The reasons why poses were doubtful that a person accepted, by frame, from 0.
fn accepted(text: &str) -> BTreeMap<usize, String> {
    let mut all: BTreeMap<usize, String> = BTreeMap::new();
    for fields in text.lines().skip(1).map(csv_fields) {
        let [frame, component, _, _, because, ..] = fields.as_slice() else {
            continue;
        };
        let told = (
            frame.parse::<usize>(),
            plain(because).strip_prefix(ACCEPTED),
        );
        if let (Ok(frame), Some(because)) = told {
            let why = format!("{}: {because}", plain(component));
            let frame = all.entry(frame.saturating_sub(1)).or_default();
            match frame.is_empty() {
                true => *frame = why,
                false => *frame = format!("{frame}; {why}"),
            }
        }
    }
    all
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
                "{} has no reference poses: name a folder of poses",
                component.name
            )
        })?;
        inputs.push(digest(&format!("{word} model"), &component.model)?);
        inputs.push(digest(&format!("{word} poses"), &file)?);
        let beside = file.with_extension("covariances.csv");
        let uncertain = match poses.is_some() && beside.is_file() {
            true => {
                inputs.push(digest(&format!("{word} covariances"), &beside)?);
                covariances(&read_text(&beside)?)
                    .with_context(|| format!("in {}", beside.display()))?
            }
            false => BTreeMap::new(),
        };
        Ok(Self {
            name: component.name.clone(),
            stated_axes: component.axes.clone(),
            model: component.read_model()?,
            poses: match poses {
                // Its covariances are put to the frames with them.
                Some(_) => read_poses(&file)?,
                None => read_poses_of(&file, study.frames.as_deref())?,
            },
            uncertain,
        })
    }
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

/// As `track` writes them: a frame, from 1, 36 numbers, and twice six of the film, which older files do not have. By frame, from 0.
///
/// # Errors
/// Names the line.
pub fn covariances(text: &str) -> Result<BTreeMap<usize, Uncertain>> {
    let mut all = BTreeMap::new();
    for (index, line) in text.lines().enumerate().skip(1) {
        let numbers: Result<Vec<f64>, _> = line.split(',').map(str::parse).collect();
        let numbers = numbers.with_context(|| format!("line {}", index + 1))?;
        let (rows, rest) = numbers.get(1..).unwrap_or_default().as_chunks::<6>();
        let whole = rest.is_empty() && matches!(rows.len(), 6 | 8);
        let matrix = rows.first_chunk::<6>().filter(|_| whole);
        let matrix = *matrix
            .with_context(|| format!("line {} does not hold 37 or 49 numbers", index + 1))?;
        let uncertain = Uncertain {
            covariance: PoseCovariance { matrix },
            film_steps: rows[6..].try_into().ok(),
        };
        // A whole number from 1: fractions would name no frame.
        all.insert((numbers[0] as usize).saturating_sub(1), uncertain);
    }
    Ok(all)
}

/// The frames, from 0, of which both components' rows say so in a column `checked`: the page writes it.
fn checked(text: &str) -> BTreeSet<usize> {
    let mut lines = text.lines();
    let heading = csv_fields(lines.next().unwrap_or_default());
    let Some(column) = heading.iter().position(|name| name == "checked") else {
        return BTreeSet::new();
    };
    let (mut once, mut both) = (BTreeSet::new(), BTreeSet::new());
    for fields in lines.map(csv_fields) {
        let Some(Ok(frame)) = fields.first().map(|frame| frame.parse::<usize>()) else {
            continue;
        };
        let is_checked = fields.get(column).is_some_and(|word| word == "1");
        if is_checked && !once.insert(frame.saturating_sub(1)) {
            both.insert(frame.saturating_sub(1));
        }
    }
    both
}

/// The reasons of `track.csv` (frame, component, state, verdict, reason) for what is not good, by frame, from 0.
pub fn doubts(text: &str) -> BTreeMap<usize, String> {
    let mut all: BTreeMap<usize, String> = BTreeMap::new();
    for line in text.lines().skip(1) {
        let fields = csv_fields(line);
        let [frame, component, state, verdict, because, ..] = fields.as_slice() else {
            continue;
        };
        let (Ok(frame), false) = (frame.parse::<usize>(), verdict == "good") else {
            continue;
        };
        let why = format!("{} {state}: {}", plain(component), plain(because));
        let all = all.entry(frame.saturating_sub(1)).or_default();
        if !all.is_empty() {
            all.push_str("; ");
        }
        all.push_str(&why);
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_person_accepted_is_told_and_a_table_of_pose_is_one_of_states() {
        let states = "frame,component,state,verdict,because\n\
            1,\"femur\",fixed,good,\"a person accepted it; it was doubtful: jump: 2 mm\"\n\
            1,\"tibia\",fixed,good,\"a person accepted it; it was doubtful: a rim\"\n\
            2,\"tibia\",followed,good,\"the edges lie on the outline\"\n";
        let told = accepted(states);
        assert_eq!(told.len(), 1);
        assert_eq!(told[&0], "femur: jump: 2 mm; tibia: a rim");

        let report = "frame,file,x_mm,y_mm,z_mm,verdict,because,decided_by\n\
            1,a.png,0.5,-2.001,-900,good,\"it lies, on what was seen\",residual\n\
            2,b.png,,,,none,\"no outline\",\n";
        let pose = |x| {
            Some(Pose {
                translation: [x, -2.0, -900.0],
                ..Pose::IDENTITY
            })
        };
        let rows_of = |poses: &[Option<Pose>]| rows_of_report("the tibia", poses, report);
        let rows = rows_of(&[pose(0.5), None]).unwrap().unwrap();
        let told = doubts(&format!("frame,component,state,verdict,because\n{rows}"));
        let told: Vec<_> = told.into_iter().collect();
        assert_eq!(told, [(1, "the tibia none: no outline".to_owned())]);
        // Of another run: another pose, one where there is none, fewer frames and more.
        for poses in [
            &[pose(0.6), None][..],
            &[pose(0.5), pose(0.5)],
            &[pose(0.5)],
            &[pose(0.5), None, None],
        ] {
            assert!(rows_of(poses).is_err());
        }
        let no_table = rows_of_report("tibia", &[], "frame,verdict\n1,good\n");
        assert!(no_table.unwrap().is_none());
    }
}
