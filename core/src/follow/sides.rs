//! Which of two mirrored ways through a film is the right one.
//!
//! A trail stays on its side of the mirror as long as both sides are apart, so the evidence of all frames between two
//! such meetings adds up: residuals where they decide, the joint with the other component where that is known.
//! The sides of all frames are chosen together by dynamic programming.

use crate::finder::choice::{DECISIVE_RATIO, TILT_MARGIN_DEG};
use crate::math::ln;

/// What a frame says of a pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SideFigures {
    /// What remains between outline and edges, pixels.
    pub misfit_px: f64,
    /// What the joint with the other component says, where that is known.
    pub knee: Option<KneeFigures>,
}

/// What the joint of a pose with the other component says of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KneeFigures {
    /// Coronal tilt, degrees.
    pub tilt_deg: f64,
    /// Whether it bends, tilts or turns as no knee does.
    pub is_impossible: bool,
}

impl KneeFigures {
    /// What the knee says for a pose and against another, 1 where it decides by itself. A tray seen along its stem and its mirror image may
    /// tilt alike, and one of them lie upside down.
    fn for_first(&self, other: &Self) -> f64 {
        match (self.is_impossible, other.is_impossible) {
            (true, false) => -1.0,
            (false, true) => 1.0,
            _ => ((other.tilt_deg.abs() - self.tilt_deg.abs()) / TILT_MARGIN_DEG).clamp(-1.0, 1.0),
        }
    }
}

/// What another pose of a frame is to the one on the trail.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rival {
    /// Its mirror image, which leaves as much but for what differs between model and part: misfits are a hint only.
    Mirrored,
    /// Another minimum ([`super::elsewhere`]): the right one of the two leaves less.
    Elsewhere,
}

/// What a frame says of a pose and of another one, its mirror image before all.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SideEvidence {
    /// Number of the frame.
    pub frame: usize,
    /// Of the pose on the trail.
    pub own: SideFigures,
    /// Of the other one.
    pub mirrored: SideFigures,
    /// Turn between the two, degrees.
    pub apart_deg: f64,
    /// What the other pose is.
    pub rival: Rival,
    /// Whether the trail has gone over to the other side since the frame before: one side of the mirror is then the trail there and the
    /// other pose here.
    pub went_over: bool,
    /// How sure that is, or that it has not, 0 to 1.
    pub sure: f64,
    /// Of a pose elsewhere: whether it goes on from the trail of the frame before, and whether the trail goes on from what was elsewhere
    /// there, rather than the trail from itself.
    pub goes_on: [bool; 2],
    /// By how much the trail turns out of the image plane from the frame before, degrees.
    pub turn_deg: f64,
}

/// Which of the two is the right one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Side {
    /// The pose on the trail.
    #[default]
    Own,
    /// Its mirror image.
    Mirrored,
}

/// What was chosen for a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SideStep {
    /// The side.
    pub side: Side,
    /// By how much the other side costs more: 1 is what a frame says that decides by itself.
    pub margin: f64,
    /// Least cost of the frames so far that ends on either side.
    costs: [f64; 2],
}

/// Both sides are one where they are nearer to each other than this, degrees: a trail may go over there.
pub(super) const ONE_DEG: f64 = 4.0;
/// Below this they are the same pose, of which a frame cannot tell two.
pub(super) const SAME_DEG: f64 = 2.0;
/// What it costs to go over from one side to the other, where they meet and elsewhere.
const GO_OVER: [f64; 2] = [0.5, 4.0];
/// What it costs to stay on a trail that jumps by [`ONE_DEG`] or less where another pose does not; by more, as much more, up to [`MOST`].
const JUMP: f64 = 0.5;
/// So many times the misfit tells by itself which of two minima is the right one, where they are no mirror images.
pub(super) const ELSEWHERE_RATIO: f64 = 1.1;
/// Both sides are two, however near they are, where one leaves so many times what the other does: from the first number on a little, from the second
/// on wholly.
const SEVERAL: [f64; 2] = [2.0, 3.0];
/// What residuals say that decide nothing by themselves.
const HINT: f64 = 0.25;
/// The most that one frame says.
pub(super) const MOST: f64 = 2.0;

