//! Frames of a film seen from both sides of a component's mirror, and from elsewhere: which, what they say, and where another
//! pose is taken.

#[cfg(feature = "alloc")]
use alloc::vec::Vec;
use core::ops::Range;

use super::cell::{Anchor, Cell};
use super::frame_pose::FramePose;
use super::motion::off_out_of_plane_deg;
#[cfg(feature = "alloc")]
use super::motion::out_of_plane_deg;
#[cfg(feature = "alloc")]
use super::sides::SAME_DEG;
use super::sides::{KneeFigures, ONE_DEG, Rival, Side, SideEvidence, SideFigures, SideStep};
#[cfg(feature = "alloc")]
use crate::math::Vector3;
use crate::pose::{Pose, geodesic_deg};

/// Every so many frames both sides are looked at; more often in a short film.
const EVERY: usize = 8;
const LEAST: usize = 6;
/// Poses of two frames belong together crosswise where they are nearer by this part than as they are.
#[cfg(feature = "alloc")]
pub(super) const CROSSED: f64 = 0.5;
/// Two frames tell what lies between them where each tells as much as so many that decide by themselves,
#[cfg(feature = "alloc")]
const TOLD: f64 = 3.0;
/// where their sides are so many times farther apart than where both are one,
#[cfg(feature = "alloc")]
const APART: f64 = 4.0;
/// and where no frame between them leaves more than so many times what they do. All three are judgements: where one does not hold, all frames are seen.
#[cfg(feature = "alloc")]
const ALIKE: f64 = 1.15;
/// Where there is no other side, it fits so many times worse.
const NO_OTHER: f64 = 10.0;

/// A frame seen from both sides, or from elsewhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SideSample {
    /// Number of the frame.
    pub frame: usize,
    /// The pose on the trail.
    pub own: FramePose,
    /// What the other pose is.
    pub rival: Rival,
    /// The other pose ([`super::mirrored_pose`], [`super::elsewhere()`]), where there is one.
    pub other: Option<FramePose>,
    /// Whether a person gave the pose.
    pub fixed: bool,
}

impl SideSample {
    /// What the frame says of both. `knee` gives what the joint of a pose with the other component says, where that is known.
    #[must_use]
    pub fn evidence(&self, knee: impl Fn(&Pose) -> Option<KneeFigures>) -> SideEvidence {
        let figures = |found: &FramePose| SideFigures {
            misfit_px: found.misfit_px,
            knee: knee(&found.pose),
        };
        let own = figures(&self.own);
        // Where there is no other side, that speaks for the own; where starts beside it lead back to it, for nothing.
        let none = SideFigures {
            misfit_px: match self.rival {
                Rival::Mirrored => NO_OTHER * own.misfit_px,
                Rival::Elsewhere => own.misfit_px,
            },
            knee: None,
        };
        let other = self.free();
        let apart = |other: FramePose| geodesic_deg(&self.own.pose.rotation, &other.pose.rotation);
        SideEvidence {
            frame: self.frame,
            own,
            mirrored: other.as_ref().map_or(none, figures),
            apart_deg: other.map_or(180.0, apart),
            rival: self.rival,
            went_over: false,
            sure: 1.0,
            goes_on: [false; 2],
            turn_deg: 0.0,
        }
    }

    /// Whether the trail has gone over to the other side between an earlier frame and this one, and how sure that is, 0 to 1: each pose is
    /// nearer to the other one of the other frame. Where the part turns as far between the two as its sides are apart, the side that it
    /// is seen from tells: limbs swing in the image plane, and mirror images differ out of it.
    #[cfg(feature = "alloc")]
    fn went_over_since(&self, before: &Self) -> (bool, f64) {
        let both = self.other.as_ref().zip(before.other.as_ref());
        let Some((other, before_other)) = both.filter(|_| self.rival == Rival::Mirrored) else {
            return (false, 1.0);
        };
        let ways = |apart: &dyn Fn(&Pose, &Pose) -> f64| {
            let of = |a: &FramePose, b: &FramePose| apart(&a.pose, &b.pose);
            let stayed = of(&self.own, &before.own) + of(other, before_other);
            let crossed = of(&self.own, before_other) + of(other, &before.own);
            [stayed, crossed]
        };
        let told = |[stayed, crossed]: [f64; 2]| {
            let nearer = stayed.min(crossed) / stayed.max(crossed).max(f64::MIN_POSITIVE);
            let sure = ((1.0 - nearer) / (1.0 - CROSSED)).min(1.0);
            (crossed < stayed, sure)
        };
        let by_all = told(ways(&|a, b| geodesic_deg(&a.rotation, &b.rotation)));
        match by_all.1 < 1.0 {
            true => told(ways(&|a, b| out_of_plane_deg(a, b))),
            false => by_all,
        }
    }

