//! One choice for each frame of a film, made together.
//!
//! Frames that residual or tilt decide are fixed. Between them the sequence of poses that jumps
//! least is found by dynamic programming (Viterbi's algorithm): the cost of a sequence is the sum
//! of the angles between successive poses, as far as they exceed what a joint turns from frame to
//! frame anyway, and next to nothing for residuals above the best.

use heapless::Vec;
use thiserror::Error;

use super::{
    CONTENDERS, Choice, Contenders, Counterpart, DECISIVE_RATIO, OpenRival, Reason, RivalPose,
    no_knee_deg,
};
use crate::pose::{Pose, geodesic_deg};

/// A frame is decided by its film where any other pose in it costs the film this much more,
/// degrees of jumps.
pub const FILM_MARGIN_DEG: f64 = 2.0;

/// Rotation from frame to frame that costs nothing, degrees. Of two smooth sequences the one that rotates less is not
/// the likelier: over a whole film a pose mirrored in one rotation alone rotated less than the right one.
const FREE_DEG: f64 = 2.0;

/// What a pose costs at the residual that would rule it out, degrees of jumps. Next to nothing:
/// below that a residual errs in the same direction frame after frame, so it must not add up to a
/// jump. It decides where jumps do not: of a film and its mirror image.
const RESIDUAL_DEG: f64 = 0.02;

/// What a pose costs that a doubtful counterpart speaks against, degrees of jumps: less than decides.
const BEHIND_DEG: f64 = 0.5;

/// What is known of one frame of a film.
#[derive(Clone, Copy, Debug, Default)]
pub struct FilmFrame<'a> {
    /// The component's poses in this frame; none where none was found.
    pub candidates: &'a [RivalPose],
    /// The other component in this frame.
    pub counterpart: Option<Counterpart>,
    /// Whether its pose is doubtful itself ([`super::ChoiceContext::is_counterpart_doubtful`]).
    pub is_counterpart_doubtful: bool,
}

/// Working memory of [`choose_film`] for one frame.
#[derive(Clone, Copy, Debug, Default)]
pub struct FilmStep {
    /// Numbers of the candidates that are open, by rising residual.
    open: [usize; CONTENDERS],
    /// Number of candidates that are open.
    count: usize,
    /// Costs of their residuals.
    own: [f64; CONTENDERS],
    /// Least cost of the film up to this frame and from it on, their own cost in the former.
    before: [f64; CONTENDERS],
    after: [f64; CONTENDERS],
    /// For each open pose, the pose of the last frame with poses that leads to it at the least cost.
    from: [usize; CONTENDERS],
}

/// Why a film's poses are not chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error(
    "a film of {frames} frames needs {frames} steps and choices but {steps} and {choices} were given"
)]
pub struct FilmError {
    /// Frames of the film.
    pub frames: usize,
    /// Steps that were given.
    pub steps: usize,
    /// Choices that were given.
    pub choices: usize,
}

