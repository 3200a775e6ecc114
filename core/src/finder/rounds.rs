//! Which poses are tried, round after round, and where those that were tried lead.

use heapless::Vec;

use super::candidate::{SAME_DEG, is_same};
use crate::finder::nearby::{about, nearby};
use crate::math::radians;
use crate::mesh::Model;
use crate::mesh::symmetry::SymmetryPlane;
use crate::pose::{Pose, geodesic_deg};
use crate::refine::{CameraView, RefineMemory, RefineOptions, Refined, Target};
use crate::shortlist::{first_of, take_out};

/// Most poses that are refined as starts.
pub const STARTS: usize = 6;

/// Most refined poses: that of each start and its three mirror images.
pub const ANSWERS: usize = 4 * STARTS;

/// See [`is_split`]: least residual, pixels, and its least ratio to the robust standard deviation of the residuals.
const SPLIT_PX: f64 = 0.1;
const SPLIT_RATIO: f64 = 3.0;
/// See [`is_split`], for an outline without noise: where the robust standard deviation is below the first, the residual at
/// the right pose is below the second, pixels. Found by trial on the exact masks of two femoral and two tibial
/// components.
const EXACT_PX: f64 = 0.046;
const INEXACT_PX: f64 = 0.03;

/// So far beside a pose another minimum is looked for, degrees: as far as views of a coarse library lie apart.
const BESIDE_DEG: f64 = 2.5;

/// Step of the search around a pose that may be a false minimum near the right one, degrees.
const CLOSE_DEG: f64 = 1.0;

/// A probe has led back to the best pose where it ends nearer to it than this, degrees; it has found no rival where its
/// loss exceeds the best one's by more than this factor.
const BACK_DEG: f64 = 0.1;
const ALIKE: f64 = 1.25;

/// See [`blurred_deg`]: degrees for each pixel of noise.
const NOISE_DEG: f64 = 2.5;

/// After a quick look a pose may still be the best where its loss is at most this many times the least, or this many times
/// so many square pixels; and two lead to the same where they are nearer than this, degrees.
const LOOKED_WORSE: f64 = 4.0;
const LOOKED_PX2: f64 = 0.125;
const LOOKED_SAME_DEG: f64 = 1.0;

/// See [`is_on_the_way`].
const ON_THE_WAY: f64 = 0.5;

/// A refined pose and what it was refined from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RefinedRival {
    /// Which of the poses to start from led to it, from 0.
    pub start: usize,
    /// Whether it was refined from the mirror image of what that start became.
    pub mirrored: bool,
    /// The pose that it was refined from.
    pub from: Pose,
    /// What refinement made of it.
    pub refined: Refined,
}

impl RefinedRival {
    /// A pose before it is refined.
    pub(super) fn at(from: Pose, start: usize, mirrored: bool) -> Self {
        Self {
            start,
            mirrored,
            from,
            refined: Refined::at(from),
        }
    }
}

/// What was seen of a model, and how its poses are refined.
#[derive(Clone, Copy)]
pub(super) struct Subject<'s> {
    pub(super) model: &'s Model<'s>,
    pub(super) views: &'s [CameraView<'s>],
    pub(super) planes: &'s [SymmetryPlane],
    pub(super) options: RefineOptions,
}

/// Which poses are tried, one after the other.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Round {
    /// Of several starts the first stage, which tells where each leads.
    First,
    /// What may be the best of these, to the end.
    Rest,
    /// Starts, to the end.
    Starts,
    /// Mirror images of all poses so far.
    Mirrors,
    /// Both sides of the best pose.
    Beside,
    /// All around it.
    Around,
}

/// What is done with a pose of a round.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Doing {
    /// The next is to be chosen.
    Choosing,
    /// A quick look at where it leads.
    Looking,
    /// It is refined.
    Refining,
    /// There is none left.
    Nothing,
}

/// The poses of a search, and what is done with them.
pub(super) struct Poses {
    /// By rising loss; at first none.
    pub(super) answers: Vec<RefinedRival, ANSWERS>,
    /// Those of a round.
    pub(super) open: Vec<RefinedRival, STARTS>,
    pub(super) round: Round,
    pub(super) doing: Doing,
    pub(super) is_outline: bool,
    /// The best pose, when the round began or a mirror image was looked at.
    pub(super) best: RefinedRival,
    /// A quick look beside it has led back to it where it ends nearer than this, degrees.
    pub(super) back_deg: f64,
    /// Whether all quick looks of the round led back.
    pub(super) all_back: bool,
}

