//! By how much other poses of each frame are less likely than its own, at the end.

use alloc::vec;
use alloc::vec::Vec;

use super::cell::Cell;
use super::false_minimum::elsewhere_margins;
use super::frame_pose::FramePose;
use super::motion::between_deg;
use super::side_margin::{SideMargin, nearer_rival, nearest, side_margin};
use super::side_samples::{CROSSED, SideSample};
use super::sides::{ONE_DEG, Rival, SideStep};
use crate::finder::choice::DECISIVE_RATIO;
use crate::math::{Vector3, add, scale, subtract};
use crate::pose::geodesic_deg;

/// By how much another pose of each frame is less likely; `None` where there is none. `samples` were seen from both sides of the mirror,
/// `steps` is what [`super::choose_sides`] made of them, `beside` was seen from elsewhere; `cells` are the poses of the film now.
///
/// The tilt of a tray errs alike in all frames, and its votes add up: where the side that was not chosen leaves so much less in any frame than is
/// usual on the chosen one that this would decide by itself, the side is open as far as both are apart. Where another pose leaves as much less than
/// the frame's own alone, that pose is off, and open in this frame. So is one that has gone back to the side that was not chosen.
#[must_use]
pub fn other_margins(
    samples: &[SideSample],
    steps: &[SideStep],
    beside: &[SideSample],
    cells: &[Cell],
) -> Vec<Option<SideMargin>> {
    let open = contradicted(samples, cells, usual_misfit(cells));
    let mirrored = |frame: usize| {
        let nearest = nearest(samples, frame)?;
        let margin =
            side_margin(samples, steps, frame)?.apart_as(&samples[nearest], cells.get(frame));
        let is_open = open[nearest]
            || is_better_seen(samples, frame, cells)
            || is_rejected(samples, steps, frame, cells);
        Some(if is_open { margin.open() } else { margin })
    };
    let margins = elsewhere_margins(beside, cells.len());
    let elsewhere = |frame: usize, margin: Option<SideMargin>| {
        let is_open = is_better_seen(beside, frame, cells);
        margin.map(|one| if is_open { one.open() } else { one })
    };
    let both = margins.into_iter().enumerate();
    both.map(|(frame, margin)| nearer_rival(mirrored(frame), elsewhere(frame, margin)))
        .collect()
}

/// Whether another pose that was seen in a frame leaves decisively less than its own.
fn is_better_seen(samples: &[SideSample], frame: usize, cells: &[Cell]) -> bool {
    let mut own = samples.iter().filter(|sample| sample.frame == frame);
    own.any(|sample| leaves_more(sample, cells, f64::MAX))
}

/// Which samples lie on a stretch between two meetings of both sides in which any leaves decisively less on the side that was not chosen.
fn contradicted(samples: &[SideSample], cells: &[Cell], usual_px: f64) -> Vec<bool> {
    let mut open = vec![false; samples.len()];
    let mut begin = 0;
    while begin < samples.len() {
        let meets = |&k: &usize| !are_apart(&samples[k]);
        let end = (begin..samples.len()).find(meets).unwrap_or(samples.len());
        let stretch = &samples[begin..end];
        let is_open = stretch
            .iter()
            .any(|sample| leaves_more(sample, cells, usual_px));
        open[begin..end].fill(is_open);
        begin = end + 1;
    }
    open
}

/// Whether a frame has another side, which is another pose.
fn are_apart(sample: &SideSample) -> bool {
    let off = |other: &FramePose| geodesic_deg(&sample.own.pose.rotation, &other.pose.rotation);
    sample.rival == Rival::Mirrored
        && sample
            .other
            .as_ref()
            .is_some_and(|other| off(other) >= ONE_DEG)
}

/// The median of what poses leave, pixels; those that a person gave leave what a hand does.
fn usual_misfit(cells: &[Cell]) -> f64 {
    let free = cells.iter().filter(|cell| !cell.fixed);
    let found = free.filter_map(Cell::found);
    let mut all: Vec<f64> = found.map(|found| found.misfit_px).collect();
    all.sort_unstable_by(f64::total_cmp);
    all.get(all.len() / 2).copied().unwrap_or(0.0)
}

/// Whether the pose of a frame, and what is usual, leaves decisively more than another that was seen in it.
fn leaves_more(sample: &SideSample, cells: &[Cell], usual_px: f64) -> bool {
    let cell = cells.get(sample.frame).filter(|cell| !cell.fixed);
    let Some(now) = cell.and_then(Cell::found) else {
        return false;
    };
    let seen = [Some(sample.own), sample.other];
    seen.iter().flatten().any(|other| {
        now.misfit_px.min(usual_px) >= DECISIVE_RATIO * other.misfit_px
            && geodesic_deg(&now.pose.rotation, &other.pose.rotation) >= ONE_DEG
    })
}

