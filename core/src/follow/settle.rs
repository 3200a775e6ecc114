//! A pose that was found without knowing the film, settled with its constants: the best of what it and those around it lead
//! to.

use super::frame_pose::{FramePose, From};
use super::look::beside;
use super::near::near_poses;
use super::starts::Starts;
use super::subject::Subject;
use super::trail::Usual;
use crate::refine::{ImageTarget, RefineMemory};

/// How far around the pose is looked, pixels, and how far along the view, parts of the distance: a false edge beside a true one
/// makes a part of the wrong size.
const NEAR_PX: f64 = 12.0;
const PARTS: [f64; 3] = [0.015, 0.03, 0.045];

/// The best of what a pose and those around it lead to, by misfit and by the strength of edges together. The pose itself where
/// nothing leads anywhere.
#[must_use]
pub fn settled(
    subject: &Subject<'_>,
    image: &ImageTarget<'_>,
    found: &FramePose,
    memory: &mut RefineMemory<'_>,
) -> FramePose {
    let middle = subject.model.bounds().centre;
    let step = found.contrast.step;
    let usual = Usual::of(found);
    let near = near_poses(subject, image, &found.pose, NEAR_PX, step, memory).unwrap_or_default();
    let far = near.iter().map(|&(_, pose)| (pose, From::Far));
    let around = PARTS
        .into_iter()
        .flat_map(|part| beside(&found.pose, &middle, part))
        .map(|pose| (pose, From::Near));
    let own = core::iter::once((found.pose, From::Near));
    let starts = Starts::new(subject, image);
    let mut best: Option<FramePose> = None;
    for (start, from) in own.chain(around).chain(far) {
        let most_px = best.map_or(f64::INFINITY, |best| usual.most_px(usual.cost(&best)));
        let one = starts.lead_within(most_px, (&start, from), memory);
        let better = |one: &FramePose| best.is_none_or(|best| usual.cost(one) < usual.cost(&best));
        best = one.filter(better).or(best);
    }
    best.unwrap_or(*found)
}
