//! What is the same for every step: observation of residuals, steps, when they are short enough.

use super::drawing::{Drawing, draw};
use super::drawn::DrawnEdges;
use super::effort::Effort;
use super::equations::Equations;
use super::error::RefineError;
use super::eye::Eye;
use super::locks::{Hold, Locks};
use super::memory::{RefineMemory, check_memory};
use super::motion::Motion;
use super::outline::{Depth, Sampling};
use super::result::Refined;
use super::stages::{Pass, STAGES, Stage};
use super::step::Step;
use super::unless::Unless;
use super::view::{CameraView, Target};
use crate::image::mask::MaskError;
use crate::math::{Vector3, within};
use crate::mesh::Model;
use crate::pose::{EulerPose, Pose};
use crate::render::RenderError;

/// A model and what was seen of it.
pub(super) struct Problem<'a> {
    pub(super) model: &'a Model<'a>,
    pub(super) views: &'a [CameraView<'a>],
    /// Middle of the model: turns about it hardly move the image.
    pub(super) middle: Vector3,
    /// Numbers of the pose that do not change.
    hold: Option<Hold>,
    pub(super) effort: Effort,
    /// Poses from which it is known where they lead.
    pub(super) known: Option<&'a dyn Fn(&Pose) -> bool>,
    /// What a correction is given up for.
    pub(super) unless: Unless<'a>,
}

/// # Errors
/// Where views, frames and memory do not belong together, or a mask is empty.
pub(super) fn check(
    views: &[CameraView<'_>],
    memory: &RefineMemory<'_>,
) -> Result<(), RefineError> {
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
    Ok(())
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
/// Edges of a grey frame have no grain: there, this part of both, and of what polishing ends at.
const WITHOUT_GRAIN: f64 = 0.02;

impl<'a> Problem<'a> {
    /// # Errors
    /// Where views, frames and memory do not belong together, or a mask is empty.
    pub(super) fn new(
        model: &'a Model<'a>,
        views: &'a [CameraView<'a>],
        memory: &RefineMemory<'_>,
    ) -> Result<Self, RefineError> {
        check(views, memory)?;
        Ok(Self::of(model, views))
    }

    /// The same of what was checked.
    pub(super) fn of(model: &'a Model<'a>, views: &'a [CameraView<'a>]) -> Self {
        Self {
            model,
            views,
            middle: model.bounds().centre,
            hold: None,
            effort: Effort::Full,
            known: None,
            unless: Unless::NOTHING,
        }
    }

    /// The first stage.
    pub(super) fn first_pass(&self) -> Pass {
        Pass {
            drawn: self.has_film(),
            ..Pass::default()
        }
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

    /// Damping of the step that is tried after one that failed.
    pub(super) fn after_failure(&self, damping: f64) -> f64 {
        let least = if self.is_outline() { CAUTIOUS } else { 0.0 };
        (damping * 8.0).max(least)
    }

    /// A step below this size lowers the loss by no more than its grain.
    pub(super) fn settled(&self) -> f64 {
        SETTLED * self.effort.coarser() * self.grain()
    }

    /// A step below this size that fails has met the grain.
    pub(super) fn grained(&self) -> f64 {
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
    pub(super) fn goes_on(&self, pass: &Pass) -> bool {
        match self.is_outline() {
            true => pass.index + 1 < STAGES,
            false => self.is_corrected(pass),
        }
    }

    /// How many times longer than on an outline without noise the last step may be: noise leaves the pose as many times
    /// less certain.
    pub(super) fn coarseness(&self, state: &Refined) -> f64 {
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
            let pose = view.placement.compose(&state.pose);
            let count = self.observe_view(view, &pose, state.offset_px, &stage, memory)?;
            let motion = self.motion(view, &pose);
            let border = memory.border.get(..count).unwrap_or_default();
            equations.add_samples(border, &motion, &stage);
            samples = Some(count);
        }
        Ok(samples)
    }

    /// What was seen at a pose, weighed as another stage does, without drawing again: of one camera, and of a
    /// silhouette, whose outline is where it is whatever the range, or of a frame whose film corrects what comes of it.
    /// Gives whether it could be.
    pub(super) fn weigh_again(
        &self,
        equations: &mut Equations,
        samples: Option<usize>,
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
        let Some(samples) = samples.and_then(|count| memory.border.get(..count)) else {
            return false;
        };
        let motion = self.motion(view, &view.placement.compose(pose));
        equations.clear();
        equations.add_samples(samples, &motion, &pass.stage(&view.target));
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

    /// Draws the model in a view, in which it has a pose, and measures how far its outline is from the target's. Afterwards
    /// `memory.border` begins with its samples, whose number is returned.
    pub(super) fn observe_view(
        &self,
        view: &CameraView<'_>,
        in_camera: &Pose,
        offset: f64,
        stage: &Stage,
        memory: &mut RefineMemory<'_>,
    ) -> Result<usize, RefineError> {
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
            all,
            film,
        } = draw(self.model, view.camera, in_camera, sampling, memory)?;
        if view.target.hides(&drawn) {
            return Err(RefineError::BeyondCrop);
        }
        let images = (projected, all);
        let edges = DrawnEdges::of(self.model, in_camera, view, stage, border, images, film)?;
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