    /// Whether the other pose goes on from the trail of an earlier frame, and the trail from the other pose there, rather than the trail from
    /// itself.
    #[cfg(feature = "alloc")]
    fn goes_on_from(&self, before: &Self) -> [bool; 2] {
        if self.rival == Rival::Mirrored {
            return [false; 2];
        }
        let deg = |a: &FramePose, b: &FramePose| out_of_plane_deg(&a.pose, &b.pose);
        let most = CROSSED * deg(&self.own, &before.own);
        let is_near = |a: Option<&FramePose>, b: Option<&FramePose>| {
            a.zip(b).is_some_and(|(a, b)| deg(a, b) < most)
        };
        [
            is_near(self.other.as_ref(), Some(&before.own)),
            is_near(Some(&self.own), before.other.as_ref()),
        ]
    }

    /// The pose on the side that was chosen, where that of the frame `now` is rather the rejected one's.
    #[cfg(feature = "alloc")]
    pub(super) fn chosen_but_left(&self, side: Side, now: &FramePose) -> Option<FramePose> {
        let deg = |a: &FramePose, b: &FramePose| geodesic_deg(&a.pose.rotation, &b.pose.rotation);
        let [chosen, rejected] = self.two_sides(side, ONE_DEG, deg)?;
        (deg(now, &rejected) < CROSSED * deg(now, &chosen)).then_some(chosen)
    }

    /// The directions from which the chosen and the rejected side are seen; `None` where both sides are one.
    #[cfg(feature = "alloc")]
    pub(super) fn directions_of_sides(&self, side: Side) -> Option<[Vector3; 2]> {
        let deg = |a: &FramePose, b: &FramePose| out_of_plane_deg(&a.pose, &b.pose);
        let both = self.two_sides(side, SAME_DEG, deg)?;
        Some(both.map(|found| found.pose.rotation[2]))
    }

    /// What was chosen and what was rejected, where these are two by so many degrees.
    #[cfg(feature = "alloc")]
    fn two_sides(
        &self,
        side: Side,
        two_deg: f64,
        deg: impl Fn(&FramePose, &FramePose) -> f64,
    ) -> Option<[FramePose; 2]> {
        let other = self.free().filter(|_| self.rival == Rival::Mirrored)?;
        let both = match side {
            Side::Own => [self.own, other],
            Side::Mirrored => [other, self.own],
        };
        (deg(&self.own, &other) >= two_deg).then_some(both)
    }

    /// The other pose; none where a person has chosen.
    pub(super) fn free(&self) -> Option<FramePose> {
        self.other.filter(|_| !self.fixed)
    }

    /// The mirror image of what a cell has now, which may have gone over to the other side since both were seen.
    #[must_use]
    pub fn mirrored_now(&self, now: &FramePose) -> Option<FramePose> {
        match now.pose == self.own.pose {
            true => self.other,
            false => Some(self.own),
        }
    }
}

/// What the frames of a film say of both their poses, in their order. `knee` gives what the joint of a pose in a frame with the other
/// component says, where that is known.
#[cfg(feature = "alloc")]
pub(super) fn evidence_of(
    samples: &[SideSample],
    knee: impl Fn(usize, &Pose) -> Option<KneeFigures>,
) -> Vec<SideEvidence> {
    let befores = core::iter::once(None).chain(samples.iter().map(Some));
    let each = samples.iter().zip(befores);
    let evidence = each.map(|(sample, before)| {
        let (went_over, sure) =
            before.map_or((false, 1.0), |before| sample.went_over_since(before));
        SideEvidence {
            went_over,
            sure,
            goes_on: before.map_or([false; 2], |before| sample.goes_on_from(before)),
            turn_deg: before.map_or(0.0, |before| {
                out_of_plane_deg(&before.own.pose, &sample.own.pose)
            }),
            ..sample.evidence(|pose| knee(sample.frame, pose))
        }
    });
    evidence.collect()
}

/// The frames that may be seen from both sides, in their order: some all along the film, and those where the trail rocks as if it went
/// over the mirror and back.
pub fn frames_for_sides(cells: &[Cell]) -> impl Iterator<Item = usize> + '_ {
    numbered(cells).map(|(frame, _)| frame)
}

