//! How well a pose agrees with a region, with the frame's edges and with the prompt, and its refinement.

use heapless::Vec;

use super::candidates::{Answer, LocatedPose, Region, Start};
use super::error::OneClickError;
use super::expected::Expected;
use super::memory::OneClickMemory;
use super::observation::Observation;
use super::prompt::Prompt;
use super::support::support;
use fluoropose::finder::Component;
use fluoropose::image::mask::{Mask, words_needed};
use fluoropose::image::silhouette::Silhouette;
use fluoropose::locate::{LocateError, locate};
use fluoropose::pose::Pose;
use fluoropose::refine::{CameraView, RefineError, RefineOptions, Refined, refine};

/// Number of poses that are located for a region.
const MINIMA: usize = 3;
/// How far from the outline of a first pose edges are searched, as a fraction of the expected size.
const NEAR: f64 = 0.04;
/// How far from a refined outline edges are searched, pixels.
const CLOSE: f64 = 1.5;
/// A first pose whose outline lies near edges by at least this fraction, and that covers its region by at least this
/// fraction, is not brought onto the region first.
const GOOD: f64 = 0.9;
/// Loss of an outline without any edge near it, square pixels: Tukey's loss with a scale of 2.5 pixels, as in refinement on
/// a frame.
const WORST: f64 = 2.5 * 2.5 / 6.0;

/// Everything that a pose is compared with.
pub(super) struct PoseScorer<'s> {
    pub(super) observation: &'s Observation<'s>,
    pub(super) component: &'s Component<'s>,
    pub(super) prompt: &'s Prompt,
    pub(super) expected: &'s Expected,
    /// Slope of an edge of metal, grey values a pixel.
    pub(super) slope: f64,
}

impl PoseScorer<'_> {
    fn size(&self) -> (usize, usize) {
        (
            self.observation.camera.width(),
            self.observation.camera.height(),
        )
    }

    /// The masks of the region that was drawn last and of what is in doubt of it.
    fn masks<'w>(&self, words: &'w [u32]) -> Result<[Mask<'w>; 2], OneClickError> {
        let (width, height) = self.size();
        let (a, b) = words.split_at(words_needed(width, height).min(words.len()));
        Ok([Mask::new(a, width, height)?, Mask::new(b, width, height)?])
    }

    /// The poses that the library has for the region that was drawn last.
    pub(super) fn locate(
        &self,
        region: Region,
        memory: &mut OneClickMemory<'_>,
    ) -> Result<Vec<LocatedPose, MINIMA>, OneClickError> {
        let [shape, _] = self.masks(memory.words)?;
        let (camera, library) = (self.observation.camera, self.component.library);
        let work = memory.workspace.reborrow();
        let found = match locate::<MINIMA>(&shape, camera, library, work) {
            // A shapeless region has no pose.
            Err(LocateError::Canonical(_)) => return Ok(Vec::new()),
            found => found?,
        };
        let area = f64::from(library.info().canonical.area());
        let located_poses = found.poses.iter().map(|located| LocatedPose {
            pose: located.pose,
            region: Some(region),
            mismatch: f64::from(located.fine.unmatched) / area,
        });
        let possible = located_poses.filter(|located| self.is_possible(&located.pose));
        Ok(possible.collect())
    }

    /// Whether the component stands at a possible distance from the focus.
    fn is_possible(&self, pose: &Pose) -> bool {
        let [_, _, z] = pose.transform(&self.component.model.bounds().centre);
        let [near, far] = self.expected.depths;
        (near..=far).contains(&-z)
    }

    /// Scores a located pose by the region that was drawn last, the frame's edges and the prompt; `None` where the model
    /// cannot be drawn.
    pub(super) fn score(
        &self,
        located: &LocatedPose,
        memory: &mut OneClickMemory<'_>,
    ) -> Result<Option<Start>, OneClickError> {
        let [shape, _] = self.masks(memory.words)?;
        let how = ((NEAR * self.expected.size).max(2.0), self.slope);
        let (observation, model) = (self.observation, self.component.model);
        let found = support(observation, model, &located.pose, how, &mut memory.refine);
        let Some(support) = RefineError::passed_over(found)? else {
            return Ok(None);
        };
        let drawn = self.drawn(memory.refine.drawn)?;
        let overlap = located.region.map_or(1.0, |_| overlap(&shape, &drawn));
        Ok(Some(Start {
            pose: located.pose,
            region: located.region,
            overlap,
            support,
            score: self.prompt.agreement(&drawn) * (overlap + support.strength),
        }))
    }

    /// The model as it was drawn last.
    fn drawn<'w>(&self, words: &'w [u32]) -> Result<Mask<'w>, OneClickError> {
        let (width, height) = self.size();
        let words = words.get(..words_needed(width, height));
        Ok(Mask::new(words.unwrap_or_default(), width, height)?)
    }

    /// Brings a first pose onto the outline of its region, which was drawn last, unless it is near edges already, and then
    /// onto the edges of the frame.
    pub(super) fn refine(
        &self,
        start: &Start,
        memory: &mut OneClickMemory<'_>,
    ) -> Result<Option<Answer>, OneClickError> {
        let mut from = *start;
        if start.region.is_some() && (start.support.fraction < GOOD || start.overlap < GOOD) {
            let [shape, doubt] = self.masks(memory.words)?;
            let silhouette = Silhouette::new(&shape, &doubt)?;
            let view = CameraView::only(self.observation.camera, silhouette);
            let (model, options) = (self.component.model, RefineOptions::default());
            let onto = refine(model, &[view], &start.pose, options, &mut memory.refine);
            if let Some(onto) = RefineError::passed_over(onto)?
                && let Some(better) = self.score(&located_at(&onto.pose, start), memory)?
                && better.score > start.score
            {
                from = better;
            }
        }
        self.onto_frame(&from.pose, memory)
    }

    /// Refines a pose on the edges of the frame and scores the result; `None` where refinement leads nowhere.
    pub(super) fn onto_frame(
        &self,
        pose: &Pose,
        memory: &mut OneClickMemory<'_>,
    ) -> Result<Option<Answer>, OneClickError> {
        let target = self.observation.target();
        let view = CameraView::only(self.observation.camera, target);
        let (model, options) = (self.component.model, RefineOptions::default());
        let refined = refine(model, &[view], pose, options, &mut memory.refine);
        match RefineError::passed_over(refined)? {
            Some(refined) => self.answer(refined, pose, memory),
            None => Ok(None),
        }
    }

    /// Scores a refined pose; `None` where it is not possible.
    pub(super) fn answer(
        &self,
        refined: Refined,
        from: &Pose,
        memory: &mut OneClickMemory<'_>,
    ) -> Result<Option<Answer>, OneClickError> {
        if !self.is_possible(&refined.pose) {
            return Ok(None);
        }
        let (model, how) = (self.component.model, (CLOSE, self.slope));
        let found = support(
            self.observation,
            model,
            &refined.pose,
            how,
            &mut memory.refine,
        );
        let Some(support) = RefineError::passed_over(found)? else {
            return Ok(None);
        };
        let drawn = self.drawn(memory.refine.drawn)?;
        Ok(Some(Answer {
            refined,
            start: *from,
            support,
            mirrored: false,
            score: self.prompt.agreement(&drawn) * support.strength * nearness(&refined),
        }))
    }

    /// Strength of the edges near the model's outline at a pose; 0 where the model cannot be drawn.
    pub(super) fn strength(
        &self,
        pose: &Pose,
        memory: &mut OneClickMemory<'_>,
    ) -> Result<f64, OneClickError> {
        let how = ((NEAR * self.expected.size).max(2.0), self.slope);
        let found = support(
            self.observation,
            self.component.model,
            pose,
            how,
            &mut memory.refine,
        );
        let found = RefineError::passed_over(found)?;
        Ok(found.map_or(0.0, |support| support.strength))
    }
}

