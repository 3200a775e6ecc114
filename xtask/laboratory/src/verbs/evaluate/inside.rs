//! Whether poses are as sure as they are said to be.

use std::array;

use fluoropose::pose::Pose;
use serde::Serialize;

use crate::choice::Decision;
use crate::choice::report::Numbers;
use crate::measure::accuracy::{Errors, in_front};

/// The parts of frames in which each number lies within one and two standard deviations of the reference's.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Inside {
    /// As it is.
    pub whole: [Numbers; 2],
    /// Without the mean difference, which no frame tells: of the reference, of the calibration, of the model.
    pub scatter: [Numbers; 2],
}

impl Inside {
    /// `None` where no pose says how sure it is. `middle` is that of the model's box.
    pub(super) fn of(
        decisions: &[Option<Decision>],
        reference: &[Option<Pose>],
        middle: &[f64; 3],
    ) -> Option<Self> {
        let frames = decisions.iter().zip(reference);
        let told: Vec<[[f64; 2]; 6]> = frames
            .filter_map(|(decision, known)| told(decision.as_ref()?, known.as_ref()?, middle))
            .collect();
        let count = told.len() as f64;
        let mean: [f64; 6] =
            array::from_fn(|k| told.iter().map(|one| one[k][0]).sum::<f64>() / count);
        // One of so many differences is the mean's.
        let wider = (count / (count - 1.0)).sqrt();
        (told.len() > 1).then(|| Self {
            whole: parts(&told, |_, error| error),
            scatter: parts(&told, |number, error| (error - mean[number]) * wider),
        })
    }
}

fn parts(told: &[[[f64; 2]; 6]], off: impl Fn(usize, f64) -> f64) -> [Numbers; 2] {
    [1.0, 2.0].map(|reach| {
        let part = |number: usize| {
            let within = |one: &&[[f64; 2]; 6]| {
                let [error, sd] = one[number];
                off(number, error).abs() <= reach * sd
            };
            told.iter().filter(within).count() as f64 / told.len() as f64
        };
        Numbers {
            x_mm: part(0),
            y_mm: part(1),
            z_mm: part(2),
            z_rot_deg: part(3),
            x_rot_deg: part(4),
            y_rot_deg: part(5),
        }
    })
}

/// How far each number is off, and its standard deviation.
fn told(decision: &Decision, known: &Pose, middle: &[f64; 3]) -> Option<[[f64; 2]; 6]> {
    let pose = decision.pose()?;
    let sd = Numbers::deviations(&decision.chosen, middle)?.all();
    let errors = Errors::of(&pose, &in_front(known, middle));
    let errors = [
        errors.x_mm,
        errors.y_mm,
        errors.z_mm,
        errors.z_rot_deg,
        errors.x_rot_deg,
        errors.y_rot_deg,
    ];
    Some(array::from_fn(|k| [errors[k], sd[k]]))
}
