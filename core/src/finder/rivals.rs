//! Refinement of several rival poses, and which of them explains what was seen best.

use heapless::Vec;

use crate::finder::nearby::{about, nearby};
use crate::image::mask::{MaskMut, words_needed};
use crate::locate::rerank::{Reranked, unmatched_at_pose};
use crate::math::radians;
use crate::mesh::Model;
use crate::mesh::mirror::mirror_pose;
use crate::mesh::symmetry::SymmetryPlane;
use crate::pace::{Pace, at_once};
use crate::pose::{Pose, geodesic_deg};
use crate::refine::{
    CameraView, Part, RefineError, RefineMemory, RefineOptions, Refined, Target, probe,
    refine_unless,
};
use crate::shortlist::{keep, take_out};

/// Most poses that are refined as starts.
pub const STARTS: usize = 6;

/// Most refined poses: that of each start and its three mirror images.
pub const ANSWERS: usize = 4 * STARTS;

/// Rivals are refined when the model drawn at them leaves at most this many times the unmatched
/// pixels of the best: the library stage is some pixels off, so near rivals are still open.
const WORTH_REFINING: f64 = 4.0;

/// A component looks symmetric when its mirrored pose leaves at most this fraction of the mask unmatched.
const SYMMETRIC_FRACTION: f64 = 0.15;

/// See [`is_split`]: least residual, pixels, and its least ratio to the robust standard deviation of the residuals.
const SPLIT_PX: f64 = 0.1;
const SPLIT_RATIO: f64 = 3.0;
/// See [`is_split`], for an outline without noise: where the robust standard deviation is below the first, the residual at
/// the right pose is below the second, pixels. Found by trial on the exact masks of two femoral and two tibial
/// components.
const EXACT_PX: f64 = 0.046;
const INEXACT_PX: f64 = 0.03;

/// So far beside a pose another minimum is looked for, degrees: as far as views of a coarse library lie apart.
const BESIDE_DEG: f64 = 2.5;

/// Step of the search around a pose that may be a false minimum near the right one, degrees.
const CLOSE_DEG: f64 = 1.0;

/// A probe has led back to the best pose where it ends nearer to it than this, degrees; it has found no rival where its
/// loss exceeds the best one's by more than this factor.
const BACK_DEG: f64 = 0.1;
const ALIKE: f64 = 1.25;

/// See [`blurred_deg`]: degrees for each pixel of noise.
const NOISE_DEG: f64 = 2.5;

/// After a quick look a pose may still be the best where its loss is at most this many times the least, or this many times
/// so many square pixels; and two lead to the same where they are nearer than this, degrees.
const LOOKED_WORSE: f64 = 4.0;
const LOOKED_PX2: f64 = 0.125;
const LOOKED_SAME_DEG: f64 = 1.0;

/// See [`is_on_the_way`].
const ON_THE_WAY: f64 = 0.5;

/// Of poses nearer to each other than this, degrees, the best is kept.
pub(super) const SAME_DEG: f64 = 0.5;

/// A refined pose and what it was refined from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RefinedRival {
    /// Which of the poses to start from led to it, from 0.
    pub start: usize,
    /// Whether it was refined from the mirror image of what that start became.
    pub mirrored: bool,
    /// The pose that it was refined from.
    pub from: Pose,
    /// What refinement made of it.
    pub refined: Refined,
}

/// The rivals whose unmatched pixels are near enough to those of the best to be worth refining: the first of `rivals`,
/// which come best first from [`crate::locate::rerank::rerank`].
#[must_use]
pub fn worth_refining(rivals: &[Reranked]) -> &[Reranked] {
    let least = rivals.first().map_or(0, |best| best.unmatched);
    let limit = WORTH_REFINING * least as f64;
    let count = rivals.partition_point(|rival| rival.unmatched as f64 <= limit);
    rivals.get(..count.min(STARTS)).unwrap_or(rivals)
}

/// Refines the first [`STARTS`] poses of `starts`, and then their mirror images in each of `planes`, the model's planes of
/// near-symmetry ([`crate::mesh::symmetry::symmetry_planes`]), where these cover the mask: between the views of a
/// library a mirror image need not be a minimum of its own. Returns the different poses by rising loss; none only where
/// there is no start.
///
/// # Errors
/// That of [`crate::refine::refine`] for the last start, when none can be refined.
pub fn refine_rivals(
    model: &Model<'_>,
    views: &[CameraView<'_>],
    starts: &[Pose],
    planes: &[SymmetryPlane],
    options: RefineOptions,
    memory: &mut RefineMemory<'_>,
) -> Result<Vec<RefinedRival, ANSWERS>, RefineError> {
    let (mut answers, pace) = (Vec::new(), Pace::new());
    let mut search = RivalRefinement {
        model,
        views,
        planes,
        options,
        memory,
        pace: &pace,
        answers: &mut answers,
    };
    at_once(&pace, search.run(starts))?;
    Ok(answers)
}

/// Refinement from a growing list of starts.
pub(super) struct RivalRefinement<'s, 'm> {
    pub(super) model: &'s Model<'s>,
    pub(super) views: &'s [CameraView<'s>],
    pub(super) planes: &'s [SymmetryPlane],
    pub(super) options: RefineOptions,
    pub(super) memory: &'s mut RefineMemory<'m>,
    pub(super) pace: &'s Pace,
    /// By rising loss; at first none. The list is long: a copy of it takes kilobytes of stack.
    pub(super) answers: &'s mut Vec<RefinedRival, ANSWERS>,
}

