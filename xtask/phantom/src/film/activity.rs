//! Activities, filmed at the rate of a fluoroscope: poses of both components, frame by frame.
//!
//! From one frame to the next a component of a real film turns by 0.45 degrees and moves by 2.2 mm in the median, by 2.1
//! degrees and 6.1 mm at most; fast activities go to four times that. What a leg does besides bending is a sum of slow waves.

use super::motion::{Position, knee};
use crate::implant::{Side, Triangles};
use crate::table::{Table, smooth_step};
use fluoropose::pose::EulerPose;
use libm::sin;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::f64::consts::TAU;
use std::fmt;
use std::str::FromStr;

/// What the person does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Activity {
    /// From standing to a deep squat.
    KneeBend,
    /// Up a step: from a bent knee to a straight one.
    Stair,
    /// Two strides of slow walking.
    Gait,
}

impl Activity {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::KneeBend, Self::Stair, Self::Gait];

    fn word(self) -> &'static str {
        match self {
            Self::KneeBend => "knee-bend",
            Self::Stair => "stair",
            Self::Gait => "gait",
        }
    }

    /// Flexion of the joint (degrees), lean of the tibia in the image plane (degrees), and the tray's place to the right and
    /// upwards (mm) at a part of the film.
    fn pose_at(self, part: f64) -> [f64; 4] {
        match self {
            Self::KneeBend => {
                let down = 0.6 * part + 0.4 * smooth_step(part);
                [
                    4.0 + 104.0 * down,
                    4.0 - 40.0 * down,
                    -6.0 + 22.0 * down,
                    -24.0 - 10.0 * down,
                ]
            }
            Self::Stair => {
                let up = smooth_step(part);
                [
                    78.0 - 72.0 * up,
                    -30.0 + 32.0 * up,
                    20.0 - 34.0 * up,
                    -34.0 + 14.0 * up,
                ]
            }
            Self::Gait => {
                let stride = (STRIDES * part).fract();
                [
                    GAIT_FLEXION.at(stride),
                    GAIT_LEAN.at(stride),
                    GAIT_RIGHT.at(stride),
                    -24.0 + 9.0 * sin(2.0 * TAU * stride),
                ]
            }
        }
    }
}

impl fmt::Display for Activity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.word())
    }
}

impl FromStr for Activity {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let known = Self::ALL.into_iter().find(|known| known.word() == text);
        known.ok_or_else(|| format!("'{text}' is no activity: use knee-bend, stair or gait"))
    }
}

/// Strides in a film of gait.
const STRIDES: f64 = 2.0;
/// Over a stride, from heel strike to heel strike.
const GAIT_FLEXION: Table = Table(&[
    (0.0, 6.0),
    (0.14, 18.0),
    (0.40, 5.0),
    (0.60, 36.0),
    (0.73, 60.0),
    (0.88, 24.0),
    (1.0, 6.0),
]);
const GAIT_LEAN: Table = Table(&[
    (0.0, 16.0),
    (0.3, 0.0),
    (0.6, -34.0),
    (0.75, -30.0),
    (1.0, 16.0),
]);
const GAIT_RIGHT: Table = Table(&[(0.0, 24.0), (0.6, -26.0), (1.0, 24.0)]);

/// Distance of the tray from the focus, mm.
const DISTANCE: f64 = 1080.0;
/// Where a joint that leaves the field goes, mm to the right, and when, parts of the film: out and back in.
const GONE: f64 = 165.0;
const GOES: [f64; 2] = [0.40, 0.62];
const RETURNS: [f64; 2] = [0.74, 0.96];
/// The other leg passes from one side to the other, mm from this one.
const PASSES: f64 = 260.0;

/// Waves of everything else: amplitude and waves in a film of 120 frames, of x, y, z (mm), rotation about x and y (degrees).
const WAVES: [(f64, f64); 5] = [(3.0, 5.0), (3.0, 4.0), (11.0, 4.0), (1.6, 3.0), (2.4, 3.0)];

/// A film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Course {
    /// What the person does.
    pub activity: Activity,
    /// Number of frames.
    pub frames: usize,
    /// Which knee.
    pub side: Side,
    /// Seed of the waves.
    pub seed: u64,
    /// Whether the joint leaves the field to one side and comes back.
    pub leaves_field: bool,
}

