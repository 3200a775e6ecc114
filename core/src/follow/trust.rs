//! How far each frame of a film is to be trusted, in one word with its reason.

use super::distrust::Distrust;
use super::frame_pose::FramePose;
use super::motion::between;
use super::side_margin::SideMargin;
use super::trail::{apart, in_plane};
use super::trust_limits::TrustLimits;
use crate::math::{Vector3, add, norm, scale, subtract};
use crate::pose::Pose;
use crate::pose::covariance::PoseCovariance;

/// What is known of a component in one frame when a film is judged.
#[derive(Clone, Copy, Debug, Default)]
pub struct FrameEvidence {
    /// The pose; none where none was found.
    pub found: Option<FramePose>,
    /// By how much another pose, its mirror image before all, is less likely over the film; `None` where there is none.
    pub side_margin: Option<SideMargin>,
    /// What another way to this frame, from the other end, came to.
    pub other_way: Option<Pose>,
    /// Where the other component is, in the camera's frame at the middle of its box, mm.
    pub other_middle: Option<Vector3>,
    /// Whether a person gave the pose.
    pub fixed: bool,
}

/// How bad it is where no part can be: nothing that a film tells is worse.
const BEHIND: f64 = 1e3;
/// Of a model of no knee's size, which lies there for that reason.
const IMPLAUSIBLE_SIZE: f64 = 2e3;
/// A rotation of which nothing is known.
const ALL_DEG: f64 = 180.0;

/// How far the pose of a frame is to be trusted.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Trust {
    /// Why it is to be looked at; none where it may be trusted, or where there is no pose.
    pub distrust: Option<Distrust>,
    /// How bad it is: above 1 it is doubtful, and the worst have the most.
    pub badness: f64,
    /// How bad what the frame says of its pose by itself is, whatever the others say.
    pub by_itself: f64,
    /// Whether there are poses in the frames on both sides, which it was compared with.
    pub is_between: bool,
}

/// What is usual in a film.
#[derive(Default)]
struct Usual {
    /// The lower quartile.
    misfit_px: f64,
    strength: f64,
    jump: [f64; 2],
    depth_mm: f64,
}

/// Judges each frame of a film by what is usual in it and by the frames beside it; `middle` is the model's. `sorted` is
/// working memory of as many numbers as there are frames. Frames for which there is no place in `trusts` are left out.
pub fn judge_film(
    film: &[FrameEvidence],
    limits: &TrustLimits,
    middle: &Vector3,
    sorted: &mut [f64],
    trusts: &mut [Trust],
) {
    // What a hand leaves is not usual, and is measured otherwise.
    let is_free = |one: &&FrameEvidence| !one.fixed && one.found.is_some();
    let any_free = film.iter().any(|one| is_free(&one));
    let free = || film.iter().filter(|one| is_free(one) || !any_free);
    let usual = Usual {
        misfit_px: lower_quartile(free().filter_map(misfit), sorted),
        strength: median(free().filter_map(strength), sorted),
        jump: [0, 1].map(|k| {
            let jumps = (0..film.len()).filter_map(|at| Some(jump(film, at, middle)?[k]));
            median(jumps, sorted)
        }),
        depth_mm: middle_one(film.iter().filter_map(|one| deeper(one, middle)), sorted),
    };
    for (at, trust) in trusts.iter_mut().enumerate().take(film.len()) {
        *trust = judge(film, at, limits, middle, &usual);
    }
    doubt_between(film, trusts);
}

/// A pose between two that may be others is no better than they are.
fn doubt_between(film: &[FrameEvidence], trusts: &mut [Trust]) {
    let mut before = None;
    for at in 0..trusts.len().min(film.len()) {
        let own = film[at].found.map(|_| trusts[at]);
        let has_next = film.get(at + 1).is_some_and(|one| one.found.is_some());
        let after = trusts.get(at + 1).copied().filter(|_| has_next);
        let stands = own.filter(|own| !film[at].fixed && own.distrust.is_none());
        let beside = [before, after].into_iter().flatten();
        let least_bad = beside.clone().map(|one| one.badness).reduce(f64::min);
        if let (Some(_), Some(bad)) = (stands, least_bad)
            && beside.clone().all(|one| one.may_be_another())
        {
            trusts[at].weigh(bad, Distrust::Beside);
        }
        before = own;
    }
}

