//! The joint that both components of a film make: how often its bands hold the true one.

use fluoropose::joint::numbers::{NUMBERS, Posed, place};
use fluoropose::joint::shared::KnownTo;
use fluoropose::joint::{Joint, JointFrame};
use fluoropose::mesh::Model;
use fluoropose::{Pose, Side};
use serde::Serialize;

use super::outcome::{Found, Outcome};
use crate::verbs::synthetic::ranges::FAILURE_DEG;

/// What is counted, with the words for it.
const COUNTED: [(&str, usize); 8] = [
    ("flexion", place::FLEXION),
    ("abduction", place::ABDUCTION),
    ("rotation", place::ROTATION),
    ("AP", 0),
    ("ML", place::MEDIAL),
    ("medial AP", place::MEDIAL_AP),
    ("lateral AP", place::LATERAL_AP),
    ("lift-off", place::LIFT_OFF),
];

/// Of the joints of films both of whose poses are right and have a covariance.
#[derive(Clone, Debug, Default, Serialize)]
pub struct JointBands {
    /// How many there are.
    pub joints: usize,
    /// Of each number the part that lies within one standard deviation of the truth, and the root mean square of the error and of the
    /// deviation.
    pub numbers: Vec<(&'static str, [f64; 3])>,
}

impl JointBands {
    /// Of all films. `None` where the tray has no plate, or no film has a joint.
    pub(super) fn of(models: &[Model<'_>; 2], outcomes: &[[Outcome; 2]]) -> Option<Self> {
        let own = Pose::IDENTITY;
        let [femur, tibia] = models.map(|model| *model.mesh());
        let joint = Joint::new((femur, &own), (tibia, &own), Side::Left)?;
        let mut memory = vec![0; joint.memory_needed()];
        let mut sums = vec![[0.0; 3]; COUNTED.len()];
        let mut joints = 0;
        for [femur, tibia] in outcomes {
            let Some((femur, tibia)) = right(femur).zip(right(tibia)) else {
                continue;
            };
            // The films show these very models with this very camera.
            let mut at = |femur: Posed, tibia: Posed| {
                let relative = joint.relative(&femur, &tibia, KnownTo::EXACTLY);
                joint.at(&relative, &mut memory).ok()
            };
            let truth = at(femur.truth.into(), tibia.truth.into());
            let found = at(posed(femur), posed(tibia));
            let Some((truth, found)) = truth.zip(found) else {
                continue;
            };
            let Some(deviations) = found.deviations else {
                continue;
            };
            joints += 1;
            add(&mut sums, &truth, &found, &deviations);
        }
        let count = joints as f64;
        let number = |((name, _), [held, error, told]): (&(&'static str, usize), &[f64; 3])| {
            (
                *name,
                [held / count, (error / count).sqrt(), (told / count).sqrt()],
            )
        };
        (joints > 0).then(|| Self {
            joints,
            numbers: COUNTED.iter().zip(&sums).map(number).collect(),
        })
    }

    /// As it is printed.
    pub(super) fn words(&self) -> String {
        let words = self.numbers.iter().map(|(name, [held, error, told])| {
            format!("{name} {:.0} % ({error:.2} for {told:.2})", 100.0 * held)
        });
        let words: Vec<String> = words.collect();
        format!("  {} joints: {}", self.joints, words.join(", "))
    }
}

fn add(sums: &mut [[f64; 3]], truth: &JointFrame, found: &JointFrame, told: &[f64; NUMBERS]) {
    for ([held, error, deviation], (_, number)) in sums.iter_mut().zip(COUNTED) {
        let off = found.numbers[number] - truth.numbers[number];
        *held += f64::from(u8::from(off.abs() <= told[number]));
        *error += off * off;
        *deviation += told[number] * told[number];
    }
}

fn right(outcome: &Outcome) -> Option<&Found> {
    outcome
        .found
        .as_ref()
        .filter(|found| found.errors.geodesic_deg <= FAILURE_DEG)
}

fn posed(found: &Found) -> Posed {
    Posed {
        covariance: found.covariance,
        ..found.pose.into()
    }
}
