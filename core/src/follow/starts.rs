//! Starts in one frame, one after the other.
//!
//! Most of those beside a pose lead back to it. Where the film is known, and what leads there is of no use, one that comes to it is given up. Those that
//! may take its place go all the way, even where another has come to the same minimum: of two ends in one, the better is taken.

use heapless::Vec;

use super::frame_pose::{FramePose, From, loss_of, refined_unless, seen};
use super::subject::Subject;
use crate::pose::Pose;
use crate::refine::{Ended, ImageTarget, RefineMemory, Unless};

/// A pose and its mirror image.
const KNOWN: usize = 2;

/// Starts in one frame, one after the other.
#[derive(Debug)]
pub struct Starts<'s> {
    subject: &'s Subject<'s>,
    image: &'s ImageTarget<'s>,
    /// Poses to which no start needs to lead.
    known: Vec<Pose, KNOWN>,
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

    /// The same where nothing is to lead to poses that are known; two at most.
    #[must_use]
    pub fn knowing(mut self, known: &[Pose]) -> Self {
        for pose in known {
            // To what there is no room for, starts go all the way.
            let _ = self.known.push(*pose);
        }
        self
    }

    /// The pose that a start leads to; `None` where that is known, and where nothing is found.
    pub fn lead(&self, start: (&Pose, From), memory: &mut RefineMemory<'_>) -> Option<FramePose> {
        self.lead_within(f64::INFINITY, start, memory)
    }

    /// The same where no more than `most_px` remain between outline and edges.
    pub fn lead_within(
        &self,
        most_px: f64,
        start: (&Pose, From),
        memory: &mut RefineMemory<'_>,
    ) -> Option<FramePose> {
        let (subject, image) = (self.subject, self.image);
        let unless = Unless {
            hopeless: loss_of(most_px),
            known: &self.known,
        };
        let (refined, ended) = refined_unless(unless, subject, image, start, memory).ok()?;
        if ended == Ended::Known || refined.loss > loss_of(most_px) {
            return None;
        }
        seen(subject, image, &refined, memory).ok()
    }
}

#[cfg(all(test, feature = "alloc"))]
mod tests {
    use super::*;
    use crate::finder::fake::{SIDE, camera, crank, grey, placed};
    use crate::follow::frame_pose::From;
    use crate::image::frame::Frame;
    use crate::refine::RefineBuffers;

    #[test]
    fn a_start_leads_nowhere_that_leaves_more_than_is_allowed() {
        let (model, camera) = (crank(), camera());
        let right = placed([20.0, 30.0, 5.0], [2.0, -3.0, 0.0]);
        let pixels = grey(&model, &camera, &right);
        let frame = Frame::new(&pixels, SIDE, SIDE, SIDE).expect("valid");
        let image = ImageTarget::dark(&frame);
        let (mut buffers, model) = (RefineBuffers::default(), model.as_model());
        let subject = Subject::new(&model, &[], &camera);
        let mut memory = buffers.borrow(&model, &camera);
        let starts = Starts::new(&subject, &image);
        let start = (&placed([20.5, 29.5, 6.0], [1.0, -2.0, 0.0]), From::Near);
        let found = starts.lead(start, &mut memory).expect("found");
        assert!(found.misfit_px > 0.0);
        let [less, more] = [0.99, 1.01]
            .map(|times| starts.lead_within(times * found.misfit_px, start, &mut memory));
        assert_eq!((less, more), (None, Some(found)));
    }
}
