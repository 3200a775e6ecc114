//! Jumps of a film, crossed from both sides.
//!
//! Where one part of a way lies in a small minimum beside the right one, it jumps where it leaves that. From the frames on
//! either side the other ones are followed anew, as far as that comes to other poses; where they leave less, they take the
//! place of what was there.

use alloc::vec::Vec;

use super::cell::{Anchor, Cell};
use super::frame_pose::FramePose;
use super::look::Looked;
use super::meeting::{have_met, join_ways};
use super::motion::between;
use super::sides::{ELSEWHERE_RATIO, MOST, ONE_DEG};
use super::trail::{Usual, apart};
use super::trust_limits::TrustLimits;
use super::way::Way;
use crate::math::{Vector3, ln};
use crate::mesh::mirror::mirror_pose;
use crate::mesh::symmetry::SymmetryPlane;
use crate::pose::{Pose, geodesic_deg};

/// So much of what would make a jump doubtful is one that is crossed.
const PART: f64 = 0.5;
/// So much of what is usual for a jump is one, at least.
const TIMES: f64 = PART * TrustLimits::USUAL.jump_times;
const LEAST: [f64; 2] = [
    PART * TrustLimits::USUAL.jump_deg,
    PART * TrustLimits::USUAL.jump_mm,
];
/// Votes for one way that decide, each a misfit so many times less ([`super::sides`]).
const DECIDED: f64 = 2.0;
/// Votes against a way after which it is given up.
const HOPELESS: f64 = 4.0;
/// Frames before a jump that tell the motion.
const BEFORE: usize = 3;
/// Frames behind a jump that are followed anew, at most.
const FAR: usize = 12;

/// A way over a jump, into the frames behind it.
#[derive(Clone, Debug)]
pub struct Crossing {
    way: Way,
    forward: bool,
    /// What is there in the frames behind the jump, the nearest first.
    there: Vec<Cell>,
    /// What was seen in them, in the same order.
    seen: Vec<Looked>,
    /// It has come to poses that were there before, or to the other side of the mirror.
    over: bool,
}

/// The frames from which jumps of a film are to be crossed, each forward or not, in their order; `middle` is the model's.
#[must_use]
pub fn frames_to_cross_from(cells: &[Cell], middle: &Vector3) -> Vec<(usize, bool)> {
    let jumps = jumps(cells, middle);
    let is_one = |frame: usize| jumps.get(frame).is_some_and(|&is_one| is_one);
    (1..cells.len())
        .filter(|&frame| is_one(frame - 1) || is_one(frame))
        .flat_map(|frame| [(frame - 1, true), (frame, false)])
        .collect()
}

/// Which frames lie off the way between those beside them.
fn jumps(cells: &[Cell], middle: &Vector3) -> Vec<bool> {
    let pose = |frame: usize| Some(cells.get(frame)?.found()?.pose);
    let off = |frame: usize| {
        let (before, after) = (pose(frame.checked_sub(1)?)?, pose(frame + 1)?);
        Some(apart(
            &between(&before, &after, 0.5, middle),
            &pose(frame)?,
            middle,
        ))
    };
    let all: Vec<Option<[f64; 2]>> = (0..cells.len()).map(off).collect();
    let most = [0, 1].map(|k: usize| {
        let mut sorted: Vec<f64> = all.iter().flatten().map(|off| off[k]).collect();
        sorted.sort_unstable_by(f64::total_cmp);
        let usual = sorted.get(sorted.len() / 2).copied().unwrap_or(0.0);
        LEAST[k].max(TIMES * usual)
    });
    let is_one =
        |off: &Option<[f64; 2]>| off.is_some_and(|off| off[0] > most[0] || off[1] > most[1]);
    all.iter().map(is_one).collect()
}

