//! A component followed from a frame in which it is known to some frames before and after it, or to one of them.

use fluoropose::follow::{Anchor, Ends, FAR, FramePose, Subject, Way, frame_pose_at, look};
use fluoropose::pose::Pose;
use fluoropose::refine::{ImageTarget, RefineError, RefineMemory};

/// A walk to both sides, or to one; its own frame is looked at first.
pub(super) struct Walk {
    frame: usize,
    pose: Pose,
    /// The frames up to which it goes.
    to: [usize; 2],
    ways: Option<[Way; 2]>,
    /// What its own frame says of the pose.
    begun: Option<FramePose>,
    ends: [Option<(usize, FramePose)>; 2],
}

impl Walk {
    pub(super) fn new(frame: usize, pose: Pose, frames: usize) -> Self {
        let last = (frame + FAR).min(frames.saturating_sub(1));
        Self::between(frame, pose, [frame.saturating_sub(FAR), last])
    }

    /// Up to one frame.
    pub(super) fn up_to(goal: usize, frame: usize, pose: Pose) -> Self {
        Self::between(frame, pose, [frame.min(goal), frame.max(goal)])
    }

    fn between(frame: usize, pose: Pose, to: [usize; 2]) -> Self {
        Self {
            frame,
            pose,
            to,
            ways: None,
            begun: None,
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
            self.begun = Some(found);
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
                    self.ends[side] = Some((frame, found));
                }
                break;
            }
        }
        Ok(())
    }

    /// The first and the last frame in which it was followed.
    pub(super) fn ends(&self) -> Ends {
        self.ends
            .map(|end| end.map(|(frame, found)| (frame, found.pose)))
    }

    /// What it led to in a frame; `None` where the component is lost there.
    pub(super) fn at(&self, goal: usize) -> Option<&FramePose> {
        if goal == self.frame {
            return self.begun();
        }
        let ends = self.ends.iter().flatten();
        ends.filter(|(frame, _)| *frame == goal)
            .map(|(_, found)| found)
            .next()
    }

    pub(super) fn begun(&self) -> Option<&FramePose> {
        self.begun.as_ref()
    }
}