impl RivalRefinement<'_, '_> {
    /// All of [`refine_rivals`].
    pub(super) async fn run(&mut self, starts: &[Pose]) -> Result<(), RefineError> {
        self.refine_starts(starts).await?;
        self.mirror().await;
        if !self.look_beside().await {
            self.look_closer().await;
        }
        keep_distinct(self.answers);
        Ok(())
    }

    /// Refines a pose, unless it leads on to one that is there already: of an outline, because on a frame all are brought to the end.
    async fn go_on(
        &mut self,
        pose: &Pose,
        (from, index, mirrored): (&Pose, usize, bool),
    ) -> Result<Went, RefineError> {
        let (answers, is_outline) = (&*self.answers, self.is_outline());
        let known = |pose: &Pose| is_outline && is_among(answers, pose);
        let (seen, options) = ((self.model, self.views), self.options);
        let (start, part) = (&Refined::at(*pose), Part::All);
        let refined = refine_unless(seen, start, part, options, &known, self.memory, self.pace);
        match refined.await? {
            None => Ok(Went::Back),
            Some(refined) => {
                self.keep(*from, refined, index, mirrored);
                Ok(Went::On)
            }
        }
    }

    fn keep(&mut self, from: Pose, refined: Refined, start: usize, mirrored: bool) {
        let answer = RefinedRival {
            start,
            mirrored,
            from,
            refined,
        };
        keep(self.answers, answer, |other| other.refined.loss);
    }

    /// Refines the starts. Of several, the first stage tells where each leads, and only the poses that may be the best are
    /// refined to the end, each once.
    async fn refine_starts(&mut self, starts: &[Pose]) -> Result<(), RefineError> {
        let starts = &starts[..starts.len().min(STARTS)];
        let mut failure = None;
        if let ([_, _, ..], true) = (starts, self.is_outline()) {
            let mut begun = Vec::new();
            self.begin_all(starts, &mut begun, &mut failure).await;
            for (start, begun) in &begun {
                let (seen, options) = ((self.model, self.views), self.options);
                let (answers, part) = (&*self.answers, Part::Rest);
                let known = |pose: &Pose| is_among(answers, pose);
                let finished =
                    refine_unless(seen, begun, part, options, &known, self.memory, self.pace);
                match finished.await {
                    Ok(None) => {}
                    Ok(Some(refined)) => {
                        let from = starts.get(*start).unwrap_or(&begun.pose);
                        self.keep(*from, refined, *start, false);
                    }
                    Err(error) => failure = Some(error),
                }
            }
        } else {
            for (start, pose) in starts.iter().enumerate() {
                if let Err(error) = self.go_on(pose, (pose, start, false)).await {
                    failure = Some(error);
                }
            }
        }
        match failure.filter(|_| self.answers.is_empty()) {
            Some(error) => Err(error),
            None => Ok(()),
        }
    }

    /// Whether all that was seen are silhouettes: edges of a frame are too many for a quick look.
    fn is_outline(&self) -> bool {
        let outline = |view: &CameraView<'_>| matches!(view.target, Target::Silhouette(_));
        self.views.iter().all(outline)
    }

    /// Where the first stage leads from the starts, each pose once, and only those that may be the best.
    async fn begin_all(
        &mut self,
        starts: &[Pose],
        begun: &mut Vec<(usize, Refined), STARTS>,
        failure: &mut Option<RefineError>,
    ) {
        for (start, pose) in starts.iter().enumerate() {
            let known = |pose: &Pose| {
                let mut begun = begun.iter();
                begun.any(|(_, other)| is_on_the_way(pose, &other.pose, LOOKED_SAME_DEG))
            };
            let (seen, options) = ((self.model, self.views), self.options);
            let (at, part) = (&Refined::at(*pose), Part::First);
            let begun_here = refine_unless(seen, at, part, options, &known, self.memory, self.pace);
            match begun_here.await {
                Ok(None) => {}
                Ok(Some(one)) => {
                    keep(begun, (start, one), |(_, one)| one.loss);
                }
                Err(error) => *failure = Some(error),
            }
        }
        keep_open(begun);
    }