impl Crossing {
    /// From the frame before a jump, with those before it; `None` where there is no pose, or nothing behind. Behind a pose that a
    /// person gave it does not go.
    #[must_use]
    pub fn over(cells: &[Cell], from: usize, forward: bool, middle: &Vector3) -> Option<Self> {
        let away = |k: usize, forward: bool| match forward {
            true => Some(from + k),
            false => from.checked_sub(k),
        };
        let looked = |frame: usize| {
            let cell = cells.get(frame)?;
            Some((frame, cell.looked?, *cell.found()?))
        };
        let before: Vec<(usize, Looked, FramePose)> = (0..BEFORE)
            .map_while(|k| looked(away(k, !forward)?))
            .collect();
        let &(frame, _, found) = before.last()?;
        // What a hand leaves is not usual.
        let free = before.iter().rev().find(|(frame, ..)| !cells[*frame].fixed);
        let usual = Usual::of(free.map_or(&found, |(_, _, found)| found));
        let anchor = Anchor {
            usual,
            ..Anchor::found(frame, found)
        };
        let mut way = Way::begin(&anchor, forward);
        for (frame, looked, _) in before.iter().rev().skip(1) {
            way.take(*frame, looked, middle);
        }
        let behind = (1..=FAR).map_while(|k| cells.get(away(k, forward)?));
        let may_change = |cell: &&Cell| !cell.fixed && cell.looked.is_some();
        let there: Vec<Cell> = behind.take_while(may_change).copied().collect();
        let seen = Vec::new();
        let over = there.is_empty();
        (!over).then_some(Self {
            way,
            forward,
            there,
            seen,
            over,
        })
    }

    /// The frame that is to be looked at; `None` where it is done.
    #[must_use]
    pub fn next(&self) -> Option<usize> {
        let is_over = self.over || self.votes() <= -HOPELESS || self.seen.len() == self.there.len();
        let to = if self.forward { usize::MAX } else { 0 };
        self.way.next(to).filter(|_| !is_over)
    }

    /// The way so far: [`super::look`] takes its trail.
    #[must_use]
    pub fn way(&self) -> &Way {
        &self.way
    }

    /// Takes what came of the next frame; `middle` and `planes` are the model's. It ends before a frame whose mirror image it has
    /// come to: sides are chosen over the whole film, by more than what poses leave ([`super::choose_sides`]).
    pub fn saw(
        &mut self,
        frame: usize,
        looked: Looked,
        (middle, planes): (&Vector3, &[SymmetryPlane]),
    ) {
        let there = self.there.get(self.seen.len());
        let there = there.and_then(|cell| cell.looked);
        if there.is_some_and(|there| are_mirrored(&there, &looked, planes)) {
            self.over = true;
            return;
        }
        self.over = there.is_some_and(|there| have_met(&there, &looked));
        self.way.take(frame, &looked, middle);
        self.seen.push(looked);
    }

    /// By how much less than what is there all that was seen leaves.
    fn votes(&self) -> f64 {
        let all = self.there.iter().zip(&self.seen);
        all.map(|(cell, looked)| votes_for(looked, cell)).sum()
    }

    /// Puts what was found where it is better than what was there: up to some frame behind the jump.
    pub fn write(mut self, cells: &mut [Cell]) {
        let count = self.seen.len();
        self.there.truncate(count);
        if !self.forward {
            self.seen.reverse();
            self.there.reverse();
        }
        let first = match self.forward {
            true => (self.way.at() + 1).saturating_sub(count),
            false => self.way.at(),
        };
        let Some(cells) = cells.get_mut(first..first + count).filter(|_| count > 0) else {
            return;
        };
        let both = self.there.iter().zip(&self.seen);
        let ways: Vec<[Option<Looked>; 2]> = both
            .map(|(there, looked)| match self.forward {
                true => [Some(*looked), there.looked],
                false => [there.looked, Some(*looked)],
            })
            .collect();
        join_ways(&ways, cells);
        self.decide(cells);
    }

