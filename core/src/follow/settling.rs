//! The order in which a followed component is brought to its right pose over the film, for whoever looks at the frames.

use alloc::boxed::Box;
use alloc::collections::VecDeque;
use alloc::vec;
use alloc::vec::Vec;
use core::mem::take;
use core::ops::Range;

use super::cell::{Anchor, Cell};
use super::crossing::{Crossing, frames_to_cross_from};
use super::false_minimum::{ROUNDS, leaves_less, runs_elsewhere};
use super::frame_pose::FramePose;
use super::known_femur::KnownFemur;
use super::look::Looked;
use super::merged_sides::widen_where_sides_are_one;
use super::other_margins::other_margins;
use super::second_look::{SecondLook, second_looks};
use super::side_margin::SideMargin;
use super::side_samples::{
    SideSample, evidence_of, first_for_sides, frames_for_sides, runs_to_go_over, tell_between,
};
use super::sides::{Rival, SideStep, choose_sides};
use super::trail::Trail;
use crate::math::Vector3;
use crate::pose::Pose;

/// So often sides are chosen anew where a way that went over rocks.
const SIDES_AGAIN: usize = 2;

/// So often all is done again where frames that stood out were mended.
const MENDINGS: usize = 2;

/// What is to be done next.
#[derive(Clone, Debug)]
pub enum SettlingStep {
    /// This jump is to be crossed, and what came of it written.
    Cross(Box<Crossing>),
    /// These frames are to be seen from the other side of the mirror, or from elsewhere: [`Settling::saw`] takes what they say.
    See(Rival, Vec<usize>),
    /// [`Settling::choose`] is to be called, for a tibia with its femur, where that is known.
    Choose,
    /// These runs of frames are to be followed from their frames, and were cleared for that.
    GoOver(Vec<(Range<usize>, Anchor)>),
    /// These frames are to be looked at once more, and [improved](Cell::improve) where that leads to something better.
    LookAgain(Vec<SecondLook>),
}

/// What comes next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    /// Jumps of the way are crossed: sides are chosen by what its frames say, and of a way that lies in small minima they say little.
    CrossWay,
    Sides,
    Choose,
    /// Frames between those, where these do not tell.
    Between,
    ChooseAgain,
    /// To the other side, where that is the right one.
    GoOver,
    /// The way may have led back.
    Stay,
    Elsewhere,
    /// To what was seen there, where that is the right one.
    GoElsewhere,
    /// It stays there where that leaves less.
    Keep,
    Cross,
    Again,
    /// What was mended leads to others, and is seen from all sides as well.
    Mended,
    Over,
}

/// Brings a component that was followed to its right side of the mirror and out of false minima. [`Self::next`] says what is to be
/// done; whoever calls does it on the frames, in threads or one by one, and calls again.
#[derive(Clone, Debug)]
pub struct Settling {
    middle: Vector3,
    range: Range<usize>,
    phase: Phase,
    /// So often frames may still go over to what was seen elsewhere.
    rounds: usize,
    /// So often sides may still be chosen anew where the way rocks then.
    sides_again: usize,
    /// The frames that were looked at once more, and how often all may still be done again where that led to other poses.
    looked_again: Vec<SecondLook>,
    mendings: usize,
    /// From where jumps are still to be crossed, and whether forward; none where that is not told yet.
    to_cross: Option<VecDeque<(usize, bool)>>,
    samples: Vec<SideSample>,
    steps: Vec<SideStep>,
    /// What sides were chosen by, each time, and what was chosen.
    choices: Vec<(Vec<SideSample>, Vec<SideStep>)>,
    /// Frames seen from elsewhere.
    elsewhere: Vec<SideSample>,
    /// The frames that went over, as they were before.
    before: Vec<(Range<usize>, Vec<Cell>)>,
    /// What was seen on ways over jumps: of the way's frame, from its trail. They are crossed more than once, and most trails are as before then.
    over_jumps: Vec<(usize, Trail, Looked)>,
}

impl Settling {
    /// Of frames `range` of a film; `middle` is the middle of the model's box.
    #[must_use]
    pub fn new(middle: Vector3, range: Range<usize>) -> Self {
        Self {
            middle,
            range,
            phase: Phase::CrossWay,
            rounds: ROUNDS,
            sides_again: SIDES_AGAIN,
            looked_again: Vec::new(),
            mendings: MENDINGS,
            to_cross: None,
            samples: Vec::new(),
            steps: Vec::new(),
            choices: Vec::new(),
            elsewhere: Vec::new(),
            before: Vec::new(),
            over_jumps: Vec::new(),
        }
    }