fn misfit(one: &FrameEvidence) -> Option<f64> {
    one.found.map(|found| found.misfit_px)
}

fn strength(one: &FrameEvidence) -> Option<f64> {
    one.found.map(|found| found.contrast.strength)
}

/// How much farther from the camera than the other component, mm.
fn deeper(one: &FrameEvidence, middle: &Vector3) -> Option<f64> {
    Some(one.other_middle?[2] - one.found?.pose.transform(middle)[2])
}

/// How far a pose lies off the way between those of the frames on both sides: degrees, and mm along the image plane.
fn jump(film: &[FrameEvidence], at: usize, middle: &Vector3) -> Option<[f64; 2]> {
    let [before, own, after] = around(film, at, |one| Some(one.found?.pose))?;
    let led = between(&before, &after, 0.5, middle);
    Some(apart(&led, &own, middle))
}

/// The mm of [`jump`] in which the other component does not jump with it: a limb that sets off takes both along.
fn jump_by_itself(film: &[FrameEvidence], at: usize, middle: &Vector3) -> Option<f64> {
    let off =
        |[before, own, after]: [Vector3; 3]| in_plane(&scale(&add(&before, &after), 0.5), &own);
    let own = off(around(film, at, |one| {
        Some(one.found?.pose.transform(middle))
    })?);
    let other = off(around(film, at, |one| one.other_middle)?);
    Some(norm(&subtract(&own, &other)))
}

/// What a frame and those on both sides say.
fn around<T>(
    film: &[FrameEvidence],
    at: usize,
    say: impl Fn(&FrameEvidence) -> Option<T>,
) -> Option<[T; 3]> {
    let said = |at: usize| film.get(at).and_then(&say);
    Some([said(at.checked_sub(1)?)?, said(at)?, said(at + 1)?])
}

fn judge(
    film: &[FrameEvidence],
    at: usize,
    limits: &TrustLimits,
    middle: &Vector3,
    usual: &Usual,
) -> Trust {
    let Some((one, found)) = film.get(at).and_then(|one| Some((one, one.found?))) else {
        return Trust::default();
    };
    let mut alone = Trust::default();
    alone.weigh_fit(&found, limits, usual);
    let mut worst = Trust {
        by_itself: alone.badness,
        ..Trust::default()
    };
    if one.fixed {
        let px = found.misfit_px;
        let apart = Distrust::Apart(px, usual.misfit_px);
        worst.weigh(px / limits.fixed_misfit_px, apart);
        return worst;
    }
    if let Some(other) = &one.side_margin {
        worst.weigh(limits.open(other), Distrust::Side(other.rival));
    }
    if let Some(other) = &one.other_way {
        let [deg, _] = apart(other, &found.pose, middle);
        worst.weigh(deg / limits.ways_deg, Distrust::Ways(deg));
    }
    let jump = jump(film, at, middle);
    if let Some([deg, mm]) = jump {
        let most = |least: f64, usual: f64| least.max(limits.jump_times * usual);
        let alone_mm = jump_by_itself(film, at, middle).map_or(mm, |alone| mm.min(alone));
        let jumps = [
            deg / most(limits.jump_deg, usual.jump[0]),
            alone_mm / most(limits.jump_mm, usual.jump[1]),
        ];
        worst.weigh(jumps[0].max(jumps[1]), Distrust::Jump(deg, mm));
    }
    worst.weigh_fit(&found, limits, usual);
    if let Some(mm) = deeper(one, middle) {
        let off = mm - usual.depth_mm;
        worst.weigh(off.abs() / limits.depth_mm, Distrust::Depths(off));
        worst.weigh(mm.abs() / limits.joint_mm, Distrust::Joint(mm));
    }
    worst.is_between = jump.is_some();
    worst
}

