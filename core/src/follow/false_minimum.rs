//! Whether a trail lies in a false minimum: what was seen elsewhere, over the film, and the way from there.

use alloc::vec;
use alloc::vec::Vec;
use core::ops::Range;

use super::cell::{Anchor, Cell};
use super::side_margin::{SideMargin, side_margin};
use super::side_samples::{SideSample, evidence_of, runs_to_go_over};
use super::sides::{ONE_DEG, Side, SideEvidence, SideStep, choose_sides};
use crate::math::ln;

/// So often a film may go over to what was seen elsewhere: from one minimum to another, and from there once more.
pub const ROUNDS: usize = 2;
/// By so much what was seen elsewhere must be more likely.
const WORTH: f64 = 1.0;
/// So many frames to either side are asked what they say in the mean, which counts so many times.
const AROUND: usize = 2;
const WITNESS: f64 = 2.0;

/// Runs of frames, of a film of `frames`, in which what was seen elsewhere is the right one, each with the frame to follow it
/// from. They are to be kept where that way [`leaves_less`], and all frames seen anew, at most [`ROUNDS`] times.
#[must_use]
pub fn runs_elsewhere(samples: &[SideSample], frames: usize) -> Vec<(Range<usize>, Anchor)> {
    let mut steps = elsewhere_steps(samples);
    for step in steps.iter_mut().filter(|step| step.margin < WORTH) {
        step.side = Side::Own;
    }
    runs_to_go_over(samples, &steps, frames).collect()
}

/// By how much what was seen elsewhere is less likely than the trail, in each frame of a film; `None` where nothing was.
pub(super) fn elsewhere_margins(samples: &[SideSample], frames: usize) -> Vec<Option<SideMargin>> {
    let steps = as_one_witness(samples, elsewhere_steps(samples));
    let margin = |frame| side_margin(samples, &steps, frame);
    (0..frames).map(margin).collect()
}

/// What the film says of the trail and of what was seen elsewhere.
fn elsewhere_steps(samples: &[SideSample]) -> Vec<SideStep> {
    let evidence = evidence_of(samples, |_, _| None);
    let mut steps = vec![SideStep::default(); evidence.len()];
    choose_sides(&evidence, &mut steps);
    for (at, step) in steps.iter_mut().enumerate() {
        if stands_alone(&evidence, at) {
            step.speaks_for_itself(&evidence[at]);
        }
    }
    steps
}

/// Those steps, none surer than what their frame and those beside it say in the mean: what a model lacks of its part it lacks in all of them, so
/// that many which say little say no more than one. Nor is a frame that speaks for the other pose by itself outvoted by them: a trail slides.
fn as_one_witness(samples: &[SideSample], mut steps: Vec<SideStep>) -> Vec<SideStep> {
    let evidence = evidence_of(samples, |_, _| None);
    for (at, step) in steps.iter_mut().enumerate() {
        let Some(around) = usual_around(samples, &evidence, at) else {
            continue;
        };
        let alone = 1.0 + step.told_by(evidence[at].for_own());
        let told = alone.min(step.told_by(around)).max(0.0);
        step.margin = step.margin.min(WITNESS * told);
    }
    steps
}

/// What a frame and those beside it say for the trail in the mean; `None` where nothing else was seen in them.
fn usual_around(samples: &[SideSample], evidence: &[SideEvidence], at: usize) -> Option<f64> {
    let around = at.saturating_sub(AROUND)..(at + AROUND + 1).min(evidence.len());
    let seen = around.filter(|&at| samples[at].free().is_some());
    let (sum, count) = seen.fold((0.0, 0.0), |(sum, count), at| {
        (sum + evidence[at].for_own(), count + 1.0)
    });
    (count > 0.0).then(|| sum / count)
}

/// Whether the trail turns out of the image plane both to a frame and on from it as far as two poses are apart: frames beside it do not speak
/// for its pose then.
fn stands_alone(evidence: &[SideEvidence], at: usize) -> bool {
    let from_before = |at: usize| evidence.get(at).map(|one| one.turn_deg >= ONE_DEG);
    let beside = [from_before(at).filter(|_| at > 0), from_before(at + 1)];
    let mut beside = beside.into_iter().flatten().peekable();
    beside.peek().is_some() && beside.all(|is_far| is_far)
}

