//! The way of a refinement: all stages one after the other, from one drawing to the next.

use core::mem::swap;
use core::task::Poll;

use super::effort::Effort;
use super::equations::Equations;
use super::error::RefineError;
use super::memory::RefineMemory;
use super::options::RefineOptions;
use super::problem::{Problem, check};
use super::result::{Iterate, Refined};
use super::stages::{POLISHING, Pass, STAGES};
use super::view::CameraView;
use crate::mesh::Model;
use crate::pose::Pose;

/// Part of a loss that is not known, because the model is drawn in whole pixels.
const GRAIN: f64 = 0.02;
/// A stage that is not the last ends where a step lowers the loss by less than this part: the next goes on from there.
const WORTH_GOING_ON: f64 = 0.02;

/// How much of the way is gone.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Part {
    All,
    /// The first stage: where a start leads. The loss is that stage's.
    First,
    /// All stages but the first, which was gone before.
    Rest,
    /// All of it by [`Effort::Probe`]: a quick look at where a start leads.
    Probe,
}

/// What the next drawing is for.
#[derive(Clone, Copy, PartialEq, Eq)]
enum At {
    /// None yet.
    Start,
    /// A stage begins.
    Stage,
    /// A damped step is tried.
    Step,
    /// An undamped one is taken.
    Polishing,
    /// No other follows.
    End,
}

/// A refinement between two drawings. What it works on is borrowed from one to the next alone, so that it can be kept anywhere.
pub(crate) struct Refinement {
    part: Part,
    start: Pose,
    at: At,
    pass: Pass,
    /// The best pose so far.
    pub(crate) state: Refined,
    /// The pose of the next drawing, where it is another.
    next: Refined,
    /// The best pose before an offset was estimated with it.
    without_offset: Refined,
    /// What was seen at the best pose.
    equations: Equations,
    /// Number of its samples in memory; `None` before anything was observed, and after another pose was.
    samples: Option<usize>,
    /// What was seen at a pose that is tried.
    tried: Equations,
    /// Steps left of a stage, or of polishing.
    left: usize,
    damping: f64,
    /// Of the last step.
    size: f64,
    /// Part of a step that is taken, and below which size it is the last.
    fraction: f64,
    small: f64,
}

/// What is borrowed for one drawing.
struct Turn<'t, 'm> {
    problem: Problem<'t>,
    edge_offset: bool,
    memory: &'t mut RefineMemory<'m>,
    trace: &'t mut dyn FnMut(&Iterate),
}

impl Refinement {
    /// All of it from a start.
    pub(crate) fn new(start: &Pose) -> Self {
        let state = Refined::at(*start);
        Self {
            part: Part::All,
            start: *start,
            at: At::Start,
            pass: Pass::default(),
            state,
            next: state,
            without_offset: state,
            equations: Equations::new(),
            samples: None,
            tried: Equations::new(),
            left: 0,
            damping: 0.0,
            size: 0.0,
            fraction: 0.0,
            small: 0.0,
        }
    }

    /// A part of it from where `begun` is, in the place of what was gone before.
    pub(crate) fn begin(&mut self, part: Part, begun: &Refined) {
        (self.part, self.start, self.state) = (part, begun.pose, *begun);
        (self.at, self.samples) = (At::Start, None);
    }

