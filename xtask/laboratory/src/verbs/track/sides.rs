//! Each component put on the right side of its mirror, over the whole film.

use anyhow::Result;
use fluoropose::finder::choice::Counterpart;
use fluoropose::follow::{
    Anchor, Cell, FramePose, SecondLook, SideEvidence, SideSample, SideStep, choose_sides,
    frames_for_sides, mirrored_pose, mirrored_runs, second_looks, side_margin,
};
use fluoropose::pose::Pose;
use rayon::prelude::*;

use super::follow::follow;
use super::part::Part;
use super::record::Record;
use super::run::Run;

/// By how much the other side of each frame is less likely; `None` where there is none.
pub(super) type Margins = Vec<Option<f64>>;

/// Chooses the sides of a component; where the other side is the right one it is followed there. `femurs` are the femoral
/// poses of all frames in the field's axes, for a tibia.
pub(super) fn settle(
    run: &Run<'_>,
    part: &Part<'_>,
    femurs: Option<&[Option<Pose>]>,
    cells: &mut [Cell],
) -> Result<Margins> {
    let samples = samples(run, part, cells)?;
    let evidence: Vec<SideEvidence> = samples
        .iter()
        .map(|sample| sample.evidence(|pose| tilt_deg(part, sample.frame, femurs, pose)))
        .collect();
    let mut steps = vec![SideStep::default(); samples.len()];
    choose_sides(&evidence, &mut steps);
    for (sample, (seen, step)) in samples.iter().zip(evidence.iter().zip(&steps)) {
        run.debug(|| {
            format!(
                "{} frame {}: own {:.3} px {:?}, mirrored {:.3} px {:?}, {:.1} deg apart: {:?} by {:.2}",
                part.name(), sample.frame + 1, seen.own.misfit_px, seen.own.tilt_deg,
                seen.mirrored.misfit_px, seen.mirrored.tilt_deg, seen.apart_deg, step.side, step.margin
            )
        });
    }
    for (range, anchor) in mirrored_runs(&samples, &steps, cells.len()) {
        go_over(run, part, anchor, range, cells)?;
    }
    look_again(run, part, cells)?;
    let margin = |frame| side_margin(&samples, &steps, frame);
    Ok((0..cells.len()).map(margin).collect())
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
        let better = run.journal.step(&key, || {
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

/// Coronal tilt of a tibial pose against the femur of its frame, degrees, where that is known.
fn tilt_deg(
    part: &Part<'_>,
    frame: usize,
    femurs: Option<&[Option<Pose>]>,
    pose: &Pose,
) -> Option<f64> {
    let femur = (*femurs?.get(frame)?)?;
    let axes = part.axes?;
    Some(Counterpart::Femur(femur).tilt_deg(&pose.compose(&axes)))
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

fn samples(run: &Run<'_>, part: &Part<'_>, cells: &[Cell]) -> Result<Vec<SideSample>> {
    let wanted: Vec<usize> = frames_for_sides(cells).collect();
    let sample = |&frame: &usize| -> Result<Option<SideSample>> {
        let Some(&own) = cells[frame].found() else {
            return Ok(None);
        };
        let bits = bits_of(own.numbers().into_iter());
        let key = format!("mirror/{}/{}/{frame}/{bits:x}", part.number, part.phase());
        let mirrored = run.journal.step(&key, || {
            part.see(run.film, frame, |subject, image, memory| {
                mirrored_pose(subject, image, &own, memory)
            })
        })?;
        Ok(Some(SideSample {
            frame,
            own,
            mirrored,
            fixed: cells[frame].fixed,
        }))
    };
    let samples: Vec<Option<SideSample>> = wanted.par_iter().map(sample).collect::<Result<_>>()?;
    Ok(samples.into_iter().flatten().collect())
}
