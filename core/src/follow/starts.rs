//! Starts in one frame, one after the other.
//!
//! Most of those beside a pose lead back to it. Where the film is known, one that comes to a pose where another has ended is given up there:
//! what it would end at is that pose.

use heapless::Vec;

use super::frame_pose::{FramePose, From, loss_of, refined_unless, seen};
use super::subject::Subject;
use crate::pose::Pose;
use crate::refine::{Ended, ImageTarget, RefineMemory, Unless};

/// Poses that are kept; to others starts go all the way.
const KEPT: usize = 32;

/// Starts in one frame, one after the other.
#[derive(Debug)]
pub struct Starts<'s> {
    subject: &'s Subject<'s>,
    image: &'s ImageTarget<'s>,
    /// Poses where starts have ended, and those that were known before.
    known: Vec<Pose, KEPT>,
}

impl<'s> Starts<'s> {
    /// In a frame, before the first start.
    #[must_use]
    pub fn new(subject: &'s Subject<'s>, image: &'s ImageTarget<'s>) -> Self {
        Self {
            subject,
            image,
            known: Vec::new(),
        }
    }

    /// The same where poses are known beforehand.
    pub(super) fn knowing(mut self, known: &[Pose]) -> Self {
        known.iter().for_each(|pose| self.keep(pose));
        self
    }

    /// The pose that a start leads to; `None` where that is known, and where nothing is found.
    pub fn lead(
        &mut self,
        start: (&Pose, From),
        memory: &mut RefineMemory<'_>,
    ) -> Option<FramePose> {
        self.lead_within(f64::INFINITY, start, memory)
    }

    /// The same where no more than `most_px` remain between outline and edges.
    pub fn lead_within(
        &mut self,
        most_px: f64,
        start: (&Pose, From),
        memory: &mut RefineMemory<'_>,
    ) -> Option<FramePose> {
        self.lead_unless([most_px; 2], start, memory)
    }

    /// The same, also given where the way is not gone to its end because what remains is `enough_px` by far.
    pub(super) fn lead_unless(
        &mut self,
        [most_px, enough_px]: [f64; 2],
        start: (&Pose, From),
        memory: &mut RefineMemory<'_>,
    ) -> Option<FramePose> {
        let (subject, image) = (self.subject, self.image);
        let unless = Unless {
            hopeless: loss_of(most_px),
            enough: loss_of(enough_px),
            known: &self.known,
        };
        let (refined, ended) = refined_unless(unless, subject, image, start, memory).ok()?;
        if ended == Ended::Itself {
            self.keep(&refined.pose);
        }
        if ended == Ended::Known || refined.loss > loss_of(most_px) {
            return None;
        }
        seen(subject, image, &refined, memory).ok()
    }

    fn keep(&mut self, pose: &Pose) {
        // Those for which there is no room are found anew.
        let _ = self.known.push(*pose);
    }
}
