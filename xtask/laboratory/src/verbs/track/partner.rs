//! What clicks led to, compared with where the joint leaves a component beside another one.

use anyhow::Result;
use fluoropose::follow::{Anchor, FramePose};

use super::part::Part;
use super::request::Click;
use super::run::Run;
use super::search::{Beside, in_joint};

/// What a joint leaves takes the place of what a click led to where its score is so many times as high.
const SURER: f64 = 1.1;
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
        pose: from.found.pose,
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