    /// Refines the mirror images of all poses so far, where they cover what was seen.
    async fn mirror(&mut self) {
        // At most one of each start so far.
        let mut distinct: Vec<(usize, Pose), STARTS> = Vec::new();
        for RefinedRival { start, refined, .. } in &*self.answers {
            if !distinct
                .iter()
                .any(|(_, other)| is_same(other, &refined.pose))
            {
                let _ = distinct.push((*start, refined.pose));
            }
        }
        for &(start, pose) in &distinct {
            for plane in self.planes {
                let mirrored = mirror_pose(&pose, plane);
                self.pace.pause().await;
                let near = self
                    .views
                    .iter()
                    .all(|view| is_near(self.model, view, &mirrored, &pose, self.memory));
                if !near {
                    continue;
                }
                if let Some(led) = self.leads_elsewhere(&mirrored).await {
                    // A mirror image that leads nowhere is no rival.
                    let _ = self.go_on(&led, (&mirrored, start, true)).await;
                }
            }
        }
    }

    /// Where a quick look finds that a pose leads to what may fit as well as the best, and was not found before.
    async fn leads_elsewhere(&mut self, start: &Pose) -> Option<Pose> {
        let (Some(best), true) = (self.answers.first().copied(), self.is_outline()) else {
            return Some(*start);
        };
        let answers = &*self.answers;
        let known = |pose: &Pose| {
            answers.iter().any(|RefinedRival { refined, .. }| {
                is_on_the_way(pose, &refined.pose, blurred_deg(refined))
            })
        };
        let (model, views, options) = (self.model, self.views, self.options);
        let looked = probe(model, views, start, options, &known, self.memory, self.pace);
        let Ok(Some(looked)) = looked.await else {
            return None;
        };
        let known = |RefinedRival { refined, .. }: &RefinedRival| {
            let apart = geodesic_deg(&refined.pose.rotation, &looked.pose.rotation);
            apart < blurred_deg(refined) && looked.loss > refined.loss / ALIKE
        };
        let limit = LOOKED_WORSE * best.refined.loss.max(LOOKED_PX2);
        (looked.loss <= limit && !self.answers.iter().any(known)).then_some(looked.pose)
    }

    /// A nearly symmetric part has minima beside each other that fit alike, some degrees apart: from both sides of the best
    /// pose, about both axes out of the image plane, it is tried whether another is there. Gives whether all that was tried
    /// led back: then no false minimum lies nearer either, it would have been met.
    async fn look_beside(&mut self) -> bool {
        let (Some(best), [view]) = (self.answers.first().copied(), self.views) else {
            return false;
        };
        if self.planes.is_empty() || !self.is_outline() || view.placement != Pose::IDENTITY {
            return false;
        }
        let middle = self.model.bounds().centre;
        let back = blurred_deg(&best.refined).max(BACK_DEG);
        let mut all_back = true;
        for turn in [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]] {
            let [x, y] = turn.map(|sign| radians(sign * BESIDE_DEG));
            let start = about(&middle, &best.refined.pose, &[x, y, 0.0], [0.0; 3]);
            all_back &= match self.probe(&start, &best.refined, back).await {
                Led::Back => true,
                Led::Nowhere => false,
                Led::To(found) => {
                    let came_from = (&found, best.start, best.mirrored);
                    // From there it leads somewhere.
                    matches!(self.go_on(&found, came_from).await, Ok(Went::Back))
                }
            };
        }
        all_back
    }

    /// Where most of the outline fits exactly and a part does not, the best pose may be a false minimum near the right
    /// one: refinement starts again from poses around it.
    async fn look_closer(&mut self) {
        let (Some(best), [view]) = (self.answers.first().copied(), self.views) else {
            return;
        };
        let Target::Silhouette(silhouette) = &view.target else {
            return;
        };
        if !is_split(&best.refined) || view.placement != Pose::IDENTITY {
            return;
        }
        let (model, camera, pose) = (self.model, view.camera, &best.refined.pose);
        // All of its drawings in one slice; few poses need it.
        self.pace.pause().await;
        let starts = nearby(model, camera, silhouette, pose, CLOSE_DEG, self.memory);
        let apart = |start: &&Pose| geodesic_deg(&start.rotation, &pose.rotation) > CLOSE_DEG / 2.0;
        for start in starts.iter().filter(apart) {
            if let Led::To(found) = self.probe(start, &best.refined, BACK_DEG).await {
                let came_from = (&found, best.start, best.mirrored);
                // From there it leads somewhere.
                let _ = self.go_on(&found, came_from).await;
            }
        }
    }

    /// Where a start leads: most lead to the best pose again, to within `back_deg`, or to a worse one.
    async fn probe(&mut self, start: &Pose, best: &Refined, back_deg: f64) -> Led {
        let known = |pose: &Pose| is_on_the_way(pose, &best.pose, back_deg);
        let (model, views, options) = (self.model, self.views, self.options);
        let looked = probe(model, views, start, options, &known, self.memory, self.pace);
        let found = match looked.await {
            Ok(Some(found)) => found,
            Ok(None) => return Led::Back,
            Err(_) => return Led::Nowhere,
        };
        let apart = geodesic_deg(&found.pose.rotation, &best.pose.rotation);
        if apart <= back_deg {
            Led::Back
        } else if found.loss < ALIKE * best.loss {
            Led::To(found.pose)
        } else {
            Led::Nowhere
        }
    }
}

