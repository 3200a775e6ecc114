//! Joint numbers against those of another program: `tests/golden/joint.py`, which says how its table was made.

use fluoropose::joint::course::{REVERSAL_DEG, at_flexion, phases};
use fluoropose::joint::kinematics::Side;
use fluoropose::joint::low_pass::LowPass;
use fluoropose::joint::numbers::{NUMBERS, Posed};
use fluoropose::joint::pivot::{CondyleLine, pivot};
use fluoropose::joint::shared::KnownTo;
use fluoropose::joint::{COLUMNS, Joint};
use fluoropose::mesh::OwnedModel;
use fluoropose::pose::covariance::PoseCovariance;
use fluoropose::pose::{EulerPose, Pose};
use fluoropose_laboratory::files::owned;
use fluoropose_phantom::implant::{self, Parameters};
use fluoropose_tests::home;

/// Those of the table: turns in radians, shifts in mm.
const FEMUR_SD: [f64; 6] = [0.004, 0.005, 0.003, 0.1, 0.1, 2.0];
const TIBIA_SD: [f64; 6] = [0.006, 0.003, 0.004, 0.1, 0.2, 3.0];
const COMMON: [[f64; 6]; 2] = [
    [0.001, 0.0, 0.0, 0.0, 0.0, 3.0],
    [0.0, 0.001, 0.0, 0.0, 0.0, 4.0],
];

fn rows(kind: &str) -> Vec<Vec<f64>> {
    let table = std::fs::read_to_string(home().join("golden/joint.csv")).expect("the table");
    let numbers = |row: &str| -> Option<Vec<f64>> {
        let numbers = row.strip_prefix(kind)?.strip_prefix(',')?;
        Some(
            numbers
                .split(',')
                .map(|x| x.parse().expect("a number"))
                .collect(),
        )
    };
    let rows: Vec<_> = table.lines().filter_map(numbers).collect();
    assert!(!rows.is_empty(), "no rows of {kind}");
    rows
}

fn pose(six: &[f64]) -> Pose {
    Pose::from(EulerPose {
        x_mm: six[0],
        y_mm: six[1],
        z_mm: six[2],
        z_rot_deg: six[3],
        x_rot_deg: six[4],
        y_rot_deg: six[5],
    })
}

fn posed(pose: Pose, deviations: &[f64; 6], film: [f64; 6]) -> Posed {
    Posed {
        pose,
        covariance: covariance(deviations, &film),
        film_steps: [film, [0.0; 6]],
    }
}

fn covariance(deviations: &[f64; 6], also: &[f64; 6]) -> Option<PoseCovariance> {
    let matrix = core::array::from_fn(|a| {
        core::array::from_fn(|b| {
            let own = if a == b {
                deviations[a] * deviations[a]
            } else {
                0.0
            };
            own + also[a] * also[b]
        })
    });
    Some(PoseCovariance { matrix })
}

struct Knee {
    femur: OwnedModel,
    tibia: OwnedModel,
    side: Side,
}

impl Knee {
    fn new(side: Side) -> Self {
        let parameters = Parameters {
            side: match side {
                Side::Left => implant::Side::Left,
                Side::Right => implant::Side::Right,
            },
            ..Parameters::default()
        };
        Self {
            femur: owned(implant::femur(&parameters).expect("valid")).expect("valid"),
            tibia: owned(implant::tibia(&parameters).expect("valid")).expect("valid"),
            side,
        }
    }

    /// The same models with their files' axes permuted.
    fn permuted(&self, by: &Pose) -> Self {
        let moved = |model: &OwnedModel| {
            let model = model.as_model();
            let vertices = model
                .vertices()
                .iter()
                .flat_map(|vertex| by.transform(&vertex.map(f64::from)).map(|x| x as f32));
            let triangles = model.triangles().as_flattened().to_vec();
            OwnedModel::new(vertices.collect(), triangles).expect("valid")
        };
        Self {
            femur: moved(&self.femur),
            tibia: moved(&self.tibia),
            side: self.side,
        }
    }
}