impl Poses {
    /// None, and nothing to do with them.
    pub(super) fn new() -> Self {
        Self {
            answers: Vec::new(),
            open: Vec::new(),
            round: Round::Starts,
            doing: Doing::Nothing,
            is_outline: false,
            best: RefinedRival::at(Pose::IDENTITY, 0, false),
            back_deg: BACK_DEG,
            all_back: false,
        }
    }

    /// Begins with the first [`STARTS`] of these.
    pub(super) fn begin(&mut self, starts: impl Iterator<Item = Pose>, views: &[CameraView<'_>]) {
        let starts = (0..).zip(starts);
        self.open = first_of(starts.map(|(start, pose)| RefinedRival::at(pose, start, false)));
        self.answers.clear();
        self.is_outline = is_outline(views);
        self.round = match (self.open.len(), self.is_outline) {
            (2.., true) => Round::First,
            _ => Round::Starts,
        };
        self.doing = Doing::Choosing;
    }

    /// Whether it is known where a pose leads that is on the way. Noise leaves several minima beside each other: of those the
    /// best is wanted.
    pub(super) fn is_known(&self, pose: &Pose) -> bool {
        let is_near =
            |other: &RefinedRival, within_deg| is_on_the_way(pose, &other.refined.pose, within_deg);
        let mut answers = self.answers.iter();
        match (self.doing, self.round) {
            (Doing::Looking, Round::Mirrors) => {
                answers.any(|other| is_near(other, blurred_deg(&other.refined)))
            }
            (Doing::Looking, _) => is_near(&self.best, self.back_deg),
            (_, Round::First) => answers.any(|other| is_near(other, LOOKED_SAME_DEG)),
            // On a frame all are brought to the end.
            _ => self.is_outline && answers.any(|other| is_near(other, BACK_DEG)),
        }
    }

    /// Where a quick look has led: mostly to the best pose again, or to a worse one.
    pub(super) fn led(&self, looked: &Refined) -> Led {
        let apart = |other: &Refined| geodesic_deg(&other.pose.rotation, &looked.pose.rotation);
        let best = &self.best.refined;
        let is_open = match self.round {
            // What may fit as well as the best, and was not found before.
            Round::Mirrors => {
                let known = |RefinedRival { refined, .. }: &RefinedRival| {
                    apart(refined) < blurred_deg(refined) && looked.loss > refined.loss / ALIKE
                };
                let limit = LOOKED_WORSE * best.loss.max(LOOKED_PX2);
                looked.loss <= limit && !self.answers.iter().any(known)
            }
            _ if apart(best) <= self.back_deg => return Led::Back,
            _ => looked.loss < ALIKE * best.loss,
        };
        if is_open { Led::On } else { Led::Nowhere }
    }

    /// Begins with the next round; gives whether the model was drawn to find its poses.
    pub(super) fn next_round(
        &mut self,
        subject: &Subject<'_>,
        memory: &mut RefineMemory<'_>,
    ) -> bool {
        let only = match subject.views {
            [view] if view.placement == Pose::IDENTITY => Some(view),
            _ => None,
        };
        match (self.round, self.answers.first().copied(), only) {
            (Round::First, ..) => self.go_on_with_begun(),
            (Round::Rest | Round::Starts, ..) => self.mirror_all(),
            (Round::Mirrors, Some(best), Some(_))
                if self.is_outline && !subject.planes.is_empty() =>
            {
                self.look_beside(&best, subject.model);
            }
            (Round::Mirrors, Some(best), Some(view)) => {
                return self.look_around(&best, subject.model, view, memory);
            }
            // Where all led back no false minimum lies nearer either: it would have been met.
            (Round::Beside, Some(best), Some(view)) if !self.all_back => {
                return self.look_around(&best, subject.model, view, memory);
            }
            _ => self.end(),
        }
        false
    }

    fn end(&mut self) {
        // Turned alike and farther away it lies on another edge.
        let same = |a: &RefinedRival, b: &RefinedRival| is_same(&a.refined.pose, &b.refined.pose);
        keep_open(&mut self.answers, f64::INFINITY, same);
        self.doing = Doing::Nothing;
    }

    /// Of what the first stage led to those poses that it leaves open, to the end.
    fn go_on_with_begun(&mut self) {
        let least = self.answers.first().map_or(0.0, |best| best.refined.loss);
        let limit = LOOKED_WORSE * least.max(LOOKED_PX2);
        keep_open(&mut self.answers, limit, |a, b| {
            is_within(a, b, LOOKED_SAME_DEG)
        });
        self.open = first_of(self.answers.iter().copied());
        self.answers.clear();
        self.round = Round::Rest;
    }

    /// Mirror images of all poses so far.
    fn mirror_all(&mut self) {
        self.open.clear();
        for answer in &self.answers {
            let mut before = self.open.iter();
            if !before.any(|other| is_within(other, answer, SAME_DEG)) {
                let own = RefinedRival::at(answer.refined.pose, answer.start, false);
                // At most one of each start so far.
                let _ = self.open.push(own);
            }
        }
        self.round = Round::Mirrors;
    }

    /// A nearly symmetric part has minima beside each other that fit alike, some degrees apart: from both sides of the best
    /// pose, about both axes out of the image plane, it is tried whether another is there.
    fn look_beside(&mut self, best: &RefinedRival, model: &Model<'_>) {
        let (middle, pose) = (model.bounds().centre, &best.refined.pose);
        let turns = [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]];
        let starts = turns.into_iter().map(|turn| {
            let [x, y] = turn.map(|sign| radians(sign * BESIDE_DEG));
            about(&middle, pose, &[x, y, 0.0], [0.0; 3])
        });
        let back_deg = blurred_deg(&best.refined).max(BACK_DEG);
        self.try_beside(Round::Beside, best, back_deg, starts);
    }