    /// What one way leaves less than the other, on either side of where the one is left for the other, says how sure that is.
    fn decide(&self, cells: &mut [Cell]) {
        let taken = |cell: &Cell, looked: &Looked| cell.looked == Some(*looked);
        let mut votes = [0.0; 2];
        for ((cell, looked), there) in cells.iter().zip(&self.seen).zip(&self.there) {
            let less = votes_for(looked, there);
            match taken(cell, looked) {
                true => votes[1] += less,
                false => votes[0] -= less,
            }
        }
        for ((cell, looked), there) in cells.iter_mut().zip(&self.seen).zip(&self.there) {
            let taken = taken(cell, looked);
            if votes[usize::from(taken)] >= DECIDED {
                cell.other_way = None;
            }
            if !taken {
                cell.other_way = cell.other_way.or(there.other_way);
            }
        }
    }
}

/// Whether two poses are on two sides of the mirror, where these are apart.
fn are_mirrored(one: &Looked, other: &Looked, planes: &[SymmetryPlane]) -> bool {
    let (Ok(one), Ok(other)) = (&one.found, &other.found) else {
        return false;
    };
    let from = |pose: &Pose| geodesic_deg(&pose.rotation, &other.pose.rotation);
    let mut images = planes.iter().map(|plane| mirror_pose(&one.pose, plane));
    from(&one.pose) >= ONE_DEG && images.any(|image| from(&image) < from(&one.pose))
}

