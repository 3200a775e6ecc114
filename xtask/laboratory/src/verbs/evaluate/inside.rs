//! Whether poses are as sure as they are said to be.

use fluoropose::pose::Pose;

use super::reference::{Reference, in_front};
use crate::choice::Decision;
use crate::choice::report::Numbers;
use crate::measure::accuracy::Errors;

/// The part of frames in which each number lies within so many standard deviations of the reference's, for one and for two.
/// `None` where no pose says how sure it is.
pub(super) fn inside(
    decisions: &[Option<Decision>],
    reference: &Reference,
    middle: &[f64; 3],
) -> [Option<Numbers>; 2] {
    let frames = decisions.iter().zip(&reference.poses);
    let ratios: Vec<[f64; 6]> = frames
        .filter_map(|(decision, known)| ratios(decision.as_ref()?, known.as_ref()?, middle))
        .collect();
    [1.0, 2.0].map(|reach| {
        let part = |number: usize| {
            let within = ratios.iter().filter(|ratios| ratios[number] <= reach);
            within.count() as f64 / ratios.len() as f64
        };
        (!ratios.is_empty()).then(|| Numbers {
            x_mm: part(0),
            y_mm: part(1),
            z_mm: part(2),
            z_rot_deg: part(3),
            x_rot_deg: part(4),
            y_rot_deg: part(5),
        })
    })
}

/// How far each number is off, in its standard deviations.
fn ratios(decision: &Decision, known: &Pose, middle: &[f64; 3]) -> Option<[f64; 6]> {
    let pose = decision.pose()?;
    let sd = Numbers::deviations(&decision.chosen, middle)?.all();
    let errors = Errors::of(&pose, &in_front(known));
    let errors = [
        errors.x_mm,
        errors.y_mm,
        errors.z_mm,
        errors.z_rot_deg,
        errors.x_rot_deg,
        errors.y_rot_deg,
    ];
    Some(std::array::from_fn(|k| errors[k].abs() / sd[k]))
}
