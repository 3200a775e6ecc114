//! How regions, poses and frame are held against each other.

use heapless::Vec;

use super::candidates::{Answer, Find, Region, Start};
use super::expect::Expected;
use super::support::support;
use super::{OneClickError, OneClickMemory, Part, Prompt, Scene};
use fluoropose::image::mask::{Mask, words_needed};
use fluoropose::image::silhouette::Silhouette;
use fluoropose::locate::locate;
use fluoropose::pose::Pose;
use fluoropose::refine::{CameraView, ImageTarget, RefineOptions, refine};

/// Poses of a region that are looked at.
const MINIMA: usize = 3;
/// How far from the outline of a first pose an edge is looked for, in parts of the size.
const NEAR: f64 = 0.04;
/// Edges are looked for so near to a refined outline, pixels.
const CLOSE: f64 = 1.5;
/// A start of which so much lies near edges, and that covers so much of its region, needs not be
/// brought onto the region first.
const GOOD: f64 = 0.9;
/// Loss of an outline no piece of which has an edge near by, square pixels: that of refinement on a
/// frame, Tukey's with a scale of 2.5 pixels.
const WORST: f64 = 2.5 * 2.5 / 6.0;

/// What is looked at, for what, and what was pointed at.
pub(super) struct Eye<'e> {
    pub(super) scene: &'e Scene<'e>,
    pub(super) part: &'e Part<'e>,
    pub(super) prompt: &'e Prompt,
    pub(super) expected: &'e Expected,
    /// Slope of an edge of metal, grey values a pixel.
    pub(super) slope: f64,
}

impl Eye<'_> {
    fn size(&self) -> (usize, usize) {
        (self.scene.camera.width(), self.scene.camera.height())
    }

    /// The masks of the region that was drawn last and of what is in doubt of it.
    fn masks<'w>(&self, words: &'w [u32]) -> Result<[Mask<'w>; 2], OneClickError> {
        let (width, height) = self.size();
        let (a, b) = words.split_at(words_needed(width, height).min(words.len()));
        Ok([Mask::new(a, width, height)?, Mask::new(b, width, height)?])
    }

    /// The poses that the library has for the region that was drawn last.
    pub(super) fn find(
        &self,
        region: Region,
        memory: &mut OneClickMemory<'_>,
    ) -> Result<Vec<Find, MINIMA>, OneClickError> {
        let [shape, _] = self.masks(memory.words)?;
        let (camera, library) = (self.scene.camera, self.part.library);
        let work = memory.workspace.reborrow();
        let Ok(found) = locate::<MINIMA>(&shape, camera, library, work) else {
            // A shapeless region has no pose.
            return Ok(Vec::new());
        };
        let area = f64::from(library.info().canonical.area());
        let finds = found.poses.iter().map(|located| Find {
            pose: located.pose,
            region: Some(region),
            mismatch: f64::from(located.fine.unmatched) / area,
        });
        Ok(finds.filter(|find| self.is_possible(&find.pose)).collect())
    }

    /// Whether the part stands where it can be.
    fn is_possible(&self, pose: &Pose) -> bool {
        let [_, _, z] = pose.transform(&self.part.model.bounds().centre);
        let [near, far] = self.expected.depths;
        (near..=far).contains(&-z)
    }

    /// Judges a find by the region that was drawn last, the frame's edges and the prompt; `None`
    /// where the model cannot be drawn.
    pub(super) fn judge(
        &self,
        find: &Find,
        memory: &mut OneClickMemory<'_>,
    ) -> Result<Option<Start>, OneClickError> {
        let [shape, _] = self.masks(memory.words)?;
        let how = ((NEAR * self.expected.size).max(2.0), self.slope);
        let (scene, model) = (self.scene, self.part.model);
        let Ok(support) = support(scene, model, &find.pose, how, &mut memory.refine) else {
            return Ok(None);
        };
        let drawn = self.drawn(memory.refine.drawn)?;
        let overlap = find.region.map_or(1.0, |_| overlap(&shape, &drawn));
        Ok(Some(Start {
            pose: find.pose,
            region: find.region,
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

    /// Brings a start onto the outline of its region, which was drawn last, where it is not near
    /// edges already, and then onto the frame.
    pub(super) fn refine(
        &self,
        start: &Start,
        memory: &mut OneClickMemory<'_>,
    ) -> Result<Option<Answer>, OneClickError> {
        let mut from = *start;
        if start.region.is_some() && (start.support.share < GOOD || start.overlap < GOOD) {
            let [shape, doubt] = self.masks(memory.words)?;
            let silhouette = Silhouette::new(&shape, &doubt)?;
            let view = CameraView::only(self.scene.camera, silhouette);
            let (model, options) = (self.part.model, RefineOptions::default());
            let onto = refine(model, &[view], &start.pose, options, &mut memory.refine);
            if let Ok(onto) = onto
                && let Some(better) = self.judge(&find_of(&onto.pose, start), memory)?
                && better.score > start.score
            {
                from = better;
            }
        }
        self.onto_frame(&from.pose, memory)
    }

    /// Refines a pose on the frame and judges what comes of it; `None` where it leads nowhere.
    pub(super) fn onto_frame(
        &self,
        pose: &Pose,
        memory: &mut OneClickMemory<'_>,
    ) -> Result<Option<Answer>, OneClickError> {
        let target = ImageTarget {
            frame: self.scene.frame,
            unknown: self.scene.excluded,
            polarity: self.scene.polarity,
        };
        let view = CameraView::only(self.scene.camera, target);
        let (model, options) = (self.part.model, RefineOptions::default());
        let refined = refine(model, &[view], pose, options, &mut memory.refine);
        let Some(refined) = refined.ok().filter(|found| self.is_possible(&found.pose)) else {
            return Ok(None);
        };
        let how = (CLOSE, self.slope);
        let Ok(support) = support(self.scene, model, &refined.pose, how, &mut memory.refine) else {
            return Ok(None);
        };
        let drawn = self.drawn(memory.refine.drawn)?;
        let off = (refined.loss / WORST).clamp(0.0, 1.0);
        Ok(Some(Answer {
            refined,
            start: *pose,
            support,
            mirrored: false,
            score: self.prompt.agreement(&drawn) * support.strength * (1.0 - off),
        }))
    }

    /// Part of the model's outline at a pose that lies on edges, strongly.
    pub(super) fn strength(&self, pose: &Pose, memory: &mut OneClickMemory<'_>) -> f64 {
        let how = ((NEAR * self.expected.size).max(2.0), self.slope);
        let found = support(self.scene, self.part.model, pose, how, &mut memory.refine);
        found.map_or(0.0, |support| support.strength)
    }
}

fn find_of(pose: &Pose, start: &Start) -> Find {
    Find {
        pose: *pose,
        region: start.region,
        mismatch: 0.0,
    }
}

/// Pixels in both masks divided by those in either.
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