    /// What is seen in the next frame of a way over a jump: by `see`, or what was seen from the same trail before.
    ///
    /// # Errors
    /// Those of `see`.
    pub fn over_jump<E>(
        &mut self,
        (frame, trail): (usize, &Trail),
        see: impl FnOnce() -> Result<Looked, E>,
    ) -> Result<Looked, E> {
        let mut seen = self.over_jumps.iter();
        if let Some((.., looked)) = seen.find(|(at, before, _)| *at == frame && before == trail) {
            return Ok(*looked);
        }
        let looked = see()?;
        self.over_jumps.push((frame, trail.clone(), looked));
        Ok(looked)
    }

    /// What is to be done next with the film's `cells`; `None` where all is done.
    pub fn next(&mut self, cells: &mut [Cell]) -> Option<SettlingStep> {
        loop {
            let (step, phase) = match self.phase {
                Phase::CrossWay => self.cross(cells, Phase::Sides),
                Phase::Sides => (self.see_sides(cells), Phase::Choose),
                Phase::Choose => (Some(SettlingStep::Choose), Phase::Between),
                Phase::Between => match self.see_between(cells) {
                    None => (None, Phase::GoOver),
                    step => (step, Phase::ChooseAgain),
                },
                Phase::ChooseAgain => (Some(SettlingStep::Choose), Phase::GoOver),
                Phase::GoOver => {
                    let runs: Vec<_> =
                        runs_to_go_over(&self.samples, &self.steps, cells.len()).collect();
                    self.keep_before(&runs, cells);
                    (self.to_go_over(runs, cells), Phase::Stay)
                }
                Phase::Stay => {
                    self.take_lost_ones_back(cells);
                    self.stay(cells);
                    (None, self.after_sides(cells))
                }
                Phase::Elsewhere => (self.see_elsewhere(cells), Phase::GoElsewhere),
                Phase::GoElsewhere => self.go_elsewhere(cells),
                Phase::Keep => match self.keep_what_leaves_less(cells) {
                    true => (None, Phase::Sides),
                    false => (None, Phase::Cross),
                },
                Phase::Cross => self.cross(cells, Phase::Again),
                Phase::Again => (self.looks_again(cells), Phase::Mended),
                Phase::Mended => (None, self.after_mending(cells)),
                Phase::Over => {
                    let margins = self.margins(cells);
                    widen_where_sides_are_one(&self.samples, &margins, cells, &self.middle);
                    return None;
                }
            };
            self.phase = phase;
            if step.is_some() {
                return step;
            }
        }
    }

    /// Takes what frames say of their own pose and of another.
    pub fn saw(&mut self, sample: SideSample) {
        match sample.rival {
            Rival::Mirrored => self.samples.push(sample),
            Rival::Elsewhere => self.elsewhere.push(sample),
        }
    }

    /// What a frame says of both sides of the mirror, where it was seen from both.
    #[must_use]
    pub fn both_sides_of(&self, frame: usize) -> Option<&SideSample> {
        self.samples.iter().find(|sample| sample.frame == frame)
    }

    /// Chooses the sides, for a tibia with its femur, where that is known.
    pub fn choose(&mut self, femur: Option<&KnownFemur>) {
        self.samples.sort_by_key(|sample| sample.frame);
        self.steps = chosen(&self.samples, femur);
        self.choices
            .push((self.samples.clone(), self.steps.clone()));
    }

    /// What was chosen last, with what it was chosen by.
    pub fn choice(&self) -> impl Iterator<Item = (&SideSample, &SideStep)> {
        self.samples.iter().zip(&self.steps)
    }

    /// Whether the same sides are chosen with a femur of which more is known by now: what was done then stands, and its margins become
    /// those of that femur. Where they are not, nothing changes.
    pub fn stands_with(&mut self, femur: Option<&KnownFemur>) -> bool {
        let mut last = None;
        for (samples, steps) in &self.choices {
            let again = chosen(samples, femur);
            let same = |(one, other): (&SideStep, &SideStep)| one.side == other.side;
            if !again.iter().zip(steps).all(same) {
                return false;
            }
            last = Some(again);
        }
        self.steps = last.unwrap_or_default();
        true
    }

