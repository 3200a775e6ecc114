//! Each component put on the right side of its mirror, over the whole film.

use anyhow::Result;
use fluoropose::follow::{
    Anchor, Cell, Crossing, FramePose, KnownFemur, Looked, ROUNDS, Rival, SecondLook, SideEvidence,
    SideMargin, SideSample, SideStep, choose_sides, elsewhere, frames_for_sides,
    frames_to_cross_from, leaves_less, look, mirrored_pose, other_margins, runs_elsewhere,
    runs_to_go_over, second_looks,
};
use rayon::prelude::*;

use super::follow::follow;
use super::part::Part;
use super::record::Record;
use super::run::Run;

/// By how much another pose of each frame is less likely; `None` where there is none.
pub(super) type Margins = Vec<Option<SideMargin>>;

/// Brings a component to its right side of the mirror and out of false minima. `femur` is that of a tibia, where
/// it is known.
pub(super) fn settle(
    run: &Run<'_>,
    part: &Part<'_>,
    femur: Option<&KnownFemur>,
    cells: &mut [Cell],
) -> Result<Margins> {
    let mut rounds = ROUNDS;
    // Of a way that lies in small minima its frames say little of the sides.
    cross_jumps(run, part, cells)?;
    run.say(format!("{}: other poses are looked at", part.name()));
    loop {
        let (samples, steps) = choose(run, part, femur, cells)?;
        let beside = seen_elsewhere(run, part, &samples, cells)?;
        if rounds > 0 && leave_false_minima(run, part, &beside, cells)? {
            rounds -= 1;
            continue;
        }
        cross_jumps(run, part, cells)?;
        look_again(run, part, cells)?;
        return Ok(other_margins(&samples, &steps, &beside, cells));
    }
}

/// Chooses the sides of a component; where the other side is the right one it is followed there.
fn choose(
    run: &Run<'_>,
    part: &Part<'_>,
    femur: Option<&KnownFemur>,
    cells: &mut [Cell],
) -> Result<(Vec<SideSample>, Vec<SideStep>)> {
    let samples = seen_from_both_sides(run, part, cells)?;
    let evidence: Vec<SideEvidence> = samples
        .iter()
        .map(|sample| sample.evidence(|pose| femur?.tilt_deg(sample.frame, pose)))
        .collect();
    let mut steps = vec![SideStep::default(); samples.len()];
    choose_sides(&evidence, &mut steps);
    for (seen, step) in evidence.iter().zip(&steps) {
        tell(run, part, seen, Some(step));
    }
    for (range, anchor) in runs_to_go_over(&samples, &steps, cells.len()) {
        go_over(run, part, anchor, range, cells)?;
    }
    Ok((samples, steps))
}

/// Goes over to what was seen elsewhere where that is the right one over the film; whether it went anywhere.
fn leave_false_minima(
    run: &Run<'_>,
    part: &Part<'_>,
    samples: &[SideSample],
    cells: &mut [Cell],
) -> Result<bool> {
    let mut any = false;
    for (range, anchor) in runs_elsewhere(samples, cells.len()) {
        let before = cells[range.clone()].to_vec();
        go_over(run, part, anchor, range.clone(), cells)?;
        match leaves_less(&cells[range.clone()], &before) {
            true => any = true,
            false => cells[range].copy_from_slice(&before),
        }
    }
    Ok(any)
}

fn tell(run: &Run<'_>, part: &Part<'_>, seen: &SideEvidence, step: Option<&SideStep>) {
    run.debug(|| {
        let (own, other) = (seen.own, seen.mirrored);
        let (name, frame, deg) = (part.name(), seen.frame + 1, seen.apart_deg);
        format!(
            "{name} frame {frame}: own {:.3} px {:?}, {:?} {:.3} px {:?}, {deg:.1} deg apart: {step:?}",
            own.misfit_px, own.tilt_deg, seen.rival, other.misfit_px, other.tilt_deg
        )
    });
}

/// Follows the frames on either side of jumps from the other side.
fn cross_jumps(run: &Run<'_>, part: &Part<'_>, cells: &mut [Cell]) -> Result<()> {
    let middle = part.middle();
    for (from, forward) in frames_to_cross_from(cells, &middle) {
        let Some(mut crossing) = Crossing::over(cells, from, forward, &middle) else {
            continue;
        };
        let mut bits = 0;
        while let Some(frame) = crossing.next() {
            let trail = crossing.way().trail();
            let expected = trail.expect(frame, &middle).pose.rotation;
            bits = bits_of(expected.into_iter().flatten().chain([f64::from_bits(bits)]));
            let key = format!("cross/{}/{}/{frame}/{bits:x}", part.number, part.phase());
            let looked: Looked = run.step(
                (part, frame),
                "followed from the other side of a jump",
                &key,
                || {
                    part.see(run.film, frame, |subject, image, memory| {
                        look(subject, image, frame, trail, memory)
                    })
                },
            )?;
            crossing.saw(frame, looked, (&middle, &part.planes));
        }
        crossing.write(cells);
    }
    Ok(())
}