impl SideStep {
    /// What speaks for the trail, as far as it speaks for what was chosen.
    #[cfg(feature = "alloc")]
    pub(super) fn told_by(&self, for_own: f64) -> f64 {
        match self.side {
            Side::Own => for_own,
            Side::Mirrored => -for_own,
        }
    }

    /// Leaves the frame to what it says alone: what frames beside it say counts as far as it says the same.
    #[cfg(feature = "alloc")]
    pub(super) fn speaks_for_itself(&mut self, evidence: &SideEvidence) {
        let own = evidence.for_own();
        let side = match own < 0.0 {
            true => Side::Mirrored,
            false => Side::Own,
        };
        self.margin = match side == self.side {
            true => self.margin.min(own.abs()),
            false => own.abs(),
        };
        self.side = side;
    }
}

impl SideEvidence {
    /// What the frame says for the pose on the trail, and against it where it is negative.
    pub(super) fn for_own(&self) -> f64 {
        let told = self.told();
        let residual = (told * self.residual()).clamp(-MOST, MOST);
        if self.rival == Rival::Elsewhere {
            return residual;
        }
        let both = self.own.knee.zip(self.mirrored.knee);
        let knee = told * both.map_or(0.0, |(own, mirrored)| own.for_first(&mirrored));
        match self.residual().abs() >= 1.0 {
            // What differs between model and part is the same in all frames, and so are their residuals, and the right side may not have
            // come to its minimum: where the knee tells otherwise, they do not tell by themselves.
            true if residual * knee < 0.0 => residual + knee,
            true => residual,
            false => knee + HINT * residual,
        }
    }

    /// How far both are two poses of which a frame can tell, 0 to 1: two sides of a mirror become one slowly. However near both are, one that
    /// leaves several times as much is not it.
    fn told(&self) -> f64 {
        let between = |at: f64, [from, to]: [f64; 2]| ((at - from) / (to - from)).clamp(0.0, 1.0);
        let decisions = self.residual().abs() * ln(DECISIVE_RATIO);
        match self.rival {
            Rival::Mirrored => {
                let apart = between(self.apart_deg, [SAME_DEG, ONE_DEG]);
                apart.max(between(decisions, SEVERAL.map(ln)))
            }
            Rival::Elsewhere => 1.0,
        }
    }

    /// What the residuals of both say for the pose on the trail, 1 where they decide by themselves.
    fn residual(&self) -> f64 {
        let ratio = self.mirrored.misfit_px / self.own.misfit_px;
        let decisive = match self.rival {
            Rival::Mirrored => DECISIVE_RATIO,
            Rival::Elsewhere => ELSEWHERE_RATIO,
        };
        ln(ratio.clamp(0.1, 10.0)) / ln(decisive)
    }

    /// What either side costs.
    fn costs(&self) -> [f64; 2] {
        let own = self.for_own();
        [(-own).max(0.0), own.max(0.0)]
    }

    /// What the ways to the next frame cost: row by row from the trail and from the other pose, to the trail and to the other pose.
    /// Where the trail jumps and the other pose does not, it is the trail that goes over.
    fn to(&self, next: &Self) -> [[f64; 2]; 2] {
        let [meeting, apart] = GO_OVER;
        let over = match self.meet() || next.meet() {
            true => meeting,
            false => meeting + next.sure * (apart - meeting),
        };
        let [leaves, comes] = next.goes_on.map(|goes_on| if goes_on { 0.0 } else { over });
        let jump = match next.goes_on.contains(&true) {
            true => JUMP * (next.turn_deg / ONE_DEG).clamp(1.0, MOST / JUMP),
            false => 0.0,
        };
        [[jump, leaves], [comes, 0.0]]
    }

