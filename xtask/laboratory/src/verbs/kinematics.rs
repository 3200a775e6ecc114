//! Verb `kinematics`: joint kinematics from two pose files.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};
use fluoropose::joint::beside::Middles;
use fluoropose::joint::flange::OtherSide;
use fluoropose::joint::kinematics::{self, joint_axes, relative_pose};
use fluoropose::joint::numbers::{NUMBERS, of_pose, place};
use fluoropose::joint::shared::KnownTo;
use fluoropose::joint::{COLUMNS, Joint};
use fluoropose::mesh::anatomy::AnatomicalAxes;
use fluoropose::mesh::{Mesh, OwnedModel};
use fluoropose::pose::{EulerPose, Pose};
use fluoropose_report::{ORIGINS, besides, impossibilities, origins_told};

use crate::exit;
use crate::files::{Role, read_model_of, read_poses, write_text};
use crate::finding::{axes_of, say_axes};
use crate::options::{of_body, sides};
use fluoropose_phantom::implant::Side;

/// Options of `kinematics`.
#[derive(clap::Args)]
#[command(
    after_help = "A row a frame: the tibial component relative to the femoral one as a pose (mm, degrees), then the field's six \
numbers: anterior-posterior, superior-inferior and mediolateral translation (mm), flexion, abduction and internal rotation (degrees); the \
translations of Grood and Suntay (gs_*, mm); and, where both models are named, the lowest points of both condyles above the tray. Translations are those \
of the origins of both files, wherever these lie: a line that begins with # says so above the table's heading, and another where they are such as no knee has. A frame in which \
either has no pose has empty numbers; without any other frame the exit code is 7. Numbers that no knee has, as swapped poses give, are told (the wrong side may give numbers that a knee has): on standard error, by the exit \
code 3, and in the table by lines before its heading that begin with # (pandas.read_csv(..., comment=\"#\")). The numbers are those of components whose files have the field's axes (of left implants x anterior, y superior, z to the \
patient's right; files of right ones are those mirrored in x: x posterior, z to the patient's left); for others name both models, so that their shapes tell the axes, or state the axes of both.\n\n\
Example:\n  cargo xtask kinematics --femur femur.jts --tibia tibia.jts --side left --out kinematics.csv"
)]
pub struct Args {
    /// Femoral poses (.jts, .jtak)
    #[arg(long)]
    femur: PathBuf,
    /// Tibial poses (.jts, .jtak), as many
    #[arg(long)]
    tibia: PathBuf,
    /// The femoral component's model: its anatomical axes are found from its shape, and poses are taken in them
    #[arg(long, value_name = "FILE")]
    femur_model: Option<PathBuf>,
    /// The tibial component's model, likewise
    #[arg(long, value_name = "FILE")]
    tibia_model: Option<PathBuf>,
    /// Which of the femoral file's axes point anteriorly, superiorly and to the patient's right, as in "x y z": instead
    /// of what its shape tells
    #[arg(long, value_name = "AXES", allow_hyphen_values = true)]
    femur_axes: Option<String>,
    /// The same of the tibial component
    #[arg(long, value_name = "AXES", allow_hyphen_values = true)]
    tibia_axes: Option<String>,
    /// Left or right knee
    #[arg(long, value_parser = sides())]
    side: Side,
    /// Table to write (CSV)
    #[arg(long)]
    out: PathBuf,
}

/// Runs the verb; the code to exit with.
///
/// # Errors
/// For files that cannot be read or written, or that differ in their number of frames.
pub fn run(args: Args) -> Result<u8> {
    let [femur, tibia] = read_both(&args)?;
    let side = of_body(args.side);
    let part = |file: &Option<PathBuf>, words: &Option<String>, role| {
        Part::read(file.as_deref(), words.as_deref(), role)
    };
    let femur_part = part(&args.femur_model, &args.femur_axes, Role::Femur)?;
    let tibia_part = part(&args.tibia_model, &args.tibia_axes, Role::Tibia)?;
    let parts = [&femur_part, &tibia_part];
    let known = parts.map(|part| part.axes.is_some());
    ensure!(
        known[0] == known[1],
        "the axes of the {} component are known and those of the other are not: name both models, or state the axes of both",
        if known[0] { "femoral" } else { "tibial" }
    );
    let Told {
        table,
        joints,
        plateless,
        told,
        far,
    } = table(parts, side, femur.into_iter().zip(tibia))?;
    let of_plate = plateless.iter().map(|told| format!("# plate: {told}\n"));
    let marked = told.iter().map(|told| format!("# doubtful: {told}\n"));
    let origins = [format!("# translations: {ORIGINS}\n")];
    let far_apart = far.iter().map(|far| format!("# origins: {far}\n"));
    let known = femur_part.model.as_ref().zip(femur_part.axes.as_ref());
    let other =
        known.and_then(|(model, axes)| OtherSide::than(side, model.as_model().mesh(), axes));
    let of_side = other.iter().map(|other| format!("# side: {other}\n"));
    let marked: String = marked
        .chain(of_side)
        .chain(of_plate)
        .chain(far_apart)
        .chain(origins)
        .collect();
    write_text(&args.out, &(marked + &table))?;
    // Written before anything is said, so that it is there where nobody reads on.
    for (name, part) in [("femoral", &femur_part), ("tibial", &tibia_part)] {
        if let Some(axes) = &part.axes {
            say_axes(name, axes);
        }
    }
    if let Some(other) = other {
        eprintln!("{other}");
    }
    println!("translations: {ORIGINS}");
    let remarks = plateless.iter().chain(&told).chain(&far);
    remarks.for_each(|told| eprintln!("{told}"));
    if joints == 0 {
        eprintln!("no frame has poses of both components: there are no numbers of a joint");
        return Ok(exit::NOTHING_FOUND);
    }
    Ok(if told.is_empty() { 0 } else { exit::DOUBTFUL })
}

