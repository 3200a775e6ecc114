//! Each component put on the right side of its mirror, over the whole film, in the core's order.

use std::fmt;
use std::hash::{DefaultHasher, Hash as _, Hasher as _};

use anyhow::Result;
use fluoropose::follow::{
    Cell, Crossing, FramePose, KnownFemur, Looked, Rival, SecondLook, Settling, SettlingStep,
    SideMargin, SideSample, elsewhere, look, mirrored_pose,
};
use rayon::prelude::*;

use super::follow::follow;
use super::part::Part;
use super::run::Run;

/// By how much another pose of each frame is less likely; `None` where there is none.
pub(super) type Margins = Vec<Option<SideMargin>>;

/// Brings a component on to where its sides are chosen, which needs no femur; whether they are to be.
pub(super) fn up_to_a_choice(
    run: &Run<'_>,
    part: &Part<'_>,
    settling: &mut Settling,
    cells: &mut [Cell],
) -> Result<bool> {
    while let Some(step) = settling.next(cells) {
        match step {
            SettlingStep::Cross(crossing) => cross(run, part, *crossing, (settling, cells))?,
            SettlingStep::See(rival, frames) => {
                for sample in seen(run, part, cells, (rival, &frames), settling)? {
                    settling.saw(sample);
                }
            }
            SettlingStep::Choose => return Ok(true),
            SettlingStep::GoOver(runs) => {
                for (range, anchor) in runs {
                    follow(run, part, &[anchor], range, cells)?;
                }
            }
            SettlingStep::LookAgain(looks) => look_again(run, part, &looks, cells)?,
        }
    }
    Ok(false)
}

/// Brings a component from there to its right side of the mirror and out of false minima. `femur` is that of a tibia, where
/// it is known.
pub(super) fn settle(
    run: &Run<'_>,
    part: &Part<'_>,
    femur: Option<&KnownFemur>,
    settling: &mut Settling,
    cells: &mut [Cell],
) -> Result<()> {
    loop {
        settling.choose(femur);
        tell(run, part, femur, settling);
        if !up_to_a_choice(run, part, settling, cells)? {
            return Ok(());
        }
    }
}

fn tell(run: &Run<'_>, part: &Part<'_>, femur: Option<&KnownFemur>, settling: &Settling) {
    for (sample, step) in settling.choice() {
        run.debug(|| {
            let seen = sample.evidence(|pose| femur?.knee(sample.frame, pose));
            let (own, other) = (seen.own, seen.mirrored);
            let (name, frame, deg) = (part.name(), seen.frame + 1, seen.apart_deg);
            format!(
                "{name} frame {frame}: own {:.3} px {:?}, {:?} {:.3} px {:?}, {deg:.1} deg apart: {step:?}",
                own.misfit_px, own.knee, seen.rival, other.misfit_px, other.knee
            )
        });
    }
}

/// Follows the frames on one side of a jump from the other side.
fn cross(
    run: &Run<'_>,
    part: &Part<'_>,
    mut crossing: Crossing,
    (settling, cells): (&mut Settling, &mut [Cell]),
) -> Result<()> {
    let middle = part.middle();
    while let Some(frame) = crossing.next() {
        let trail = crossing.way().trail();
        let key = key_of("cross", part, frame, trail);
        let look = || {
            part.see(run.film, frame, |subject, image, memory| {
                look(subject, image, frame, trail, memory)
            })
        };
        let told = "followed from behind a jump";
        let see = || run.step((part, frame), told, &key, look);
        let looked: Looked = settling.over_jump((frame, trail), see)?;
        crossing.saw(frame, looked, (&middle, &part.planes));
    }
    crossing.write(cells);
    Ok(())
}

/// Looks once more at frames that stand out.
fn look_again(
    run: &Run<'_>,
    part: &Part<'_>,
    looks: &[SecondLook],
    cells: &mut [Cell],
) -> Result<()> {
    let one = |look: &SecondLook| -> Result<(usize, Option<FramePose>)> {
        let frame = look.frame;
        let key = key_of("second", part, frame, look);
        let better = run.step((part, frame), "looked at once more", &key, || {
            part.see(run.film, frame, |subject, image, memory| {
                look.run(subject, image, memory)
            })
        })?;
        Ok((frame, better))
    };
    let found: Vec<_> = looks
        .par_iter()
        .with_max_len(1)
        .map(one)
        .collect::<Result<_>>()?;
    for (frame, better) in found {
        if let Some(better) = better {
            run.debug(|| {
                let px = better.misfit_px;
                format!(
                    "{} frame {}: {px:.2} px at a second look",
                    part.name(),
                    frame + 1
                )
            });
            cells[frame].improve(better);
        }
    }
    Ok(())
}

/// Tells some numbers from others.
/// The key of a step that is done more than once in a frame, each time by something else: its text has every digit of what the step goes by. With
/// parts of that a run that was stopped took what had been seen on another way.
fn key_of(what: &str, part: &Part<'_>, frame: usize, by: &impl fmt::Debug) -> String {
    let mut hasher = DefaultHasher::new();
    format!("{by:?}").hash(&mut hasher);
    let (number, phase, by) = (part.number, part.phase(), hasher.finish());
    format!("{what}/{number}/{phase}/{frame}/{by:x}")
}

/// Looks at some frames for another pose.
fn seen(
    run: &Run<'_>,
    part: &Part<'_>,
    cells: &[Cell],
    (rival, frames): (Rival, &[usize]),
    settling: &Settling,
) -> Result<Vec<SideSample>> {
    let (what, told) = match rival {
        Rival::Mirrored => ("mirror", "compared with its mirror image"),
        Rival::Elsewhere => ("elsewhere", "other poses near by"),
    };
    let look = |frame: usize, own: &FramePose, mirrored: Option<&FramePose>| {
        part.see(run.film, frame, |subject, image, memory| match rival {
            Rival::Mirrored => mirrored_pose(subject, image, own, memory),
            Rival::Elsewhere => elsewhere(subject, image, (own, mirrored), memory),
        })
    };
    let known_mirrored = |frame: usize, own: &FramePose| match rival {
        Rival::Mirrored => None,
        Rival::Elsewhere => settling.both_sides_of(frame)?.mirrored_now(own),
    };
    let sample = |&frame: &usize| -> Result<Option<SideSample>> {
        let Some(&own) = cells[frame].found() else {
            return Ok(None);
        };
        let mirrored = known_mirrored(frame, &own);
        let key = key_of(what, part, frame, &(own, mirrored));
        Ok(Some(SideSample {
            frame,
            own,
            rival,
            other: run.step((part, frame), told, &key, || {
                look(frame, &own, mirrored.as_ref())
            })?,
            fixed: cells[frame].fixed,
        }))
    };
    let samples: Vec<Option<SideSample>> = frames
        .par_iter()
        .with_max_len(1)
        .map(sample)
        .collect::<Result<_>>()?;
    Ok(samples.into_iter().flatten().collect())
}
