//! Frames whose pose is known before a component is followed because another component's is: where their joint leaves it, and where the
//! other one does not hide it.

use anyhow::Result;
use fluoropose::follow::{Anchor, FramePose};
use fluoropose::pose::Pose;

use super::follow::beside;
use super::part::Part;
use super::request::Click;
use super::run::Run;
use super::search::{Beside, in_joint, searched};

/// Frames that are searched beside another component's anchor lie so far from it at most.
const FAR: usize = 6;
/// So many anchors of another component lead to one that is missing.
const LED: usize = 3;
/// What a joint leaves takes the place of what a click led to where its score is so many times as high.
const SURER: f64 = 1.1;
/// Where a pose has such a score others are not looked for.
const ENOUGH: f64 = 0.55;

/// Looks for a component where its joint leaves it beside another one, in the frames of that one's anchors and near them: where it shows
/// best.
pub(super) fn begin_in_joint(
    run: &Run<'_>,
    part: &Part<'_>,
    others: &[(&Part<'_>, &[Anchor])],
) -> Result<Vec<Anchor>> {
    let mut best: Option<Anchor> = None;
    for &(other, anchors) in others.iter().filter(|(other, _)| other.limb.is_some()) {
        for from in anchors.iter().take(LED) {
            for (frame, pose) in known_beside(run, other, from)? {
                if best.is_some_and(|best| best.found.score() >= ENOUGH) {
                    break;
                }
                let seen = Beside {
                    part: other,
                    from,
                    pose: &pose,
                };
                let found = in_joint(run, part, frame, seen)?;
                let better =
                    |one: &FramePose| best.is_none_or(|best| one.score() > best.found.score());
                if let Some(found) = found.filter(better) {
                    best = Some(Anchor::found(frame, found));
                }
            }
        }
    }
    if let Some(best) = &best {
        run.say(format!(
            "{}: found in frame {}, by its joint",
            part.name(),
            best.frame + 1
        ));
    }
    Ok(best.into_iter().collect())
}

/// What clicks led to, each compared with what its joint leaves in that frame beside another component that is known there: a click into a
/// faint tray may take what surrounds it. What was clicked must lie on it.
pub(super) fn or_in_joint(
    run: &Run<'_>,
    part: &Part<'_>,
    anchors: &[Anchor],
    others: &[(&Part<'_>, &[Anchor])],
) -> Result<Vec<Anchor>> {
    let each = anchors.iter();
    each.map(|anchor| one_or_in_joint(run, part, anchor, others))
        .collect()
}

fn one_or_in_joint(
    run: &Run<'_>,
    part: &Part<'_>,
    anchor: &Anchor,
    others: &[(&Part<'_>, &[Anchor])],
) -> Result<Anchor> {
    let known = others
        .iter()
        .filter(|(other, _)| other.number != part.number);
    let mut known = known.flat_map(|&(other, own)| own.iter().map(move |from| (other, from)));
    let beside = known.find(|(_, from)| from.frame == anchor.frame);
    let (Some((other, from)), Some([column, row]), false) =
        (beside, clicked_at(run, part, anchor.frame), anchor.fixed)
    else {
        return Ok(*anchor);
    };
    let seen = Beside {
        part: other,
        from,
        pose: &from.found.pose,
    };
    let surer = |found: &FramePose| found.score() > SURER * anchor.found.score();
    match in_joint(run, part, anchor.frame, seen)?.filter(surer) {
        Some(found) if part.silhouette(&found.pose)?.mask().get(column, row) => {
            Ok(Anchor::found(anchor.frame, found))
        }
        _ => Ok(*anchor),
    }
}

/// The pixel of a component that a person clicked into in a frame.
fn clicked_at(run: &Run<'_>, part: &Part<'_>, frame: usize) -> Option<[usize; 2]> {
    let is_there = |click: &&Click| click.frame == frame && click.component == part.name();
    let click = run.request.clicks.iter().find(is_there)?;
    Some(click.place.map(|place| place.max(0.0) as usize))
}

/// The frames in which a component is looked for beside another one's anchor, that frame first, with the other one's pose.
fn known_beside(run: &Run<'_>, other: &Part<'_>, from: &Anchor) -> Result<Vec<(usize, Pose)>> {
    let mut known = vec![(from.frame, from.found.pose)];
    let all = beside(run, other, from, FAR)?;
    let ends = [all.first(), all.last()].into_iter().flatten();
    known.extend(ends.filter(|(frame, _)| *frame != from.frame));
    Ok(known)
}

/// Looks for a component that was not found once more, beside another one: what is the other's is left out of sight.
pub(super) fn begin_beside(
    run: &Run<'_>,
    part: &Part<'_>,
    others: &[(&Part<'_>, &[Anchor])],
) -> Result<Vec<Anchor>> {
    for &(other, anchors) in others {
        for from in anchors {
            for (frame, pose) in known_beside(run, other, from)? {
                let seen = Beside {
                    part: other,
                    from,
                    pose: &pose,
                };
                let depth = Some(other.depth_of(&pose));
                let (name, other) = (part.name(), other.name());
                let place = format!("beside the {other} in frame {}", frame + 1);
                run.say(format!("{name}: looked for {place}"));
                if let Some(found) = searched(run, part, frame, depth, Some(seen))? {
                    run.say(format!("{name}: found {place}"));
                    return Ok(vec![Anchor::found(frame, found)]);
                }
            }
        }
    }
    run.say(format!(
        "{}: no frame that was searched has edges all along its outline from any side; click into it, or fix a pose",
        part.name()
    ));
    Ok(Vec::new())
}
