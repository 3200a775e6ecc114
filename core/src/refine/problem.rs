//! What is the same for every step: observation of residuals, damped steps, polishing.

use core::future::{Future, poll_fn};
use core::mem::swap;
use core::task::Poll;

use super::drawing::{Drawing, draw};
use super::drawn::DrawnEdges;
use super::effort::Effort;
use super::equations::Equations;
use super::error::RefineError;
use super::eye::Eye;
use super::locks::{Hold, Locks};
use super::memory::{RefineMemory, check_memory};
use super::motion::Motion;
use super::options::RefineOptions;
use super::outline::{Depth, Sampling};
use super::result::{Iterate, Refined};
use super::stages::{POLISHING, Pass, STAGES, Stage};
use super::step::Step;
use super::view::{CameraView, Target};
use crate::image::mask::MaskError;
use crate::math::{Vector3, within};
use crate::mesh::Model;
use crate::pace::Pace;
use crate::pose::{EulerPose, Pose};
use crate::render::RenderError;

/// Part of a loss that is not known, because the model is drawn in whole pixels.
const GRAIN: f64 = 0.02;

/// A model and what was seen of it.
pub(super) struct Problem<'a> {
    pub(super) model: &'a Model<'a>,
    pub(super) views: &'a [CameraView<'a>],
    /// Middle of the model: turns about it hardly move the image.
    pub(super) middle: Vector3,
    /// Numbers of the pose that do not change.
    hold: Option<Hold>,
    pub(super) effort: Effort,
    /// Where it pauses, before each drawing.
    pub(super) pace: Option<&'a Pace>,
    /// Poses from which it is known where they lead.
    pub(super) known: Option<&'a dyn Fn(&Pose) -> bool>,
    /// Loss of a correction, square pixels, above which it is given up.
    pub(super) hopeless: f64,
}

/// Steps shorter than this lower the loss by no more than its grain: [`Step::size`]. Polishing does the rest. With all
/// steps tried to the end 150 femurs and tibias came out alike within 3 % after more than twice as many drawings.
const SETTLED: f64 = 0.05;
/// One below this size that fails has met the grain, as larger ones do not: a more cautious one would meet it too. It is this
/// many times [`SETTLED`] at least, and of grey frames no more.
const GRAINED: f64 = 0.5;
const GRAINED_SETTLED: f64 = 2.0;
/// Damping of the first try after one that failed against an outline, at least: with less the step is the same again.
const CAUTIOUS: f64 = 0.5;
/// Standard deviation of the residuals from which an outline counts as noisy, pixels; [`Problem::coarseness`] is at most
/// the second.
const NOISE_PX: f64 = 0.1;
const COARSEST: f64 = 20.0;
/// Most steps of the stages before correction by the film, which goes on from wherever they end.
const BEFORE_CORRECTION: [usize; STAGES] = [5, 0, 3, 0];
/// A stage that is not the last ends where a step lowers the loss by less than this part: the next goes on from there.
const WORTH_GOING_ON: f64 = 0.02;
/// Edges of a grey frame have no grain: there, this part of both, and of what polishing ends at.
const WITHOUT_GRAIN: f64 = 0.02;

/// What was seen at a pose, in one place from the first drawing to the last: it is long.
pub(super) struct Seen {
    pub(super) equations: Equations,
    /// Number of its samples in memory; `None` before anything was observed, and after another pose was.
    samples: Option<usize>,
    /// Of a pose that is tried.
    tried: Equations,
}

impl Seen {
    /// Nothing yet.
    pub(super) fn new() -> Self {
        Self {
            equations: Equations::new(),
            samples: None,
            tried: Equations::new(),
        }
    }

    /// What is seen next begins anew.
    pub(super) fn forget(&mut self) {
        self.samples = None;
    }
}

