//! Refinement of several rival poses, and which of them explains what was seen best.

use core::task::{Poll, ready};

use heapless::Vec;

pub use super::rounds::{ANSWERS, RefinedRival, STARTS};
use super::rounds::{Doing, Led, Poses, Round, Subject};
use crate::image::mask::{MaskMut, words_needed};
use crate::locate::rerank::{Reranked, unmatched_at_pose};
use crate::mesh::Model;
use crate::mesh::mirror::mirror_pose;
use crate::mesh::symmetry::SymmetryPlane;
use crate::pace::to_the_end;
use crate::pose::Pose;
use crate::refine::{
    CameraView, Part, RefineError, RefineMemory, RefineOptions, Refined, Refinement, Target,
};
use crate::shortlist::keep;

/// Rivals are refined when the model drawn at them leaves at most this many times the unmatched
/// pixels of the best: the library stage is some pixels off, so near rivals are still open.
const WORTH_REFINING: f64 = 4.0;

/// A component looks symmetric when its mirrored pose leaves at most this fraction of the mask unmatched.
const SYMMETRIC_FRACTION: f64 = 0.15;

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
    let subject = Subject {
        model,
        views,
        planes,
        options,
    };
    let mut rivals = Rivals::new();
    rivals.begin(starts.iter().copied(), &subject);
    to_the_end(|| rivals.go_on(&subject, memory))?;
    Ok(rivals.poses.answers)
}

/// All of [`refine_rivals`] between two drawings.
pub(super) struct Rivals {
    poses: Poses,
    failure: Option<RefineError>,
    /// Number of the next pose of the round.
    next: usize,
    /// The one at hand, and how it is refined.
    tried: RefinedRival,
    refinement: Refinement,
}

impl Rivals {
    /// Nothing to do.
    pub(super) fn new() -> Self {
        Self {
            poses: Poses::new(),
            failure: None,
            next: 0,
            tried: RefinedRival::at(Pose::IDENTITY, 0, false),
            refinement: Refinement::new(&Pose::IDENTITY),
        }
    }

    /// What was found, by rising loss.
    pub(super) fn answers(&self) -> &[RefinedRival] {
        &self.poses.answers
    }

    /// Begins with the first [`STARTS`] of these. Of several, the first stage tells where each leads, and only the poses that
    /// may be the best are refined to the end, each once.
    pub(super) fn begin(&mut self, starts: impl Iterator<Item = Pose>, subject: &Subject<'_>) {
        self.poses.begin(starts, subject.views);
        (self.next, self.failure) = (0, None);
    }

    /// Draws once, and takes in what is seen; [`Poll::Ready`] where nothing is left to draw.
    #[inline(never)]
    pub(super) fn go_on(
        &mut self,
        subject: &Subject<'_>,
        memory: &mut RefineMemory<'_>,
    ) -> Poll<Result<(), RefineError>> {
        while self.poses.doing == Doing::Choosing {
            if self.has_drawn(subject, memory) {
                return Poll::Pending;
            }
        }
        if self.poses.doing == Doing::Nothing {
            let failure = self.failure.filter(|_| self.poses.answers.is_empty());
            return Poll::Ready(failure.map_or(Ok(()), Err));
        }
        let (poses, seen) = (&self.poses, (subject.model, subject.views));
        let known = |pose: &Pose| poses.is_known(pose);
        let (options, refinement) = (subject.options, &mut self.refinement);
        let ended = ready!(refinement.go_on(seen, options, &known, memory, &mut |_| ()));
        if let Err(short @ RefineError::Memory(_)) = ended {
            // The poses that need less of it are not the best ones for that.
            return Poll::Ready(Err(short));
        }
        self.take(ended);
        Poll::Pending
    }

    /// Begins with the next pose of the round, or with the next round; gives whether the model was drawn for that.
    fn has_drawn(&mut self, subject: &Subject<'_>, memory: &mut RefineMemory<'_>) -> bool {
        let (poses, next) = (&mut self.poses, self.next);
        // Each pose has an image in each plane.
        let times = match poses.round {
            Round::Mirrors => subject.planes.len(),
            _ => 1,
        };
        let tried = next.checked_div(times).and_then(|at| poses.open.get(at));
        let Some(&tried) = tried else {
            self.next = 0;
            return poses.next_round(subject, memory);
        };
        (self.next, self.tried) = (next + 1, tried);
        match poses.round {
            Round::First => self.refine(Part::First, &tried.refined),
            Round::Rest => self.refine(Part::Rest, &tried.refined),
            Round::Starts => self.refine(Part::All, &tried.refined),
            Round::Beside | Round::Around => self.refine(Part::Probe, &tried.refined),
            Round::Mirrors => {
                let plane = next
                    .checked_rem(times)
                    .and_then(|at| subject.planes.get(at));
                plane.inspect(|plane| self.mirror(plane, subject, memory));
                return true;
            }
        }
        false
    }

    /// Goes on with the mirror image of a pose, where it covers what was seen.
    fn mirror(
        &mut self,
        plane: &SymmetryPlane,
        subject: &Subject<'_>,
        memory: &mut RefineMemory<'_>,
    ) {
        let own = self.tried.refined.pose;
        let mirrored = mirror_pose(&own, plane);
        let mut views = subject.views.iter();
        if !views.all(|view| is_near(subject.model, view, &mirrored, &own, memory)) {
            return;
        }
        self.tried = RefinedRival::at(mirrored, self.tried.start, true);
        if let Some(best) = self.poses.answers.first() {
            self.poses.best = *best;
        }
        // Edges of a frame are too many for a quick look.
        let part = match self.poses.is_outline {
            true => Part::Probe,
            false => Part::All,
        };
        self.refine(part, &Refined::at(mirrored));
    }

    fn refine(&mut self, part: Part, begun: &Refined) {
        self.poses.doing = match part {
            Part::Probe => Doing::Looking,
            _ => Doing::Refining,
        };
        self.refinement.begin(part, begun);
    }

    /// Takes in where a pose has led.
    fn take(&mut self, ended: Result<(), RefineError>) {
        let (poses, led) = (&mut self.poses, self.refinement.state);
        let where_to = match ended {
            Err(error) => {
                self.failure = Some(error);
                Led::Nowhere
            }
            Ok(()) if poses.is_known(&led.pose) => Led::Back,
            Ok(()) if poses.doing == Doing::Looking => poses.led(&led),
            Ok(()) => {
                self.tried.refined = led;
                keep(&mut poses.answers, self.tried, |other| other.refined.loss);
                Led::Nowhere
            }
        };
        poses.doing = Doing::Choosing;
        match where_to {
            Led::Back => {}
            Led::Nowhere => poses.all_back = false,
            Led::On => {
                if poses.round != Round::Mirrors {
                    self.tried.from = led.pose;
                }
                self.refine(Part::All, &Refined::at(led.pose));
            }
        }
    }
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

#[cfg(all(test, feature = "alloc"))]
mod tests;