    /// By how much another pose of each frame is less likely; `None` where there is no other.
    #[must_use]
    pub fn margins(&self, cells: &[Cell]) -> Vec<Option<SideMargin>> {
        other_margins(&self.samples, &self.steps, &self.elsewhere, cells)
    }

    /// Where the film came to another pose of a frame from its other end that is the pose to compare with, unless its mirror image is open.
    pub fn way_to_compare(&self, frame: usize, cells: &[Cell]) -> Option<Pose> {
        let margin = self.margins(cells).get(frame).copied().flatten();
        let is_mirror_open =
            margin.is_some_and(|other| other.rival == Rival::Mirrored && !other.decides());
        cells[frame].other_way.filter(|_| !is_mirror_open)
    }

    /// The next jump, and `after` the last one.
    fn cross(&mut self, cells: &[Cell], after: Phase) -> (Option<SettlingStep>, Phase) {
        let middle = self.middle;
        let to_cross = self
            .to_cross
            .get_or_insert_with(|| frames_to_cross_from(cells, &middle).into());
        while let Some((from, forward)) = to_cross.pop_front() {
            if let Some(crossing) = Crossing::over(cells, from, forward, &middle) {
                return (Some(SettlingStep::Cross(Box::new(crossing))), self.phase);
            }
        }
        self.to_cross = None;
        (None, after)
    }

    /// What is seen from both sides before any is chosen.
    fn see_sides(&mut self, cells: &[Cell]) -> Option<SettlingStep> {
        let frames = first_for_sides(cells).filter(|frame| self.range.contains(frame));
        let frames = frames.collect();
        self.unseen(Rival::Mirrored, frames, cells)
    }

    /// What is seen as well, because what was chosen does not tell it.
    fn see_between(&mut self, cells: &[Cell]) -> Option<SettlingStep> {
        let chosen: Vec<(&SideSample, &SideStep)> = self.choice().collect();
        let is_told = |frame: usize| {
            let behind = chosen.partition_point(|(sample, _)| sample.frame < frame);
            let pair = behind.checked_sub(1).and_then(|k| chosen.get(k..k + 2));
            let pair = pair.and_then(|pair| <[_; 2]>::try_from(pair).ok());
            pair.is_some_and(|pair| tell_between(pair, cells))
        };
        let frames = frames_for_sides(cells)
            .filter(|frame| self.range.contains(frame) && !is_told(*frame))
            .collect();
        self.unseen(Rival::Mirrored, frames, cells)
    }

    /// What is seen from elsewhere: what was from both sides.
    fn see_elsewhere(&mut self, cells: &[Cell]) -> Option<SettlingStep> {
        let frames = self.samples.iter().map(|sample| sample.frame);
        let frames = frames.filter(|&frame| !cells[frame].fixed).collect();
        self.unseen(Rival::Elsewhere, frames, cells)
    }

    /// The frames that are to be seen, but for those that were, whose pose is as it was then.
    fn unseen(&mut self, rival: Rival, frames: Vec<usize>, cells: &[Cell]) -> Option<SettlingStep> {
        let samples = match rival {
            Rival::Mirrored => &mut self.samples,
            Rival::Elsewhere => &mut self.elsewhere,
        };
        samples.retain(|sample| cells[sample.frame].found() == Some(&sample.own));
        let is_new = |frame: &usize| !samples.iter().any(|one| one.frame == *frame);
        let frames: Vec<usize> = frames.into_iter().filter(is_new).collect();
        (!frames.is_empty()).then_some(SettlingStep::See(rival, frames))
    }

    fn to_go_over(
        &self,
        runs: Vec<(Range<usize>, Anchor)>,
        cells: &mut [Cell],
    ) -> Option<SettlingStep> {
        let within = |(run, anchor): (Range<usize>, Anchor)| (self.within(&run), anchor);
        let runs: Vec<(Range<usize>, Anchor)> = runs.into_iter().map(within).collect();
        for (run, _) in &runs {
            // What is there is another pose's; what a person gave stays.
            for cell in cells[run.clone()].iter_mut().filter(|cell| !cell.fixed) {
                *cell = Cell::default();
            }
        }
        (!runs.is_empty()).then_some(SettlingStep::GoOver(runs))
    }

    fn keep_before(&mut self, runs: &[(Range<usize>, Anchor)], cells: &[Cell]) {
        for (run, _) in runs {
            let run = self.within(run);
            let kept = cells[run.clone()].to_vec();
            self.before.push((run, kept));
        }
    }