/// Whether another way through some frames leaves less than the one before: over those in which both have the component; or
/// has it in more frames.
#[must_use]
pub fn leaves_less(other: &[Cell], before: &[Cell]) -> bool {
    let count = |cells: &[Cell]| cells.iter().filter(|cell| cell.found().is_some()).count();
    let both = other.iter().zip(before);
    let ratios = both.filter_map(|(other, before)| {
        let (other, before) = (other.found()?, before.found()?);
        Some(ln(
            before.misfit_px.max(f64::MIN_POSITIVE) / other.misfit_px.max(f64::MIN_POSITIVE)
        ))
    });
    count(other) >= count(before) && ratios.sum::<f64>() > 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::follow::Rival;
    use crate::follow::fake::{looked, turned};

    /// A film whose other minimum leaves so many times as much, seen in every second frame.
    fn film(ratios: &[f64]) -> Vec<SideSample> {
        let sample = |(k, &ratio): (usize, &f64)| SideSample {
            frame: 2 * k + 1,
            own: turned(0.0, 0.6),
            rival: Rival::Elsewhere,
            other: Some(turned(8.0, 0.6 * ratio)),
            fixed: false,
        };
        ratios.iter().enumerate().map(sample).collect()
    }

    fn runs(samples: &[SideSample]) -> Vec<Range<usize>> {
        let runs = runs_elsewhere(samples, 2 * samples.len()).into_iter();
        runs.map(|(run, _)| run).collect()
    }

    #[test]
    fn a_trail_that_slid_goes_back_to_what_leaves_less() {
        let slid = film(&[0.82, 0.9, 0.84, 0.8, 1.02, 0.83, 1.1, 1.15, 1.2, 1.1, 1.2]);
        assert_eq!(runs(&slid).as_slice(), core::slice::from_ref(&(0..13)));
        // One frame that errs, and a film that says as much of both.
        assert!(runs(&film(&[1.2, 1.1, 0.8, 1.2, 1.1])).is_empty());
        assert!(runs(&film(&[0.98, 1.01, 0.97, 1.0])).is_empty());
        let margins = elsewhere_margins(&film(&[0.98, 1.01, 0.97, 1.0]), 8);
        assert!(
            margins
                .iter()
                .all(|margin| margin.is_some_and(|one| one.margin < 1.0))
        );
        let margins = elsewhere_margins(&slid, 22);
        assert!(
            margins[..13]
                .iter()
                .all(|margin| margin.is_some_and(|one| one.margin == 0.0))
        );
        assert!(
            margins[15..]
                .iter()
                .all(|margin| margin.is_some_and(|one| one.margin > 1.0))
        );
    }

    #[test]
    fn a_frame_that_the_trail_rocks_to_speaks_for_itself() {
        let mut still = film(&[1.05; 7]);
        let margin =
            |samples: &[SideSample]| elsewhere_margins(samples, 14)[7].map(|one| one.margin);
        assert!(margin(&still).is_some_and(|margin| margin > 1.0));
        still[3].own = turned(-9.0, 0.6);
        still[3].other = Some(turned(-17.0, 0.6 * 1.05));
        assert!(margin(&still).is_some_and(|margin| margin < 1.0));
        still[3].other = Some(turned(-17.0, 0.6 * 1.3));
        assert!(margin(&still).is_some_and(|margin| margin > 1.0));
    }

    /// The first frame of a film, in a minimum that leaves twice as much as what was seen elsewhere.
    #[test]
    fn a_frame_that_the_trail_rocks_from_goes_over_by_itself() {
        let mut first = film(&[0.5, 1.2, 1.1, 1.15, 1.2]);
        assert!(runs(&first).is_empty(), "the trail is one way");
        first[0].own = turned(-9.0, 0.6);
        first[0].other = Some(turned(0.0, 0.3));
        assert_eq!(runs(&first).as_slice(), core::slice::from_ref(&(0..3)));
    }

    #[test]
    fn many_frames_that_say_little_say_no_more_than_one() {
        let margins = |ratios: &[f64]| elsewhere_margins(&film(ratios), 2 * ratios.len());
        let is_open = |one: Option<SideMargin>| one.is_some_and(|one| one.margin < 1.0);
        assert!(margins(&[1.03; 15]).into_iter().all(is_open));
        assert!(!margins(&[1.08; 15]).into_iter().any(is_open));
        let mut one = [1.2; 15];
        one[7] = 0.93;
        let open: Vec<usize> = (0..30).filter(|&at| is_open(margins(&one)[at])).collect();
        assert_eq!(open, [15, 16], "it speaks for the other by itself");
    }

    #[test]
    fn what_a_person_gave_stays_and_nothing_elsewhere_says_nothing() {
        let mut given = film(&[0.8; 6]);
        given.iter_mut().for_each(|sample| sample.fixed = true);
        assert!(runs(&given).is_empty());
        assert_eq!(elsewhere_margins(&given, 3), [None; 3]);
        let mut alone = film(&[0.8; 6]);
        alone.iter_mut().for_each(|sample| sample.other = None);
        assert!(runs(&alone).is_empty());
    }

    #[test]
    fn a_way_is_kept_where_it_leaves_less_in_no_fewer_frames() {
        let way = |misfits: &[f64]| -> Vec<Cell> {
            let cell = |&misfit_px: &f64| Cell::on_the_way(looked(Ok(turned(0.0, misfit_px))));
            misfits.iter().map(cell).collect()
        };
        let before = way(&[0.6, 0.7, 0.65]);
        assert!(leaves_less(&way(&[0.5, 0.72, 0.6]), &before));
        assert!(!leaves_less(&way(&[0.64, 0.72, 0.62]), &before));
        let mut shorter = way(&[0.5, 0.5, 0.5]);
        shorter[2] = Cell::default();
        assert!(!leaves_less(&shorter, &before));
    }
}
