//! What is known of a component in each frame while a film is followed.

use super::frame_pose::{FramePose, From as Refined, frame_pose_at, refined_on_frame};
use super::look::Looked;
use super::subject::Subject;
use super::trail::Usual;
use crate::pose::Pose;
use crate::refine::{ImageTarget, RefineError, RefineMemory};

/// A frame whose pose is known before a component is followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Anchor {
    /// Number of the frame, from 0.
    pub frame: usize,
    /// The pose, and what the frame says of it.
    pub found: FramePose,
    /// Whether a person gave it: it never changes.
    pub fixed: bool,
    /// What is usual of the component's poses, as far as this frame tells.
    pub usual: Usual,
}

impl Anchor {
    /// At a pose that was found.
    #[must_use]
    pub fn found(frame: usize, found: FramePose) -> Self {
        Self {
            frame,
            found,
            fixed: false,
            usual: Usual::of(&found),
        }
    }

    /// The same where frames are read in squares with sides of so many of the pixels that it was found in: the pose is the same, and what is
    /// told in pixels is in fewer.
    #[must_use]
    pub fn in_squares(&self, side: usize) -> Self {
        let Self { found, usual, .. } = *self;
        Self {
            found: found.in_squares(side),
            usual: Usual {
                misfit_px: usual.misfit_px / side.max(1) as f64,
                ..usual
            },
            ..*self
        }
    }

    /// At a pose that a person gave. Hands leave more than refinement does: what is usual is told by the pose that it leads to.
    ///
    /// # Errors
    /// [`RefineError`] where the model cannot be drawn there.
    pub fn fixed(
        subject: &Subject<'_>,
        image: &ImageTarget<'_>,
        (frame, pose): (usize, &Pose),
        memory: &mut RefineMemory<'_>,
    ) -> Result<Self, RefineError> {
        let found = frame_pose_at(subject, image, pose, memory)?;
        let refined = refined_on_frame(subject, image, (pose, Refined::Near), memory).ok();
        Ok(Self {
            frame,
            found,
            fixed: true,
            usual: Usual::of(&better_of(found, refined)),
        })
    }
}

/// What refinement led to from a pose that a person gave, where that leaves less: in what the outline lies off by everywhere, as what remains of
/// the robust loss is bounded where nothing is met.
fn better_of(found: FramePose, refined: Option<FramePose>) -> FramePose {
    let less = refined.filter(|refined| refined.fit.misfit_px < found.fit.misfit_px);
    less.unwrap_or(found)
}

/// What came of a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cell {
    /// None where it was never reached.
    pub looked: Option<Looked>,
    /// Whether a person gave the pose.
    pub fixed: bool,
    /// What the way from the other end came to, where it differs.
    pub other_way: Option<Pose>,
}

impl Cell {
    /// A frame on the way from an anchor.
    #[must_use]
    pub fn on_the_way(looked: Looked) -> Self {
        Self {
            looked: Some(looked),
            ..Self::default()
        }
    }

    /// Takes a better pose of the frame.
    pub fn improve(&mut self, found: FramePose) {
        if let Some(looked) = &mut self.looked {
            looked.known = found.fit.seen();
            looked.found = Ok(found);
            looked.searched = true;
        }
    }

    /// The pose, where one was found or given.
    #[must_use]
    pub fn found(&self) -> Option<&FramePose> {
        self.looked.as_ref()?.found.as_ref().ok()
    }
}

impl From<&Anchor> for Cell {
    fn from(anchor: &Anchor) -> Self {
        Self {
            looked: Some(Looked {
                found: Ok(anchor.found),
                ordinary: true,
                searched: false,
                known: anchor.found.fit.seen(),
            }),
            fixed: anchor.fixed,
            other_way: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::follow::fake::turned;

    /// Edges far off cost the robust loss no more than 1.44 pixels, which a hand may lie off as well.
    #[test]
    fn what_lies_on_no_edges_is_no_better_than_what_a_hand_left() {
        let of = |misfit_px: f64, off_px: f64| {
            let mut pose = turned(0.0, misfit_px);
            pose.fit.misfit_px = off_px;
            pose
        };
        let (hand, astray, right) = (of(1.5, 1.5), of(1.4, 3.6), of(0.3, 0.35));
        assert_eq!(better_of(hand, Some(astray)), hand);
        assert_eq!(better_of(hand, Some(right)), right);
        assert_eq!(better_of(hand, None), hand);
    }
}