    /// What the pose of a number, 0 for the trail's, is in the frame before, and the other way round.
    fn across(&self, pose: usize) -> usize {
        match self.went_over {
            true => 1 - pose,
            false => pose,
        }
    }

    /// Whether both sides of a mirror are one here.
    fn meet(&self) -> bool {
        self.rival == Rival::Mirrored && self.apart_deg < ONE_DEG
    }
}

/// Chooses a side for each frame of a trail that was looked at from both; they come in the order of their frames.
/// Frames for which there is no step are left out.
pub fn choose_sides(evidence: &[SideEvidence], steps: &mut [SideStep]) {
    let count = evidence.len().min(steps.len());
    let (evidence, steps) = (&evidence[..count], &mut steps[..count]);
    for at in 0..count {
        let own = evidence[at].costs();
        let led = at.checked_sub(1).map(|last| {
            let (before, ways) = (steps[last].costs, evidence[last].to(&evidence[at]));
            [0, 1].map(|to: usize| {
                let by = |from: usize| before[from] + ways[from][evidence[at].across(to)];
                by(0).min(by(1))
            })
        });
        let led = led.unwrap_or_default();
        steps[at] = SideStep {
            costs: [0, 1].map(|side: usize| led[side] + own[side]),
            ..SideStep::default()
        };
    }
    let mut rest = [0.0; 2];
    for at in (0..count).rev() {
        if let Some(next) = evidence.get(at + 1) {
            let (own, ways) = (next.costs(), evidence[at].to(next));
            let behind = [0, 1].map(|side: usize| rest[side] + own[side]);
            rest = [0, 1].map(|from: usize| {
                let by = |to: usize| ways[from][next.across(to)] + behind[to];
                by(0).min(by(1))
            });
        }
        let step = &mut steps[at];
        let [own, mirrored] = [0, 1].map(|side: usize| step.costs[side] + rest[side]);
        step.side = match mirrored < own {
            true => Side::Mirrored,
            false => Side::Own,
        };
        step.margin = (own - mirrored).abs();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::vec;
    use std::vec::Vec;

    fn seen(frame: usize, ratio: f64, tilts: Option<[f64; 2]>, apart_deg: f64) -> SideEvidence {
        let figures = |misfit_px: f64, k: usize| SideFigures {
            misfit_px,
            knee: tilts.map(|tilts| KneeFigures {
                tilt_deg: tilts[k],
                is_impossible: false,
            }),
        };
        SideEvidence {
            frame,
            own: figures(1.0, 0),
            mirrored: figures(ratio, 1),
            apart_deg,
            rival: Rival::Mirrored,
            went_over: false,
            sure: 1.0,
            goes_on: [false; 2],
            turn_deg: 0.0,
        }
    }

    fn chosen(evidence: &[SideEvidence]) -> Vec<(Side, f64)> {
        let mut steps = vec![SideStep::default(); evidence.len()];
        choose_sides(evidence, &mut steps);
        steps.iter().map(|step| (step.side, step.margin)).collect()
    }

    #[test]
    fn one_frame_that_errs_does_not_turn_a_film() {
        let film: Vec<_> = (0..9)
            .map(|frame| {
                let tilts = if frame == 4 { [6.0, 1.0] } else { [1.0, 6.0] };
                seen(frame, 1.0, Some(tilts), 12.0)
            })
            .collect();
        for (side, margin) in chosen(&film) {
            assert_eq!(side, Side::Own);
            assert!(margin >= 4.0, "{margin}");
        }
    }

    /// Tilts of a tray seen along its stem: both sides are level, and one lies upside down.
    #[test]
    fn the_side_that_no_knee_has_is_not_chosen() {
        let film = |is_impossible: [bool; 2]| -> Vec<SideEvidence> {
            let frames = (0..8).map(|frame| seen(frame, 0.98, Some([0.9, 1.2]), 177.0));
            let judged = frames.map(|mut one| {
                let knees = [&mut one.own.knee, &mut one.mirrored.knee];
                for (knee, is_impossible) in knees.into_iter().flatten().zip(is_impossible) {
                    knee.is_impossible = is_impossible;
                }
                one
            });
            judged.collect()
        };
        let chosen = |is_impossible: [bool; 2]| chosen(&film(is_impossible))[0];
        for (is_impossible, side) in [([true, false], Side::Mirrored), ([false, true], Side::Own)] {
            let (told, margin) = chosen(is_impossible);
            assert!(told == side && margin > 4.0, "{told:?} {margin}");
        }
        assert_eq!(chosen([true; 2]), chosen([false; 2]));
    }

    /// What four frames' residuals tell is one thing told four times.
    #[test]
    fn residuals_and_a_knee_that_contradict_each_other_leave_it_open() {
        let film = |tilts: Option<[f64; 2]>| {
            let frames = (0..4).map(|frame| seen(frame, 1.35, tilts, 18.0));
            let frames: Vec<_> = frames.collect();
            chosen(&frames)
        };
        let decided = film(None)[0];
        assert!(decided.0 == Side::Own && decided.1 > 4.0);
        assert_eq!(film(Some([1.0, 4.0])), film(None), "they agree");
        let (_, margin) = film(Some([4.0, 1.0]))[0];
        assert!(margin < 1.0, "{margin}");
    }

    #[test]
    fn where_both_sides_meet_the_trail_may_have_gone_over() {
        let film: Vec<_> = (0..9)
            .map(|frame| match frame {
                0..4 => seen(frame, 1.0, Some([1.0, 6.0]), 12.0),
                4 => seen(frame, 1.0, Some([2.0, 2.5]), 1.0),
                _ => seen(frame, 1.0, Some([6.0, 1.0]), 12.0),
            })
            .collect();
        let sides: Vec<Side> = chosen(&film).iter().map(|step| step.0).collect();
        assert_eq!(sides[..4], [Side::Own; 4]);
        assert_eq!(sides[5..], [Side::Mirrored; 4]);
    }

    /// A trail that jumped over the mirror is no way: what goes on there is the other pose.
    #[test]
    fn where_the_trail_jumped_over_its_other_side_goes_on() {
        let film = |went_over: bool| -> Vec<SideEvidence> {
            let before = (0..3).map(|frame| seen(frame, 1.2, Some([0.2, 2.4]), 90.0));
            let behind = (3..5).map(|frame| SideEvidence {
                went_over: went_over && frame == 3,
                ..seen(frame, 0.9, Some([2.5, 1.2]), 90.0)
            });
            before.chain(behind).collect()
        };
        let sides = |film: &[SideEvidence]| -> Vec<Side> {
            chosen(film).iter().map(|step| step.0).collect()
        };
        let (own, other) = (Side::Own, Side::Mirrored);
        assert_eq!(sides(&film(true)), [own, own, own, other, other]);
        assert_eq!(sides(&film(false)), [own; 5]);
        // Whichever the trail is called.
        let mut turned = film(true);
        turned[3..].iter_mut().for_each(|one| {
            (one.own, one.mirrored) = (one.mirrored, one.own);
        });
        turned[3].went_over = false;
        let margins = |film: &[SideEvidence]| {
            chosen(film)
                .into_iter()
                .map(|step| step.1)
                .collect::<Vec<_>>()
        };
        assert_eq!(sides(&turned), [own; 5]);
        assert_eq!(margins(&turned), margins(&film(true)));
    }

    /// Of a pose that is on neither side nobody can say which is the trail's.
    #[test]
    fn frames_whose_sides_are_not_told_apart_are_not_bound_to_each_other() {
        let film = |sure: f64| -> Vec<SideEvidence> {
            let seen = |frame: usize| match frame {
                0 => seen(frame, 1.7, Some([0.5, 4.0]), 5.0),
                _ => SideEvidence {
                    sure: if frame == 1 { sure } else { 1.0 },
                    ..seen(frame, 0.95, Some([4.0, 0.5]), 5.0)
                },
            };
            (0..8).map(seen).collect()
        };
        let first = |sure: f64| chosen(&film(sure))[0];
        assert_eq!(first(1.0).0, Side::Mirrored);
        let (side, margin) = first(0.1);
        assert!(side == Side::Own && margin > 1.0, "{margin}");
    }

    #[test]
    fn a_trail_that_jumps_is_left_where_it_does() {
        let film = |jumps: bool| -> Vec<SideEvidence> {
            let seen = |frame: usize| SideEvidence {
                rival: Rival::Elsewhere,
                goes_on: [jumps && frame == 6, false],
                ..seen(frame, if frame < 6 { 1.08 } else { 0.7 }, None, 5.0)
            };
            (0..8).map(seen).collect()
        };
        let [stayed, left] = [false, true].map(|jumps| chosen(&film(jumps)));
        assert!(stayed.iter().all(|step| step.0 == Side::Own));
        let sides = left.iter().map(|step| step.0);
        assert!(
            sides
                .enumerate()
                .all(|(k, side)| (side == Side::Mirrored) == (k >= 6))
        );
        assert!(left[6].1 > 3.0 && left[7].1 > 3.0, "{left:?}");
    }

    #[test]
    fn a_frame_that_the_trail_jumps_to_and_from_is_open() {
        let film = |turn_deg: f64| -> Vec<SideEvidence> {
            let seen = |frame: usize| SideEvidence {
                rival: Rival::Elsewhere,
                goes_on: [frame == 4, frame == 5],
                turn_deg,
                ..seen(frame, 1.3, None, 5.0)
            };
            (0..8).map(seen).collect()
        };
        assert_eq!(chosen(&film(1.0))[4].0, Side::Own);
        assert_eq!(chosen(&film(17.0))[4].0, Side::Mirrored);
        assert!(
            chosen(&film(17.0))
                .iter()
                .filter(|step| step.0 == Side::Mirrored)
                .count()
                == 1
        );
    }

    #[test]
    fn sides_that_are_nearly_one_are_told_apart_by_what_is_left_of_the_difference() {
        let film = |apart_deg: f64| [seen(0, 1.4, None, 12.0), seen(8, 1.4, None, apart_deg)];
        let margin = |apart_deg: f64| chosen(&film(apart_deg))[1].1;
        assert!(margin(1.9) < margin(3.0) && margin(3.0) < margin(3.9));
        assert!(margin(1.9) < 1.0 && margin(3.9) > 1.0);
        // One of the two leaves three times as much.
        let film = [seen(0, 1.4, None, 12.0), seen(8, 3.0, None, 2.4)];
        assert!(chosen(&film)[1].1 > 1.0);
    }

    /// A start on the other side that ends in a false minimum a degree beside the trail: the trail may seem to go over there and back.
    #[test]
    fn what_leaves_several_times_as_much_is_not_it_however_near_it_is() {
        let film = |ratio: f64| {
            let mut film = [
                seen(0, 8.9, None, 8.3),
                seen(2, ratio, None, 1.1),
                seen(4, 6.6, None, 3.2),
            ];
            film[1..].iter_mut().for_each(|one| one.went_over = true);
            film
        };
        assert_eq!(chosen(&film(1.2))[1].0, Side::Mirrored);
        let told = chosen(&film(3.0));
        assert!(
            told.iter()
                .all(|(side, margin)| *side == Side::Own && *margin >= 1.0)
        );
    }

    #[test]
    fn residuals_alike_and_no_other_component_leave_it_open() {
        let film: Vec<_> = (0..4).map(|frame| seen(frame, 1.02, None, 12.0)).collect();
        for (_, margin) in chosen(&film) {
            assert!(margin < 0.5, "{margin}");
        }
        assert!(chosen(&[]).is_empty());
    }
}
