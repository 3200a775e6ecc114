//! Components that are looked for, and the frames in which they are known.

use heapless::Vec;

use crate::math::Vector3;
use crate::mesh::anatomy::KneeComponent;
use crate::pose::Pose;

/// So many frames in which a component is known lead to one that is missing.
pub const LED: usize = 3;

/// A frame in which a component is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KnownFrame {
    /// Number of the frame, from 0.
    pub frame: usize,
    /// `camera_from_model`.
    pub pose: Pose,
    /// By what poses are compared ([`crate::follow::FramePose::score`]).
    pub score: f64,
    /// The first and the last frame beside it in which it is followed, once that was asked for.
    pub(super) ends: Option<Ends>,
}

/// Frames with poses, where they are followed there.
pub type Ends = [Option<(usize, Pose)>; 2];

impl KnownFrame {
    /// A pose in a frame.
    #[must_use]
    pub fn new(frame: usize, pose: Pose, score: f64) -> Self {
        Self {
            frame,
            pose,
            score,
            ends: None,
        }
    }
}

/// A component that is looked for, as a film shows it in one way.
#[derive(Clone, Debug)]
pub struct Sought {
    role: Option<KneeComponent>,
    pub(super) is_limb: bool,
    middle: Vector3,
    pub(super) known: Vec<KnownFrame, LED>,
}

impl Sought {
    /// A component with the role in the knee that it has, if any; `is_limb` where its shape tells which way it lies, so that its joint tells
    /// where it is ([`crate::follow::Limb`]). `middle` is that of the model's box.
    #[must_use]
    pub fn new(role: Option<KneeComponent>, is_limb: bool, middle: Vector3) -> Self {
        Self {
            role,
            is_limb: is_limb && role.is_some(),
            middle,
            known: Vec::new(),
        }
    }

    /// Takes a frame in which it is known; of more than [`LED`] the first.
    pub fn know(&mut self, known: KnownFrame) {
        // Those for which there is no room lead nowhere.
        let _ = self.known.push(known);
    }

    /// Frames in which it is known.
    #[must_use]
    pub fn known(&self) -> &[KnownFrame] {
        &self.known
    }

    pub(super) fn is_tray(&self) -> bool {
        self.role == Some(KneeComponent::Tibia)
    }

    pub(super) fn is_missing(&self) -> bool {
        self.known.is_empty()
    }

    /// What the best of its frames scores; 0 without any.
    pub(super) fn best_score(&self) -> f64 {
        let scores = self.known.iter().map(|known| known.score);
        scores.fold(0.0, f64::max)
    }

    pub(super) fn leads(&self, to: &Self) -> bool {
        self.is_limb && to.is_limb && self.role != to.role
    }

    pub(super) fn depth_mm(&self, pose: &Pose) -> f64 {
        -pose.transform(&self.middle)[2]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use KneeComponent::{Femur, Tibia};

    #[test]
    fn a_limb_leads_to_the_other_one_of_its_joint_alone() {
        let of = |(role, is_limb)| Sought::new(role, is_limb, [0.0; 3]);
        let all = [
            (Some(Femur), true),
            (Some(Tibia), true),
            (Some(Femur), false),
            (Some(Tibia), false),
            (None, true),
        ];
        for (k, one) in all.into_iter().enumerate() {
            for (j, other) in all.into_iter().enumerate() {
                let leads = of(one).leads(&of(other));
                assert_eq!(
                    leads,
                    matches!((k, j), (0, 1) | (1, 0)),
                    "{one:?} {other:?}"
                );
            }
            assert_eq!(of(one).is_tray(), one.0 == Some(Tibia));
        }
    }

    #[test]
    fn the_first_frames_that_are_known_stay_and_the_best_of_them_counts() {
        let mut sought = Sought::new(Some(Femur), true, [1.0, 2.0, 3.0]);
        assert!(sought.is_missing() && sought.best_score() == 0.0 && sought.known().is_empty());
        let pose = Pose {
            translation: [0.0, 0.0, -900.0],
            ..Pose::IDENTITY
        };
        for (frame, score) in [(7, 0.4), (2, 0.6), (5, 0.5), (1, 0.9)] {
            sought.know(KnownFrame::new(frame, pose, score));
            assert!(!sought.is_missing());
        }
        assert!(sought.known().iter().map(|known| known.frame).eq([7, 2, 5]));
        assert_eq!(sought.best_score(), 0.6);
        // In front of the camera, at the middle of its box.
        assert_eq!(sought.depth_mm(&pose), 897.0);
    }
}
