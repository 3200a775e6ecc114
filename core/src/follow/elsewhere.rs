//! Poses of a frame that are neither the one on the trail nor its mirror image.
//!
//! An outline may fit a second time some degrees beside the right pose, and a way that slides into such a minimum stays in it:
//! step by step nothing is out of the ordinary, and the mirror image of a false pose is as false. So frames are also looked at
//! from starts turned out of the image plane to all sides. What those lead to says nothing in one frame, but over a film the
//! right pose leaves less.

use heapless::Vec;

use super::frame_pose::{FramePose, From, probed, refined_on_frame};
use super::subject::Subject;
use crate::finder::nearby::about;
use crate::math::{Vector3, radians, sin_cos};
use crate::pose::{Pose, geodesic_deg};
use crate::refine::{ImageTarget, RefineMemory};

/// Starts are turned by so many degrees about axes in the image plane, to so many sides.
const TURN_DEG: f64 = 9.0;
const SIDES: usize = 6;
/// Poses nearer to each other than this are one, degrees; on their way they may be farther off.
const SAME_DEG: f64 = 2.0;
/// Least strength of the edges, in that of the pose on the trail.
const LEAST_STRENGTH: f64 = 0.85;
/// Poses that are known or were found.
const SEEN: usize = SIDES + 2;

/// The pose that leaves least of those that starts beside a frame's pose lead to, apart from that and from its mirror image;
/// `None` where all lead back, or nowhere.
#[must_use]
pub fn elsewhere(
    subject: &Subject<'_>,
    image: &ImageTarget<'_>,
    (own, mirrored): (&FramePose, Option<&FramePose>),
    memory: &mut RefineMemory<'_>,
) -> Option<FramePose> {
    let middle = subject.model.bounds().centre;
    let mut seen: Vec<Pose, SEEN> = core::iter::once(own)
        .chain(mirrored)
        .map(|known| known.pose)
        .collect();
    let mut best: Option<FramePose> = None;
    for start in starts(&own.pose, &middle) {
        let Ok(near) = probed(subject, image, &start, memory) else {
            continue;
        };
        if seen.iter().any(|one| are_one(one, &near)) {
            continue;
        }
        // There is room for each.
        let _ = seen.push(near);
        let Ok(found) = refined_on_frame(subject, image, (&near, From::Near), memory) else {
            continue;
        };
        let known = core::iter::once(own).chain(mirrored);
        let back = known.into_iter().any(|one| are_one(&one.pose, &found.pose));
        let strong = found.contrast.strength >= LEAST_STRENGTH * own.contrast.strength;
        let less = best.is_none_or(|best| found.misfit_px < best.misfit_px);
        if strong && less && !back {
            best = Some(found);
        }
    }
    best
}

fn are_one(one: &Pose, other: &Pose) -> bool {
    geodesic_deg(&one.rotation, &other.rotation) < SAME_DEG
}

fn starts(pose: &Pose, middle: &Vector3) -> impl Iterator<Item = Pose> {
    (0..SIDES).map(move |side| {
        let (sin, cos) = sin_cos(core::f64::consts::TAU * side as f64 / SIDES as f64);
        let turn = radians(TURN_DEG);
        about(middle, pose, &[turn * cos, turn * sin, 0.0], [0.0; 3])
    })
}
