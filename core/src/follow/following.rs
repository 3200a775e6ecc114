//! A component followed by a caller that gives frames one by one, when they are asked for.

mod beside;
mod task;

use alloc::boxed::Box;
use alloc::collections::VecDeque;
use alloc::vec;
use alloc::vec::Vec;
use core::ops::Range;

use beside::Beside;
use task::{Span, Task, Walk};

use super::cell::{Anchor, Cell};
use super::conclude::{KnownBeside, conclude, trusted_middles};
use super::conclusion::Conclusion;
use super::elsewhere::{elsewhere, from_other_way};
use super::frame_pose::FramePose;
use super::good_frames::{frames_to_ask, good_poses};
use super::known_femur::KnownFemur;
use super::mirrored::mirrored_pose;
use super::search_order::RunsToSearch;
use super::second_look::SecondLook;
use super::settling::{Settling, SettlingStep};
use super::side_samples::SideSample;
use super::sides::Rival;
use super::subject::Subject;
use crate::math::Vector3;
use crate::pose::Pose;
use crate::refine::{ImageTarget, RefineError, RefineMemory};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    /// From the poses that were given over all frames.
    Way,
    /// Runs of frames in which it was not found are searched.
    Search,
    /// It is brought to its right pose.
    Settle,
    /// It is looked for beside the other component, where it is lost after all.
    Beside,
    Over,
    /// Frames are seen from the other side too, for who compares.
    Compare,
}

/// Follows one component over some frames of a film. [`Self::wanted`] says which frame is to be looked at, [`Self::take`] looks at
/// it. When none is left, [`Self::choose_sides`] begins the second part, after which [`Self::conclude`] has the answer.
///
/// Frames are asked for one at a time and none is kept. Poses that a person gave never change.
#[derive(Clone, Debug)]
pub struct Following {
    middle: Vector3,
    range: Range<usize>,
    cells: Vec<Cell>,
    anchors: Vec<Anchor>,
    tasks: VecDeque<Task>,
    phase: Phase,
    /// The caller looks for the component in whole frames where nothing leads to it.
    searches: bool,
    runs: RunsToSearch,
    /// For who looks beside the other component.
    beside: Beside,
    settling: Settling,
    /// A step that waits for the caller's word.
    waiting: Option<SettlingStep>,
    /// [`Self::see_sides`] was called.
    may_see: bool,
    /// [`Self::choose_sides`] was called.
    may_choose: bool,
    femur: Option<KnownFemur>,
    /// Other sides of frames that somebody wants to compare.
    rivals: Vec<SideSample>,
}

impl Following {
    /// Over the frames `range` of a film of `frames`; `middle` is the middle of the model's box.
    #[must_use]
    pub fn new(middle: Vector3, frames: usize, range: Range<usize>) -> Self {
        let range = range.start..range.end.min(frames);
        Self {
            middle,
            settling: Settling::new(middle, range.clone()),
            range,
            cells: vec![Cell::default(); frames],
            anchors: Vec::new(),
            tasks: VecDeque::new(),
            phase: Phase::Way,
            searches: false,
            runs: RunsToSearch::default(),
            beside: Beside::default(),
            waiting: None,
            may_see: false,
            may_choose: false,
            femur: None,
            rivals: Vec::new(),
        }
    }

    /// Gives a pose to follow from, before the first frame is asked for. One that is `fixed` a person gave: it never changes.
    /// Frames outside of the film are left out.
    pub fn give(&mut self, frame: usize, pose: Pose, fixed: bool) {
        if self.range.contains(&frame) {
            self.tasks.push_back(Task::Given { frame, pose, fixed });
        }
    }

    /// From now on [`Self::wanted`] also asks for frames that are to be searched as a whole ([`Self::is_search`]), where the
    /// component was not found in a run of them.
    pub fn search_where_lost(&mut self) {
        self.searches = true;
    }

    /// Whether the frame that [`Self::wanted`] asks for is to be searched as a whole: [`Self::searched`] takes the answer.
    #[must_use]
    pub fn is_search(&self) -> bool {
        matches!(self.tasks.front(), Some(Task::Search { .. }))
    }

    /// The pose of the other component in the frame that is to be searched, where it is to be looked for beside that: where its joint leaves it
    /// ([`JointSearch`](super::JointSearch)).
    #[must_use]
    pub fn beside(&self) -> Option<&Pose> {
        match self.tasks.front() {
            Some(Task::Search { beside, .. }) => beside.as_ref(),
            _ => None,
        }
    }

