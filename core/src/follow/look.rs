//! One frame looked at with an expectation: refined from there, and searched around where that is out of the ordinary.

use super::frame_pose::{FramePose, From};
use super::motion::Expected;
use super::near::near_poses;
use super::starts::Starts;
use super::subject::Subject;
use super::trail::{Trail, Usual, apart};
use crate::finder::nearby::about;
use crate::image::blank::{ONE_GREY, is_blank};
use crate::math::{Vector3, radians, scale};
use crate::pose::Pose;
use crate::refine::{ImageTarget, RefineMemory, part_beyond};

/// Ordinary poses have at most this many times the usual misfit and so many pixels more, and at least this part of the
/// usual strength.
const ORDINARY: [f64; 3] = [1.2, 0.08, 0.85];
/// Poses that are believed at all, the same.
const BELIEVED: [f64; 3] = [2.0, 0.3, 0.6];
/// Least step of grey values, in usual ones: less is noise, or another thing.
const LEAST_STEP: f64 = 0.1;
/// Least part of the outline that must be in the frame and not hidden.
const LEAST_KNOWN: f64 = 0.5;
/// Beside an expected pose the way is tried again from so far, degrees out of the plane and part of the distance.
const BESIDE_DEG: f64 = 2.5;
const BESIDE_PART: f64 = 0.015;
/// How far around an expected pose is searched, pixels; and farther with each frame in which nothing was found.
pub(super) const REACH_PX: f64 = 24.0;
const FARTHER_PX: f64 = 6.0;
const FARTHEST_PX: f64 = 72.0;
/// What it costs to be as far from what was expected as is still in the ordinary, in usual misfits.
const OFF: f64 = 0.1;
/// Of the poses around, so many are refined.
pub(super) const REFINED: usize = 4;

/// Why a frame has no pose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Missing {
    /// Too little of the outline lies in the frame where the component is expected.
    Outside,
    /// Where it is expected, and around there, are no edges of it.
    Hidden,
    /// The frame shows nothing at all.
    Blank,
}

/// What came of a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Looked {
    /// The pose, or why there is none.
    pub found: Result<FramePose, Missing>,
    /// Whether it is where it was expected and looks as usual.
    pub ordinary: bool,
    /// Whether poses around the expected one were searched.
    pub searched: bool,
    /// The part of the outline that lies in the frame, at the pose or where it is expected.
    pub known: f64,
}

impl Looked {
    /// A frame that shows nothing at all, where nothing was expected.
    pub const BLANK: Self = Self {
        found: Err(Missing::Blank),
        ordinary: false,
        searched: true,
        known: 0.0,
    };
}

/// Looks at a frame for the component that came along a trail; [`Trail::take`] takes the answer.
#[must_use]
pub fn look(
    subject: &Subject<'_>,
    image: &ImageTarget<'_>,
    frame: usize,
    trail: &Trail,
    memory: &mut RefineMemory<'_>,
) -> Looked {
    let middle = subject.model.bounds().centre;
    let expected = trail.expect(frame, &middle);
    let usual = trail.usual();
    let search = Search {
        subject,
        image,
        expected,
        usual,
        middle,
    };
    search.run(trail.missed(), memory)
}

struct Search<'s> {
    subject: &'s Subject<'s>,
    image: &'s ImageTarget<'s>,
    expected: Expected,
    usual: &'s Usual,
    middle: Vector3,
}

