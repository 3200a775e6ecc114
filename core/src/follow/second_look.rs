//! Frames that stand out in their film, looked at once more from where the frames beside them lead.
//!
//! A way from frame to frame takes what is in the ordinary so far, and that may be a small minimum beside the right one. Once all
//! frames are known such a frame stands out, and those on both sides of it tell where the right one is.

use alloc::vec;
use alloc::vec::Vec;

use super::cell::Cell;
use super::frame_pose::{FramePose, From};
use super::look::beside;
use super::motion::between;
use super::starts::Starts;
use super::subject::Subject;
use super::trail::{Usual, apart};
use super::trust::{FrameEvidence, Trust, judge_film};
use super::trust_limits::TrustLimits;
use crate::math::Vector3;
use crate::pose::Pose;
use crate::refine::{ImageTarget, RefineMemory};

/// A frame stands out that is so bad, where 1 would be doubtful.
const STANDS_OUT: f64 = 0.7;
/// Most misfit here, in usual ones of the film: to look once more costs little, and of frames that leave twice as much most are right.
const MISFIT: f64 = 1.8;
/// Frames on both sides lead to it that are at most so far away.
const REACH: usize = 6;
/// What it costs to be so far from where they lead, in usual misfits: 20 degrees or 30 mm for one.
const DEG: f64 = 1.0 / 20.0;
const MM: f64 = 1.0 / 30.0;
/// A pose that costs so much less than the one before takes its place.
const WORTH: f64 = 0.1;
/// Around where they lead: part of the distance.
const PART: f64 = 0.015;

/// A frame that is to be looked at once more.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SecondLook {
    /// Number of the frame, from 0.
    pub frame: usize,
    /// Its pose so far.
    pub own: FramePose,
    /// Where the frames beside it lead.
    pub expected: Pose,
    /// What is usual in the film.
    pub usual: Usual,
}

/// The frames of a film that stand out; `middle` is the model's. What a person gave is as it is.
#[must_use]
pub fn second_looks(cells: &[Cell], middle: &Vector3) -> Vec<SecondLook> {
    let trusts = judged(cells, middle);
    let pose = |at: usize| cells.get(at)?.found();
    let is_plain = |at: usize| trusts[at].badness <= STANDS_OUT || cells[at].fixed;
    let plain = |at: usize| pose(at).filter(|_| is_plain(at));
    // One beside a bad frame jumps, and is good by itself.
    let fits = |at: usize| pose(at).filter(|_| trusts[at].by_itself <= STANDS_OUT);
    let known = |at: usize| Some((at, plain(at)?));
    // What a hand leaves is not usual.
    let free = (0..cells.len()).filter(|&at| !cells[at].fixed);
    let all = || (0..cells.len()).filter_map(plain);
    let Some(usual) = usual(free.filter_map(plain)).or_else(|| usual(all())) else {
        return Vec::new();
    };
    let one = |frame: usize| {
        let own = pose(frame).filter(|_| !is_plain(frame))?;
        let before = || (frame.saturating_sub(REACH)..frame).rev();
        let after = || frame + 1..=frame + REACH;
        let fit = |at: usize| Some((at, fits(at)?));
        let before = before()
            .find_map(known)
            .or_else(|| before().find_map(fit))?;
        let after = after().find_map(known).or_else(|| after().find_map(fit))?;
        let fraction = (frame - before.0) as f64 / (after.0 - before.0) as f64;
        Some(SecondLook {
            frame,
            own: *own,
            expected: between(&before.1.pose, &after.1.pose, fraction, middle),
            usual,
        })
    };
    (0..cells.len()).filter_map(one).collect()
}

/// How far each frame is to be trusted by what its own film says.
fn judged(cells: &[Cell], middle: &Vector3) -> Vec<Trust> {
    let evidence = cells.iter().map(|cell| FrameEvidence::of(cell, None, None));
    let evidence: Vec<FrameEvidence> = evidence.collect();
    let mut trusts = vec![Trust::default(); cells.len()];
    let mut sorted = vec![0.0; cells.len()];
    let limits = TrustLimits {
        misfit: MISFIT,
        ..TrustLimits::USUAL
    };
    judge_film(&evidence, &limits, middle, &mut sorted, &mut trusts);
    trusts
}

/// The medians of some poses; `None` without any.
fn usual<'p>(poses: impl Iterator<Item = &'p FramePose>) -> Option<Usual> {
    let seen: Vec<Usual> = poses.map(Usual::of).collect();
    let median = |of: fn(&Usual) -> f64| {
        let mut values: Vec<f64> = seen.iter().map(of).collect();
        values.sort_unstable_by(f64::total_cmp);
        values.get(values.len() / 2).copied()
    };
    Some(Usual {
        misfit_px: median(|usual| usual.misfit_px)?,
        step: median(|usual| usual.step)?,
        strength: median(|usual| usual.strength)?,
    })
}