    /// What came of looking for the component in the frame that was asked for.
    pub fn searched(&mut self, pose: Option<Pose>) {
        if !self.is_search() {
            return;
        }
        if let Some(Task::Search { frame, run, .. }) = self.tasks.pop_front() {
            self.runs.searched(frame, &run, pose.is_some());
            let found = pose.map(|pose| Task::Found { frame, pose, run });
            found
                .into_iter()
                .for_each(|task| self.tasks.push_front(task));
        }
    }

    /// The frame that is to be looked at; `None` where a part of the work is done.
    pub fn wanted(&mut self) -> Option<usize> {
        loop {
            if let Some(frame) = self.tasks.front_mut().and_then(Task::wanted) {
                return Some(frame);
            }
            match self.tasks.pop_front() {
                Some(task) => task.write(&mut self.cells),
                None => self.go_on()?,
            }
        }
    }

    /// Looks at the frame that [`Self::wanted`] asked for; gives its pose, where one was found.
    ///
    /// # Errors
    /// Where a pose that was given cannot be drawn: it is left out, and the work goes on.
    pub fn take(
        &mut self,
        subject: &Subject<'_>,
        image: &ImageTarget<'_>,
        memory: &mut RefineMemory<'_>,
    ) -> Result<Option<FramePose>, RefineError> {
        let task = match self.tasks.front_mut() {
            Some(task @ (Task::Walk(_) | Task::Span(_) | Task::Crossing(_))) => {
                let known = (&self.middle, &mut self.settling);
                return Ok(task.go_on(subject, image, known, memory));
            }
            // The answer of a search comes by another way.
            None | Some(Task::Search { .. }) => return Ok(None),
            Some(_) => self.tasks.pop_front(),
        };
        match task {
            Some(Task::Given { frame, pose, fixed }) => {
                let anchor = match fixed {
                    true => Anchor::fixed(subject, image, (frame, &pose), memory)?,
                    false => task::given(subject, image, (frame, &pose), memory)?,
                };
                self.anchors.push(anchor);
                Ok(Some(anchor.found))
            }
            Some(Task::Found { frame, pose, run }) => {
                let anchor = task::given(subject, image, (frame, &pose), memory)?;
                self.go_through(&anchor, &run);
                Ok(Some(anchor.found))
            }
            Some(Task::Again(look)) => Ok(self.look_again(&look, subject, image, memory)),
            Some(Task::BothSides(frame)) => Ok(self.see_both_sides(subject, image, frame, memory)),
            Some(Task::Elsewhere(frame)) => {
                Ok(self.see_from_elsewhere(subject, image, frame, memory))
            }
            _ => Ok(None),
        }
    }

    fn look_again(
        &mut self,
        look: &SecondLook,
        subject: &Subject<'_>,
        image: &ImageTarget<'_>,
        memory: &mut RefineMemory<'_>,
    ) -> Option<FramePose> {
        let better = look.run(subject, image, memory);
        if let Some(found) = better {
            self.cells[look.frame].improve(found);
        }
        Some(better.unwrap_or(look.own))
    }

    /// Begins to choose the sides of the mirror, for a tibia with its femur, where that is known.
    pub fn choose_sides(&mut self, femur: Option<KnownFemur>) {
        self.see_sides();
        if self.may_see {
            self.femur = femur;
            self.may_choose = true;
        }
    }

    /// Begins to see frames from both sides of the mirror, which needs no femur: [`Self::choose_sides`] goes on from there.
    pub fn see_sides(&mut self) {
        self.may_see |= self.waiting.is_some();
    }

    /// Whether the same sides are chosen with a femur of which more is known by now: what was done then stands, and its margins become
    /// those of that femur. Where they are not, nothing changes: the work is to be done again from before [`Self::choose_sides`].
    pub fn stands_with(&mut self, femur: Option<KnownFemur>) -> bool {
        let stands = self.settling.stands_with(femur.as_ref());
        if stands {
            self.femur = femur;
        }
        stands
    }

    /// Once all is done, begins to look for the component where it is lost after all, or lies on other edges: beside the `other` one of its joint in
    /// frames in which that is [good](Self::good), and settles it again where it is found there, or better. A caller that
    /// [searches](Self::search_where_lost) not has nothing to do. `other_middles` are the other one's [`Self::middles`]; `femur` is that of a tibia,
    /// as far as it is known by now.
    pub fn look_beside(
        &mut self,
        (other, other_middles): (Vec<Option<Pose>>, &[Option<Vector3>]),
        femur: Option<KnownFemur>,
    ) {
        if self.searches && self.phase == Phase::Over && self.tasks.is_empty() {
            self.femur = femur;
            self.beside = Beside::new(&self.cells, self.good(other_middles), other);
            self.runs = RunsToSearch::default();
            self.phase = Phase::Beside;
        }
    }

