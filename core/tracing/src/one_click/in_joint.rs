//! Starts where the joint leaves the component beside the other one, where that is known: a tray that is faint, or over which condyles
//! lie, is no region.

use super::candidates::{SAME_ANSWER, keep};
use super::drawn::drawn_at;
use super::error::OneClickError;
use super::memory::OneClickMemory;
use super::observation::Observation;
use super::state::OneClick;
use fluoropose::finder::Component;
use fluoropose::follow::{JointPlaces, Subject};
use fluoropose::refine::ImageTarget;

impl OneClick {
    /// The component is looked for as well where its joint leaves it in this frame.
    #[must_use]
    pub fn in_joint(mut self, places: JointPlaces) -> Self {
        self.joint = Some(places);
        self
    }

    /// Leaves out bends of the knee for which the component cannot lie where somebody pointed.
    pub(super) fn begin_in_joint(
        &mut self,
        observation: &Observation<'_>,
        component: &Component<'_>,
        memory: &mut OneClickMemory<'_>,
    ) {
        let Some(places) = &mut self.joint else {
            return;
        };
        let (prompt, camera) = (self.prompt, observation.camera);
        let subject = Subject::new(component.model, component.planes, camera);
        places.keep_bends(&subject, |pose, reach_px| {
            let drawn = drawn_at(pose, component.model, camera, &mut memory.refine);
            drawn.is_some_and(|drawn| prompt.is_within(&drawn, reach_px))
        });
    }

    /// Slides the outline around one more pose that the joint leaves; places that do not agree with the prompt are none. Returns whether
    /// there may be more.
    pub(super) fn slide(
        &mut self,
        observation: &Observation<'_>,
        component: &Component<'_>,
        memory: &mut OneClickMemory<'_>,
    ) -> bool {
        let Some(places) = &mut self.joint else {
            return false;
        };
        let (model, camera, prompt) = (component.model, observation.camera, self.prompt);
        let subject = Subject::new(model, component.planes, camera);
        let image = ImageTarget {
            unknown: observation.beside.or(observation.excluded),
            ..observation.target()
        };
        places.step(&subject, &image, &mut memory.refine, |pose, memory| {
            let drawn = drawn_at(pose, model, camera, memory);
            drawn.is_some_and(|drawn| prompt.agreement(&drawn) > 0.0)
        })
    }

    /// The part of all bends around which the outline has slid, 0 to 1.
    pub(super) fn slid(&self) -> f64 {
        let (done, all) = self.joint.as_ref().map_or((0, 0), JointPlaces::done);
        done as f64 / all.max(1) as f64
    }

    /// Refines one of the places where the joint leaves the component. Returns whether there may be another.
    pub(super) fn refine_in_joint(
        &mut self,
        at: usize,
        observation: &Observation<'_>,
        component: &Component<'_>,
        memory: &mut OneClickMemory<'_>,
    ) -> Result<bool, OneClickError> {
        let places = self.joint.as_ref().map_or(&[][..], JointPlaces::found);
        let Some((_, pose)) = places.get(at).copied() else {
            return Ok(false);
        };
        let scorer = self.scorer(observation, component);
        if let Some(answer) = scorer.onto_frame(&pose, memory)? {
            keep(&mut self.answers, answer, SAME_ANSWER, component.model);
        }
        Ok(true)
    }
}
