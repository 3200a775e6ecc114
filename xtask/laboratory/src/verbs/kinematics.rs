//! Verb `kinematics`: joint kinematics from two pose files.

use std::fmt::Write as _;
use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use fluoropose::pose::kinematics::{self, joint_angles, relative_pose};
use fluoropose::pose::{EulerPose, Pose};

use crate::files::read_poses;
use crate::options::sides;
use fluoropose_phantom::implant::Side;

/// Options of `kinematics`.
#[derive(clap::Args)]
#[command(
    after_help = "A row a frame: the tibial component relative to the femoral one as a pose (mm, degrees), then the field's six \
numbers: anterior-posterior, superior-inferior and mediolateral translation (mm), flexion, abduction and internal rotation (degrees).\n\n\
Example:\n  cargo xtask kinematics --femur femur.jts --tibia tibia.jts --side left --out kinematics.csv"
)]
pub struct Args {
    /// Femoral poses (.jts)
    #[arg(long)]
    femur: PathBuf,
    /// Tibial poses (.jts), as many
    #[arg(long)]
    tibia: PathBuf,
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
    let mut table = String::from(
        "frame,rel_x_mm,rel_y_mm,rel_z_mm,rel_z_rot_deg,rel_x_rot_deg,rel_y_rot_deg,\
         anterior_posterior_mm,superior_inferior_mm,mediolateral_mm,flexion_deg,abduction_deg,internal_rotation_deg\n",
    );
    for (frame, (femur, tibia)) in femur.into_iter().zip(tibia).enumerate() {
        let relative = relative_pose(&Pose::from(femur), &Pose::from(tibia));
        let pose = EulerPose::from(relative);
        let joint = joint_angles(&relative, side);
        let numbers = [
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
        ];
        write!(table, "{}", frame + 1)?;
        for number in numbers {
            write!(table, ",{number:.4}")?;
        }
        table.push('\n');
    }
    std::fs::write(&args.out, table).with_context(|| format!("cannot write {}", args.out.display()))
}