impl SecondLook {
    /// The best pose that leads from where the frame is expected to be and from around there, where it is better than its own.
    #[must_use]
    pub fn run(
        &self,
        subject: &Subject<'_>,
        image: &ImageTarget<'_>,
        memory: &mut RefineMemory<'_>,
    ) -> Option<FramePose> {
        let middle = subject.model.bounds().centre;
        let around = beside(&self.expected, &middle, PART).map(|pose| (pose, From::Near));
        let here = [From::Near, From::Far].map(|from| (self.expected, from));
        let own = self.cost(&self.own, &middle);
        let starts = Starts::new(subject, image).knowing(&[self.own.pose]);
        let (mut best, mut least) = (None, own - WORTH);
        for (start, from) in here.into_iter().chain(around) {
            let most_px = self.usual.most_px(least);
            let Some(one) = starts.lead_within(most_px, (&start, from), memory) else {
                continue;
            };
            let cost = self.cost(&one, &middle);
            if cost < least {
                (best, least) = (Some(one), cost);
            }
        }
        best
    }

    fn cost(&self, found: &FramePose, middle: &Vector3) -> f64 {
        let [deg, mm] = apart(&self.expected, &found.pose, middle);
        self.usual.cost(found) + DEG * deg + MM * mm
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::follow::fake::{looked, turned};
    use crate::pose::EulerPose;

    const MIDDLE: Vector3 = [0.0; 3];

    fn cell(flexion_deg: f64, misfit_px: f64) -> Cell {
        let pose = Pose::from(EulerPose {
            x_mm: 0.3 * flexion_deg,
            y_mm: 0.0,
            z_mm: -900.0,
            z_rot_deg: flexion_deg,
            x_rot_deg: 0.0,
            y_rot_deg: 0.0,
        });
        let found = FramePose {
            pose,
            ..turned(0.0, misfit_px)
        };
        Cell::on_the_way(looked(Ok(found)))
    }

    #[test]
    fn a_frame_that_leaves_more_than_the_others_is_looked_at_from_where_they_lead() {
        let film = |bad: &[usize]| -> Vec<Cell> {
            (0..20)
                .map(|k| match bad.contains(&k) {
                    true => cell(4.0 * k as f64 + 2.0, 0.8),
                    false => cell(4.0 * k as f64, 0.45 + 0.01 * (k % 3) as f64),
                })
                .collect()
        };
        assert!(second_looks(&film(&[]), &MIDDLE).is_empty());
        let looks = second_looks(&film(&[7, 8, 12]), &MIDDLE);
        let frames: Vec<usize> = looks.iter().map(|look| look.frame).collect();
        assert_eq!(frames, [7, 8, 12]);
        for look in &looks {
            let Cell { looked, .. } = film(&[])[look.frame];
            let right = looked.and_then(|looked| looked.found.ok()).expect("found");
            let [deg, mm] = apart(&look.expected, &right.pose, &MIDDLE);
            assert!(deg < 1e-6 && mm < 1e-6, "{deg} {mm}");
        }
        // Among bad ones a frame jumps, and is good by itself: it leads to those that are farther from the others than that.
        let bad: Vec<usize> = (4..9).chain(10..15).collect();
        let looks = second_looks(&film(&bad), &MIDDLE);
        let frames: Vec<usize> = looks.iter().map(|look| look.frame).collect();
        assert_eq!(frames, (4..15).collect::<Vec<usize>>());
        // At the end of a film nothing leads to it from both sides, and what a person gave stays.
        assert!(second_looks(&film(&[0, 19]), &MIDDLE).is_empty());
        let mut given = film(&[7]);
        given[7].fixed = true;
        assert!(second_looks(&given, &MIDDLE).is_empty());
    }

    #[test]
    fn what_hands_leave_is_not_what_is_usual() {
        let film = |hands: &[usize]| -> Vec<Cell> {
            let one = |k: usize| {
                let px = match (hands.contains(&k), k) {
                    (true, _) => 1.9,
                    (false, 8) => 0.9,
                    (false, _) => 0.45,
                };
                Cell {
                    fixed: hands.contains(&k),
                    ..cell(4.0 * k as f64, px)
                }
            };
            (0..20).map(one).collect()
        };
        for hands in [
            &[][..],
            &[3],
            &[0, 1, 2, 3, 4, 5, 10, 11, 12, 13, 14, 15, 16],
        ] {
            let looks = second_looks(&film(hands), &MIDDLE);
            let told: Vec<(usize, f64)> = looks
                .iter()
                .map(|look| (look.frame, look.usual.misfit_px))
                .collect();
            assert_eq!(told, [(8, 0.45)], "{hands:?}");
        }
    }

    const USUAL: Usual = Usual {
        misfit_px: 0.4,
        step: 160.0,
        strength: 1.0,
    };

    /// Twenty degrees or thirty millimetres from where it is expected cost as much as a usual misfit.
    #[test]
    fn a_pose_costs_the_more_the_farther_it_is_from_where_it_is_led() {
        let look = SecondLook {
            frame: 3,
            own: turned(0.0, 0.4),
            expected: turned(0.0, 0.0).pose,
            usual: USUAL,
        };
        let cost = |deg: f64, mm: f64, misfit_px: f64| {
            let mut found = turned(deg, misfit_px);
            found.pose.translation[1] = mm;
            look.cost(&found, &MIDDLE)
        };
        for (deg, mm, misfit_px, wanted) in [
            (0.0, 0.0, 0.5, 1.0),
            (20.0, 0.0, 0.5, 2.0),
            (-20.0, 30.0, 0.5, 3.0),
            (10.0, -60.0, 0.0, 2.5),
        ] {
            let found = cost(deg, mm, misfit_px);
            assert!(
                (found - wanted).abs() < 1e-6,
                "{deg} {mm} {misfit_px}: {found}"
            );
        }
    }

    /// A frame of the crank, expected a little beside where it is seen, whose own pose so far is the expected one turned by so many degrees.
    fn found_again(off_deg: f64, misfit_px: f64) -> (Option<FramePose>, Pose) {
        use crate::finder::fake::{SIDE, camera, crank, grey, placed};
        use crate::image::frame::Frame;
        use crate::refine::RefineBuffers;
        let (model, camera) = (crank(), camera());
        let right = placed([20.0, 30.0, 5.0], [2.0, -3.0, 0.0]);
        let pixels = grey(&model, &camera, &right);
        let frame = Frame::new(&pixels, SIDE, SIDE, SIDE).expect("valid");
        let image = ImageTarget::dark(&frame);
        let mut own = turned(0.0, misfit_px);
        own.pose = placed([20.0, 30.0, 5.0 + off_deg], [2.0, -3.0, 0.0]);
        own.contrast.step = 160.0;
        let look = SecondLook {
            frame: 3,
            own,
            expected: placed([20.5, 29.5, 6.0], [1.0, -2.0, 0.0]),
            usual: USUAL,
        };
        let (mut buffers, model) = (RefineBuffers::default(), model.as_model());
        let subject = Subject::new(&model, &[], &camera);
        let mut memory = buffers.borrow(&model, &camera);
        (look.run(&subject, &image, &mut memory), right)
    }

    #[test]
    fn a_second_look_finds_what_is_better_by_far_and_nothing_else() {
        let (found, right) = found_again(40.0, 1.5);
        let found = found.expect("better");
        let [deg, mm] = apart(&right, &found.pose, &MIDDLE);
        assert!(deg < 3.0 && mm < 1.0, "{deg} {mm}");
        assert_eq!(found_again(0.0, 0.0).0, None);
    }

    #[test]
    fn frames_that_lead_to_another_lie_at_most_six_away() {
        let looked_at = |missing: &[usize]| {
            let cells: Vec<Cell> = (0..24)
                .map(|k| match missing.contains(&k) {
                    true => Cell::default(),
                    false => cell(4.0 * k as f64, if k == 10 { 0.9 } else { 0.45 }),
                })
                .collect();
            second_looks(&cells, &MIDDLE).len()
        };
        let frames = |run: core::ops::Range<usize>| run.collect::<Vec<usize>>();
        assert_eq!(
            [frames(11..16), frames(5..10)].map(|run| looked_at(&run)),
            [1; 2]
        );
        assert_eq!(
            [frames(11..17), frames(4..10)].map(|run| looked_at(&run)),
            [0; 2]
        );
    }

    #[test]
    fn what_is_usual_is_the_middle_one_of_each_number() {
        let pose = |misfit_px: f64, step: f64, strength: f64| {
            let mut found = turned(0.0, misfit_px);
            (found.contrast.step, found.contrast.strength) = (step, strength);
            found
        };
        let all = [
            pose(5.0, 10.0, 0.9),
            pose(1.0, 50.0, 0.1),
            pose(3.0, 20.0, 0.5),
            pose(2.0, 40.0, 0.7),
            pose(4.0, 30.0, 0.3),
        ];
        let Usual {
            misfit_px,
            step,
            strength,
        } = usual(all.iter()).expect("some");
        assert_eq!([misfit_px, step, strength], [3.0, 30.0, 0.5]);
        assert_eq!(usual(core::iter::empty()), None);
    }
}
