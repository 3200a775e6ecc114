//! Frames whose pose is known before a component is followed: fixed by a person, clicked into, or found.

use anyhow::{Context, Result, ensure};
use fluoropose::follow::{
    Anchor, Cell, FramePose, Places, RunsToSearch, leads_by_itself, set_aside, settled,
};
use fluoropose::pose::Pose;

use super::clicks::Doubtful;
use super::follow::{follow, mark};
use super::part::Part;
use super::request::{Click, Told};
use super::run::Run;
use super::search::{Beside, clicked, in_joint, searched};
use super::table::TABLE;

/// The frames whose pose a person fixed.
pub(super) fn fixed_poses(run: &Run<'_>, part: &Part<'_>) -> Vec<(usize, Pose)> {
    let mut fixed_poses = Vec::new();
    for fixed in run
        .request
        .fixed
        .iter()
        .filter(|one| one.component == part.name())
    {
        let poses = fixed.poses.iter().enumerate();
        fixed_poses.extend(poses.filter_map(|(frame, pose)| Some((frame, (*pose)?))));
    }
    fixed_poses
}

/// The frames that a person gave: fixed poses, and what clicks lead to, each with what is known of other components in its frame, in the
/// order of frames; and the clicks whose poses do not convince.
pub(super) fn given(
    run: &Run<'_>,
    part: &Part<'_>,
    others: &[(&Part<'_>, &[Anchor])],
) -> Result<(Vec<Anchor>, Vec<Doubtful>)> {
    let (mut anchors, mut doubtful) = (Vec::new(), Vec::new());
    for (frame, pose) in fixed_poses(run, part) {
        anchors.push(of_person(run, part, frame, &pose)?);
    }
    for click in run
        .request
        .clicks
        .iter()
        .filter(|one| one.component == part.name())
    {
        if anchors
            .iter()
            .any(|anchor: &Anchor| anchor.frame == click.frame)
        {
            let told = format!("{}: left out, as its frame is known already", click.called);
            (run.request.listener)(Told::Remark(told));
            continue;
        }
        let beside = Beside::in_frame(click.frame, others);
        match clicked(run, part, click.frame, click.place, beside)? {
            Some(found) if leads_by_itself(&found) => {
                anchors.push(Anchor::found(click.frame, found));
            }
            Some(found) => doubtful.push(Doubtful {
                click: click.clone(),
                found,
            }),
            None => tell_vain(run, click)?,
        }
    }
    anchors.sort_by_key(|anchor| anchor.frame);
    Ok((anchors, doubtful))
}

/// Tells of a click that leads to no pose. Results that are there already are better than what is found without it.
///
/// # Errors
/// Where there are such.
fn tell_vain(run: &Run<'_>, click: &Click) -> Result<()> {
    let told = format!("{}: the click leads to no pose", click.called);
    let out = &run.request.out;
    ensure!(
        !out.join(TABLE).exists(),
        "{told}; what {} holds stays as it was",
        out.display()
    );
    (run.request.listener)(Told::Remark(told));
    Ok(())
}

fn of_person(run: &Run<'_>, part: &Part<'_>, frame: usize, pose: &Pose) -> Result<Anchor> {
    let anchor = part.see(run.film, frame, |subject, image, memory| {
        Anchor::fixed(subject, image, (frame, pose), memory)
    })?;
    anchor.with_context(|| format!("the pose of frame {}", frame + 1))
}

/// The same frames looked at again, now that the film's constants are known: the best of what the pose and those near it
/// lead to.
pub(super) fn again(run: &Run<'_>, part: &Part<'_>, anchors: &[Anchor]) -> Result<Vec<Anchor>> {
    let one = |anchor: &Anchor| -> Result<Anchor> {
        if part.film().is_none() {
            return Ok(*anchor);
        }
        let (frame, pose) = (anchor.frame, anchor.found.pose);
        if anchor.fixed {
            return of_person(run, part, frame, &pose);
        }
        let key = format!("again/{}/{}/{}", part.number, part.phase(), mark(anchor));
        let found: Option<FramePose> = run.step(
            (part, frame),
            "looked at with the film's constants",
            &key,
            || {
                part.see(run.film, frame, |subject, image, memory| {
                    Some(settled(subject, image, &anchor.found, memory))
                })
            },
        )?;
        Ok(Anchor::found(frame, found.unwrap_or(anchor.found)))
    };
    anchors.iter().map(one).collect()
}

/// Looks for a component in runs of frames in which it was not found, or lies on other edges by where it is `good`, and the other one of its joint is
/// known: where the joint leaves it beside that.
pub(super) fn fill_in_joint(
    run: &Run<'_>,
    (part, good, cells): (&Part<'_>, &[Option<FramePose>], &mut Vec<Cell>),
    (other, known): (&Part<'_>, &[Option<FramePose>]),
) -> Result<()> {
    let mut runs = RunsToSearch::default();
    let all = 0..cells.len();
    loop {
        *cells = set_aside(cells, good);
        let Some((frame, gap)) = runs.next_beside(cells, known, &all) else {
            return Ok(());
        };
        let Some(beside) = known[frame] else {
            return Ok(());
        };
        let beside = Beside {
            part: other,
            from: &Anchor::found(frame, beside),
            pose: beside.pose,
        };
        let found = in_joint(run, part, frame, beside)?;
        runs.searched(frame, &gap, found.is_some());
        if let Some(found) = found {
            follow(run, part, &[Anchor::found(frame, found)], gap, cells)?;
        }
    }
}

/// Looks for a component in runs of frames in which it was not found, and follows it from where it is.
pub(super) fn fill(run: &Run<'_>, part: &Part<'_>, cells: &mut [Cell]) -> Result<()> {
    let Some(known) = cells.iter().find_map(Cell::found) else {
        // It was searched in vain.
        return Ok(());
    };
    let depth = Some(part.depth_of(&known.pose));
    let mut runs = RunsToSearch::default();
    while let Some((frame, gap)) = runs.next(cells, &(0..cells.len())) {
        let found = searched(run, part, frame, (depth, Places::All), None)?;
        runs.searched(frame, &gap, found.is_some());
        if let Some(found) = found {
            let anchor = Anchor::found(frame, found);
            follow(run, part, &[anchor], gap, cells)?;
        }
    }
    Ok(())
}
