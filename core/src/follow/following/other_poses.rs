//! Where a film may be on the wrong side of a mirror, or in a false minimum: its frames seen from there, and what is made of
//! that.

use alloc::vec;
use alloc::vec::Vec;
use core::mem::take;
use core::ops::Range;

use super::task::Task;
use super::{Following, Phase};
use crate::follow::cell::{Anchor, Cell};
use crate::follow::elsewhere::elsewhere;
use crate::follow::false_minimum::{leaves_less, runs_elsewhere};
use crate::follow::frame_pose::{FramePose, mirrored_pose};
use crate::follow::known_femur::KnownFemur;
use crate::follow::other_margins::other_margins;
use crate::follow::side_margin::SideMargin;
use crate::follow::side_samples::{SideSample, frames_for_sides, runs_to_go_over};
use crate::follow::sides::{Rival, SideEvidence, SideStep, choose_sides};
use crate::follow::subject::Subject;
use crate::refine::{ImageTarget, RefineMemory};

impl Following {
    /// Some frames of all are to be seen from the other side of the mirror, but those whose pose is as it was when they were
    /// seen last.
    pub(super) fn see_other_sides(&mut self) {
        let cells = &self.cells;
        let wanted = frames_for_sides(cells).filter(|frame| self.range.contains(frame));
        let wanted = not_seen(wanted, cells, &mut self.samples);
        self.tasks.extend(wanted.into_iter().map(Task::BothSides));
    }

    pub(super) fn see_both_sides(
        &mut self,
        subject: &Subject<'_>,
        image: &ImageTarget<'_>,
        frame: usize,
        memory: &mut RefineMemory<'_>,
    ) -> Option<FramePose> {
        let &own = self.cells[frame].found()?;
        let sample = SideSample {
            frame,
            own,
            rival: Rival::Mirrored,
            other: mirrored_pose(subject, image, &own, memory),
            fixed: self.cells[frame].fixed,
        };
        match self.phase {
            Phase::Compare => self.rivals.push(sample),
            _ => self.samples.push(sample),
        }
        Some(own)
    }

    pub(super) fn begin_other_sides(&mut self) {
        self.samples.sort_by_key(|sample| sample.frame);
        self.steps = chosen(&self.samples, self.femur.as_ref());
        self.choices
            .push((self.samples.clone(), self.steps.clone()));
        let runs: Vec<(Range<usize>, Anchor)> =
            runs_to_go_over(&self.samples, &self.steps, self.cells.len()).collect();
        for (run, anchor) in runs {
            self.go_over(&self.within(&run), &anchor);
        }
    }

    /// Whether the same sides are chosen with a femur of which more is known by now: what was done then stands, and its margins become
    /// those of that femur. Where they are not, nothing changes: the work is to be done again from before [`Self::choose_sides`].
    pub fn stands_with(&mut self, femur: Option<KnownFemur>) -> bool {
        let mut last = None;
        for (samples, steps) in &self.choices {
            let again = chosen(samples, femur.as_ref());
            let same = |(one, other): (&SideStep, &SideStep)| one.side == other.side;
            if !again.iter().zip(steps).all(same) {
                return false;
            }
            last = Some(again);
        }
        self.steps = last.unwrap_or_default();
        self.femur = femur;
        true
    }

    /// The frames that were seen from both sides are to be seen from elsewhere too, but those that were.
    pub(super) fn see_elsewhere(&mut self) {
        let cells = &self.cells;
        let frames = self.samples.iter().map(|sample| sample.frame);
        let free = frames.filter(|&frame| !cells[frame].fixed);
        let wanted = not_seen(free, cells, &mut self.elsewhere);
        self.tasks.extend(wanted.into_iter().map(Task::Elsewhere));
    }

    pub(super) fn see_from_elsewhere(
        &mut self,
        subject: &Subject<'_>,
        image: &ImageTarget<'_>,
        frame: usize,
        memory: &mut RefineMemory<'_>,
    ) -> Option<FramePose> {
        let &own = self.cells[frame].found()?;
        let sample = self.samples.iter().find(|sample| sample.frame == frame)?;
        let mirrored = sample.mirrored_now(&own);
        self.elsewhere.push(SideSample {
            frame,
            own,
            rival: Rival::Elsewhere,
            other: elsewhere(subject, image, (&own, mirrored.as_ref()), memory),
            fixed: false,
        });
        Some(own)
    }

    /// Begins to go over to what was seen elsewhere; whether there is anything to do.
    pub(super) fn begin_elsewhere(&mut self) -> bool {
        self.elsewhere.sort_by_key(|sample| sample.frame);
        if self.rounds == 0 {
            return false;
        }
        self.rounds -= 1;
        let runs = runs_elsewhere(&self.elsewhere, self.cells.len());
        for (run, anchor) in &runs {
            let run = self.within(run);
            self.before
                .push((run.clone(), self.cells[run.clone()].to_vec()));
            self.go_over(&run, anchor);
        }
        !runs.is_empty()
    }

    /// The ways to elsewhere stay where they leave less; whether any does.
    pub(super) fn keep_what_leaves_less(&mut self) -> bool {
        let mut any = false;
        for (run, before) in take(&mut self.before) {
            let cells = &mut self.cells[run];
            match leaves_less(cells, &before) {
                true => any = true,
                false => cells.copy_from_slice(&before),
            }
        }
        any
    }

    fn within(&self, run: &Range<usize>) -> Range<usize> {
        run.start.max(self.range.start)..run.end.min(self.range.end)
    }

    fn go_over(&mut self, run: &Range<usize>, anchor: &Anchor) {
        // What is there is of the wrong side; what a person gave stays.
        let cells = self.cells[run.clone()].iter_mut();
        for cell in cells.filter(|cell| !cell.fixed) {
            *cell = Cell::default();
        }
        self.go_through(anchor, run);
    }

    /// By how much another pose of each frame is less likely; `None` where there is no other.
    pub(super) fn side_margins(&self) -> Vec<Option<SideMargin>> {
        other_margins(&self.samples, &self.steps, &self.elsewhere, &self.cells)
    }
}

/// The side of each frame that was seen from both, with the femur where that is known.
fn chosen(samples: &[SideSample], femur: Option<&KnownFemur>) -> Vec<SideStep> {
    let evidence = samples.iter().map(|sample| {
        sample.evidence(|pose| femur.and_then(|femur| femur.tilt_deg(sample.frame, pose)))
    });
    let evidence: Vec<SideEvidence> = evidence.collect();
    let mut steps = vec![SideStep::default(); evidence.len()];
    choose_sides(&evidence, &mut steps);
    steps
}

/// Of some frames those that are to be seen: samples of a pose that is no more are dropped, the others stand.
fn not_seen(
    frames: impl Iterator<Item = usize>,
    cells: &[Cell],
    samples: &mut Vec<SideSample>,
) -> Vec<usize> {
    samples.retain(|sample| cells[sample.frame].found() == Some(&sample.own));
    let is_new = |frame: &usize| !samples.iter().any(|one| one.frame == *frame);
    frames.filter(is_new).collect()
}
