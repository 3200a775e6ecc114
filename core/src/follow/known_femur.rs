//! What the femur of a knee says of its tibia over a film.

use alloc::vec::Vec;

use super::conclusion::Conclusion;
use super::distrust::Distrust;
use super::sides::KneeFigures;
use crate::finder::choice::Counterpart;
use crate::joint::impossible::impossible_pose;
use crate::joint::kinematics::relative_pose;
use crate::pose::Pose;

/// The femur, for who follows its tibia.
#[derive(Clone, Debug)]
pub struct KnownFemur {
    /// Femoral poses of all frames, in the field's axes.
    pub poses: Vec<Option<Pose>>,
    /// The field's axes in the followed model's: `model_from_field`.
    pub axes: Pose,
}

impl KnownFemur {
    /// What the joint of a tibial pose with the femur of a frame says of it, where that is known.
    #[must_use]
    pub fn knee(&self, frame: usize, pose: &Pose) -> Option<KneeFigures> {
        let femur = (*self.poses.get(frame)?)?;
        let tibia = pose.compose(&self.axes);
        Some(KneeFigures {
            tilt_deg: Counterpart::Femur(femur).tilt_deg(&tibia),
            is_impossible: impossible_pose(&relative_pose(&femur, &tibia)).is_some(),
        })
    }

    /// Makes those poses of the tibia doubtful in which its joint would bend or turn as no knee does, of either side of the body. A tray has
    /// false minima that its outline alone does not tell.
    pub fn distrust_impossible(&self, film: &mut [Conclusion]) {
        for (one, femur) in film.iter_mut().zip(&self.poses) {
            let (Some(tibia), Some(femur)) = (one.pose, femur) else {
                continue;
            };
            let relative = relative_pose(femur, &tibia.compose(&self.axes));
            if let Some(why) = impossible_pose(&relative) {
                one.distrust(Distrust::Knee(why));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::follow::{State, Why};
    use crate::pose::EulerPose;
    use std::vec;

    #[test]
    fn a_tibia_that_turns_as_no_knee_does_is_doubtful_whichever_the_side() {
        let turned = |y_rot_deg: f64| EulerPose {
            z_mm: -900.0,
            y_rot_deg,
            ..EulerPose::default()
        };
        let film = |tibia_deg: f64| {
            let followed = Conclusion {
                state: State::Followed,
                pose: Some(turned(tibia_deg).into()),
                why: Why::Agrees,
                badness: 0.3,
            };
            let mut film = [followed; 2];
            let femur = KnownFemur {
                poses: vec![None, Some(turned(0.0).into())],
                axes: Pose::IDENTITY,
            };
            femur.distrust_impossible(&mut film);
            film.map(|one| one.state)
        };
        let knee = KnownFemur {
            poses: vec![Some(turned(0.0).into()), None],
            axes: Pose::IDENTITY,
        };
        let is_impossible = |frame: usize, deg: f64| {
            let figures = knee.knee(frame, &turned(deg).into());
            figures.map(|knee| knee.is_impossible)
        };
        assert_eq!(is_impossible(0, 80.0), Some(true));
        assert_eq!(is_impossible(0, 30.0), Some(false));
        assert_eq!(is_impossible(1, 80.0), None);
        for deg in [80.0, -80.0, 120.0] {
            assert_eq!(film(deg), [State::Followed, State::Doubtful], "{deg}");
        }
        for deg in [0.0, 30.0, -30.0] {
            assert_eq!(film(deg), [State::Followed; 2], "{deg}");
        }
    }
}