impl Trust {
    /// Whether its reason is that another pose may be the right one.
    fn may_be_another(&self) -> bool {
        use Distrust::{Jump, Side, Ways};
        matches!(self.distrust, Some(Side(_) | Ways(_) | Jump(..)))
    }

    /// Takes the worse reason.
    fn weigh(&mut self, badness: f64, distrust: Distrust) {
        if badness > self.badness {
            self.badness = badness;
            self.distrust = (badness > 1.0).then_some(distrust);
        }
    }

    /// What a frame by itself says of its pose.
    fn weigh_fit(&mut self, found: &FramePose, limits: &TrustLimits, usual: &Usual) {
        if found.fit.implausible_width_mm > 0.0 {
            self.weigh(
                IMPLAUSIBLE_SIZE,
                Distrust::ImplausibleSize(found.fit.implausible_width_mm),
            );
        }
        if found.fit.behind_mm > 0.0 {
            self.weigh(BEHIND, Distrust::Behind(found.fit.behind_mm));
        }
        let part = found.contrast.strength / usual.strength.max(f64::MIN_POSITIVE);
        self.weigh(limits.strength / part.max(0.01), Distrust::Faint(part));
        let px = found.misfit_px;
        let times = px / usual.misfit_px.max(limits.least_misfit_px);
        let most = px / limits.most_misfit_px;
        let apart = (times / limits.misfit).max(most);
        self.weigh(apart, Distrust::Apart(px, usual.misfit_px));
        let met = found.fit.met;
        self.weigh((1.0 - met) / (1.0 - limits.met), Distrust::Unmet(met));
        let known = found.fit.seen();
        self.weigh(limits.known / known.max(0.01), Distrust::Cut(known));
        let deg = open_deg(found.covariance.as_ref());
        self.weigh(deg / limits.sd_deg, Distrust::Undetermined(deg));
    }
}

/// How much of a rotation a frame leaves open, degrees (standard deviation): all of it where it determines no pose, or so little of one that
/// what is worked out for a variance is none.
fn open_deg(covariance: Option<&PoseCovariance>) -> f64 {
    let determined = covariance.filter(|one| (0..6).all(|k| one.matrix[k][k] > 0.0));
    determined.map_or(ALL_DEG, PoseCovariance::rotation_deg)
}

/// The median of some numbers; 0 without any.
fn median(values: impl Iterator<Item = f64>, sorted: &mut [f64]) -> f64 {
    let sorted = sort(values, sorted);
    sorted.get(sorted.len() / 2).copied().unwrap_or(0.0)
}

/// The same, but of an even number of them the mean of both in the middle: that of numbers with their signs turned is its own with its sign turned.
fn middle_one(values: impl Iterator<Item = f64>, sorted: &mut [f64]) -> f64 {
    let sorted = sort(values, sorted);
    let at = |index: Option<usize>| index.and_then(|at| sorted.get(at)).copied().unwrap_or(0.0);
    let count = sorted.len();
    f64::midpoint(
        at(count.checked_sub(1).map(|last| last / 2)),
        at(Some(count / 2)),
    )
}

/// The number that a quarter of them lies below, and the greater one of two; 0 without any.
fn lower_quartile(values: impl Iterator<Item = f64>, sorted: &mut [f64]) -> f64 {
    let sorted = sort(values, sorted);
    let quartile = sorted.get(sorted.len().div_ceil(4)).or(sorted.last());
    quartile.copied().unwrap_or(0.0)
}

/// The numbers for which there is room, the least first.
fn sort(values: impl Iterator<Item = f64>, room: &mut [f64]) -> &[f64] {
    let mut count = 0;
    for (place, value) in room.iter_mut().zip(values) {
        *place = value;
        count += 1;
    }
    let sorted = &mut room[..count];
    sorted.sort_unstable_by(f64::total_cmp);
    sorted
}

#[cfg(test)]
mod tests;
