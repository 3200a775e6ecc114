//! A component on its way from an anchor, frame by frame in one direction.

use super::cell::Anchor;
use super::look::Looked;
use super::trail::Trail;
use crate::math::Vector3;

/// A way ends after so many frames without a pose: whole frames are to be searched from there on.
const GIVE_UP: usize = 12;

/// A way from an anchor. Whoever drives it asks for the [`Way::next`] frame, looks at it ([`super::look`]), and gives what came
/// of that to [`Way::take`].
#[derive(Clone, Debug)]
pub struct Way {
    trail: Trail,
    at: usize,
    forward: bool,
}

impl Way {
    /// From an anchor to later frames, or to earlier ones.
    #[must_use]
    pub fn begin(from: &Anchor, forward: bool) -> Self {
        Self {
            trail: Trail::begin(from.frame, &from.found.pose, from.usual),
            at: from.frame,
            forward,
        }
    }

    /// The frame that is to be looked at on the way to `to`; `None` where the way has come there, or is given up.
    #[must_use]
    pub fn next(&self, to: usize) -> Option<usize> {
        if self.trail.missed() >= GIVE_UP {
            return None;
        }
        match self.forward {
            true => (self.at < to).then(|| self.at + 1),
            false => (self.at > to).then(|| self.at - 1),
        }
    }

    /// What is known of the component on the way so far.
    #[must_use]
    pub fn trail(&self) -> &Trail {
        &self.trail
    }

    /// The last frame that was looked at; before that, the anchor's.
    #[must_use]
    pub fn at(&self) -> usize {
        self.at
    }

    /// Takes what came of a frame. `middle` is the model's.
    pub fn take(&mut self, frame: usize, looked: &Looked, middle: &Vector3) {
        self.at = frame;
        let found = looked.found.as_ref().ok();
        self.trail.take(frame, found, looked.ordinary, middle);
    }
}
