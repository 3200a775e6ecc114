//! Verb `kinematics`: joint kinematics from two pose files.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use fluoropose::joint::kinematics::{self, joint_angles, joint_axes, relative_pose};
use fluoropose::mesh::anatomy::AnatomicalAxes;
use fluoropose::pose::{EulerPose, Pose};

use crate::files::{Role, read_model, read_poses};
use crate::finding::axes_of;
use crate::options::sides;
use fluoropose_phantom::implant::Side;

/// Options of `kinematics`.
#[derive(clap::Args)]
#[command(
    after_help = "A row a frame: the tibial component relative to the femoral one as a pose (mm, degrees), then the field's six \
numbers: anterior-posterior, superior-inferior and mediolateral translation (mm), flexion, abduction and internal rotation (degrees). A frame in which either \
has no pose has empty numbers. The numbers are those of components whose files have the field's axes (x anterior, y superior, z to the \
patient's right); for others name the models, so that their shape tells the axes, or state the axes.\n\n\
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

/// Runs the verb.
///
/// # Errors
/// For files that cannot be read or written, or that differ in their number of frames.
pub fn run(args: Args) -> Result<()> {
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
    let side = match args.side {
        Side::Left => kinematics::Side::Left,
        Side::Right => kinematics::Side::Right,
    };
    let stated = |file: &Option<PathBuf>, words: &Option<String>, role| {
        axes(file.as_deref(), words.as_deref(), role, side)
    };
    let femur_axes = stated(&args.femur_model, &args.femur_axes, Role::Femur)?;
    let tibia_axes = stated(&args.tibia_model, &args.tibia_axes, Role::Tibia)?;
    let mut table = String::from(
        "frame,rel_x_mm,rel_y_mm,rel_z_mm,rel_z_rot_deg,rel_x_rot_deg,rel_y_rot_deg,\
         anterior_posterior_mm,superior_inferior_mm,mediolateral_mm,flexion_deg,abduction_deg,internal_rotation_deg\n",
    );
    for (frame, (femur, tibia)) in femur.into_iter().zip(tibia).enumerate() {
        write!(table, "{}", frame + 1)?;
        match femur.zip(tibia) {
            Some((femur, tibia)) => {
                let (femur, tibia) = (femur.compose(&femur_axes), tibia.compose(&tibia_axes));
                for number in joint_numbers(&relative_pose(&femur, &tibia), side) {
                    write!(table, ",{number:.4}")?;
                }
            }
            None => table.push_str(&",".repeat(NUMBERS)),
        }
        table.push('\n');
    }
    std::fs::write(&args.out, table).with_context(|| format!("cannot write {}", args.out.display()))
}

/// The rotation from the axes in which the field takes a joint to a file's: stated, told by the shape of its model, or, without
/// either, none.
fn axes(
    file: Option<&Path>,
    words: Option<&str>,
    role: Role,
    side: kinematics::Side,
) -> Result<Pose> {
    let name = match role {
        Role::Femur => "femoral",
        Role::Tibia => "tibial",
    };
    let Some(axes) = known_axes(file, words, role)? else {
        return Ok(Pose::IDENTITY);
    };
    println!("{name} anterior, superior, right: {axes}");
    if !axes.are_files_own {
        eprintln!(
            "the {name} file's axes are more than 10 degrees off those of its shape, which are taken"
        );
    }
    if !axes.front_is_known {
        eprintln!(
            "the shape of the {name} component does not tell front from back: if flexion has the wrong sign, state its axes"
        );
    }
    Ok(joint_axes(&axes.model_from_field, side))
}

fn known_axes(
    file: Option<&Path>,
    words: Option<&str>,
    role: Role,
) -> Result<Option<AnatomicalAxes>> {
    if let Some(words) = words {
        return Ok(Some(AnatomicalAxes::from_words(words)?));
    }
    let Some(file) = file else {
        return Ok(None);
    };
    let model = read_model(file)?;
    let axes = axes_of(&model.as_model(), role, None)?;
    let none = || {
        format!(
            "the shape of {} does not tell its axes: state them",
            file.display()
        )
    };
    axes.with_context(none).map(Some)
}

/// Numbers of a row after that of the frame.
const NUMBERS: usize = 12;

fn joint_numbers(relative: &Pose, side: kinematics::Side) -> [f64; NUMBERS] {
    let pose = EulerPose::from(*relative);
    let joint = joint_angles(relative, side);
    [
        pose.x_mm,
        pose.y_mm,
        pose.z_mm,
        pose.z_rot_deg,
        pose.x_rot_deg,
        pose.y_rot_deg,
        joint.anterior_mm,
        joint.superior_mm,
        joint.lateral_mm,
        joint.flexion_deg,
        joint.abduction_deg,
        joint.internal_deg,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

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
        let rows: Vec<Vec<&str>> = table
            .lines()
            .skip(1)
            .map(|row| row.split(',').collect())
            .collect();
        assert_eq!(rows.len(), 4);
        for (frame, row) in rows.iter().enumerate() {
            assert_eq!(
                (row.len(), row[0]),
                (1 + NUMBERS, (frame + 1).to_string().as_str())
            );
            let filled = row[1..].iter().filter(|number| !number.is_empty()).count();
            assert_eq!(filled, if frame == 2 { NUMBERS } else { 0 });
        }
        assert_eq!((rows[2][2], rows[2][4]), ("3.0000", "9.0000"));
    }
}