    /// Begins to look at frames for the other pose that may be the right one, for somebody who compares both; see [`Self::rival`].
    pub fn compare_sides(&mut self, frames: impl Iterator<Item = usize>) {
        if self.phase == Phase::Over {
            self.phase = Phase::Compare;
            let margins = self.settling.margins(&self.cells);
            let is_elsewhere = |frame: &usize| {
                let margin = margins.get(*frame).copied().flatten();
                margin.is_some_and(|other| other.rival == Rival::Elsewhere && !other.decides())
            };
            let wanted = frames.filter(|frame| self.range.contains(frame));
            self.tasks
                .extend(wanted.map(|frame| match is_elsewhere(&frame) {
                    true => Task::Elsewhere(frame),
                    false => Task::BothSides(frame),
                }));
        }
    }

    /// The other pose of a frame, where it was compared and there is one: the one beside it that is as likely, that from the film's other
    /// end, or its mirror image.
    #[must_use]
    pub fn rival(&self, frame: usize) -> Option<&FramePose> {
        let compared = self.rivals.iter().find(|sample| sample.frame == frame)?;
        compared.other.as_ref()
    }

    /// Ends the work before all is done: what its unfinished parts saw counts.
    pub fn stop(&mut self) {
        for task in self.tasks.drain(..) {
            task.write(&mut self.cells);
        }
        if self.phase == Phase::Beside {
            self.beside.end(&mut self.cells);
        }
        self.phase = Phase::Over;
    }

    /// The poses so far.
    #[must_use]
    pub fn cells(&self) -> &[Cell] {
        &self.cells
    }

    /// Where the component is in each frame in which it is to be trusted, mm; see [`trusted_middles`].
    #[must_use]
    pub fn middles(&self) -> Vec<Option<Vector3>> {
        let margins = self.settling.margins(&self.cells);
        trusted_middles(&self.cells, &margins, &self.middle)
    }

    /// The answer, with the other component's [`Self::middles`], where there is one.
    #[must_use]
    pub fn conclude(&self, other_middles: &[Option<Vector3>]) -> Vec<Conclusion> {
        let margins = self.settling.margins(&self.cells);
        let beside = KnownBeside {
            other_middles,
            femur: self.femur.as_ref(),
            ..KnownBeside::default()
        };
        conclude(&self.cells, &margins, &beside, &self.middle)
    }

    /// The pose of each frame in which the component is good, with the other component's [`Self::middles`], where there is one.
    #[must_use]
    pub fn good(&self, other_middles: &[Option<Vector3>]) -> Vec<Option<FramePose>> {
        good_poses(&self.cells, &self.conclude(other_middles))
    }

    /// The frames that are asked whether the constants of the film stand, with their poses; see [`frames_to_ask`].
    #[must_use]
    pub fn to_ask(&self, other_middles: &[Option<Vector3>]) -> Vec<(usize, Pose)> {
        frames_to_ask(&self.good(other_middles))
    }

    /// What is to be done when nothing is left to do; `None` where the caller has to say more, or all is over.
    fn go_on(&mut self) -> Option<()> {
        match self.phase {
            Phase::Way => {
                self.begin_ways();
                self.phase = Phase::Search;
            }
            Phase::Search => match self.to_search() {
                Some(search) => self.tasks.push_back(search),
                None => self.phase = Phase::Settle,
            },
            Phase::Settle => {
                let waiting = self.waiting.take();
                match waiting.or_else(|| self.settling.next(&mut self.cells)) {
                    Some(step) if self.waits_for(&step) => {
                        self.waiting = Some(step);
                        return None;
                    }
                    Some(step) => self.begin(step),
                    None => self.phase = Phase::Over,
                }
            }
            Phase::Beside => {
                let next = self.beside.next(&mut self.cells, &self.runs, &self.range);
                match next {
                    Some((frame, run, pose)) => self.tasks.push_back(Task::Search {
                        frame,
                        run,
                        beside: Some(pose),
                    }),
                    None => self.end_beside(),
                }
            }
            Phase::Over | Phase::Compare => return None,
        }
        Some(())
    }

    /// Whether a step waits for what the caller says first. Of a component without two sides the first one is to choose.
    fn waits_for(&self, step: &SettlingStep) -> bool {
        match step {
            SettlingStep::See(..) => !self.may_see,
            SettlingStep::Choose => !self.may_choose,
            _ => false,
        }
    }

