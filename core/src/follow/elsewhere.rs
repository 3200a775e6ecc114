//! Poses of a frame that are neither the one on the trail nor its mirror image.
//!
//! An outline may fit a second time some degrees beside the right pose, and a way that slides into such a minimum stays in it:
//! step by step nothing is out of the ordinary, and the mirror image of a false pose is as false. So frames are also looked at
//! from starts turned out of the image plane to all sides. What those lead to says nothing in one frame, but over a film the
//! right pose leaves less.

use heapless::Vec;

use super::frame_pose::{FramePose, From, probed};
use super::sides::ELSEWHERE_RATIO;
use super::starts::Starts;
use super::subject::Subject;
use super::valley::along_valley;
use crate::finder::nearby::about;
use crate::math::{Vector3, radians, sin_cos};
use crate::pose::{Pose, geodesic_deg};
use crate::refine::{ImageTarget, RefineMemory};
use crate::shortlist::keep;

/// Starts are turned by so many degrees about axes in the image plane, to so many sides.
const TURN_DEG: f64 = 9.0;
const SIDES: usize = 6;
/// Poses nearer to each other than this are one, degrees; on their way they may be farther off.
const SAME_DEG: f64 = 2.0;
/// Least strength of the edges, in that of the pose on the trail.
const LEAST_STRENGTH: f64 = 0.85;
/// So many of the poses that starts lead to on the first look are looked at closely.
const REFINED: usize = 2;
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
    let known = || core::iter::once(own).chain(mirrored);
    let mut best: Option<FramePose> = None;
    let around = near_elsewhere(subject, image, known().map(|known| &known.pose), memory);
    let valley = along_valley(own.known(), &subject.model.bounds().centre);
    let mut starts = Starts::new(subject, image).knowing(&[own.pose]);
    if let Some(mirrored) = mirrored {
        starts = starts.knowing(&[mirrored.pose]);
    }
    for near in around.into_iter().chain(valley) {
        let most_px = best.map_or(f64::INFINITY, |best| best.misfit_px);
        let Some(found) = starts.lead_within(most_px, (&near, From::Near), memory) else {
            continue;
        };
        let back = known().any(|one| {
            let leaves_less = ELSEWHERE_RATIO * found.misfit_px < one.misfit_px;
            are_one(&one.pose, &found.pose) && !leaves_less
        });
        let strong = found.contrast.strength >= LEAST_STRENGTH * own.contrast.strength;
        let less = best.is_none_or(|best| found.misfit_px < best.misfit_px);
        if strong && less && !back {
            best = Some(found);
        }
    }
    best
}

/// Where the pose leads that another way through the film came to; `None` where that is the frame's own.
#[cfg(feature = "alloc")]
#[must_use]
pub(super) fn from_other_way(
    subject: &Subject<'_>,
    image: &ImageTarget<'_>,
    (own, other): (&FramePose, &Pose),
    memory: &mut RefineMemory<'_>,
) -> Option<FramePose> {
    let starts = Starts::new(subject, image).knowing(&[own.pose]);
    let found = starts.lead((other, From::Near), memory)?;
    (!are_one(&found.pose, &own.pose)).then_some(found)
}

/// Where starts beside the first of the known poses come on the first look, apart from all of them: those that leave least there.
fn near_elsewhere<'p>(
    subject: &Subject<'_>,
    image: &ImageTarget<'_>,
    known: impl Iterator<Item = &'p Pose>,
    memory: &mut RefineMemory<'_>,
) -> Vec<Pose, REFINED> {
    let middle = subject.model.bounds().centre;
    let mut seen: Vec<Pose, SEEN> = known.copied().collect();
    let mut least: Vec<(f64, Pose), REFINED> = Vec::new();
    let own = seen.first().copied();
    for start in own.iter().flat_map(|own| starts(own, &middle)) {
        let Ok(near) = probed(subject, image, &start, memory) else {
            continue;
        };
        if seen.iter().any(|one| are_one(one, &near.pose)) {
            continue;
        }
        // There is room for each.
        let _ = seen.push(near.pose);
        keep(&mut least, (near.loss, near.pose), |one| one.0);
    }
    least.into_iter().map(|(_, pose)| pose).collect()
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::follow::fake::turned;
    use crate::math::{degrees, multiply, norm, rotation_by, rotation_vector, subtract, transpose};

    #[test]
    fn starts_are_turned_alike_to_all_sides_out_of_the_image_plane_about_the_middle() {
        let mut pose = turned(20.0, 0.3).pose;
        pose.rotation = multiply(&rotation_by(&[0.3, 0.0, -0.8]), &pose.rotation);
        let middle = [7.0, -4.0, 11.0];
        let starts: std::vec::Vec<Pose> = starts(&pose, &middle).collect();
        let turns: std::vec::Vec<Vector3> = (starts.iter())
            .map(|start| {
                let off = subtract(&start.transform(&middle), &pose.transform(&middle));
                assert!(norm(&off) < 1e-9, "{off:?}");
                let turn = multiply(&start.rotation, &transpose(&pose.rotation));
                rotation_vector(&turn).map(degrees)
            })
            .collect();
        assert_eq!(turns.len(), 6);
        for (k, turn) in turns.iter().enumerate() {
            // A regular hexagon: its sides are as long as its radius.
            let aside = norm(&subtract(turn, &turns[(k + 1) % 6]));
            let across = norm(&subtract(turn, &turns[(k + 3) % 6]));
            assert!(
                turn[2].abs() < 1e-9 && (norm(turn) - 9.0).abs() < 1e-9,
                "{turn:?}"
            );
            assert!((aside - 9.0).abs() < 1e-9 && (across - 18.0).abs() < 1e-9);
        }
        let apart = |deg: f64| {
            are_one(
                &pose,
                &about(&middle, &pose, &[radians(deg), 0.0, 0.0], [5.0; 3]),
            )
        };
        assert!(apart(1.99) && apart(-1.99) && !apart(2.01));
    }
}