/// `model_from_field` of the built-in implants: a right one is a left one mirrored in x.
fn axes(side: Side) -> Pose {
    let turn = if side == Side::Left { 0.0 } else { 180.0 };
    let axes = Pose::from(EulerPose {
        y_rot_deg: turn,
        ..EulerPose::default()
    });
    Pose {
        rotation: axes.rotation.map(|row| row.map(f64::round)),
        ..axes
    }
}

fn check_frames(permute: &Pose) {
    let back = permute.inverse();
    for side in [Side::Left, Side::Right] {
        let knee = Knee::new(side).permuted(permute);
        let own = permute.compose(&axes(side));
        let (femur, tibia) = (knee.femur.as_model(), knee.tibia.as_model());
        let joint = Joint::new((*femur.mesh(), &own), (*tibia.mesh(), &own), side);
        let joint = joint.expect("a plate");
        let mut memory = vec![0; joint.memory_needed()];
        let of_side = rows("frame")
            .into_iter()
            .filter(|row| (row[0] == 1.0) == (side == Side::Left));
        let mut frames = 0;
        for row in of_side {
            let poses = [&row[1..7], &row[7..13]].map(|six| pose(six).compose(&back));
            let relative = joint.relative(
                &posed(poses[0], &FEMUR_SD, COMMON[0]),
                &posed(poses[1], &TIBIA_SD, COMMON[1]),
                KnownTo::EXACTLY,
            );
            let found = joint.at(&relative, &mut memory).expect("room");
            let deviations = found.deviations.expect("covariances");
            for k in 0..NUMBERS {
                let (wanted, name) = (row[13 + k], COLUMNS[k].name);
                let number = found.numbers[k];
                assert!(
                    (number - wanted).abs() < 1e-4,
                    "{side:?} {name}: {number} {wanted}"
                );
                let (deviation, wanted) = (deviations[k], row[13 + NUMBERS + k]);
                assert!(
                    (deviation / wanted - 1.0).abs() < 0.01,
                    "{side:?} {name}: deviation {deviation} {wanted}"
                );
            }
            frames += 1;
        }
        assert_eq!(frames, 14);
    }
}

#[test]
fn numbers_of_28_frames_are_those_of_the_other_program_left_and_right() {
    check_frames(&Pose::IDENTITY);
}

#[test]
fn and_with_the_files_axes_permuted() {
    let rotation = [[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]];
    check_frames(&Pose {
        rotation,
        ..Pose::IDENTITY
    });
}

#[test]
fn the_filter_is_that_of_the_other_program() {
    for row in rows("filter") {
        let (raw, wanted) = row[2..].split_at((row.len() - 2) / 2);
        let filter = LowPass::new(row[0], row[1]).expect("possible");
        let mut values = raw.to_vec();
        let mut memory = vec![0.0; LowPass::memory_needed(values.len())];
        filter.smooth(&mut values, &mut memory).expect("room");
        for (found, wanted) in values.iter().zip(wanted) {
            assert!((found - wanted).abs() < 1e-6, "{found} {wanted}");
        }
    }
}

#[test]
fn the_pivot_is_that_of_the_other_program() {
    for row in rows("pivot") {
        let (ends, wanted) = row.split_at(row.len() - 4);
        let lines = ends.chunks_exact(4).map(|four| CondyleLine {
            medial: [four[0], four[1]],
            lateral: [four[2], four[3]],
        });
        let found = pivot(lines).expect("a pivot");
        let [a, b] = found.deviation_mm;
        let found = [found.anterior_mm, found.medial_mm, a, b];
        for (found, wanted) in found.iter().zip(wanted) {
            assert!((found - wanted).abs() < 1e-4, "{found} {wanted}");
        }
    }
}

#[test]
fn numbers_against_flexion_are_those_of_the_other_program() {
    for row in rows("bin") {
        let (flexion, values) = row[3..].split_at((row.len() - 3) / 2);
        let mut room = vec![Default::default(); flexion.len()];
        let phases = phases(flexion, REVERSAL_DEG, &mut room).expect("room");
        assert_eq!(phases.len(), 2);
        let bin = at_flexion(flexion, values, phases, row[0]);
        assert_eq!(bin.n as f64, row[1], "at {}", row[0]);
        assert!((bin.mean - row[2]).abs() < 1e-6, "{bin:?}");
    }
}