    fn begin(&mut self, step: SettlingStep) {
        match step {
            SettlingStep::Cross(crossing) => self.tasks.push_back(Task::Crossing(crossing)),
            SettlingStep::See(Rival::Mirrored, frames) => {
                self.tasks.extend(frames.into_iter().map(Task::BothSides));
            }
            SettlingStep::See(Rival::Elsewhere, frames) => {
                self.tasks.extend(frames.into_iter().map(Task::Elsewhere));
            }
            SettlingStep::Choose => self.settling.choose(self.femur.as_ref()),
            SettlingStep::GoOver(runs) => {
                for (run, anchor) in runs {
                    self.go_through(&anchor, &run);
                }
            }
            SettlingStep::LookAgain(looks) => {
                let looks = looks.into_iter().map(Box::new);
                self.tasks.extend(looks.map(Task::Again));
            }
        }
    }

    fn see_both_sides(
        &mut self,
        subject: &Subject<'_>,
        image: &ImageTarget<'_>,
        frame: usize,
        memory: &mut RefineMemory<'_>,
    ) -> Option<FramePose> {
        let &own = self.cells[frame].found()?;
        let compares = self.phase == Phase::Compare;
        let way = compares.then(|| self.settling.way_to_compare(frame, &self.cells));
        let way = way.flatten();
        let other = way.and_then(|pose| from_other_way(subject, image, (&own, &pose), memory));
        let sample = SideSample {
            frame,
            own,
            rival: Rival::Mirrored,
            other: other.or_else(|| mirrored_pose(subject, image, &own, memory)),
            fixed: self.cells[frame].fixed,
        };
        match self.phase {
            Phase::Compare => self.rivals.push(sample),
            _ => self.settling.saw(sample),
        }
        Some(own)
    }

    fn see_from_elsewhere(
        &mut self,
        subject: &Subject<'_>,
        image: &ImageTarget<'_>,
        frame: usize,
        memory: &mut RefineMemory<'_>,
    ) -> Option<FramePose> {
        let &own = self.cells[frame].found()?;
        let both = self.settling.both_sides_of(frame);
        if both.is_none() && self.phase != Phase::Compare {
            return None;
        }
        let mirrored = both.and_then(|both| both.mirrored_now(&own));
        let other = elsewhere(subject, image, (&own, mirrored.as_ref()), memory);
        let sample = SideSample {
            frame,
            own,
            rival: Rival::Elsewhere,
            other,
            fixed: self.cells[frame].fixed,
        };
        match (self.phase, other) {
            // What a frame beside it was seen with may not be there.
            (Phase::Compare, None) => return self.see_both_sides(subject, image, frame, memory),
            (Phase::Compare, Some(_)) => self.rivals.push(sample),
            _ => self.settling.saw(sample),
        }
        Some(own)
    }

    fn begin_ways(&mut self) {
        // Of two poses of one frame the first that was given.
        self.anchors.sort_by_key(|anchor| anchor.frame);
        self.anchors.dedup_by_key(|anchor| anchor.frame);
        for anchor in &self.anchors {
            self.cells[anchor.frame] = Cell::from(anchor);
        }
        let between = self.anchors.windows(2).filter_map(|pair| match pair {
            [a, b] => Span::between(a, b).map(Box::new).map(Task::Span),
            _ => None,
        });
        self.tasks.extend(between);
        if let (Some(first), Some(last)) = (self.anchors.first(), self.anchors.last()) {
            let ends = [(last, self.range.end - 1), (first, self.range.start)];
            let walks = ends.map(|(anchor, to)| Walk::new(anchor, to));
            self.tasks.extend(walks.map(Box::new).map(Task::Walk));
        }
    }

    /// The next frame in which it was not found, though it was in others.
    fn to_search(&self) -> Option<Task> {
        let may_search = self.searches && !self.anchors.is_empty();
        let next = self.runs.next(&self.cells, &self.range);
        let (frame, run) = next.filter(|_| may_search)?;
        Some(Task::Search {
            frame,
            run,
            beside: None,
        })
    }

    /// What was found beside the other component is brought to its right pose with the rest of the film.
    fn end_beside(&mut self) {
        self.phase = Phase::Over;
        if self.beside.end(&mut self.cells) {
            self.settling = Settling::new(self.middle, self.range.clone());
            self.phase = Phase::Settle;
        }
    }

    /// From a frame to both ends of a run of frames.
    fn go_through(&mut self, anchor: &Anchor, run: &Range<usize>) {
        self.cells[anchor.frame] = Cell::from(anchor);
        let walks = [run.end - 1, run.start].map(|to| Walk::new(anchor, to));
        self.tasks.extend(walks.map(Box::new).map(Task::Walk));
    }
}