/// The poses of both components, a frame each.
fn read_both(args: &Args) -> Result<[Vec<Option<Pose>>; 2]> {
    let (femur, tibia) = (read_poses(&args.femur)?, read_poses(&args.tibia)?);
    if femur.len() != tibia.len() {
        bail!(
            "{} has {} frames but {} has {}: both must be of the same sequence",
            args.femur.display(),
            femur.len(),
            args.tibia.display(),
            tibia.len()
        );
    }
    Ok([femur, tibia])
}

/// The table, and what is told of it.
struct Told {
    table: String,
    /// Frames with a joint.
    joints: usize,
    /// Why there are no lowest points though both models are known.
    plateless: Option<String>,
    /// Of numbers that no knee has.
    told: Vec<String>,
    /// Of translations that no knee has by the origins of the files.
    far: Option<String>,
}

fn table(
    [femur_part, tibia_part]: [&Part; 2],
    side: kinematics::Side,
    poses: impl Iterator<Item = (Option<Pose>, Option<Pose>)>,
) -> Result<Told> {
    let poses: Vec<(Option<Pose>, Option<Pose>)> = poses.collect();
    let joint = joint(femur_part, tibia_part, side);
    let mut memory = vec![0; joint.map_or(0, |joint| joint.memory_needed())];
    let columns = if joint.is_some() {
        NUMBERS
    } else {
        place::MEDIAL_AP
    };
    let mut table = heading(columns);
    let mut frames = Vec::new();
    for (frame, (femur, tibia)) in poses.iter().copied().enumerate() {
        write!(table, "{}", frame + 1)?;
        match femur.zip(tibia) {
            Some((femur, tibia)) => {
                let relative = relative_pose(
                    &femur.compose(&femur_part.joint_axes(side)),
                    &tibia.compose(&tibia_part.joint_axes(side)),
                );
                let mut numbers = [f64::NAN; NUMBERS];
                if let Some(joint) = &joint {
                    let known = KnownTo::USUALLY;
                    let both = joint.relative(&femur.into(), &tibia.into(), known);
                    numbers = joint.at(&both, &mut memory)?.numbers;
                }
                numbers[..place::MEDIAL_AP].copy_from_slice(&of_pose(&relative, side));
                for number in row_numbers(&relative, &numbers[..columns]) {
                    write!(table, ",{number:.4}")?;
                }
                frames.push((frame + 1, numbers));
            }
            None => table.push_str(&",".repeat(POSE_NUMBERS + columns)),
        }
        table.push('\n');
    }
    let known = femur_part.known().zip(tibia_part.known());
    Ok(Told {
        table,
        joints: frames.len(),
        plateless: known.filter(|_| joint.is_none()).map(|_| {
            "no part of the tibial model faces upwards like a tray's plate, so that lowest points are not known: are its axes right?".to_owned()
        }),
        told: impossibilities(frames.iter().copied())
            .into_iter()
            .chain(lying_beside([femur_part, tibia_part], poses))
            .collect(),
        far: origins_told(frames.into_iter()),
    })
}

/// What is told of frames whose components lie beside each other as in no knee.
fn lying_beside(
    [femur, tibia]: [&Part; 2],
    poses: Vec<(Option<Pose>, Option<Pose>)>,
) -> Option<String> {
    let middles = Middles::new(femur.known()?, tibia.known()?)?;
    let (femur, tibia): (Vec<_>, Vec<_>) = poses.into_iter().unzip();
    let told = middles.judge_poses(&femur, &tibia);
    let frames = told.into_iter().enumerate();
    besides(frames.filter_map(|(frame, told)| Some((frame + 1, told?))))
}

