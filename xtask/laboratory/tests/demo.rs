//! The demonstration: its motion is a deep knee bend, its files agree with each other and with the poses.
#![allow(clippy::unwrap_used, reason = "a refusal fails the test")]

use fluoropose::joint::kinematics::{joint_angles, relative_pose};
use fluoropose::pose::{EulerPose, Pose};
use fluoropose_decode::{Pixels, decode_frames};
use fluoropose_laboratory::files::Study;
use fluoropose_laboratory::files::{MaskBuffer, read_mask, read_poses};
use fluoropose_phantom::film::motion::{DEEPEST_DEG, Position, deep_knee_bend};
use fluoropose_phantom::implant::{Parameters, Side, Triangles, femur, tibia};
use fluoropose_phantom::sequence::{Options, write};
use std::fs;
use std::path::{Path, PathBuf};

fn parts(side: Side) -> (Triangles, Triangles) {
    let parameters = Parameters {
        side,
        ..Parameters::default()
    };
    (femur(&parameters).unwrap(), tibia(&parameters).unwrap())
}

fn bend(side: Side, frames: usize, seed: u64) -> Vec<Position> {
    deep_knee_bend(frames, side, &parts(side).0, 70.0, seed)
}

fn six(position: &Position, side: fluoropose::joint::kinematics::Side) -> [f64; 6] {
    let (femur, tibia) = (Pose::from(position.femur), Pose::from(position.tibia));
    let joint = joint_angles(&relative_pose(&femur, &tibia), side);
    [
        joint.anterior_mm,
        joint.superior_mm,
        joint.lateral_mm,
        joint.flexion_deg,
        joint.abduction_deg,
        joint.internal_deg,
    ]
}

#[test]
fn motion_is_a_deep_knee_bend_in_the_fields_numbers() {
    let numbers: Vec<_> = bend(Side::Left, 12, 3)
        .iter()
        .map(|p| six(p, fluoropose::joint::kinematics::Side::Left))
        .collect();
    assert!(numbers[0][3].abs() < 1e-6 && (numbers[11][3] - DEEPEST_DEG).abs() < 1e-6);
    for pair in numbers.windows(2) {
        assert!(pair[1][3] > pair[0][3] + 1.0, "flexion grows");
        assert!(pair[1][5] > pair[0][5], "the tibia turns inwards");
    }
    let gained = numbers[11][5] - numbers[0][5];
    assert!(
        (8.0..15.0).contains(&gained),
        "internal rotation gains {gained} degrees"
    );
    // Rollback: the posterior condyles' axis ends further back than at mid-flexion.
    assert!(
        numbers[11][0] < numbers[5][0] - 3.0,
        "{} to {} mm",
        numbers[5][0],
        numbers[11][0]
    );
}

#[test]
fn a_right_knee_has_the_same_joint_motion() {
    let left = bend(Side::Left, 5, 3);
    let right = bend(Side::Right, 5, 3);
    for (l, r) in left.iter().zip(&right) {
        let l = six(l, fluoropose::joint::kinematics::Side::Left);
        let r = six(r, fluoropose::joint::kinematics::Side::Right);
        for (a, b) in l.iter().zip(&r) {
            assert!((a - b).abs() < 1e-6, "{l:?} and {r:?}");
        }
    }
}

#[test]
fn every_pose_lies_in_the_range_of_a_library_and_in_the_frame() {
    for side in [Side::Left, Side::Right] {
        for seed in 0..20 {
            for position in bend(side, 9, seed) {
                for EulerPose {
                    x_mm,
                    y_mm,
                    z_mm,
                    x_rot_deg,
                    y_rot_deg,
                    ..
                } in [position.femur, position.tibia]
                {
                    assert!(
                        x_rot_deg.abs() <= 8.0 && y_rot_deg.abs() <= 10.0,
                        "{position:?}"
                    );
                    assert!(x_mm.abs() < 40.0 && y_mm.abs() < 45.0 && (z_mm + 1080.0).abs() < 15.0);
                }
            }
        }
    }
}

#[test]
fn the_femur_rests_on_the_insert_and_stays_clear_of_the_tray() {
    let (femur, _) = parts(Side::Left);
    for position in bend(Side::Left, 9, 1) {
        let tibia_from_femur = Pose::from(position.tibia)
            .inverse()
            .compose(&Pose::from(position.femur));
        let heights = femur
            .vertices
            .iter()
            .map(|v| tibia_from_femur.transform(&v.map(f64::from))[1]);
        let lowest = heights.fold(f64::INFINITY, f64::min);
        assert!(
            (lowest - 9.4).abs() < 1e-6,
            "{lowest} mm above the plate's middle"
        );
    }
}

struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path =
            std::env::temp_dir().join(format!("fluoropose-demo-{name}-{}", std::process::id()));
        Self(path)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // Leaving files behind in a temporary folder is no reason to fail.
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn grey(path: &Path) -> Vec<u8> {
    let mut pictures = decode_frames(&fs::read(path).unwrap(), "frame.png").unwrap();
    let picture = pictures.remove(0);
    assert_eq!((picture.width, picture.height), (1024, 1024));
    match picture.pixels {
        Pixels::U8(pixels) => pixels.to_vec(),
        Pixels::U16(_) => panic!("a frame has 8 bits"),
    }
}

#[test]
fn files_agree_with_each_other_and_repeat_bit_for_bit() {
    let (one, two, other) = (Folder::new("one"), Folder::new("two"), Folder::new("other"));
    let options = Options {
        frames: 2,
        seed: 5,
        side: Side::Right,
        ..Options::default()
    };
    write(&options, &one.0).unwrap();
    write(&options, &two.0).unwrap();
    write(&Options { seed: 6, ..options }, &other.0).unwrap();

    let study = Study::read(&one.0.join("study.toml")).unwrap();
    assert_eq!(study.side, Some(Side::Right));
    for component in &study.components {
        let poses = read_poses(component.reference.as_ref().unwrap()).unwrap();
        assert_eq!(poses.len(), 2);
    }
    for name in [
        "frames/0001.png",
        "frames/0002.png",
        "masks/femur/0002.png",
        "femur.stl",
        "tibia.jts",
        "demo.json",
    ] {
        let bytes = fs::read(one.0.join(name)).unwrap();
        assert_eq!(bytes, fs::read(two.0.join(name)).unwrap(), "{name}");
        if name.starts_with("frames") {
            assert_ne!(
                bytes,
                fs::read(other.0.join(name)).unwrap(),
                "the seed does not matter in {name}"
            );
        }
    }
    implants_are_dark_exactly_where_their_masks_are(&one.0);
}

/// Metal is dark, and nothing is darker than what the femur's mask covers: moved by a pixel in any direction it takes in tissue.
/// (The tray's rim is thin enough to let light through, so the tray is only asked to be dark.)
fn implants_are_dark_exactly_where_their_masks_are(folder: &Path) {
    let frame = grey(&folder.join("frames/0002.png"));
    let [femur, tibia] = ["femur", "tibia"]
        .map(|name| read_mask(&folder.join("masks").join(name).join("0002.png")).unwrap());
    // Grey under the mask moved by (right - 1, down - 1).
    let under = |mask: &MaskBuffer, right: usize, down: usize| {
        let mask = mask.mask();
        let places = (2..1022).flat_map(|row| (2..1022).map(move |column| (column, row)));
        places
            .filter(|&(column, row)| mask.get(column + 1 - right, row + 1 - down))
            .map(|(column, row)| f64::from(frame[row * 1024 + column]))
            .sum::<f64>()
    };
    let still = under(&femur, 1, 1);
    let across = [under(&femur, 0, 1), under(&femur, 2, 1)];
    let down = [under(&femur, 1, 0), under(&femur, 1, 2)];
    for [before, after] in [across, down] {
        // Where a parabola through the three sums is lowest: the shift at which image and mask agree best. Tissue
        // is not equally bright all round, so this is not zero, but a pixel convention gone wrong would be 0.5.
        let best = (before - after) / (2.0 * (before - 2.0 * still + after));
        assert!(best.abs() < 0.3, "image and mask are {best} pixels apart");
    }
    for (name, mask, sum) in [
        ("femur", &femur, still),
        ("tibia", &tibia, under(&tibia, 1, 1)),
    ] {
        let mean = sum / mask.mask().area() as f64;
        assert!(mean < 75.0, "{name} is not dark: {mean}");
    }
}

#[test]
fn no_frames_are_refused() {
    let folder = Folder::new("none");
    let error = write(
        &Options {
            frames: 0,
            ..Options::default()
        },
        &folder.0,
    )
    .unwrap_err();
    assert!(error.to_string().contains("1 to 9999"));
}
