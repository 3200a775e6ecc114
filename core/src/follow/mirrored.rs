//! The other side of a pose's mirror in a frame.

use super::frame_pose::{FramePose, From};
use super::starts::Starts;
use super::subject::Subject;
use super::valley::along_valley;
use crate::mesh::mirror::mirror_pose;
use crate::pose::geodesic_deg;
use crate::refine::{ImageTarget, RefineMemory};

/// Mirror images nearer to their pose than this are the same pose, degrees.
const SAME_DEG: f64 = 1.0;

/// The best of the poses that the mirror images of a pose lead to; `None` where they lead back to it or nowhere.
#[must_use]
pub fn mirrored_pose(
    subject: &Subject<'_>,
    image: &ImageTarget<'_>,
    own: &FramePose,
    memory: &mut RefineMemory<'_>,
) -> Option<FramePose> {
    let starts = Starts::new(subject, image).knowing(&[own.pose]);
    let mut best: Option<FramePose> = None;
    for plane in subject.planes {
        let start = mirror_pose(&own.pose, plane);
        let Some(found) = starts.lead((&start, From::Far), memory) else {
            continue;
        };
        let apart = geodesic_deg(&found.pose.rotation, &own.pose.rotation) > SAME_DEG;
        if apart && best.is_none_or(|best| found.score() > best.score()) {
            best = Some(found);
        }
    }
    best.map(|best| least_along_valley(subject, &starts, (&best, own), memory))
}

/// The pose that leaves least of one and of what starts along what the frame tells least of lead to, but for those that lead to `other`.
fn least_along_valley(
    subject: &Subject<'_>,
    starts: &Starts<'_>,
    (one, other): (&FramePose, &FramePose),
    memory: &mut RefineMemory<'_>,
) -> FramePose {
    let mut least = *one;
    for start in along_valley(one.known(), &subject.model.bounds().centre) {
        let found = starts.lead_within(least.misfit_px, (&start, From::Near), memory);
        let off = |found: &FramePose| geodesic_deg(&found.pose.rotation, &other.pose.rotation);
        if let Some(found) = found.filter(|found| off(found) > SAME_DEG) {
            least = found;
        }
    }
    least
}