impl<'a> Problem<'a> {
    /// # Errors
    /// Where views, frames and memory do not belong together, or a mask is empty.
    pub(super) fn new(
        model: &'a Model<'a>,
        views: &'a [CameraView<'a>],
        memory: &mut RefineMemory<'_>,
    ) -> Result<Self, RefineError> {
        if views.is_empty() {
            return Err(RefineError::NoView);
        }
        for view in views {
            if view.target.size() != (view.camera.width(), view.camera.height()) {
                return Err(RenderError::Size.into());
            }
            check_memory(view.camera, memory)?;
            if let Target::Silhouette(silhouette) = &view.target
                && silhouette.mask().area() == 0
            {
                return Err(MaskError::Empty.into());
            }
        }
        Ok(Self {
            model,
            views,
            middle: model.bounds().centre,
            hold: None,
            effort: Effort::Full,
            pace: None,
            known: None,
            hopeless: f64::INFINITY,
        })
    }

    /// To refine a start as exactly as the options ask for.
    ///
    /// # Errors
    /// As [`Problem::new`].
    pub(super) fn refining(
        model: &'a Model<'a>,
        views: &'a [CameraView<'a>],
        start: &Pose,
        options: RefineOptions,
        memory: &mut RefineMemory<'_>,
    ) -> Result<Self, RefineError> {
        let mut problem = Self::new(model, views, memory)?;
        problem.hold(options.locks, start);
        problem.effort = options.effort;
        Ok(problem)
    }

    /// The first stage.
    pub(super) fn first_pass(&self) -> Pass {
        Pass {
            drawn: self.has_film(),
            ..Pass::default()
        }
    }

    /// Before a drawing.
    pub(super) fn pause(&self) -> impl Future<Output = ()> {
        poll_fn(|context| match self.pace {
            Some(pace) => pace.take(context),
            None => Poll::Ready(()),
        })
    }

    /// Whether it is known where a pose leads.
    pub(super) fn is_known(&self, pose: &Pose) -> bool {
        self.known.is_some_and(|known| known(pose))
    }

    /// Holds the locked numbers as they are at `start`.
    pub(super) fn hold(&mut self, locks: Locks, start: &Pose) {
        self.hold = (!locks.is_empty()).then(|| Hold {
            locks,
            start: EulerPose::from(*start),
        });
    }

    /// The step that the equations ask for at a pose, and the change of the offset.
    pub(super) fn step(
        &self,
        equations: &Equations,
        damping: f64,
        pass: &Pass,
        pose: &Pose,
    ) -> Option<(Step, f64)> {
        match &self.hold {
            None => equations.step(damping, pass.free),
            Some(hold) => {
                let rows = hold.locks.rows(pose, &self.middle);
                equations.held_step(damping, pass.free, rows)
            }
        }
    }

    pub(super) fn apply(&self, step: &Step, pose: &Pose) -> Pose {
        match &self.hold {
            None => step.apply(pose, &self.middle),
            Some(hold) => hold.apply(step, pose, &self.middle),
        }
    }

    /// Levenberg's and Marquardt's damping: a step that does not lower the loss is taken back
    /// and tried again more cautiously, until it is so short that the grain of the loss hides the way.
    ///
    /// `seen` is what the stage before saw at this pose, and what this one saw at the last, afterwards.
    pub(super) async fn run(
        &self,
        pass: &Pass,
        state: &mut Refined,
        seen: &mut Seen,
        memory: &mut RefineMemory<'_>,
        trace: &mut dyn FnMut(&Iterate),
    ) -> Result<(), RefineError> {
        if !self.weigh_again(seen, pass, &state.pose, memory) {
            self.pause().await;
            seen.samples = self.look(&mut seen.equations, state, pass, memory)?;
            trace(&seen.equations.iterate(pass, state));
        }
        let mut damping = 1e-3;
        for _ in 0..self.steps(pass) {
            let Some((step, more)) = self.step(&seen.equations, damping, pass, &state.pose) else {
                return Err(RefineError::TooFar);
            };
            let coarser = self.effort.coarser();
            if step.size() < SETTLED * coarser * self.grain() {
                break;
            }
            let mut next = *state;
            next.pose = self.apply(&step, &state.pose);
            next.offset_px += more;
            if self.is_known(&next.pose) {
                *state = next;
                break;
            }
            self.pause().await;
            let tried = self.look(&mut seen.tried, &mut next, pass, memory);
            state.renders = next.renders;
            match tried {
                Ok(samples) if seen.tried.loss() < seen.equations.loss() => {
                    let gained = 1.0 - seen.tried.loss() / seen.equations.loss();
                    swap(&mut seen.equations, &mut seen.tried);
                    (*state, seen.samples) = (next, samples);
                    damping = (damping * 0.2).max(1e-9);
                    trace(&seen.equations.iterate(pass, state));
                    if gained < WORTH_GOING_ON && self.goes_on(pass) {
                        break;
                    }
                }
                // No step leads round it, and to stop short of it would pass for an answer.
                Err(error @ RefineError::Memory(_)) => return Err(error),
                _ => {
                    damping = self.after_failure(damping);
                    seen.samples = None;
                    if step.size() < self.grained() {
                        break;
                    }
                }
            }
        }
        seen.equations.report(state);
        Ok(())
    }

    /// Damping of the step that is tried after one that failed.
    fn after_failure(&self, damping: f64) -> f64 {
        let least = if self.is_outline() { CAUTIOUS } else { 0.0 };
        (damping * 8.0).max(least)
    }

    /// A step below this size that fails has met the grain.
    fn grained(&self) -> f64 {
        let least = if self.is_outline() { GRAINED } else { 0.0 };
        let settled = GRAINED_SETTLED * SETTLED * self.effort.coarser();
        least.max(settled) * self.grain()
    }

    /// Most steps tried in a stage.
    pub(super) fn steps(&self, pass: &Pass) -> usize {
        let of = |steps: [usize; STAGES]| steps.get(pass.index).copied().unwrap_or(0);
        let most = of(self.effort.steps());
        match self.is_corrected(pass) {
            true => most.min(of(BEFORE_CORRECTION)),
            false => most,
        }
    }

    /// Whether the film corrects what the stages lead to.
    fn is_corrected(&self, pass: &Pass) -> bool {
        self.has_film() && self.effort != Effort::Probe && !pass.free
    }

    /// Whether another stage, or correction by the film, goes on from where this one ends.
    fn goes_on(&self, pass: &Pass) -> bool {
        match self.is_outline() {
            true => pass.index + 1 < STAGES,
            false => self.is_corrected(pass),
        }
    }

    /// Undamped steps to the zero of the gradient. The loss of a pose is known no better than the
    /// pixels of its outline allow, and near its minimum that hides the way down; the gradient
    /// still shows it. A step longer than the one before is a sign of swinging to and fro, and
    /// the next are shortened.
    pub(super) async fn polish(
        &self,
        pass: &Pass,
        state: &mut Refined,
        seen: &mut Seen,
        memory: &mut RefineMemory<'_>,
        trace: &mut dyn FnMut(&Iterate),
    ) -> Result<(), RefineError> {
        let Some(small) = self.effort.polished() else {
            return Ok(());
        };
        let small = small * self.coarseness(state);
        let mut next = *state;
        let (mut fraction, mut last) = (1.0, f64::INFINITY);
        for _ in 0..POLISHING {
            let Some((step, more)) = self.step(&seen.equations, 0.0, pass, &next.pose) else {
                break;
            };
            if step.size() > last {
                fraction *= 0.6;
            }
            last = step.size();
            let step = step.scaled(fraction);
            next.converged = step.size() < small;
            if next.converged {
                break;
            }
            next.pose = self.apply(&step, &next.pose);
            next.offset_px += fraction * more;
            if self.is_known(&next.pose) {
                *state = next;
                return Ok(());
            }
            self.pause().await;
            seen.samples = self.look(&mut seen.equations, &mut next, pass, memory)?;
        }
        state.renders = next.renders;
        if seen.equations.loss() <= state.loss * (1.0 + GRAIN) + GRAIN * GRAIN {
            *state = next;
            seen.equations.report(state);
            trace(&seen.equations.iterate(pass, state));
        }
        Ok(())
    }

    /// How many times longer than on an outline without noise the last step may be: noise leaves the pose as many times
    /// less certain.
    fn coarseness(&self, state: &Refined) -> f64 {
        match self.is_outline() {
            true => within(state.robust_sigma_px / NOISE_PX, 1.0, COARSEST),
            false => self.grain(),
        }
    }

    /// How coarse the loss is, against that of silhouettes.
    fn grain(&self) -> f64 {
        // What is known of a film is no finer.
        if self.has_film() || self.is_outline() {
            1.0
        } else {
            WITHOUT_GRAIN
        }
    }

    /// Whether all that was seen are silhouettes.
    fn is_outline(&self) -> bool {
        let silhouette = |view: &CameraView<'_>| matches!(view.target, Target::Silhouette(_));
        self.views.iter().all(silhouette)
    }

    /// Observes a pose, and counts the drawings. Gives the number of samples of the last view.
    pub(super) fn look(
        &self,
        equations: &mut Equations,
        state: &mut Refined,
        pass: &Pass,
        memory: &mut RefineMemory<'_>,
    ) -> Result<Option<usize>, RefineError> {
        equations.clear();
        state.renders += self.views.len();
        let mut samples = None;
        for view in self.views {
            let stage = pass.stage(&view.target);
            let (pose, offset) = (&state.pose, state.offset_px);
            let count = self.observe_view(view, pose, offset, &stage, memory)?;
            let motion = self.motion(view, &view.placement.compose(pose));
            let border = memory.border.get(..count).unwrap_or_default();
            equations.add_samples(border, &motion, &stage);
            samples = Some(count);
        }
        Ok(samples)
    }

    /// What was seen at a pose, weighed as another stage does, without drawing again: of one camera, and of a
    /// silhouette, whose outline is where it is whatever the range, or of a frame whose film corrects what comes of it.
    /// Gives whether it could be.
    fn weigh_again(
        &self,
        seen: &mut Seen,
        pass: &Pass,
        pose: &Pose,
        memory: &RefineMemory<'_>,
    ) -> bool {
        let [view] = self.views else {
            return false;
        };
        if !self.is_outline() && !self.is_corrected(pass) {
            return false;
        }
        let samples = seen.samples.and_then(|count| memory.border.get(..count));
        let Some(samples) = samples else {
            return false;
        };
        let motion = self.motion(view, &view.placement.compose(pose));
        seen.equations.clear();
        seen.equations
            .add_samples(samples, &motion, &pass.stage(&view.target));
        true
    }

    /// Whether an offset that was estimated with the pose is determined by the data: it differs
    /// from zero by more than its uncertainty, and the pose cannot take its part.
    pub(super) fn supports_offset(
        &self,
        pass: &Pass,
        state: &Refined,
        memory: &mut RefineMemory<'_>,
    ) -> Result<bool, RefineError> {
        let mut equations = Equations::new();
        self.look(&mut equations, &mut { *state }, pass, memory)?;
        Ok(equations.supports_offset(state.offset_px))
    }

    /// How the outline moves in a view, in which the model has a pose.
    pub(super) fn motion(&self, view: &CameraView<'_>, in_camera: &Pose) -> Motion {
        Motion::of(view, &in_camera.transform(&self.middle))
    }

    /// Draws the model in a view and measures how far its outline is from the target's. Afterwards
    /// `memory.border` begins with its samples, whose number is returned.
    pub(super) fn observe_view(
        &self,
        view: &CameraView<'_>,
        pose: &Pose,
        offset: f64,
        stage: &Stage,
        memory: &mut RefineMemory<'_>,
    ) -> Result<usize, RefineError> {
        let pose = view.placement.compose(pose);
        let sampling = Sampling {
            depth: Depth::of(&view.target, stage),
            every: stage.every.unwrap_or(self.effort.every()),
            turn: stage.turn,
        };
        let sampling = sampling.in_part(view.target.before());
        let Drawing {
            drawn,
            border,
            projected,
            film,
        } = draw(self.model, view.camera, &pose, sampling, memory)?;
        if view.target.hides(&drawn) {
            return Err(RefineError::BeyondCrop);
        }
        let edges = DrawnEdges::of(self.model, &pose, view, stage, border, projected, film)?;
        let count = border.len();
        let eye = Eye {
            view,
            drawn,
            edges,
            offset: offset + view.target.offset_px(),
            stage,
        };
        eye.measure(border);
        Ok(count)
    }
}
