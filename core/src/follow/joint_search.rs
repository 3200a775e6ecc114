//! A component looked for beside the other one of its joint, where that is known.
//!
//! Its outline slides over the frame around each pose that the joint leaves it ([`InJoint`]); the places with the strongest edges are
//! refined. That needs no region that stands out, as a click does, so a tray is found that is faint, or lies half behind the femur.

use heapless::Vec;

use super::frame_pose::{FramePose, From, refined_on_frame};
use super::in_joint::{BENDS, InJoint, Limb};
use super::near::near_poses;
use super::subject::Subject;
use crate::image::frame::Grey;
use crate::mesh::anatomy::KneeComponent;
use crate::pose::Pose;
use crate::refine::{ImageTarget, RefineMemory};
use crate::shortlist::keep;

/// How far around an expected place it is looked for, mm.
const REACH_MM: f64 = 25.0;
/// So many places are refined.
const REFINED: usize = 12;
/// Places at which a frame is asked how much it changes, to a side.
const ASKED: usize = 64;
/// Across which it is asked, pixels to either side, and how many times the mean change a step of metal is.
const HALF_PX: f64 = 4.0;
const STEPS: f64 = 3.0;
/// What is asked of a pose: its score ([`FramePose::score`]), the part of its outline that is met, and that is seen. A femur that is
/// taken for its mirror image meets as much as many a tray beside its femur.
const TRAY_SCORE: f64 = 0.38;
const FEMUR_SCORE: f64 = 0.45;
const MET: f64 = 0.7;
const MOST_PX: f64 = 1.5;
const KNOWN: f64 = 0.7;

/// The search of a frame, in steps between which it can be called off.
#[derive(Clone, Debug)]
pub struct JointSearch {
    component: KneeComponent,
    expected: Vec<Pose, { 2 * BENDS }>,
    at: usize,
    /// Step of grey values that edges are measured by.
    step: f64,
    places: Vec<(f64, Pose), REFINED>,
    found: Option<FramePose>,
}

impl JointSearch {
    /// Begins to look for a component in a frame, where its joint leaves it. What is the other one's should be unknown in `image`.
    #[must_use]
    pub fn new(image: &ImageTarget<'_>, joint: &InJoint, sought: &Limb<'_>) -> Self {
        Self {
            component: sought.component,
            expected: joint.poses(sought).collect(),
            at: 0,
            step: usual_step(image.frame),
            places: Vec::new(),
            found: None,
        }
    }

    /// The part of the work that is done, 0 to 1.
    #[must_use]
    pub fn progress(&self) -> f64 {
        self.at as f64 / (self.expected.len() + 1) as f64
    }

    /// The best that was found, where it is good.
    #[must_use]
    pub fn found(&self) -> Option<&FramePose> {
        self.found.as_ref()
    }

    /// The next part of the work. Returns whether there is more to do.
    pub fn step(
        &mut self,
        subject: &Subject<'_>,
        image: &ImageTarget<'_>,
        memory: &mut RefineMemory<'_>,
    ) -> bool {
        match self.expected.get(self.at) {
            Some(&expected) => self.slide(&expected, subject, image, memory),
            None => self.refine(subject, image, memory),
        }
        self.at += 1;
        self.at <= self.expected.len()
    }

    fn slide(
        &mut self,
        expected: &Pose,
        subject: &Subject<'_>,
        image: &ImageTarget<'_>,
        memory: &mut RefineMemory<'_>,
    ) {
        let depth = -expected.transform(&subject.model.bounds().centre)[2];
        let [fx, fy] = subject.camera.focal();
        let reach_px = REACH_MM * fx.max(fy) / depth.max(1.0);
        // Behind the camera there is none.
        let near = near_poses(subject, image, expected, reach_px, self.step, memory);
        for place in near.unwrap_or_default() {
            keep(&mut self.places, place, |(score, _)| -score);
        }
    }

    fn refine(
        &mut self,
        subject: &Subject<'_>,
        image: &ImageTarget<'_>,
        memory: &mut RefineMemory<'_>,
    ) {
        for (_, pose) in &self.places {
            let Ok(one) = refined_on_frame(subject, image, (pose, From::Far), memory) else {
                continue;
            };
            let is_better = |found: FramePose| one.score() > found.score();
            if is_good(&one, self.component) && self.found.is_none_or(is_better) {
                self.found = Some(one);
            }
        }
    }
}

fn is_good(found: &FramePose, component: KneeComponent) -> bool {
    let score = match component {
        KneeComponent::Femur => FEMUR_SCORE,
        KneeComponent::Tibia => TRAY_SCORE,
    };
    found.score() >= score
        && found.fit.met >= MET
        && found.misfit_px <= MOST_PX
        && found.fit.known >= KNOWN
}

/// What a step of metal is at least, by how much the frame changes over some pixels everywhere.
fn usual_step(frame: &dyn Grey) -> f64 {
    let (width, height) = frame.size();
    let at = |k: usize, side: usize| (2 * k + 1) as f64 * side as f64 / (2 * ASKED) as f64;
    let (mut sum, mut count) = (0.0, 0usize);
    for [down, right] in (0..ASKED * ASKED).map(|k| [k / ASKED, k % ASKED]) {
        let (column, row) = (at(right, width), at(down, height));
        for (x, y) in [(HALF_PX, 0.0), (0.0, HALF_PX)] {
            let sides = (frame.at(column + x, row + y), frame.at(column - x, row - y));
            if let (Some(one), Some(other)) = sides {
                sum += (one - other).abs();
                count += 1;
            }
        }
    }
    // Of a frame without any nothing is a step.
    (STEPS * sum / count.max(1) as f64).max(f64::MIN_POSITIVE)
}