/// Chooses a pose in each frame of a film such that the component does not jump.
/// Frames without candidates have no choice; those on both sides are linked across them, the more
/// weakly the farther apart they are.
///
/// Frames that residual or tilt decide keep their own choice and reason. The others are decided
/// by the film only where at least one frame is decided by itself: a film mirrored as a whole is
/// as smooth as the right one. Nor does a film decide that jumps at a frame, or all along, as far as any other pose
/// would cost it: of single pictures one of the poses is always the nearest to those beside it.
///
/// # Errors
/// [`FilmError`] where `steps` or `choices` are fewer or more than the frames.
pub fn choose_film(
    frames: &[FilmFrame<'_>],
    steps: &mut [FilmStep],
    choices: &mut [Option<Choice>],
) -> Result<(), FilmError> {
    if steps.len() != frames.len() || choices.len() != frames.len() {
        return Err(FilmError {
            frames: frames.len(),
            steps: steps.len(),
            choices: choices.len(),
        });
    }
    for ((frame, step), choice) in frames.iter().zip(&mut *steps).zip(&mut *choices) {
        let beside = frame.counterpart.as_ref();
        let contenders = Contenders::of(frame.candidates, beside, frame.is_counterpart_doubtful);
        *step = FilmStep::new(&contenders);
        *choice = contenders.choice();
    }
    let anchored = choices.iter().flatten().any(Choice::is_decided);
    let last = forward(frames, steps);
    backward(frames, steps);
    if let Some(last) = last {
        follow(frames, steps, choices, last, anchored);
    }
    Ok(())
}

/// Whether a frame was decided by its film though the nearest poses before and after it are doubtful themselves: that it goes with those says little.
/// `good` has a verdict for each frame, none where there is no pose.
#[must_use]
pub fn rests_on_doubt(at: usize, choice: &Choice, good: &[Option<bool>]) -> bool {
    let (before, after) = good.split_at(at.min(good.len()));
    let before = before.iter().rev().find_map(|good| *good);
    let after = after.iter().skip(1).find_map(|good| *good);
    matches!(choice.reason, Reason::Film { .. })
        && before.or(after).is_some()
        && ![before, after].contains(&Some(true))
}

impl FilmStep {
    fn new(contenders: &Contenders<'_>) -> Self {
        let mut step = Self {
            count: contenders.open.len(),
            ..Self::default()
        };
        let best = contenders.first().map_or(0.0, |k| contenders.residual(k));
        for (number, &index) in contenders.open.iter().enumerate() {
            let residual = contenders.residual(index);
            step.open[number] = index;
            if number >= contenders.preferred {
                step.own[number] = BEHIND_DEG;
            }
            // Also where both are zero or infinite.
            if residual > best {
                step.own[number] += RESIDUAL_DEG * (residual / best - 1.0) / (DECISIVE_RATIO - 1.0);
            }
        }
        step
    }

    /// The pose to which the cheapest film leads that ends here, and what that costs.
    fn cheapest(&self) -> (usize, f64) {
        cheapest(self.count, |&number| self.before[number]).unwrap_or((0, 0.0))
    }

    /// How far the film jumps to pose `number` from the last of the steps `before` that has poses, degrees.
    fn jump_to_deg(&self, number: usize, before: &[Self]) -> Option<f64> {
        let last = before.iter().rev().find(|step| step.count > 0)?;
        Some(self.before[number] - self.own[number] - last.before[self.from[number]])
    }

    /// Poses that are open, by their number among those.
    fn poses<'a>(&self, frame: &FilmFrame<'a>) -> Vec<&'a Pose, CONTENDERS> {
        let pose = |&index: &usize| frame.candidates.get(index).map(|c| &c.pose);
        self.open.iter().take(self.count).filter_map(pose).collect()
    }

    /// The choice of an open frame in which the cheapest film takes pose `number`, and which
    /// would have been `alone`. The film decides from `margin_deg` on.
    fn choice(
        &self,
        frame: &FilmFrame<'_>,
        number: usize,
        margin_deg: f64,
        alone: &Choice,
    ) -> Choice {
        let whole = |k: usize| self.before[k] + self.after[k];
        let others = || (0..self.count).filter(|&k| k != number);
        let saved_deg = others().fold(f64::INFINITY, |least, k| {
            least.min(whole(k) - whole(number))
        });
        let index = self.open[number];
        let decided = saved_deg >= margin_deg;
        let residual = |k: usize| {
            let candidate = frame.candidates.get(self.open[k]);
            candidate.map_or(f64::NAN, |candidate| candidate.residual_px)
        };
        let open = others().next().filter(|_| !decided).map(|k| OpenRival {
            index: self.open[k],
            chosen_px: residual(number),
            other_px: residual(k),
        });
        let reason = match open {
            None => Reason::Film { saved_deg },
            Some(_) if index == alone.index => alone.reason,
            Some(open) => Reason::Undecided {
                chosen_px: open.chosen_px,
                other_px: open.other_px,
            },
        };
        let candidate = frame.candidates.get(index);
        let beside = frame.counterpart.as_ref();
        let beside = beside.filter(|_| !frame.is_counterpart_doubtful);
        Choice {
            index,
            reason,
            open,
            no_knee_deg: no_knee_deg(beside, candidate),
        }
    }
}

