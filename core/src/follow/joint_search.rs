//! A component looked for beside the other one of its joint, where that is known: the best of the places where the joint leaves it
//! ([`JointPlaces`]), refined. So a tray is found that is faint, or lies half behind the femur.

use super::frame_pose::{FramePose, From, refined_on_frame};
use super::in_joint::{InJoint, Limb};
use super::joint_places::JointPlaces;
use super::subject::Subject;
use crate::mesh::anatomy::KneeComponent;
use crate::refine::{ImageTarget, RefineMemory};

/// What is asked of a pose: its score ([`FramePose::score`]), the part of its outline that is met, and that is seen. A femur that is
/// taken for its mirror image meets as much as many a tray beside its femur.
pub(super) const TRAY_SCORE: f64 = 0.38;
const FEMUR_SCORE: f64 = 0.45;
pub(super) const MET: f64 = 0.7;
const MOST_PX: f64 = 1.5;
const KNOWN: f64 = 0.7;

/// The search of a frame, in steps between which it can be called off.
#[derive(Clone, Debug)]
pub struct JointSearch {
    component: KneeComponent,
    places: JointPlaces,
    is_done: bool,
    found: Option<FramePose>,
}

impl JointSearch {
    /// Begins to look for a component in a frame, where its joint leaves it. What is the other one's should be unknown in `image`.
    #[must_use]
    pub fn new(image: &ImageTarget<'_>, joint: &InJoint, sought: &Limb<'_>) -> Self {
        Self {
            component: sought.component,
            places: JointPlaces::new(image.frame, joint, sought),
            is_done: false,
            found: None,
        }
    }

    /// The part of the work that is done, 0 to 1.
    #[must_use]
    pub fn progress(&self) -> f64 {
        let (done, all) = self.places.done();
        (done + usize::from(self.is_done)) as f64 / (all + 1) as f64
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
        if !self.places.step(subject, image, memory, |_, _| true) {
            self.refine(subject, image, memory);
            self.is_done = true;
        }
        !self.is_done
    }

    fn refine(
        &mut self,
        subject: &Subject<'_>,
        image: &ImageTarget<'_>,
        memory: &mut RefineMemory<'_>,
    ) {
        for (_, pose) in self.places.found() {
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
