//! A deep knee bend: poses of both components from joint motion.
//!
//! The tibia leans forward while the thigh sinks back. Flexion, internal rotation of the tibia and rollback of the
//! contact follow smooth curves; the femur's height is found by setting the mesh down on the insert.

use crate::implant::{Side, Triangles};
use crate::table::{Table, smooth_step};
use fluoropose::pose::{EulerPose, Pose};
use glam::DVec3;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Flexion at the end of the bend, degrees.
pub const DEEPEST_DEG: f64 = 110.0;

/// Lean of the tibia (rotation in the image plane, degrees) over flexion in degrees.
const LEAN: Table = Table(&[(0.0, 4.0), (30.0, -6.0), (70.0, -22.0), (110.0, -36.0)]);
/// Internal rotation of the tibia over flexion, degrees: early, then slower.
const INTERNAL: Table = Table(&[(0.0, 0.5), (30.0, 4.5), (70.0, 7.5), (110.0, 10.5)]);
/// Abduction over flexion, degrees.
const ABDUCTION: Table = Table(&[(0.0, 0.6), (60.0, 1.2), (110.0, 0.4)]);
/// Where the condyles touch the insert, mm in front of the stem's axis for a 70 mm tray: rollback.
const CONTACT: Table = Table(&[(0.0, -1.0), (30.0, -3.5), (70.0, -6.5), (110.0, -10.0)]);
/// Out-of-plane rotations of the tibia, degrees.
const TIBIA_X: Table = Table(&[(0.0, 1.2), (60.0, 2.4), (110.0, 2.0)]);
const TIBIA_Y: Table = Table(&[(0.0, 2.5), (50.0, -1.5), (110.0, -4.5)]);
/// The tray's place in the camera's frame, mm.
const TIBIA_PLACE: [Table; 3] = [
    Table(&[(0.0, -6.0), (60.0, 4.0), (110.0, 16.0)]),
    Table(&[(0.0, -24.0), (60.0, -28.0), (110.0, -34.0)]),
    Table(&[(0.0, -1084.0), (60.0, -1080.0), (110.0, -1077.0)]),
];

/// Height of the insert's surface above the middle of a 70 mm tray's plate, where the condyles rest, mm.
const INSERT: f64 = 9.4;
/// The femur sits this far to the medial side of the tray's middle, mm.
const MEDIAL: f64 = 0.6;

/// Poses of one frame, exactly as `.jts` files state them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Position {
    /// Flexion put in, degrees.
    pub flexion_deg: f64,
    /// `camera_from_femur`.
    pub femur: EulerPose,
    /// `camera_from_tibia`.
    pub tibia: EulerPose,
}

/// Poses of `frames` frames from extension to the deepest flexion. The seed varies the out-of-plane rotations by about a degree.
///
/// `femur` is the mesh that is set down on the insert; `width_mm` is its mediolateral width.
pub fn deep_knee_bend(
    frames: usize,
    side: Side,
    femur: &Triangles,
    width_mm: f64,
    seed: u64,
) -> Vec<Position> {
    let sway = Sway::new(seed);
    (0..frames)
        .map(|frame| {
            let part = if frames > 1 {
                frame as f64 / (frames - 1) as f64
            } else {
                0.0
            };
            // The bend starts and ends gently.
            let flexion_deg = DEEPEST_DEG * (0.6 * part + 0.4 * smooth_step(part));
            position(flexion_deg, side, femur, width_mm, &sway)
        })
        .collect()
}

fn position(flexion: f64, side: Side, femur: &Triangles, width_mm: f64, sway: &Sway) -> Position {
    let [x_mm, y_mm, z_mm] = TIBIA_PLACE.map(|place| place.at(flexion));
    let tibia = EulerPose {
        x_mm,
        y_mm,
        z_mm,
        z_rot_deg: LEAN.at(flexion),
        x_rot_deg: TIBIA_X.at(flexion) + sway.at(flexion, 0),
        y_rot_deg: TIBIA_Y.at(flexion) + sway.at(flexion, 1),
    };
    knee(tibia, flexion, side, femur, width_mm)
}

/// A knee bent by so many degrees whose tray is at a pose: that of a left knee's; a right one is its mirror image.
///
/// `femur` is the mesh that is set down on the insert; `width_mm` is its mediolateral width.
pub fn knee(
    tibia: EulerPose,
    flexion: f64,
    side: Side,
    femur: &Triangles,
    width_mm: f64,
) -> Position {
    let (tibia, scale) = (Pose::from(tibia), width_mm / 70.0);
    let turn = Pose::from(EulerPose {
        z_rot_deg: -flexion,
        x_rot_deg: ABDUCTION.at(flexion),
        y_rot_deg: -INTERNAL.at(flexion),
        ..EulerPose::default()
    });
    let rotation = turn.inverse().rotation;
    let lowest = lowest_point(
        femur,
        side,
        &Pose {
            rotation,
            translation: [0.0; 3],
        },
        scale,
    );
    let tibia_from_femur = Pose {
        rotation,
        translation: [
            CONTACT.at(flexion) * scale - lowest.x,
            INSERT * scale - lowest.y,
            MEDIAL * scale,
        ],
    };
    let [femur, tibia] =
        [tibia.compose(&tibia_from_femur), tibia].map(|pose| EulerPose::from(sided(&pose, side)));
    Position {
        flexion_deg: flexion,
        femur,
        tibia,
    }
}

/// The lowest point of the femur above the tray. Vertices weigh less the higher they lie, so that it moves smoothly from
/// one to the next; its height is the lowest vertex's.
fn lowest_point(femur: &Triangles, side: Side, turn: &Pose, scale: f64) -> DVec3 {
    let mirror = if side == Side::Right { -1.0 } else { 1.0 };
    let turned = |v: &[f32; 3]| {
        DVec3::from(turn.transform(&[mirror * f64::from(v[0]), v[1].into(), v[2].into()]))
    };
    let lowest = femur
        .vertices
        .iter()
        .map(|v| turned(v).y)
        .fold(f64::INFINITY, f64::min);
    let (mut sum, mut weights) = (DVec3::ZERO, 0.0);
    for vertex in &femur.vertices {
        let point = turned(vertex);
        let weight = libm::exp((lowest - point.y) / (0.4 * scale));
        sum += point * weight;
        weights += weight;
    }
    DVec3::new(sum.x / weights, lowest, sum.z / weights)
}

/// A left knee's pose mirrored for a right knee, whose models are mirrored in `x`.
fn sided(pose: &Pose, side: Side) -> Pose {
    if side == Side::Left {
        return *pose;
    }
    let mut mirrored = *pose;
    for k in 0..3 {
        mirrored.rotation[0][k] = -mirrored.rotation[0][k];
        mirrored.rotation[k][0] = -mirrored.rotation[k][0];
    }
    mirrored.translation[0] = -mirrored.translation[0];
    mirrored
}

/// Slow changes of the out-of-plane rotations that differ from one seed to the next.
struct Sway {
    phases: [f64; 2],
}

impl Sway {
    fn new(seed: u64) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        random.set_stream(u64::MAX);
        let mut phase = || std::f64::consts::TAU * f64::from(random.next_u32()) / 4_294_967_296.0;
        Self {
            phases: [phase(), phase()],
        }
    }

    fn at(&self, flexion: f64, axis: usize) -> f64 {
        0.8 * libm::sin(flexion / 25.0 + self.phases[axis])
    }
}