/// How near edges lie to a refined outline: 1 where they lie on it, 0 where there are none.
pub(super) fn nearness(refined: &Refined) -> f64 {
    1.0 - (refined.loss / WORST).clamp(0.0, 1.0)
}

fn located_at(pose: &Pose, start: &Start) -> LocatedPose {
    LocatedPose {
        pose: *pose,
        region: start.region,
        mismatch: 0.0,
    }
}

/// Number of pixels in both masks divided by that of pixels in either.
fn overlap(a: &Mask<'_>, b: &Mask<'_>) -> f64 {
    let pairs = a.words().iter().zip(b.words());
    let (mut both, mut either) = (0u64, 0u64);
    for (a, b) in pairs {
        both += u64::from((a & b).count_ones());
        either += u64::from((a | b).count_ones());
    }
    both as f64 / either.max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use fluoropose::image::mask::MaskMut;

    #[test]
    fn edges_are_as_near_as_their_loss_is_small() {
        let with = |part: f64| {
            nearness(&Refined {
                loss: part * WORST,
                ..Refined::at(Pose::IDENTITY)
            })
        };
        for part in [0.0, 0.25, 0.75, 1.0, 3.5] {
            assert!(
                (with(part) - (1.0f64 - part).max(0.0)).abs() < 1e-12,
                "{part}"
            );
        }
    }

    #[test]
    fn overlap_is_intersection_over_union() {
        let block = |rows: core::ops::Range<usize>| {
            let mut words = std::vec![0; words_needed(64, 64)];
            let mut mask = MaskMut::new(&mut words, 64, 64).expect("fits");
            rows.for_each(|row| mask.fill_span(row, 10, 50));
            words
        };
        let words = [20..40, 30..40, 50..60].map(block);
        let [a, b, c] = [0, 1, 2].map(|k| Mask::new(&words[k], 64, 64).expect("valid"));
        assert_eq!(
            [overlap(&a, &a), overlap(&a, &b), overlap(&a, &c)],
            [1.0, 0.5, 0.0]
        );
    }
}
