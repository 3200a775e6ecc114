//! A component followed from a frame in which it is known to some frames before and after it.

use fluoropose::follow::{Anchor, Ends, FAR, Subject, Way, frame_pose_at, look};
use fluoropose::pose::Pose;
use fluoropose::refine::{ImageTarget, RefineError, RefineMemory};

/// A walk to both sides; its own frame is looked at first.
pub(super) struct Walk {
    frame: usize,
    pose: Pose,
    /// The frames up to which it goes.
    to: [usize; 2],
    ways: Option<[Way; 2]>,
    ends: Ends,
}

impl Walk {
    pub(super) fn new(frame: usize, pose: Pose, frames: usize) -> Self {
        let last = (frame + FAR).min(frames.saturating_sub(1));
        Self {
            frame,
            pose,
            to: [frame.saturating_sub(FAR), last],
            ways: None,
            ends: [None, None],
        }
    }

    /// The frame that is to be looked at next.
    pub(super) fn wanted(&self) -> Option<usize> {
        match &self.ways {
            None => Some(self.frame),
            Some(ways) => ways.iter().zip(self.to).find_map(|(way, to)| way.next(to)),
        }
    }

    /// Looks at it.
    ///
    /// # Errors
    /// Where the model cannot be drawn at the pose that is known.
    pub(super) fn take(
        &mut self,
        subject: &Subject<'_>,
        image: &ImageTarget<'_>,
        memory: &mut RefineMemory<'_>,
    ) -> Result<(), RefineError> {
        let Some(ways) = &mut self.ways else {
            let found = frame_pose_at(subject, image, &self.pose, memory)?;
            let anchor = Anchor::found(self.frame, found);
            self.ways = Some([false, true].map(|forward| Way::begin(&anchor, forward)));
            return Ok(());
        };
        let middle = subject.model.bounds().centre;
        for (side, way) in ways.iter_mut().enumerate() {
            if let Some(frame) = way.next(self.to[side]) {
                let looked = look(subject, image, frame, way.trail(), memory);
                way.take(frame, &looked, &middle);
                if let Ok(found) = looked.found {
                    self.ends[side] = Some((frame, found.pose));
                }
                break;
            }
        }
        Ok(())
    }

    /// The first and the last frame in which it was followed.
    pub(super) fn ends(&self) -> Ends {
        self.ends
    }
}