/// By how much less than what is there something leaves.
fn votes_for(looked: &Looked, there: &Cell) -> f64 {
    match (&looked.found, there.found()) {
        (Ok(here), Some(there)) => ln(there.misfit_px / here.misfit_px) / ln(ELSEWHERE_RATIO),
        (Err(_), Some(_)) => -MOST,
        _ => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::follow::fake::{looked, turned};
    use crate::follow::look::Missing;
    use core::ops::Range;

    const MIDDLE: Vector3 = [0.0; 3];

    /// A frame of a film that turns by 2 degrees from frame to frame.
    fn seen(frame: usize, off_deg: f64, misfit_px: f64) -> Looked {
        looked(Ok(turned(2.0 * frame as f64 + off_deg, misfit_px)))
    }

    /// Twenty frames; from `slid` on 4 degrees off and leaving more.
    fn film(slid: Range<usize>) -> Vec<Cell> {
        let one = |frame: usize| match slid.contains(&frame) {
            true => seen(frame, 4.0, 0.7),
            false => seen(frame, 0.0, 0.5),
        };
        (0..20).map(|frame| Cell::on_the_way(one(frame))).collect()
    }

    /// Crosses all jumps; every frame shows the right pose to who comes from one, and the false one to who comes from that.
    fn crossed(mut cells: Vec<Cell>, planes: &[SymmetryPlane]) -> (Vec<Cell>, usize) {
        let mut looks = 0;
        for (from, forward) in frames_to_cross_from(&cells, &MIDDLE) {
            let Some(mut crossing) = Crossing::over(&cells, from, forward, &MIDDLE) else {
                continue;
            };
            let slid = cells[from]
                .found()
                .is_some_and(|found| found.misfit_px > 0.6);
            while let Some(frame) = crossing.next() {
                looks += 1;
                let looked = if slid {
                    seen(frame, 4.0, 0.7)
                } else {
                    seen(frame, 0.0, 0.5)
                };
                crossing.saw(frame, looked, (&MIDDLE, planes));
            }
            crossing.write(&mut cells);
        }
        (cells, looks)
    }

    #[test]
    fn what_slid_comes_back_from_either_side_and_the_right_frames_stay() {
        for slid in [8..13, 0..4, 15..20, 9..10, 6..16] {
            let (cells, _) = crossed(film(slid.clone()), &[]);
            for (frame, cell) in cells.iter().enumerate() {
                let found = cell.found().expect("found");
                assert_eq!(found.misfit_px, 0.5, "{slid:?}, frame {frame}");
                assert_eq!(cell.other_way, None, "{slid:?}, frame {frame}");
            }
        }
    }

    /// A part that is the same seen from both sides of a plane, filmed nearly square to that: its mirror image is turned the other
    /// way. What leaves less there is not gone over to.
    #[test]
    fn the_other_side_of_the_mirror_is_not_gone_over_to() {
        let at = |frame: usize, deg: f64, px: f64| {
            let pose = turned(deg, px);
            (frame, Cell::on_the_way(looked(Ok(pose))))
        };
        let plane = SymmetryPlane {
            point: [0.0; 3],
            normal: [0.0, 0.0, 1.0],
            deviation_mm: 0.0,
        };
        let cells = || {
            (0..9)
                .map(|frame| at(frame, 6.0, 0.7).1)
                .collect::<Vec<Cell>>()
        };
        for (planes, gone_over) in [(&[plane][..], false), (&[], true)] {
            let mut cells = cells();
            let mut crossing = Crossing::over(&cells, 4, true, &MIDDLE).expect("frames behind");
            while let Some(frame) = crossing.next() {
                crossing.saw(frame, looked(Ok(turned(-6.0, 0.5))), (&MIDDLE, planes));
            }
            crossing.write(&mut cells);
            let left = cells[6].found().map(|found| found.misfit_px);
            assert_eq!(left == Some(0.5), gone_over);
        }
    }

    #[test]
    fn a_steady_film_is_not_looked_at_again() {
        assert_eq!(crossed(film(0..0), &[]).1, 0);
        assert_eq!(crossed(film(0..20), &[]).1, 0);
    }

    #[test]
    fn poses_that_a_person_gave_stay_and_stop_it() {
        let mut cells = film(8..13);
        cells[10].fixed = true;
        let (cells, _) = crossed(cells, &[]);
        assert_eq!(cells[10].found(), film(8..13)[10].found());
        assert!(cells[10].fixed);
        for frame in [8, 9, 11, 12] {
            assert_eq!(cells[frame].found().map(|found| found.misfit_px), Some(0.5));
        }
    }

    #[test]
    fn a_way_that_loses_the_component_changes_nothing() {
        let cells = film(8..13);
        let mut crossing = Crossing::over(&cells, 7, true, &MIDDLE).expect("frames behind");
        let nothing = looked(Err(Missing::Hidden));
        while let Some(frame) = crossing.next() {
            crossing.saw(frame, nothing, (&MIDDLE, &[]));
        }
        let mut after = cells.clone();
        crossing.write(&mut after);
        for (cell, before) in after.iter().zip(&cells) {
            let turn = |cell: &Cell| cell.found().expect("found").pose.rotation;
            assert!(geodesic_deg(&turn(cell), &turn(before)) < 1e-9);
        }
    }

    /// A frame that lies off the way, and those beside it, which lie half as far off their own: jumps between all of these and the next are
    /// crossed both ways.
    #[test]
    fn jumps_are_crossed_from_the_frames_on_both_sides_of_each() {
        let expected: Vec<(usize, bool)> = (8..=11)
            .flat_map(|frame| [(frame - 1, true), (frame, false)])
            .collect();
        assert_eq!(frames_to_cross_from(&film(9..10), &MIDDLE), expected);
    }

    /// Where what was there leaves less all along, by as much as decides, it is right without a doubt; where it hardly does, both stay open.
    #[test]
    fn what_was_there_is_sure_where_another_way_leaves_more_all_along() {
        let other_ways = |frames: usize, times: f64| {
            let before: Vec<Cell> = (0..=frames)
                .map(|frame| Cell::on_the_way(seen(frame, 0.0, 0.5)))
                .collect();
            let mut crossing = Crossing::over(&before, 0, true, &MIDDLE).expect("frames behind");
            while let Some(frame) = crossing.next() {
                // On the other side of where the part turns to: nowhere between does the one lie nearer to the other.
                crossing.saw(frame, seen(frame, -5.0, 0.5 * times), (&MIDDLE, &[]));
            }
            let mut after = before.clone();
            crossing.write(&mut after);
            let stays = |(a, b): (&Cell, &Cell)| a.found() == b.found();
            assert!(after.iter().zip(&before).all(stays), "{frames} {times}");
            after.iter().filter(|cell| cell.other_way.is_some()).count()
        };
        // A vote is a misfit that is so many times less.
        assert_eq!(other_ways(3, ELSEWHERE_RATIO), 0);
        assert_eq!(other_ways(1, 1.01 * ELSEWHERE_RATIO), 1);
    }
}