/// A component: its model and its anatomical axes, where they are known.
struct Part {
    model: Option<OwnedModel>,
    /// Stated, or told by the shape of the model.
    axes: Option<AnatomicalAxes>,
}

impl Part {
    fn read(file: Option<&Path>, words: Option<&str>, role: Role) -> Result<Self> {
        let read = |file| read_model_of(file, Some(role));
        let model = file.map(read).transpose()?;
        let axes = known_axes(file.zip(model.as_ref()), words, role)?;
        Ok(Self { model, axes })
    }

    /// The mesh and its axes, where both are known.
    fn known(&self) -> Option<(Mesh<'_>, &Pose)> {
        let (model, axes) = (self.model.as_ref()?, self.axes.as_ref()?);
        Some((*model.as_model().mesh(), &axes.model_from_field))
    }

    /// The rotation from the axes in which the field takes a joint to the file's: none where no axes are known.
    fn joint_axes(&self, side: kinematics::Side) -> Pose {
        let axes = self.axes.as_ref();
        axes.map_or(Pose::IDENTITY, |axes| {
            joint_axes(&axes.model_from_field, side)
        })
    }
}

/// The joint of two models whose axes are known.
fn joint<'p>(femur: &'p Part, tibia: &'p Part, side: kinematics::Side) -> Option<Joint<'p>> {
    Joint::new(femur.known()?, tibia.known()?, side)
}

fn known_axes(
    file: Option<(&Path, &OwnedModel)>,
    words: Option<&str>,
    role: Role,
) -> Result<Option<AnatomicalAxes>> {
    if let Some(words) = words {
        return Ok(Some(AnatomicalAxes::from_words(words)?));
    }
    let Some((file, model)) = file else {
        return Ok(None);
    };
    let axes = axes_of(&model.as_model(), role, None)?;
    let none = || {
        format!(
            "the shape of {} does not tell its axes: state them",
            file.display()
        )
    };
    axes.with_context(none).map(Some)
}

/// Numbers of the relative pose, which stand first in a row.
const POSE_NUMBERS: usize = 6;

/// The first line, with so many of the joint's numbers.
fn heading(columns: usize) -> String {
    let mut line = String::from(
        "frame,rel_x_mm,rel_y_mm,rel_z_mm,rel_z_rot_deg,rel_x_rot_deg,rel_y_rot_deg,\
         anterior_posterior_mm,superior_inferior_mm,mediolateral_mm,flexion_deg,abduction_deg,internal_rotation_deg",
    );
    for column in &COLUMNS[POSE_NUMBERS..columns] {
        line.push(',');
        line.push_str(column.name);
    }
    line.push('\n');
    line
}