impl Search<'_> {
    fn run(&self, missed: usize, memory: &mut RefineMemory<'_>) -> Looked {
        let Subject { model, camera, .. } = self.subject;
        let known = 1.0 - part_beyond(model, camera, &self.expected.pose);
        if known < LEAST_KNOWN {
            return self.nothing(Missing::Outside, known);
        }
        let start = &self.expected.pose;
        let mut first: Option<FramePose> = None;
        let starts = Starts::new(self.subject, self.image);
        for from in [From::Near, From::Far] {
            if from == From::Far && self.image.film.is_none() {
                break;
            }
            let found = starts.lead((start, from), memory);
            if let Some(found) = found.filter(|found| self.is_ordinary(found)) {
                return Looked {
                    found: Ok(found),
                    ordinary: true,
                    searched: false,
                    known: found.fit.seen(),
                };
            }
            first = self.better(first, found);
        }
        let best = self.around(first, &starts, missed, memory);
        match best.filter(|found| self.is_believed(found)) {
            Some(found) => Looked {
                found: Ok(found),
                ordinary: self.is_ordinary(&found),
                searched: true,
                known: found.fit.seen(),
            },
            None if self.is_blank() => self.nothing(Missing::Blank, known),
            None => self.nothing(Missing::Hidden, known),
        }
    }

    fn nothing(&self, why: Missing, known: f64) -> Looked {
        Looked {
            found: Err(why),
            ordinary: false,
            searched: why != Missing::Outside,
            known,
        }
    }

    /// Steps that are less than an edge of the component has do not count.
    fn is_blank(&self) -> bool {
        is_blank(self.image.frame, ONE_GREY.max(LEAST_STEP * self.usual.step))
    }

    /// The best of what refinement found and of what poses around the expected one lead to.
    fn around(
        &self,
        first: Option<FramePose>,
        starts: &Starts<'_>,
        missed: usize,
        memory: &mut RefineMemory<'_>,
    ) -> Option<FramePose> {
        let reach = self.reach_px(missed);
        let (subject, image, step) = (self.subject, self.image, self.usual.step);
        let expected = &self.expected.pose;
        let near = near_poses(subject, image, expected, reach, step, memory).unwrap_or_default();
        let near = near
            .iter()
            .take(REFINED)
            .map(|(_, pose)| (*pose, From::Far));
        let beside = beside(expected, &self.middle, BESIDE_PART).map(|pose| (pose, From::Near));
        let mut best = first;
        // Where the outline has the strongest edges first: most misses are ways in the image plane.
        for (start, from) in near.chain(beside) {
            let most_px = self.most_px(best.as_ref());
            let found = starts.lead_within(most_px, (&start, from), memory);
            best = self.better(best, found);
        }
        best
    }

    /// How far around the expected pose is searched, pixels: as far as is in the ordinary, and farther where it was missed.
    fn reach_px(&self, missed: usize) -> f64 {
        let [fx, fy] = self.subject.camera.focal();
        let depth = self.expected.pose.transform(&self.middle)[2].abs();
        let ordinary = self.expected.shift_mm * fx.max(fy) / depth.max(1.0);
        (ordinary.max(REACH_PX) + FARTHER_PX * missed as f64).min(FARTHEST_PX)
    }

    /// The one that is more as usual; of two alike, the one nearer to what was expected.
    fn better(&self, one: Option<FramePose>, other: Option<FramePose>) -> Option<FramePose> {
        match (one, other) {
            (Some(one), Some(other)) if self.cost(&other) >= self.cost(&one) => Some(one),
            (one, other) => other.or(one),
        }
    }

    fn cost(&self, found: &FramePose) -> f64 {
        let [turn_deg, shift_mm] = apart(&self.expected.pose, &found.pose, &self.middle);
        let off = turn_deg / self.expected.turn_deg + shift_mm / self.expected.shift_mm;
        self.usual.cost(found) + OFF * off
    }

    /// The misfit above which a pose is worse than the best so far, or not believed, pixels.
    fn most_px(&self, best: Option<&FramePose>) -> f64 {
        let believed = self.most_like(BELIEVED);
        let better = best.map(|best| self.usual.most_px(self.cost(best)));
        better.map_or(believed, |px| px.min(believed))
    }

    fn is_ordinary(&self, found: &FramePose) -> bool {
        let [turn_deg, shift_mm] = apart(&self.expected.pose, &found.pose, &self.middle);
        let depth = |pose: &Pose| pose.transform(&self.middle)[2];
        let deeper = (depth(&found.pose) - depth(&self.expected.pose)).abs();
        let near = turn_deg <= self.expected.turn_deg
            && shift_mm <= self.expected.shift_mm
            && deeper <= self.expected.depth_mm;
        near && self.fits(found, ORDINARY)
    }

    fn is_believed(&self, found: &FramePose) -> bool {
        self.fits(found, BELIEVED)
    }

    fn fits(&self, found: &FramePose, limits @ [.., part]: [f64; 3]) -> bool {
        found.misfit_px <= self.most_like(limits)
            && found.contrast.strength >= part * self.usual.strength
            && found.contrast.step >= LEAST_STEP * self.usual.step
            && found.fit.seen() >= LEAST_KNOWN
    }

    fn most_like(&self, [times, more, _]: [f64; 3]) -> f64 {
        times * self.usual.misfit_px + more
    }
}

/// Poses a little turned out of the image plane, and a little nearer and farther.
pub(super) fn beside(pose: &Pose, middle: &Vector3, part: f64) -> [Pose; 6] {
    let centre = pose.transform(middle);
    let turned = |x: f64, y: f64| about(middle, pose, &[radians(x), radians(y), 0.0], [0.0; 3]);
    let moved = |part: f64| about(middle, pose, &[0.0; 3], scale(&centre, part));
    [
        turned(BESIDE_DEG, 0.0),
        turned(-BESIDE_DEG, 0.0),
        turned(0.0, BESIDE_DEG),
        turned(0.0, -BESIDE_DEG),
        moved(part),
        moved(-part),
    ]
}

#[cfg(all(test, feature = "alloc"))]
mod tests;