/// Whether the pose of a frame has gone back to the side that was not chosen: by where that is seen from, in the frame itself or between the samples
/// before and behind it.
fn is_rejected(samples: &[SideSample], steps: &[SideStep], frame: usize, cells: &[Cell]) -> bool {
    let cell = cells.get(frame).filter(|cell| !cell.fixed);
    let Some(now) = cell.and_then(Cell::found) else {
        return false;
    };
    let of = |at: usize| -> Option<(usize, [Vector3; 2])> {
        let sample = samples.get(at)?;
        Some((
            sample.frame,
            sample.directions_of_sides(steps.get(at)?.side)?,
        ))
    };
    let behind = samples.partition_point(|sample| sample.frame < frame);
    let is_own = samples
        .get(behind)
        .is_some_and(|sample| sample.frame == frame);
    let before = behind.checked_sub(1).filter(|_| !is_own);
    let sides = match (before.and_then(of), of(behind)) {
        (Some((first, before)), Some((last, behind))) => {
            let part = (frame - first) as f64 / (last - first) as f64;
            let between = |k: usize| {
                let (from, to) = (&before[k], &behind[k]);
                add(from, &scale(&subtract(to, from), part))
            };
            [between(0), between(1)]
        }
        (one, other) => match one.or(other) {
            Some((_, sides)) => sides,
            None => return false,
        },
    };
    let [chosen, rejected] = sides.map(|side| between_deg(&side, &now.pose.rotation[2]));
    rejected < CROSSED * chosen
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::follow::fake::turned;
    use crate::follow::{Anchor, KneeFigures};

    const CHOSEN: f64 = 0.6;

    /// Seven frames on the side at 0 degrees with the mirror image 40 degrees off, which leaves what is given.
    fn film(others: [f64; 7], meeting: Option<usize>) -> (Vec<SideSample>, Vec<Cell>) {
        let own = |frame: usize| Anchor::found(frame, turned(0.0, CHOSEN));
        let sample = |(frame, left): (usize, f64)| SideSample {
            frame,
            own: turned(0.0, CHOSEN),
            rival: Rival::Mirrored,
            other: Some(turned(
                if meeting == Some(frame) { 1.0 } else { 40.0 },
                left,
            )),
            fixed: false,
        };
        let cells = (0..7).map(|frame| Cell::from(&own(frame))).collect();
        (others.into_iter().enumerate().map(sample).collect(), cells)
    }

    fn margins(others: [f64; 7], meeting: Option<usize>) -> Vec<f64> {
        let (samples, cells) = film(others, meeting);
        // As many votes of the tilt would choose them.
        let evidence = samples.iter().map(|sample| {
            sample.evidence(|pose| {
                Some(KneeFigures {
                    tilt_deg: if pose == &sample.own.pose { 0.0 } else { 30.0 },
                    is_impossible: false,
                })
            })
        });
        let evidence: Vec<_> = evidence.collect();
        let mut steps = vec![SideStep::default(); 7];
        crate::follow::choose_sides(&evidence, &mut steps);
        let margins = other_margins(&samples, &steps, &[], &cells);
        margins
            .iter()
            .map(|one| one.map_or(9.0, |one| one.margin))
            .collect()
    }

    #[test]
    fn where_a_person_has_chosen_there_is_no_other_side() {
        let (mut samples, cells) = film([0.62; 7], None);
        samples[0].fixed = true;
        let steps = vec![SideStep::default(); 7];
        let margins = other_margins(&samples, &steps, &[], &cells);
        assert_eq!(margins[0], None);
        assert!(margins[1].is_some());
    }

    #[test]
    fn a_pose_that_went_back_to_the_other_side_is_open() {
        let (samples, mut cells) = film([0.9; 7], None);
        let mut steps = vec![SideStep::default(); 7];
        steps.iter_mut().for_each(|step| step.margin = 5.0);
        let margin = |cells: &[Cell]| {
            let margins = other_margins(&samples, &steps, &[], cells);
            margins[5].map(|one| one.margin)
        };
        assert_eq!(margin(&cells), Some(5.0));
        cells[5] = Cell::from(&Anchor::found(5, turned(39.0, CHOSEN)));
        assert_eq!(margin(&cells), Some(0.0));
    }

    /// Frame 4 is the last that was seen from both sides, where these meet; the part turns on.
    #[test]
    fn sides_that_part_behind_the_last_frame_that_was_seen_are_two_poses_there() {
        let (all, mut cells) = film([0.62; 7], None);
        let samples = [SideSample {
            other: Some(turned(1.5, 0.62)),
            ..all[4]
        }];
        let at = |frame, deg: f64| Cell::from(&Anchor::found(frame, turned(deg, CHOSEN)));
        (cells[5], cells[6]) = (at(5, -0.2), at(6, -2.5));
        let margins = other_margins(&samples, &[SideStep::default()], &[], &cells);
        let apart = |frame: usize| margins[frame].map_or(-1.0, |one| one.apart_deg);
        for (frame, expected) in [(4, 1.5), (5, 1.9), (6, 6.5)] {
            assert!((apart(frame) - expected).abs() < 0.01, "{}", apart(frame));
        }
    }

    /// Frames 0, 3 and 6 were seen from both sides.
    #[test]
    fn a_pose_between_two_that_were_seen_is_open_on_the_side_that_was_not_chosen() {
        let (all, mut cells) = film([0.9; 7], None);
        let seen = |apart_deg: f64| -> Vec<SideSample> {
            let some = all.iter().filter(|sample| sample.frame % 3 == 0);
            some.map(|sample| SideSample {
                other: Some(turned(apart_deg, 0.9)),
                ..*sample
            })
            .collect()
        };
        let mut steps = [SideStep::default(); 3];
        steps.iter_mut().for_each(|step| step.margin = 5.0);
        let margin = |cells: &[Cell], apart_deg: f64| {
            let margins = other_margins(&seen(apart_deg), &steps, &[], cells);
            margins[4].map(|one| one.margin)
        };
        assert_eq!(margin(&cells, 6.0), Some(5.0));
        cells[4] = Cell::from(&Anchor::found(4, turned(5.0, CHOSEN)));
        assert_eq!(margin(&cells, 6.0), Some(0.0));
        assert_eq!(margin(&cells, 1.5), Some(5.0), "both sides are one");
        cells[4].fixed = true;
        assert_eq!(margin(&cells, 6.0), Some(5.0));
    }

    /// Both sides turn by as much as they are apart, twice, from one sample to the next.
    #[test]
    fn a_pose_between_two_that_were_seen_is_compared_with_where_their_sides_lead() {
        let sample = |frame: usize, deg: f64| SideSample {
            frame,
            own: turned(deg, CHOSEN),
            rival: Rival::Mirrored,
            other: Some(turned(deg + 3.0, CHOSEN)),
            fixed: false,
        };
        let samples = [sample(0, 0.0), sample(6, 6.0)];
        let is_open = |deg: f64| {
            let cells = vec![Cell::from(&Anchor::found(0, turned(deg, CHOSEN))); 7];
            is_rejected(&samples, &[SideStep::default(); 2], 3, &cells)
        };
        assert!(is_open(6.0) && is_open(5.5));
        assert!(!is_open(3.0) && !is_open(4.0));
    }

    #[test]
    fn a_pose_that_leaves_decisively_more_than_one_elsewhere_is_open() {
        let margin = |left: f64| {
            let (mut samples, cells) = film([1.2; 7], None);
            samples
                .iter_mut()
                .for_each(|sample| sample.rival = Rival::Elsewhere);
            samples[3].other = Some(turned(7.0, left));
            other_margins(&[], &[], &samples, &cells)[3].map(|one| one.margin)
        };
        assert!(margin(0.595).is_some_and(|margin| margin > 1.0));
        assert_eq!(margin(0.4), Some(0.0));
    }

    #[test]
    fn what_hands_leave_is_not_what_is_usual() {
        let (_, mut cells) = film([0.62; 7], None);
        for cell in &mut cells[..4] {
            *cell = Cell::from(&Anchor::found(0, turned(0.0, 1.9)));
            cell.fixed = true;
        }
        assert_eq!(usual_misfit(&cells), CHOSEN);
    }

    #[test]
    fn one_frame_that_fits_the_other_side_decisively_opens_the_side_up_to_where_both_meet() {
        let mut others = [0.62; 7];
        assert!(margins(others, None).iter().all(|&margin| margin > 1.0));
        others[5] = 0.44;
        assert!(margins(others, None).iter().all(|&margin| margin == 0.0));
        let mut off = [0.62; 7];
        off[5] = 0.5;
        let (samples, mut cells) = film(off, None);
        cells[5] = Cell::from(&Anchor::found(5, turned(3.0, 0.8)));
        let usual = usual_misfit(&cells);
        assert!(leaves_more(&samples[5], &cells, f64::MAX));
        assert_eq!(contradicted(&samples, &cells, usual), [false; 7]);
        let parted = margins(others, Some(3));
        assert!(parted[..3].iter().all(|&margin| margin > 0.5), "{parted:?}");
        assert!(
            parted[4..].iter().all(|&margin| margin == 0.0),
            "{parted:?}"
        );
    }
}