impl Course {
    /// Poses of all frames. `femur` is the mesh that is set down on the insert; `width_mm` is its mediolateral width.
    pub fn positions(&self, femur: &Triangles, width_mm: f64) -> Vec<Position> {
        let mut random = ChaCha8Rng::seed_from_u64(self.seed);
        random.set_stream(u64::MAX);
        let mut phase = || TAU * f64::from(random.next_u32()) / 4_294_967_296.0;
        let waves: Vec<(f64, f64, f64)> = WAVES
            .iter()
            .map(|&(amplitude, count)| (amplitude, count * self.frames as f64 / 120.0, phase()))
            .collect();
        (0..self.frames)
            .map(|frame| {
                let part = self.part(frame);
                let wave = |k: usize| {
                    let (amplitude, count, phase) = waves[k];
                    amplitude * sin(TAU * count * part + phase)
                };
                let [flexion, lean, right, up] = self.activity.pose_at(part);
                let tibia = EulerPose {
                    x_mm: right + wave(0) + self.aside(part),
                    y_mm: up + wave(1),
                    z_mm: -DISTANCE + wave(2),
                    z_rot_deg: lean,
                    x_rot_deg: 1.5 + wave(3),
                    y_rot_deg: wave(4),
                };
                knee(tibia, flexion, self.side, femur, width_mm)
            })
            .collect()
    }

    /// How far to the right of this leg the other one is in a frame, mm.
    pub fn second_leg_mm(&self, frame: usize) -> f64 {
        PASSES * (2.0 * self.part(frame) - 1.0)
    }

    fn part(&self, frame: usize) -> f64 {
        frame as f64 / (self.frames.max(2) - 1) as f64
    }

    fn aside(&self, part: f64) -> f64 {
        if !self.leaves_field {
            return 0.0;
        }
        let within = |[from, to]: [f64; 2]| smooth_step((part - from) / (to - from));
        GONE * (within(GOES) - within(RETURNS))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::implant::{Parameters, femur};
    use fluoropose::pose::{Pose, geodesic_deg};

    fn median(mut values: Vec<f64>) -> f64 {
        values.sort_by(f64::total_cmp);
        values[values.len() / 2]
    }

    #[test]
    fn steps_from_frame_to_frame_are_those_of_real_films() {
        let mesh = femur(&Parameters::default()).unwrap();
        for (activity, fast) in [
            (Activity::KneeBend, 1.5),
            (Activity::Stair, 1.5),
            (Activity::Gait, 4.0),
        ] {
            let course = Course {
                activity,
                frames: 120,
                side: Side::Left,
                seed: 1,
                leaves_field: false,
            };
            let positions = course.positions(&mesh, 70.0);
            for part in [|p: &Position| p.femur, |p: &Position| p.tibia] {
                let poses: Vec<Pose> = positions.iter().map(|p| part(p).into()).collect();
                let step = |pair: &[Pose]| {
                    let moved = |k: usize| pair[1].translation[k] - pair[0].translation[k];
                    let mm = moved(0).hypot(moved(1)).hypot(moved(2));
                    (geodesic_deg(&pair[0].rotation, &pair[1].rotation), mm)
                };
                let (degrees, mms): (Vec<f64>, Vec<f64>) = poses.windows(2).map(step).unzip();
                let most = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
                let (most_deg, most_mm) = (most(&degrees), most(&mms));
                let (usual_deg, usual_mm) = (median(degrees), median(mms));
                assert!(
                    (0.2..1.9).contains(&usual_deg) && (0.8..3.5).contains(&usual_mm),
                    "{activity}: median {usual_deg} deg, {usual_mm} mm"
                );
                assert!(
                    most_deg < 2.1 * fast && most_mm < 6.1 * fast,
                    "{activity}: at most {most_deg} deg, {most_mm} mm"
                );
            }
        }
    }

    #[test]
    fn a_joint_that_leaves_the_field_comes_back() {
        let mesh = femur(&Parameters::default()).unwrap();
        let course = Course {
            activity: Activity::Stair,
            frames: 60,
            side: Side::Right,
            seed: 3,
            leaves_field: true,
        };
        let (away, at_home) = (
            course.positions(&mesh, 70.0),
            Course {
                leaves_field: false,
                ..course
            }
            .positions(&mesh, 70.0),
        );
        let aside: Vec<f64> = away
            .iter()
            .zip(&at_home)
            .map(|(a, b)| (a.tibia.x_mm - b.tibia.x_mm).abs())
            .collect();
        assert_eq!([aside[0], aside[10], aside[59]], [0.0; 3]);
        assert!((aside[40] - GONE).abs() < 1e-9);
        for activity in Activity::ALL {
            assert_eq!(activity.to_string().parse(), Ok(activity));
        }
        assert!("sleep".parse::<Activity>().is_err());
    }
}