    /// Where most of the outline fits exactly and a part does not, the best pose may be a false minimum near the right
    /// one: refinement starts again from poses around it. All drawings for that are one slice; few poses need it.
    fn look_around(
        &mut self,
        best: &RefinedRival,
        model: &Model<'_>,
        view: &CameraView<'_>,
        memory: &mut RefineMemory<'_>,
    ) -> bool {
        let Target::Silhouette(silhouette) = &view.target else {
            self.end();
            return false;
        };
        if !is_split(&best.refined) {
            self.end();
            return false;
        }
        let pose = &best.refined.pose;
        let starts = nearby(model, view.camera, silhouette, pose, CLOSE_DEG, memory);
        let apart = |start: &Pose| geodesic_deg(&start.rotation, &pose.rotation) > CLOSE_DEG / 2.0;
        let starts = starts.iter().copied().filter(apart);
        self.try_beside(Round::Around, best, BACK_DEG, starts);
        true
    }

    fn try_beside(
        &mut self,
        round: Round,
        best: &RefinedRival,
        back_deg: f64,
        starts: impl Iterator<Item = Pose>,
    ) {
        let tried = |start| RefinedRival::at(start, best.start, best.mirrored);
        self.open = first_of(starts.map(tried));
        (self.round, self.best, self.back_deg) = (round, *best, back_deg);
        self.all_back = true;
    }
}

/// Whether all that was seen are silhouettes.
fn is_outline(views: &[CameraView<'_>]) -> bool {
    let outline = |view: &CameraView<'_>| matches!(view.target, Target::Silhouette(_));
    views.iter().all(outline)
}

/// Where a quick look leads.
pub(super) enum Led {
    /// To where another led before.
    Back,
    /// To a worse pose, or to none.
    Nowhere,
    /// To a pose that may be better.
    On,
}

/// Whether a quick look that has come to `pose` will end within so many degrees of `other`: it is well on the way there.
fn is_on_the_way(pose: &Pose, other: &Pose, within_deg: f64) -> bool {
    geodesic_deg(&pose.rotation, &other.rotation) < ON_THE_WAY * within_deg
}

/// How far apart a quick look may leave what is one minimum, degrees.
fn blurred_deg(refined: &Refined) -> f64 {
    (NOISE_DEG * refined.robust_sigma_px).min(LOOKED_SAME_DEG)
}

/// Whether most of an outline fits exactly and a part does not at all, which noise does not cause; or whether an outline
/// without noise leaves a residual that rounding does not explain.
fn is_split(refined: &Refined) -> bool {
    let (residual, sigma) = (refined.residual_px, refined.robust_sigma_px);
    let split = residual > SPLIT_PX && residual > SPLIT_RATIO * sigma;
    split || (sigma < EXACT_PX && residual > INEXACT_PX)
}

/// Keeps those poses whose loss is within a limit, each once, where it comes first: they are listed by rising loss.
fn keep_open(
    rivals: &mut Vec<RefinedRival, ANSWERS>,
    limit: f64,
    same: impl Fn(&RefinedRival, &RefinedRival) -> bool,
) {
    let mut place = 0;
    while let Some(one) = rivals.get(place) {
        let mut before = rivals.iter().take(place);
        let is_there = before.any(|other| same(other, one));
        if one.refined.loss > limit || is_there {
            take_out(rivals, place);
        } else {
            place += 1;
        }
    }
}

fn is_within(a: &RefinedRival, b: &RefinedRival, within_deg: f64) -> bool {
    geodesic_deg(&a.refined.pose.rotation, &b.refined.pose.rotation) < within_deg
}

#[cfg(test)]
mod tests;