/// Least costs up to each frame; the last frame with poses.
fn forward(frames: &[FilmFrame<'_>], steps: &mut [FilmStep]) -> Option<usize> {
    let mut last: Option<usize> = None;
    for at in 0..frames.len() {
        let poses = steps[at].poses(&frames[at]);
        if poses.is_empty() {
            continue;
        }
        for (number, pose) in poses.iter().enumerate() {
            let led = last.and_then(|last| {
                let links = links(pose, &frames[last], &steps[last], at - last);
                let cost = |k: &usize| steps[last].before[*k] + links[*k];
                cheapest(links.len(), cost)
            });
            let (from, cost) = led.unwrap_or((0, 0.0));
            steps[at].from[number] = from;
            steps[at].before[number] = cost + steps[at].own[number];
        }
        last = Some(at);
    }
    last
}

/// Least costs from each frame on.
fn backward(frames: &[FilmFrame<'_>], steps: &mut [FilmStep]) {
    let mut next: Option<usize> = None;
    for at in (0..frames.len()).rev() {
        let poses = steps[at].poses(&frames[at]);
        if poses.is_empty() {
            continue;
        }
        for (number, pose) in poses.iter().enumerate() {
            let led = next.and_then(|next| {
                let links = links(pose, &frames[next], &steps[next], next - at);
                let cost = |k: &usize| steps[next].own[*k] + steps[next].after[*k] + links[*k];
                cheapest(links.len(), cost)
            });
            steps[at].after[number] = led.map_or(0.0, |(_, cost)| cost);
        }
        next = Some(at);
    }
}

/// Costs of the ways from `pose` to each of a frame's poses that is `apart` frames away.
fn links(
    pose: &Pose,
    frame: &FilmFrame<'_>,
    step: &FilmStep,
    apart: usize,
) -> Vec<f64, CONTENDERS> {
    let jump = |other: &&Pose| {
        let turn = geodesic_deg(&pose.rotation, &other.rotation) / apart as f64;
        // NaN stays NaN, which is never the cheapest.
        if turn <= FREE_DEG {
            0.0
        } else {
            turn - FREE_DEG
        }
    };
    step.poses(frame).iter().map(jump).collect()
}

/// The first of the least of `count` costs.
fn cheapest(count: usize, cost: impl Fn(&usize) -> f64) -> Option<(usize, f64)> {
    let all = (0..count).map(|number| (number, cost(&number)));
    all.min_by(|(_, a), (_, b)| a.total_cmp(b))
}

/// What the cheapest film jumps from frame to frame in the mean, degrees.
fn mean_jump_deg(steps: &[FilmStep], last: usize) -> f64 {
    let whole_deg = steps[last].cheapest().1;
    let frames = steps.iter().filter(|step| step.count > 0).count();
    whole_deg / frames.saturating_sub(1).max(1) as f64
}

/// Reads the cheapest film backwards into the choices of the frames that are open. It decides a frame by no less than it jumps itself, to it and from
/// it on, and by no less than it jumps in the mean.
fn follow(
    frames: &[FilmFrame<'_>],
    steps: &[FilmStep],
    choices: &mut [Option<Choice>],
    last: usize,
    anchored: bool,
) {
    let mean_deg = mean_jump_deg(steps, last);
    let mut number = steps[last].cheapest().0;
    let mut onward_deg = None;
    for at in (0..=last).rev().filter(|&at| steps[at].count > 0) {
        let to_deg = steps[at].jump_to_deg(number, &steps[..at]);
        if let Some(alone) = choices[at].filter(|_| steps[at].count > 1) {
            let jumps = [to_deg, onward_deg].into_iter().flatten();
            let links = jumps.clone().count() as f64;
            // Of two takes one after the other the jump between them is not the film's.
            let own_deg = links * jumps.fold(f64::INFINITY, f64::min);
            let margin_deg = match anchored {
                true => own_deg.max(mean_deg).max(FILM_MARGIN_DEG),
                false => f64::INFINITY,
            };
            choices[at] = Some(steps[at].choice(&frames[at], number, margin_deg, &alone));
        }
        number = steps[at].from[number];
        onward_deg = to_deg;
    }
}

#[cfg(test)]
mod tests;
