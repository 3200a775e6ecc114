//! The way of a component from frame to frame in one direction: what it did last, and what is usual of it.

use heapless::Deque;

use super::frame_pose::FramePose;
use super::motion::{Expected, Known, between};
use crate::math::{Vector3, norm, subtract};
use crate::pose::{Pose, geodesic_deg};

/// What is expected of the first frame beside a pose, whose motion is not known: degrees, mm.
const FIRST: [f64; 2] = [8.0, 15.0];
/// So many times the usual error of what was expected is in the ordinary, but never less than this: degrees, mm.
const TIMES: f64 = 4.0;
const LEAST: [f64; 2] = [2.0, 3.0];
/// Errors that are remembered.
const ERRORS: usize = 8;
/// In the ordinary along the view: this part of the distance.
const DEPTH: f64 = 0.03;
/// Motion is continued so many frames beyond the last; then the component is expected to rest.
const GOES_ON: usize = 2;
/// A trail is lost after so many frames without a pose.
const PATIENCE: usize = 3;
/// A misfit below this says nothing, pixels.
const LEAST_MISFIT_PX: f64 = 0.1;
/// What it costs to have no edges at all, in usual misfits, and the part that may be lacking for nothing.
const LACKING: f64 = 8.0;
const LACKING_FREE: f64 = 0.15;
/// How fast what is usual follows what was seen.
const LEARNING: f64 = 0.2;

/// What is usual of a component's poses in the frames so far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Usual {
    /// What remains between outline and edges, pixels.
    pub misfit_px: f64,
    /// Step of grey values along the outline.
    pub step: f64,
    /// Part of that step all along the outline.
    pub strength: f64,
}

impl Usual {
    /// What one pose says.
    #[must_use]
    pub fn of(pose: &FramePose) -> Self {
        Self {
            misfit_px: pose.misfit_px,
            step: pose.contrast.step,
            strength: pose.contrast.strength,
        }
    }

    /// How much worse a pose is than usual, the least for the best: by its misfit in usual ones, and by what it lacks of the
    /// usual strength.
    #[must_use]
    pub fn cost(&self, pose: &FramePose) -> f64 {
        let lacking = 1.0 - pose.contrast.strength / self.strength.max(f64::MIN_POSITIVE);
        let misfit = pose.misfit_px / (self.misfit_px + LEAST_MISFIT_PX);
        misfit + LACKING * (lacking - LACKING_FREE).max(0.0)
    }

    /// The misfit above which every pose costs more than this, pixels.
    pub(super) fn most_px(&self, cost: f64) -> f64 {
        cost * (self.misfit_px + LEAST_MISFIT_PX)
    }

    fn learn(&mut self, pose: &FramePose) {
        let seen = Self::of(pose);
        let towards = |usual: &mut f64, seen: f64| *usual += LEARNING * (seen - *usual);
        towards(&mut self.misfit_px, seen.misfit_px);
        towards(&mut self.step, seen.step);
        towards(&mut self.strength, seen.strength);
    }
}

/// The way of a component through a film in one direction.
#[derive(Clone, Debug, PartialEq)]
pub struct Trail {
    last: Known,
    before: Option<Known>,
    /// How far poses were from those expected: degrees, mm.
    errors: Deque<[f64; 2], ERRORS>,
    usual: Usual,
    missed: usize,
}

impl Trail {
    /// Begins at a frame whose pose is known.
    #[must_use]
    pub fn begin(frame: usize, pose: &Pose, usual: Usual) -> Self {
        Self {
            last: Known { frame, pose: *pose },
            before: None,
            errors: Deque::new(),
            usual,
            missed: 0,
        }
    }

    /// What is usual so far.
    #[must_use]
    pub fn usual(&self) -> &Usual {
        &self.usual
    }

    /// Where the motion so far leads to in a frame. `middle` is the model's.
    #[must_use]
    pub fn expect(&self, frame: usize, middle: &Vector3) -> Expected {
        let away = frame.abs_diff(self.last.frame);
        let pose = match self.before {
            None => self.last.pose,
            Some(before) => {
                let lag = self.last.frame.abs_diff(before.frame).max(1);
                let on = away.min(GOES_ON) as f64 / lag as f64;
                between(&before.pose, &self.last.pose, 1.0 + on, middle)
            }
        };
        let [turn_deg, shift_mm] = core::array::from_fn(|k| self.in_the_ordinary(k, away));
        Expected {
            pose,
            turn_deg,
            shift_mm,
            depth_mm: DEPTH * pose.transform(middle)[2].abs(),
        }
    }

    fn in_the_ordinary(&self, which: usize, away: usize) -> f64 {
        let mut errors: heapless::Vec<f64, ERRORS> =
            self.errors.iter().map(|error| error[which]).collect();
        errors.sort_unstable_by(f64::total_cmp);
        let first = if self.before.is_none() {
            FIRST[which]
        } else {
            0.0
        };
        let median = errors.get(errors.len() / 2).copied().unwrap_or(0.0);
        (TIMES * median).max(LEAST[which]).max(first) * away.max(1) as f64
    }

    /// Takes what was found in a frame, `None` where nothing was. `ordinary` tells whether what is usual may learn from it.
    pub fn take(
        &mut self,
        frame: usize,
        found: Option<&FramePose>,
        ordinary: bool,
        middle: &Vector3,
    ) {
        let Some(found) = found else {
            self.missed += 1;
            return;
        };
        let expected = self.expect(frame, middle);
        if self.errors.is_full() {
            self.errors.pop_front();
        }
        // There is room.
        let _ = self
            .errors
            .push_back(apart(&expected.pose, &found.pose, middle));
        // A long gap tells nothing of the motion beside it.
        let near = frame.abs_diff(self.last.frame) <= PATIENCE;
        self.before = near.then_some(self.last);
        self.last = Known {
            frame,
            pose: found.pose,
        };
        if ordinary {
            self.usual.learn(found);
        }
        self.missed = 0;
    }

    /// Frames without a pose since the last.
    #[must_use]
    pub fn missed(&self) -> usize {
        self.missed
    }

    /// Whether the component is lost: it is to be searched in more than the neighbourhood of where it was.
    #[must_use]
    pub fn is_lost(&self) -> bool {
        self.missed >= PATIENCE
    }
}

/// Turn (degrees) and way of the model's middle in the image plane (mm) from one pose to another.
pub(super) fn apart(a: &Pose, b: &Pose, middle: &Vector3) -> [f64; 2] {
    let way = in_plane(&a.transform(middle), &b.transform(middle));
    [geodesic_deg(&a.rotation, &b.rotation), norm(&way)]
}

/// The way from one point of the camera's frame to another along the image plane, mm: seen at one distance, so that an error of depth is
/// none of it.
pub(super) fn in_plane(from: &Vector3, to: &Vector3) -> Vector3 {
    let away = if to[2] == 0.0 { 1.0 } else { from[2] / to[2] };
    subtract(&[to[0] * away, to[1] * away, 0.0], &[from[0], from[1], 0.0])
}

#[cfg(test)]
mod tests;