/// Those of them that are seen before any side is chosen: every other of those all along a long film, and all where the trail rocks.
#[cfg(feature = "alloc")]
pub(super) fn first_for_sides(cells: &[Cell]) -> impl Iterator<Item = usize> + '_ {
    let is_first = |&(_, number): &(usize, Option<usize>)| number.is_none_or(|k| k % 2 == 0);
    numbered(cells).filter(is_first).map(|(frame, _)| frame)
}

/// [`frames_for_sides`], those all along a film that is long with their numbers: a short one has few.
fn numbered(cells: &[Cell]) -> impl Iterator<Item = (usize, Option<usize>)> + '_ {
    let posed = || (0..cells.len()).filter(|&frame| cells[frame].found().is_some());
    let every = (posed().count() / LEAST).clamp(1, EVERY);
    let near = |frame: usize| frame.saturating_sub(1)..=frame + 1;
    posed().enumerate().filter_map(move |(k, frame)| {
        let by_itself = cells[frame].fixed || near(frame).any(|frame| rocks(cells, frame));
        let is_regular = k % every == every / 2;
        let number = (!by_itself && every == EVERY).then_some(k / every);
        (is_regular || by_itself).then_some((frame, number))
    })
}

/// Whether what two frames said of their sides tells the side of all between them: the trail is on the right one in both by far, its sides stay
/// apart, and no frame between them leaves more than these.
#[cfg(feature = "alloc")]
pub(super) fn tell_between(
    [(before, first), (behind, last)]: [(&SideSample, &SideStep); 2],
    cells: &[Cell],
) -> bool {
    let is_told = |step: &SideStep| step.side == Side::Own && step.margin >= TOLD;
    let apart = |sample: &SideSample| {
        let other = sample.other.as_ref().map(|other| &other.pose.rotation);
        other.map_or(0.0, |other| geodesic_deg(&sample.own.pose.rotation, other))
    };
    let least_apart = apart(before).min(apart(behind));
    let turn = out_of_plane_deg(&before.own.pose, &behind.own.pose);
    let most_px = ALIKE * before.own.misfit_px.max(behind.own.misfit_px);
    let is_alike = |cell: &Cell| cell.found().is_some_and(|now| now.misfit_px <= most_px);
    let between = cells.get(before.frame..behind.frame).unwrap_or_default();
    is_told(first)
        && is_told(last)
        && least_apart >= APART * ONE_DEG
        && turn <= least_apart / 2.0
        && between.iter().all(is_alike)
}

/// Whether a frame lies as far out of the image plane off the way between those beside it as one does where two sides of a mirror that are
/// two begin to jump: limbs swing fast in that plane, and hardly out of it.
fn rocks(cells: &[Cell], frame: usize) -> bool {
    let pose = |frame: usize| Some(cells.get(frame)?.found()?.pose);
    let off_deg = || {
        let (before, after) = (pose(frame.checked_sub(1)?)?, pose(frame + 1)?);
        Some(off_out_of_plane_deg(&pose(frame)?, [&before, &after]))
    };
    off_deg().is_some_and(|off| off >= ONE_DEG / 2.0)
}

/// Runs of frames, of a film of `frames`, in which the other pose is the right one by the `steps` of [`super::choose_sides`], each
/// with the frame to follow it from.
pub fn runs_to_go_over<'s>(
    samples: &'s [SideSample],
    steps: &'s [SideStep],
    frames: usize,
) -> impl Iterator<Item = (Range<usize>, Anchor)> + 's {
    let mut at = 0;
    core::iter::from_fn(move || {
        while at < samples.len() {
            let (begin, side) = (at, steps.get(at)?.side);
            let differs = |&k: &usize| steps.get(k).is_none_or(|step| step.side != side);
            at = (at..samples.len()).find(differs).unwrap_or(samples.len());
            let first = begin.checked_sub(1).map_or(0, |last| {
                usize::midpoint(samples[last].frame, samples[begin].frame) + 1
            });
            let behind = samples.get(at).map_or(frames, |next| {
                usize::midpoint(samples[at - 1].frame, next.frame) + 1
            });
            let anchor = best_other(&samples[begin..at]);
            if let (Side::Mirrored, Some(anchor)) = (side, anchor) {
                return Some((first..behind, anchor));
            }
        }
        None
    })
}

fn best_other(samples: &[SideSample]) -> Option<Anchor> {
    // What a person gave stays, even where the film speaks for the other side.
    let others = samples
        .iter()
        .filter_map(|sample| Some(Anchor::found(sample.frame, sample.free()?)));
    others.max_by(|a, b| a.found.score().total_cmp(&b.found.score()))
}

#[cfg(test)]
mod tests;