    /// Frames in which the way on the other side lost the component, and the one before had it: where it goes on there is seen next.
    fn take_lost_ones_back(&mut self, cells: &mut [Cell]) {
        for (run, before) in take(&mut self.before) {
            let lost = |(now, before): &(&mut Cell, Cell)| {
                now.found().is_none() && before.found().is_some()
            };
            for (now, before) in cells[run].iter_mut().zip(before).filter(lost) {
                *now = before;
            }
        }
    }

    /// Frames whose way led back to the side that was not chosen take the pose that was seen on the other one.
    fn stay(&self, cells: &mut [Cell]) {
        for (sample, step) in self.choice() {
            let cell = &mut cells[sample.frame];
            let now = cell.found().filter(|_| !cell.fixed);
            if let Some(chosen) = now.and_then(|now| sample.chosen_but_left(step.side, now)) {
                cell.improve(chosen);
            }
        }
    }

    /// A way on the other side may rock where the one before did not: those frames are seen from both sides too, and sides chosen once more.
    fn after_sides(&mut self, cells: &[Cell]) -> Phase {
        let is_seen = |frame: &usize| self.both_sides_of(*frame).is_some();
        let rocks_anew = first_for_sides(cells)
            .filter(|frame| self.range.contains(frame))
            .any(|frame| !is_seen(&frame));
        match rocks_anew && self.sides_again > 0 {
            true => {
                self.sides_again -= 1;
                Phase::Sides
            }
            false => Phase::Elsewhere,
        }
    }

    fn go_elsewhere(&mut self, cells: &mut [Cell]) -> (Option<SettlingStep>, Phase) {
        self.elsewhere.sort_by_key(|sample| sample.frame);
        if self.rounds == 0 {
            return (None, Phase::Cross);
        }
        self.rounds -= 1;
        let runs = runs_elsewhere(&self.elsewhere, cells.len());
        self.keep_before(&runs, cells);
        match self.to_go_over(runs, cells) {
            None => (None, Phase::Cross),
            step => (step, Phase::Keep),
        }
    }

    /// The ways to elsewhere stay where they leave less, in frames that were seen from there also what was seen; whether any does.
    fn keep_what_leaves_less(&mut self, cells: &mut [Cell]) -> bool {
        let mut any = false;
        for (run, before) in take(&mut self.before) {
            self.take_what_was_seen(&run, cells);
            let cells = &mut cells[run];
            match leaves_less(cells, &before) {
                true => any = true,
                false => cells.copy_from_slice(&before),
            }
        }
        any
    }

    /// Where the way there leaves more than what was seen there.
    fn take_what_was_seen(&self, run: &Range<usize>, cells: &mut [Cell]) {
        let seen = self.elsewhere.iter();
        for sample in seen.filter(|sample| run.contains(&sample.frame)) {
            let cell = &mut cells[sample.frame];
            let less = |other: &FramePose| {
                let now = cell.found();
                now.is_none_or(|now| now.misfit_px > other.misfit_px)
            };
            if let Some(other) = sample.free().filter(less) {
                cell.improve(other);
            }
        }
    }

    fn looks_again(&mut self, cells: &[Cell]) -> Option<SettlingStep> {
        let looks = second_looks(cells, &self.middle).into_iter();
        let looks = looks.filter(|look| self.range.contains(&look.frame));
        let looks: Vec<SecondLook> = looks.collect();
        self.looked_again.clone_from(&looks);
        (!looks.is_empty()).then_some(SettlingStep::LookAgain(looks))
    }

    fn after_mending(&mut self, cells: &[Cell]) -> Phase {
        let is_better = |look: &SecondLook| cells[look.frame].found() != Some(&look.own);
        let any = take(&mut self.looked_again).iter().any(is_better);
        match any && self.mendings > 0 {
            true => {
                self.mendings -= 1;
                Phase::Sides
            }
            false => Phase::Over,
        }
    }

    fn within(&self, run: &Range<usize>) -> Range<usize> {
        run.start.max(self.range.start)..run.end.min(self.range.end)
    }
}

/// The side of each frame that was seen from both, with the femur where that is known.
fn chosen(samples: &[SideSample], femur: Option<&KnownFemur>) -> Vec<SideStep> {
    let evidence = evidence_of(samples, |frame, pose| femur?.knee(frame, pose));
    let mut steps = vec![SideStep::default(); evidence.len()];
    choose_sides(&evidence, &mut steps);
    steps
}

#[cfg(test)]
mod tests;