fn row_numbers(relative: &Pose, joint: &[f64]) -> impl Iterator<Item = f64> {
    let pose = <[f64; 6]>::from(EulerPose::from(*relative));
    pose.into_iter().chain(joint.iter().copied())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_of_one_component_alone_are_refused() {
        let file = std::env::temp_dir().join(format!("fluoropose-axes-{}.jts", std::process::id()));
        std::fs::write(&file, "JT_EULER_312\n1,2,-900,0,0,0\n").unwrap();
        let out = file.with_extension("csv");
        let args = |femur_axes: bool, tibia_axes: bool| Args {
            femur: file.clone(),
            tibia: file.clone(),
            femur_model: None,
            tibia_model: None,
            femur_axes: femur_axes.then(|| "x y z".to_owned()),
            tibia_axes: tibia_axes.then(|| "x y z".to_owned()),
            side: Side::Right,
            out: out.clone(),
        };
        for (femur, tibia, words) in [
            (true, false, "of the femoral"),
            (false, true, "of the tibial"),
        ] {
            let error = run(args(femur, tibia)).unwrap_err().to_string();
            assert!(error.contains(words), "{error}");
        }
        run(args(true, true)).unwrap();
        std::fs::remove_file(file).unwrap();
        std::fs::remove_file(out).unwrap();
    }

    /// Six of the relative pose, six of the field, three of Grood and Suntay.
    const NUMBERS_WITHOUT_MODELS: usize = 15;

    #[test]
    fn a_frame_without_a_pose_has_empty_numbers_and_the_others_keep_theirs() {
        let folder = std::env::temp_dir().join(format!("fluoropose-joint-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let [femur, tibia, out] =
            ["femur.jts", "tibia.jtak", "out.csv"].map(|name| folder.join(name));
        let pose = "1,2,-900,0,0,0\n";
        let lines = ["JT_EULER_312\nNaN,NaN,NaN,NaN,NaN,NaN\n", pose, pose, pose];
        std::fs::write(&femur, lines.concat()).unwrap();
        let lines = [
            "JTA_EULER_KINEMATICS\n",
            pose,
            "NOT_OPTIMIZED,\n",
            "1,5,-900,9,0,0\n",
            "0,0,0,0,0,0\n",
        ];
        std::fs::write(&tibia, lines.concat()).unwrap();
        let side = Side::Right;
        run(Args {
            femur,
            tibia,
            femur_model: None,
            tibia_model: None,
            femur_axes: None,
            tibia_axes: None,
            side,
            out: out.clone(),
        })
        .unwrap();
        let table = std::fs::read_to_string(out).unwrap();
        std::fs::remove_dir_all(folder).unwrap();
        assert!(table.starts_with("# translations: origins are those of the models' files"));
        let rows: Vec<Vec<&str>> = table
            .lines()
            .filter(|line| !line.starts_with('#'))
            .skip(1)
            .map(|row| row.split(',').collect())
            .collect();
        assert_eq!(rows.len(), 4);
        for (frame, row) in rows.iter().enumerate() {
            assert_eq!(
                (row.len(), row[0]),
                (1 + NUMBERS_WITHOUT_MODELS, (frame + 1).to_string().as_str())
            );
            let filled = row[1..].iter().filter(|number| !number.is_empty()).count();
            assert_eq!(
                filled,
                if frame == 2 {
                    NUMBERS_WITHOUT_MODELS
                } else {
                    0
                }
            );
        }
        assert_eq!((rows[2][2], rows[2][4]), ("3.0000", "9.0000"));
    }

    /// Poses of frames that the other component has none of, and a tray whose stated axes leave nothing that faces upwards.
    #[test]
    fn no_joint_and_no_plate_are_told() {
        let folder = std::env::temp_dir().join(format!("fluoropose-none-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let place = |name: &str| folder.join(name);
        let (none, pose) = ("NaN,NaN,NaN,NaN,NaN,NaN\n", "1,2,-900,0,0,0\n");
        for (name, rows) in [("a.jts", [none, pose]), ("b.jts", [pose, none])] {
            std::fs::write(place(name), format!("JT_EULER_312\n{}", rows.concat())).unwrap();
        }
        let parameters = fluoropose_phantom::implant::Parameters::default();
        let femur = fluoropose_phantom::implant::femur(&parameters).unwrap();
        fluoropose_phantom::stl::write_file(&femur, &place("femur.stl")).unwrap();
        // A wall, of which nothing faces upwards.
        let wall = "v 0 0 -30\nv 0 0 30\nv 0 40 -30\nv 0 40 30\nv 2 20 0\nf 1 2 5\nf 2 4 5\nf 4 3 5\nf 3 1 5\n";
        std::fs::write(place("wall.obj"), wall).unwrap();
        let args = |tibia: &str| Args {
            femur: place("a.jts"),
            tibia: place(tibia),
            femur_model: Some(place("femur.stl")),
            tibia_model: Some(place("wall.obj")),
            femur_axes: Some("x y z".to_owned()),
            tibia_axes: Some("x y z".to_owned()),
            side: Side::Left,
            out: place("out.csv"),
        };
        assert_eq!(run(args("b.jts")).unwrap(), exit::NOTHING_FOUND);
        run(args("a.jts")).unwrap();
        let table = std::fs::read_to_string(place("out.csv")).unwrap();
        std::fs::remove_dir_all(&folder).unwrap();
        assert!(
            table.contains("# plate: no part of the tibial model"),
            "{table}"
        );
        assert!(!table.contains("medial_ap_mm"));
    }

    #[test]
    fn with_models_a_row_ends_with_the_lowest_points() {
        let parameters = fluoropose_phantom::implant::Parameters::default();
        let made = |mesh| Some(crate::files::owned(mesh).unwrap());
        let part = |model| Part {
            model,
            axes: Some(AnatomicalAxes::from_words("x y z").unwrap()),
        };
        let femur = part(made(
            fluoropose_phantom::implant::femur(&parameters).unwrap(),
        ));
        let tibia = part(made(
            fluoropose_phantom::implant::tibia(&parameters).unwrap(),
        ));
        let joint = joint(&femur, &tibia, kinematics::Side::Left).unwrap();
        assert!(joint.plate().depth_mm > 40.0);
        let names = heading(NUMBERS);
        assert!(
            names.contains("internal_rotation_deg,gs_lateral_mm")
                && names.ends_with(",lift_off_mm\n")
        );
        assert_eq!(names.split(',').count(), 1 + POSE_NUMBERS + NUMBERS);
    }
}