/// Where a quick look beside the best pose leads.
enum Led {
    /// To the best pose again.
    Back,
    /// To a worse pose, or to none.
    Nowhere,
    /// To a pose that may be better.
    To(Pose),
}

/// Whether what a quick look led to was there already.
enum Went {
    Back,
    On,
}

/// Whether a pose that is being refined has come to one that was.
fn is_among(answers: &[RefinedRival], pose: &Pose) -> bool {
    answers.iter().any(|RefinedRival { refined, .. }| {
        // Noise leaves several minima beside each other: of those the best is wanted.
        is_on_the_way(pose, &refined.pose, BACK_DEG)
    })
}

/// Whether a quick look that has come to `pose` will end within so many degrees of `other`: it is well on the way there.
fn is_on_the_way(pose: &Pose, other: &Pose, within_deg: f64) -> bool {
    geodesic_deg(&pose.rotation, &other.rotation) < ON_THE_WAY * within_deg
}

/// How far apart a quick look may leave what is one minimum, degrees.
fn blurred_deg(refined: &Refined) -> f64 {
    (NOISE_DEG * refined.robust_sigma_px).min(LOOKED_SAME_DEG)
}

/// Whether most of an outline fits exactly and a part does not at all, which noise does not cause; or whether an outline
/// without noise leaves a residual that rounding does not explain.
fn is_split(refined: &Refined) -> bool {
    let (residual, sigma) = (refined.residual_px, refined.robust_sigma_px);
    let split = residual > SPLIT_PX && residual > SPLIT_RATIO * sigma;
    split || (sigma < EXACT_PX && residual > INEXACT_PX)
}

/// Whether the model drawn at a mirrored pose covers the silhouette nearly as well as at its own,
/// or well by itself. Of a grey frame that is not known: `true`.
fn is_near(
    model: &Model<'_>,
    view: &CameraView<'_>,
    mirrored: &Pose,
    own: &Pose,
    memory: &mut RefineMemory<'_>,
) -> bool {
    let Target::Silhouette(silhouette) = &view.target else {
        return true;
    };
    let mut unmatched = |pose: &Pose| {
        let (width, height) = (silhouette.mask().width(), silhouette.mask().height());
        let words = memory.drawn.get_mut(..words_needed(width, height))?;
        let mut drawn = MaskMut::new(words, width, height).ok()?;
        let pose = view.placement.compose(pose);
        let scratch = &mut *memory.projected;
        unmatched_at_pose(model, view.camera, &pose, silhouette, scratch, &mut drawn).ok()
    };
    let Some(there) = unmatched(mirrored) else {
        return false;
    };
    let limit = SYMMETRIC_FRACTION * silhouette.mask().area() as f64;
    there as f64 <= limit || unmatched(own).is_none_or(|here| there <= 2 * here)
}

/// Keeps those poses that a quick look leaves open, each once, where it comes first: they are listed by rising loss.
fn keep_open(begun: &mut Vec<(usize, Refined), STARTS>) {
    let least = begun.first().map_or(0.0, |(_, best)| best.loss);
    let limit = LOOKED_WORSE * least.max(LOOKED_PX2);
    let mut place = 0;
    while let Some((_, one)) = begun.get(place) {
        let same = |(_, other): &(usize, Refined)| {
            geodesic_deg(&other.pose.rotation, &one.pose.rotation) < LOOKED_SAME_DEG
        };
        if one.loss > limit || begun.iter().take(place).any(same) {
            take_out(begun, place);
        } else {
            place += 1;
        }
    }
}

/// Keeps each pose once, where it comes first.
fn keep_distinct(answers: &mut Vec<RefinedRival, ANSWERS>) {
    let mut place = 0;
    while let Some(RefinedRival { refined, .. }) = answers.get(place) {
        let pose = refined.pose;
        let mut before = answers.iter().take(place);
        if before.any(|other| is_same(&other.refined.pose, &pose)) {
            take_out(answers, place);
        } else {
            place += 1;
        }
    }
}

fn is_same(a: &Pose, b: &Pose) -> bool {
    geodesic_deg(&a.rotation, &b.rotation) < SAME_DEG
}