/// Looks once more at frames that stand out.
fn look_again(run: &Run<'_>, part: &Part<'_>, cells: &mut [Cell]) -> Result<()> {
    let looks = second_looks(cells, &part.middle());
    let one = |look: &SecondLook| -> Result<(usize, Option<FramePose>)> {
        let frame = look.frame;
        let numbers = look.own.numbers().into_iter();
        let beside = look.expected.rotation.into_iter().flatten();
        let bits = bits_of(numbers.chain(beside));
        let key = format!("second/{}/{}/{frame}/{bits:x}", part.number, part.phase());
        let better = run.step((part, frame), "looked at once more", &key, || {
            part.see(run.film, frame, |subject, image, memory| {
                look.run(subject, image, memory)
            })
        })?;
        Ok((frame, better))
    };
    let found: Vec<_> = looks.par_iter().map(one).collect::<Result<_>>()?;
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
fn bits_of(numbers: impl Iterator<Item = f64>) -> u64 {
    numbers.fold(0, |bits, number| bits.rotate_left(7) ^ number.to_bits())
}

/// Follows the other side over some frames.
fn go_over(
    run: &Run<'_>,
    part: &Part<'_>,
    anchor: Anchor,
    range: std::ops::Range<usize>,
    cells: &mut [Cell],
) -> Result<()> {
    // What is there is of the wrong side; what a person fixed stays.
    for cell in cells[range.clone()].iter_mut().filter(|cell| !cell.fixed) {
        *cell = Cell::default();
    }
    follow(run, part, &[anchor], range, cells)
}

fn seen_from_both_sides(run: &Run<'_>, part: &Part<'_>, cells: &[Cell]) -> Result<Vec<SideSample>> {
    let wanted: Vec<usize> = frames_for_sides(cells).collect();
    seen(run, part, cells, Rival::Mirrored, &wanted, |frame, own| {
        part.see(run.film, frame, |subject, image, memory| {
            mirrored_pose(subject, image, own, memory)
        })
    })
}

fn seen_elsewhere(
    run: &Run<'_>,
    part: &Part<'_>,
    samples: &[SideSample],
    cells: &[Cell],
) -> Result<Vec<SideSample>> {
    let wanted = samples.iter().map(|sample| sample.frame);
    let wanted: Vec<usize> = wanted.filter(|&frame| !cells[frame].fixed).collect();
    let mirrored = |frame: usize, own: &FramePose| {
        let sample = samples.iter().find(|sample| sample.frame == frame)?;
        sample.mirrored_now(own)
    };
    let beside = seen(run, part, cells, Rival::Elsewhere, &wanted, |frame, own| {
        part.see(run.film, frame, |subject, image, memory| {
            elsewhere(subject, image, (own, mirrored(frame, own).as_ref()), memory)
        })
    })?;
    for sample in &beside {
        tell(run, part, &sample.evidence(|_| None), None);
    }
    Ok(beside)
}

/// Looks at some frames for another pose.
fn seen(
    run: &Run<'_>,
    part: &Part<'_>,
    cells: &[Cell],
    rival: Rival,
    frames: &[usize],
    look: impl Fn(usize, &FramePose) -> Result<Option<FramePose>> + Sync,
) -> Result<Vec<SideSample>> {
    let (what, told) = match rival {
        Rival::Mirrored => ("mirror", "seen from the other side"),
        Rival::Elsewhere => ("elsewhere", "other poses near by"),
    };
    let sample = |&frame: &usize| -> Result<Option<SideSample>> {
        let Some(&own) = cells[frame].found() else {
            return Ok(None);
        };
        let bits = bits_of(own.numbers().into_iter());
        let key = format!("{what}/{}/{}/{frame}/{bits:x}", part.number, part.phase());
        Ok(Some(SideSample {
            frame,
            own,
            rival,
            other: run.step((part, frame), told, &key, || look(frame, &own))?,
            fixed: cells[frame].fixed,
        }))
    };
    let samples: Vec<Option<SideSample>> = frames.par_iter().map(sample).collect::<Result<_>>()?;
    Ok(samples.into_iter().flatten().collect())
}
