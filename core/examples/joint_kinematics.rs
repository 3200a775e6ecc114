//! From the poses of two components to joint kinematics, frame by frame.
//!
//! `cargo run -p fluoropose --example joint_kinematics [FEMUR.jts TIBIA.jts [left|right]]`: without files, three frames of a
//! right knee that bends.

use std::error::Error;

use fluoropose::pose::jts;
use fluoropose::{EulerPose, Pose, Side, coronal_tilt_deg, joint_angles, relative_pose};

const FEMUR: &str = "JT_EULER_312
x_tran, y_tran, z_tran, z_rot, x_rot, y_rot
10.0, -20.0, -950.0,   0.0, 0.0, 0.0
11.0, -21.0, -951.0, -15.0, 0.0, 0.0
12.0, -22.0, -952.0, -30.0, 0.0, 0.0
";
const TIBIA: &str = "JT_EULER_312
x_tran, y_tran, z_tran, z_rot, x_rot, y_rot
10.0, -50.0, -950.0, 0.0, 0.0, 0.0
11.0, -51.0, -951.0, 0.0, 0.0, 0.0
12.0, -52.0, -952.0, 0.0, 0.0, 0.0
";

fn poses(text: &str) -> Result<Vec<Option<Pose>>, jts::JtsError> {
    jts::read(text)?
        .map(|row| row.map(|pose| pose.map(Pose::from)))
        .collect()
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (femur, tibia, side) = match arguments.as_slice() {
        [] => (FEMUR.to_owned(), TIBIA.to_owned(), Side::Right),
        [femur, tibia, side @ ..] => {
            let left = side.first().is_some_and(|side| side == "left");
            let side = if left { Side::Left } else { Side::Right };
            (
                std::fs::read_to_string(femur)?,
                std::fs::read_to_string(tibia)?,
                side,
            )
        }
        _ => return Err("name two files of poses, or none".into()),
    };

    let mut flexions = Vec::new();
    println!("frame  flexion  abduction  internal     AP     SI     ML   tilt");
    for (frame, (femur, tibia)) in poses(&femur)?.iter().zip(&poses(&tibia)?).enumerate() {
        let (Some(femur), Some(tibia)) = (femur, tibia) else {
            println!("{frame:5}  no pose");
            continue;
        };
        let relative = relative_pose(femur, tibia);
        let joint = joint_angles(&relative, side);
        println!(
            "{frame:5} {:8.2} {:10.2} {:9.2} {:6.1} {:6.1} {:6.1} {:6.2}",
            joint.flexion_deg,
            joint.abduction_deg,
            joint.internal_deg,
            joint.anterior_mm,
            joint.superior_mm,
            joint.lateral_mm,
            coronal_tilt_deg(femur, tibia),
        );
        // The two poses and the relative one say the same.
        let again = EulerPose::from(femur.compose(&relative));
        assert!((again.z_rot_deg - EulerPose::from(*tibia).z_rot_deg).abs() < 1e-9);
        flexions.push(joint.flexion_deg);
    }
    if arguments.is_empty() {
        // The femoral component rotated by 0, -15 and -30 degrees over a tibial one that stood still.
        let expected = [0.0, 15.0, 30.0];
        assert!(
            flexions
                .iter()
                .zip(expected)
                .all(|(found, truth)| (found - truth).abs() < 1e-9),
            "{flexions:?}"
        );
    }
    Ok(())
}
