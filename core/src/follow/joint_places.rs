//! Places of a component where its joint leaves it beside the other one: its outline slides over the frame around each pose that the joint
//! leaves it ([`InJoint`]), and those with the strongest edges are kept. That needs no region that stands out.

use heapless::Vec;

use super::contrast::usual_step;
use super::in_joint::{BENDS, InJoint, Limb};
use super::near::near_poses;
use super::subject::Subject;
use crate::image::grey::Grey;
use crate::pose::Pose;
use crate::refine::{ImageTarget, RefineMemory};
use crate::shortlist::keep;

/// So many places are kept.
pub const JOINT_PLACES: usize = 12;

/// How far around an expected place it is looked for, mm.
const REACH_MM: f64 = 25.0;

/// The places of a frame, looked for in steps: one for each pose that the joint leaves.
#[derive(Clone, Debug)]
pub struct JointPlaces {
    expected: Vec<Pose, { 2 * BENDS }>,
    at: usize,
    /// Step of grey values that edges are measured by.
    step: f64,
    places: Vec<(f64, Pose), JOINT_PLACES>,
}

impl JointPlaces {
    /// Begins to look for a component in a frame, where its joint leaves it.
    #[must_use]
    pub fn new(frame: &dyn Grey, joint: &InJoint, sought: &Limb<'_>) -> Self {
        Self {
            expected: joint.poses(sought).collect(),
            at: 0,
            step: usual_step(frame),
            places: Vec::new(),
        }
    }

    /// From now on only those poses that the joint leaves are looked around for which `wanted` says so; it is told how far around, pixels.
    pub fn keep_bends(
        &mut self,
        subject: &Subject<'_>,
        mut wanted: impl FnMut(&Pose, f64) -> bool,
    ) {
        self.expected
            .retain(|pose| wanted(pose, reach_px(subject, pose)));
    }

    /// The steps that are done, and of how many.
    #[must_use]
    pub fn done(&self) -> (usize, usize) {
        (self.at, self.expected.len())
    }

    /// The places that were found by now, with the mean step along the outline of each, the strongest first.
    #[must_use]
    pub fn found(&self) -> &[(f64, Pose)] {
        &self.places
    }

    /// The next part of the work; only places that are `wanted` are kept. What is the other component's should be unknown in `image`.
    /// Returns whether anything was left to do.
    pub fn step(
        &mut self,
        subject: &Subject<'_>,
        image: &ImageTarget<'_>,
        memory: &mut RefineMemory<'_>,
        mut wanted: impl FnMut(&Pose, &mut RefineMemory<'_>) -> bool,
    ) -> bool {
        let Some(expected) = self.expected.get(self.at) else {
            return false;
        };
        self.at += 1;
        let reach_px = reach_px(subject, expected);
        // Behind the camera there is none.
        let near = near_poses(subject, image, expected, reach_px, self.step, memory);
        for place in near.unwrap_or_default() {
            if wanted(&place.1, memory) {
                keep(&mut self.places, place, |(score, _)| -score);
            }
        }
        true
    }
}

/// How far around a pose it is looked for, pixels.
fn reach_px(subject: &Subject<'_>, pose: &Pose) -> f64 {
    let depth = -pose.transform(&subject.model.bounds().centre)[2];
    let [fx, fy] = subject.camera.focal();
    REACH_MM * fx.max(fy) / depth.max(1.0)
}
