//! Which frames of a component are good, by all that is known of both.

use fluoropose::follow::{
    Cell, Conclusion, FramePose, KnownBeside, KnownFemur, conclude, good_poses, trusted_middles,
};
use fluoropose::joint::beside::Beside;

use super::part::Part;
use super::run::Run;
use super::sides::Margins;
use crate::files::Role;

/// A component's whole film judged, with what is told of its `joint`.
pub(super) fn judged(
    run: &Run<'_>,
    (number, parts): (usize, &[Part<'_>]),
    films: &[Vec<Cell>],
    margins: &[Margins],
    joint: &[Option<Beside>],
) -> Vec<Conclusion> {
    let part = &parts[number];
    let middles = other_of(number, parts).map_or(Vec::new(), |other| {
        trusted_middles(&films[other], &margins[other], &parts[other].middle())
    });
    let femur = femur_of(part, parts, films);
    let known = KnownBeside {
        other_middles: &middles,
        femur: femur.as_ref(),
        joint,
        other_shape: part.other_shape(),
        longest_gap: run.request.interpolate,
    };
    conclude(&films[number], &margins[number], &known, &part.middle())
}

/// The frames in which a component is good as it was followed, with its poses.
pub(super) fn good(
    run: &Run<'_>,
    (number, parts): (usize, &[Part<'_>]),
    films: &[Vec<Cell>],
    margins: &[Margins],
) -> Vec<Option<FramePose>> {
    let judged = judged(run, (number, parts), films, margins, &[]);
    good_poses(&films[number], &judged)
}

/// What of what is told of the `joint` speaks against a component.
pub(super) fn against(
    run: &Run<'_>,
    (number, parts): (usize, &[Part<'_>]),
    films: &[Vec<Cell>],
    margins: &[Margins],
    joint: &[Option<Beside>],
) -> Vec<Option<Beside>> {
    let Some(other) = other_of(number, parts).filter(|_| joint.iter().any(Option::is_some)) else {
        return joint.to_vec();
    };
    let [own, others] = [number, other].map(|at| good(run, (at, parts), films, margins));
    let each = joint.iter().zip(own.iter().zip(&others));
    let left = |(told, (own, other)): (&Option<Beside>, (&Option<_>, &Option<_>))| {
        told.and_then(|told| told.against(own.is_some(), other.is_some()))
    };
    each.map(left).collect()
}

pub(super) fn is_tibia(part: &Part<'_>) -> bool {
    part.role() == Some(Role::Tibia)
}

/// The other component of a component's joint.
pub(super) fn other_of(number: usize, parts: &[Part<'_>]) -> Option<usize> {
    let own = parts[number].role()?;
    parts
        .iter()
        .position(|other| other.role() == Some(own.other()))
}

/// The femur of a tibia, where both components' axes are known.
pub(super) fn femur_of(
    part: &Part<'_>,
    parts: &[Part<'_>],
    films: &[Vec<Cell>],
) -> Option<KnownFemur> {
    let axes = part.axes.filter(|_| is_tibia(part))?;
    let is_femur = |part: &Part<'_>| part.role() == Some(Role::Femur);
    let femur = parts.iter().position(is_femur)?;
    let in_field = parts[femur].axes?;
    let pose = |cell: &Cell| cell.found().map(|found| found.pose.compose(&in_field));
    Some(KnownFemur {
        poses: films[femur].iter().map(pose).collect(),
        axes,
    })
}
