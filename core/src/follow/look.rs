//! One frame looked at with an expectation: refined from there, and searched around where that is out of the ordinary.

use super::frame_pose::{FramePose, From, Subject, refined_on_frame};
use super::motion::Expected;
use super::near::near_poses;
use super::trail::{Trail, Usual, apart};
use crate::math::Vector3;
use crate::pose::Pose;
use crate::refine::{ImageTarget, RefineMemory};

/// Ordinary poses have at most this many times the usual misfit and so many pixels more, and at least this part of the
/// usual strength.
const ORDINARY: [f64; 3] = [1.35, 0.15, 0.85];
/// Poses that are believed at all, the same.
const BELIEVED: [f64; 3] = [2.0, 0.3, 0.6];
/// Least part of the outline that must be in the frame and not hidden.
const LEAST_KNOWN: f64 = 0.5;
/// How far around an expected pose is searched, pixels; and farther with each frame in which nothing was found.
const REACH_PX: f64 = 24.0;
const FARTHER_PX: f64 = 6.0;
const FARTHEST_PX: f64 = 72.0;
/// Of the poses around, so many are refined.
const REFINED: usize = 4;

/// Why a frame has no pose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Missing {
    /// Too little of the outline lies in the frame where the component is expected.
    Outside,
    /// Where it is expected, and around there, are no edges of it.
    Hidden,
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
        let step = self.usual.step;
        let known = in_frame(self.subject, &self.expected.pose);
        if known < LEAST_KNOWN {
            return self.nothing(Missing::Outside, known);
        }
        let start = &self.expected.pose;
        let mut first: Option<FramePose> = None;
        for from in [From::Near, From::Far] {
            let (subject, image) = (self.subject, self.image);
            if from == From::Far && image.film.is_none() {
                break;
            }
            let found = refined_on_frame(subject, image, (start, from), Some(step), memory).ok();
            if let Some(found) = found.filter(|found| self.is_ordinary(found)) {
                return Looked {
                    found: Ok(found),
                    ordinary: true,
                    searched: false,
                    known: found.fit.known,
                };
            }
            first = better(first, found);
        }
        let best = self.around(first, missed, memory);
        match best.filter(|found| self.is_believed(found)) {
            Some(found) => Looked {
                found: Ok(found),
                ordinary: self.is_ordinary(&found),
                searched: true,
                known: found.fit.known,
            },
            None => self.nothing(Missing::Hidden, known),
        }
    }

    fn nothing(&self, why: Missing, known: f64) -> Looked {
        Looked {
            found: Err(why),
            ordinary: false,
            searched: why == Missing::Hidden,
            known,
        }
    }

    /// The best of what refinement found and of what poses around the expected one lead to.
    fn around(
        &self,
        first: Option<FramePose>,
        missed: usize,
        memory: &mut RefineMemory<'_>,
    ) -> Option<FramePose> {
        let reach = (REACH_PX + FARTHER_PX * missed as f64).min(FARTHEST_PX);
        let (subject, image, step) = (self.subject, self.image, self.usual.step);
        let starts = near_poses(subject, image, &self.expected.pose, reach, step, memory);
        let mut best = first;
        for start in starts.unwrap_or_default().iter().take(REFINED) {
            let from = (start, From::Far);
            best = better(best, refined_on_frame(subject, image, from, Some(step), memory).ok());
        }
        best
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

    fn fits(&self, found: &FramePose, [times, more, part]: [f64; 3]) -> bool {
        found.misfit_px <= times * self.usual.misfit_px + more
            && found.contrast.strength >= part * self.usual.strength
            && found.fit.known >= LEAST_KNOWN
    }
}

/// The one with the greater score.
fn better(one: Option<FramePose>, other: Option<FramePose>) -> Option<FramePose> {
    match (one, other) {
        (Some(one), Some(other)) if other.score() <= one.score() => Some(one),
        (one, other) => other.or(one),
    }
}

/// Part of the component's vertices whose image lies in the frame.
fn in_frame(subject: &Subject<'_>, pose: &Pose) -> f64 {
    let (vertices, camera) = (subject.model.vertices(), subject.camera);
    let every = (vertices.len() / 256).max(1);
    let (mut inside, mut all) = (0usize, 0usize);
    for vertex in vertices.iter().step_by(every) {
        all += 1;
        let Some(place) = camera.project(&pose.transform(&vertex.map(f64::from))) else {
            continue;
        };
        let within = |at: f64, side: usize| (0.0..side as f64).contains(&at);
        inside += usize::from(
            within(place.column, camera.width()) && within(place.row, camera.height()),
        );
    }
    inside as f64 / all.max(1) as f64
}
