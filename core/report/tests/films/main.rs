//! A made-up film as files, figure and report: what is written reads back, and what a reader must be told stands there.
#![allow(clippy::unwrap_used, reason = "a refusal fails the test")]

mod drawn;
mod files;

use fluoropose::Side;
use fluoropose::joint::JointFrame;
use fluoropose::joint::numbers::{NUMBERS, place};
use fluoropose::joint::shared::ERRORS;
use fluoropose_report::{JointFilm, JointRow};

/// Bent from 0 to 58 degrees in 2-degree steps about a centre at (-4, 12); frame 8 has no pose, frame 5 is doubtful.
fn film(rotation_deg: f64) -> JointFilm {
    let row = |k: usize| {
        let turn = (rotation_deg * (k as f64 / 29.0 - 0.5)).to_radians();
        let mut numbers = [0.0; NUMBERS];
        for (number, value) in numbers.iter_mut().enumerate() {
            *value = number as f64 + 0.1 * (k as f64).sin();
        }
        numbers[place::FLEXION] = 2.0 * k as f64;
        numbers[place::ROTATION] = turn.to_degrees();
        for (ap, across, at) in [
            (place::MEDIAL_AP, place::MEDIAL_ACROSS, 24.0),
            (place::LATERAL_AP, place::LATERAL_ACROSS, -24.0),
        ] {
            numbers[ap] = -4.0 + (at - 12.0) * turn.sin();
            numbers[across] = 12.0 + (at - 12.0) * turn.cos();
        }
        let deviations = (!k.is_multiple_of(3)).then_some([0.5; NUMBERS]);
        JointRow {
            number: k + 11,
            joint: (k != 8).then_some(JointFrame {
                numbers,
                deviations,
                shared: [[0.0; NUMBERS]; ERRORS],
            }),
            filtered: None,
            checked: k == 2,
            beside: None,
            accepted: None,
            doubt: (k == 5).then(|| "tibia doubtful: \"rim\" <inner>, or not".to_owned()),
        }
    };
    JointFilm {
        name: "a & b".to_owned(),
        side: Side::Left,
        plate_depth_mm: 48.0,
        plate_width_mm: 74.0,
        plate_outline: vec![[24.0, 37.0], [24.0, -37.0], [-24.0, -37.0], [-24.0, 37.0]],
        frames_per_s: Some(15.0),
        cutoff_hz: None,
        remarks: Vec::new(),
        has_verdicts: true,
        rows: (0..30).map(row).collect(),
    }
}