    /// Draws once, and goes on to the next drawing: [`Poll::Ready`] where there is none, or a pose is reached from which it is
    /// `known` where that leads.
    pub(crate) fn go_on(
        &mut self,
        (model, views): (&Model<'_>, &[CameraView<'_>]),
        mut options: RefineOptions,
        known: &dyn Fn(&Pose) -> bool,
        memory: &mut RefineMemory<'_>,
        trace: &mut dyn FnMut(&Iterate),
    ) -> Poll<Result<(), RefineError>> {
        if self.part == Part::Probe {
            (options.effort, options.edge_offset) = (Effort::Probe, false);
        }
        if self.at == At::Start {
            check(views, memory)?;
        }
        let mut problem = Problem::of(model, views);
        problem.hold(options.locks, &self.start);
        (problem.effort, problem.known) = (options.effort, Some(known));
        let edge_offset = options.edge_offset;
        let turn = &mut Turn {
            problem,
            edge_offset,
            memory,
            trace,
        };
        if self.at == At::Start {
            self.pass = turn.problem.first_pass();
            self.at = At::Stage;
            if self.part == Part::Rest {
                self.after_stage(turn)?;
            }
        }
        self.draw(turn)?;
        self.advance(turn)?;
        match self.at {
            At::End => Poll::Ready(Ok(())),
            _ => Poll::Pending,
        }
    }

    /// Draws, and takes in what is seen.
    fn draw(&mut self, turn: &mut Turn<'_, '_>) -> Result<(), RefineError> {
        let (problem, pass) = (&turn.problem, &self.pass);
        match self.at {
            At::Stage => {
                let (equations, state) = (&mut self.equations, &mut self.state);
                self.samples = problem.look(equations, state, pass, turn.memory)?;
                (turn.trace)(&equations.iterate(pass, state));
                self.begin_steps(turn);
            }
            At::Step => self.try_step(turn)?,
            At::Polishing => {
                let (equations, next) = (&mut self.equations, &mut self.next);
                self.samples = problem.look(equations, next, pass, turn.memory)?;
            }
            At::Start | At::End => {}
        }
        Ok(())
    }

    /// Goes on until something has to be drawn.
    fn advance(&mut self, turn: &mut Turn<'_, '_>) -> Result<(), RefineError> {
        loop {
            match self.at {
                At::Stage => {
                    let (equations, pose) = (&mut self.equations, &self.state.pose);
                    let (problem, samples) = (&turn.problem, self.samples);
                    if !problem.weigh_again(equations, samples, &self.pass, pose, turn.memory) {
                        return Ok(());
                    }
                    self.begin_steps(turn);
                }
                At::Step => {
                    if self.is_step_next(turn)? {
                        return Ok(());
                    }
                    self.equations.report(&mut self.state);
                    self.after_stage(turn)?;
                }
                At::Polishing => {
                    if self.is_polished_next(turn) {
                        return Ok(());
                    }
                    self.polished(turn)?;
                }
                At::Start | At::End => return Ok(()),
            }
        }
    }

    fn begin_steps(&mut self, turn: &Turn<'_, '_>) {
        (self.at, self.damping) = (At::Step, 1e-3);
        self.left = turn.problem.steps(&self.pass);
    }

    /// Levenberg's and Marquardt's damping: a step that does not lower the loss is taken back
    /// and tried again more cautiously, until it is so short that the grain of the loss hides the way.
    fn is_step_next(&mut self, turn: &Turn<'_, '_>) -> Result<bool, RefineError> {
        let Some(left) = self.left.checked_sub(1) else {
            return Ok(false);
        };
        self.left = left;
        let (problem, pose) = (&turn.problem, &self.state.pose);
        let step = problem.step(&self.equations, self.damping, &self.pass, pose);
        let Some((step, more)) = step else {
            return Err(RefineError::TooFar);
        };
        self.size = step.size();
        if self.size < problem.settled() {
            return Ok(false);
        }
        self.next = self.state;
        self.next.pose = problem.apply(&step, pose);
        self.next.offset_px += more;
        let is_known = problem.is_known(&self.next.pose);
        if is_known {
            self.state = self.next;
        }
        Ok(!is_known)
    }

    /// Draws the pose after a step, which becomes the best where its loss is lower.
    fn try_step(&mut self, turn: &mut Turn<'_, '_>) -> Result<(), RefineError> {
        let (problem, pass) = (&turn.problem, &self.pass);
        let looked = problem.look(&mut self.tried, &mut self.next, pass, turn.memory);
        self.state.renders = self.next.renders;
        match looked {
            Ok(samples) if self.tried.loss() < self.equations.loss() => {
                let gained = 1.0 - self.tried.loss() / self.equations.loss();
                swap(&mut self.equations, &mut self.tried);
                (self.state, self.samples) = (self.next, samples);
                self.damping = (self.damping * 0.2).max(1e-9);
                (turn.trace)(&self.equations.iterate(pass, &self.state));
                if gained < WORTH_GOING_ON && problem.goes_on(pass) {
                    self.left = 0;
                }
            }
            // No step leads round it, and to stop short of it would pass for an answer.
            Err(error @ RefineError::Memory(_)) => return Err(error),
            _ => {
                self.damping = problem.after_failure(self.damping);
                self.samples = None;
                if self.size < problem.grained() {
                    self.left = 0;
                }
            }
        }
        Ok(())
    }

    /// The next stage, or what follows the last.
    fn after_stage(&mut self, turn: &mut Turn<'_, '_>) -> Result<(), RefineError> {
        let problem = &turn.problem;
        if self.pass.free {
            return self.polish(turn);
        }
        self.at = At::End;
        while self.part != Part::First && !problem.is_known(&self.state.pose) {
            if self.pass.index + 1 == STAGES {
                return self.after_stages(turn);
            }
            let drawn = self.pass.drawn;
            self.pass = Pass {
                index: self.pass.index + 1,
                sigma_px: self.state.robust_sigma_px,
                drawn,
                ..Pass::default()
            };
            // An outline is weighed again, a frame would be looked at again.
            if !drawn || problem.steps(&self.pass) > 0 {
                self.at = At::Stage;
                break;
            }
        }
        Ok(())
    }

    fn after_stages(&mut self, turn: &mut Turn<'_, '_>) -> Result<(), RefineError> {
        let problem = &turn.problem;
        if !problem.has_film() {
            return self.polish(turn);
        }
        if problem.effort != Effort::Probe {
            problem.correct(&self.pass, &mut self.state, turn.memory, turn.trace)?;
        }
        self.end(turn)
    }

    /// Undamped steps to the zero of the gradient. The loss of a pose is known no better than the
    /// pixels of its outline allow, and near its minimum that hides the way down; the gradient
    /// still shows it.
    fn polish(&mut self, turn: &mut Turn<'_, '_>) -> Result<(), RefineError> {
        let Some(small) = turn.problem.effort.polished() else {
            return self.end(turn);
        };
        self.small = small * turn.problem.coarseness(&self.state);
        (self.at, self.left, self.next) = (At::Polishing, POLISHING, self.state);
        (self.fraction, self.size) = (1.0, f64::INFINITY);
        Ok(())
    }

    /// A step longer than the one before is a sign of swinging to and fro, and the next are shortened.
    fn is_polished_next(&mut self, turn: &Turn<'_, '_>) -> bool {
        let (problem, pose) = (&turn.problem, &self.next.pose);
        let Some(left) = self.left.checked_sub(1) else {
            return false;
        };
        self.left = left;
        let Some((step, more)) = problem.step(&self.equations, 0.0, &self.pass, pose) else {
            return false;
        };
        if step.size() > self.size {
            self.fraction *= 0.6;
        }
        self.size = step.size();
        let step = step.scaled(self.fraction);
        self.next.converged = step.size() < self.small;
        if self.next.converged {
            return false;
        }
        self.next.pose = problem.apply(&step, pose);
        self.next.offset_px += self.fraction * more;
        let is_known = problem.is_known(&self.next.pose);
        if is_known {
            self.state = self.next;
        }
        !is_known
    }

    /// Where polishing leads is taken unless its loss is higher, as far as that is known.
    fn polished(&mut self, turn: &mut Turn<'_, '_>) -> Result<(), RefineError> {
        self.state.renders = self.next.renders;
        if self.equations.loss() <= self.state.loss * (1.0 + GRAIN) + GRAIN * GRAIN {
            self.state = self.next;
            self.equations.report(&mut self.state);
            (turn.trace)(&self.equations.iterate(&self.pass, &self.state));
        }
        self.end(turn)
    }

    /// All of it once more with an offset, where one is asked for; it is taken where the data support it.
    fn end(&mut self, turn: &mut Turn<'_, '_>) -> Result<(), RefineError> {
        self.at = At::End;
        if !turn.edge_offset {
            return Ok(());
        }
        if !self.pass.free {
            self.pass.free = true;
            (self.at, self.without_offset, self.samples) = (At::Stage, self.state, None);
            return Ok(());
        }
        let problem = &turn.problem;
        if !problem.supports_offset(&self.pass, &self.state, turn.memory)? {
            let renders = self.state.renders;
            self.state = Refined {
                renders,
                ..self.without_offset
            };
        }
        Ok(())
    }
}
