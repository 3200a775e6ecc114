//! Each component put on the right side of its mirror, over the whole film.

use anyhow::Result;
use fluoropose::finder::choice::Counterpart;
use fluoropose::follow::{
    FramePose, Side, SideEvidence, SideFigures, SideStep, choose_sides, mirrored_pose,
};
use fluoropose::pose::{Pose, geodesic_deg};
use rayon::prelude::*;

use super::follow::{Anchor, Cell, follow};
use super::part::Part;
use super::record::Record;
use super::run::Run;

/// Every so many frames both sides are looked at; more often in a short film.
const EVERY: usize = 8;
const LEAST: usize = 6;

/// By how much the other side of each frame is less likely; `None` where there is none.
pub(super) type Margins = Vec<Option<f64>>;

/// A frame seen from both sides.
struct Sample {
    frame: usize,
    own: FramePose,
    mirrored: Option<FramePose>,
    fixed: bool,
}

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
        .map(|sample| evidence(part, sample, femurs))
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
    let mut margins = vec![None; cells.len()];
    let mut at = 0;
    while at < samples.len() {
        let side = steps[at].side;
        let end = (at..samples.len())
            .find(|&k| steps[k].side != side)
            .unwrap_or(samples.len());
        let first = at.checked_sub(1).map_or(0, |last| {
            usize::midpoint(samples[last].frame, samples[at].frame) + 1
        });
        let behind = samples.get(end).map_or(cells.len(), |next| {
            usize::midpoint(samples[end - 1].frame, next.frame) + 1
        });
        if side == Side::Mirrored {
            go_over(run, part, &samples[at..end], first..behind, cells)?;
        }
        at = end;
    }
    for (frame, margin) in margins.iter_mut().enumerate() {
        let nearest = (0..samples.len()).min_by_key(|&k| samples[k].frame.abs_diff(frame));
        *margin = nearest
            .filter(|&k| samples[k].mirrored.is_some() && !samples[k].fixed)
            .map(|k| steps[k].margin);
    }
    Ok(margins)
}

/// Follows the other side over some frames.
fn go_over(
    run: &Run<'_>,
    part: &Part<'_>,
    samples: &[Sample],
    range: std::ops::Range<usize>,
    cells: &mut [Cell],
) -> Result<()> {
    let score = |sample: &&Sample| sample.mirrored.map_or(0.0, |found| found.score());
    let best = samples.iter().max_by(|a, b| score(a).total_cmp(&score(b)));
    let Some((frame, found)) = best.and_then(|best| Some((best.frame, best.mirrored?))) else {
        return Ok(());
    };
    let anchor = Anchor {
        frame,
        found,
        fixed: false,
    };
    // What is there is of the wrong side; what a person fixed stays.
    for cell in cells[range.clone()].iter_mut().filter(|cell| !cell.fixed) {
        *cell = Cell::default();
    }
    follow(run, part, &[anchor], range, cells)
}

fn samples(run: &Run<'_>, part: &Part<'_>, cells: &[Cell]) -> Result<Vec<Sample>> {
    let posed: Vec<usize> = (0..cells.len())
        .filter(|&frame| cells[frame].found().is_some())
        .collect();
    let every = (posed.len() / LEAST).clamp(1, EVERY);
    let wanted: Vec<usize> = posed
        .iter()
        .enumerate()
        .filter(|&(k, &frame)| k % every == every / 2 || cells[frame].fixed)
        .map(|(_, &frame)| frame)
        .collect();
    let sample = |&frame: &usize| -> Result<Option<Sample>> {
        let Some(&own) = cells[frame].found() else {
            return Ok(None);
        };
        let bits: u64 = own
            .numbers()
            .iter()
            .fold(0, |bits, number| bits.rotate_left(7) ^ number.to_bits());
        let key = format!("mirror/{}/{}/{frame}/{bits:x}", part.number, part.phase());
        let mirrored = run.journal.step(&key, || {
            part.see(run.film, frame, |subject, image, memory| {
                mirrored_pose(subject, image, &own, memory)
            })
        })?;
        Ok(Some(Sample {
            frame,
            own,
            mirrored,
            fixed: cells[frame].fixed,
        }))
    };
    let samples: Vec<Option<Sample>> = wanted.par_iter().map(sample).collect::<Result<_>>()?;
    Ok(samples.into_iter().flatten().collect())
}

fn evidence(part: &Part<'_>, sample: &Sample, femurs: Option<&[Option<Pose>]>) -> SideEvidence {
    let femur = femurs.and_then(|femurs| femurs.get(sample.frame).copied().flatten());
    let tilt = |pose: &Pose| {
        let (femur, axes) = (femur?, part.axes?);
        Some(Counterpart::Femur(femur).tilt_deg(&pose.compose(&axes)))
    };
    let figures = |found: &FramePose| SideFigures {
        misfit_px: found.misfit_px,
        tilt_deg: tilt(&found.pose),
    };
    let own = figures(&sample.own);
    // Without another side, and where a person has chosen, the own side is the right one.
    let none = SideFigures {
        misfit_px: 10.0 * own.misfit_px,
        tilt_deg: None,
    };
    let mirrored = sample.mirrored.filter(|_| !sample.fixed);
    SideEvidence {
        frame: sample.frame,
        own,
        mirrored: mirrored.as_ref().map_or(none, figures),
        apart_deg: mirrored.map_or(180.0, |other| {
            geodesic_deg(&sample.own.pose.rotation, &other.pose.rotation)
        }),
    }
}
