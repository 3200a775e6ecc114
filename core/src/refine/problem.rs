//! What is the same for every step: observation of residuals, damped steps, polishing.

use super::edge;
use super::locks::{Hold, Locks};
use super::outline::{BorderPixel, Outliner};
use super::probe::{self, Found};
use super::solve::{Equations, Step};
use super::stages::{POLISHING, STEPS, Stage};
use super::view::{Target, View};
use super::{Iterate, RefineError, RefineMemory, Refined, check_memory};
use crate::mask::{MaskError, MaskMut, words_needed};
use crate::math::Vector3;
use crate::mesh::Mesh;
use crate::pose::{EulerPose, Pose};
use crate::raster::{RenderError, render};

/// Part of a loss that is not known, because the model is drawn in whole pixels.
const GRAIN: f64 = 0.02;

/// How far the drawn model's own outline may be from the middle of a border pixel, pixels.
pub(super) const OWN_RANGE: f64 = 3.0;

/// A model and what was seen of it.
pub(super) struct Problem<'a> {
    pub(super) mesh: &'a Mesh<'a>,
    pub(super) views: &'a [View<'a>],
    /// Middle of the model: turns about it hardly move the image.
    pub(super) middle: Vector3,
    /// Numbers of the pose that do not change.
    hold: Option<Hold>,
}

/// One stage as it applies to all views.
#[derive(Clone, Copy, Default)]
pub(super) struct Pass {
    pub(super) index: usize,
    /// Standard deviation of the residuals before, pixels.
    pub(super) spread: f64,
    /// Whether the offset is estimated.
    pub(super) free: bool,
}

impl<'a> Problem<'a> {
    /// # Errors
    /// Where views, frames and memory do not belong together, or a mask is empty.
    pub(super) fn new(
        mesh: &'a Mesh<'a>,
        views: &'a [View<'a>],
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
        memory.places.fill(0);
        Ok(Self {
            mesh,
            views,
            middle: mesh.bounds().centre,
            hold: None,
        })
    }

    /// Holds the locked numbers as they are at `start`.
    pub(super) fn hold(&mut self, locks: Locks, start: &Pose) {
        self.hold = (!locks.is_empty()).then(|| Hold {
            locks,
            start: EulerPose::from(*start),
        });
    }

    /// The step that the equations ask for at a pose, and the change of the offset.
    fn step(
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

    fn apply(&self, step: &Step, pose: &Pose) -> Pose {
        match &self.hold {
            None => step.apply(pose, &self.middle),
            Some(hold) => hold.apply(step, pose, &self.middle),
        }
    }

    /// Levenberg's and Marquardt's damping: a step that does not lower the loss is taken back
    /// and tried again more cautiously.
    pub(super) fn run(
        &self,
        pass: &Pass,
        state: &mut Refined,
        memory: &mut RefineMemory<'_>,
        trace: &mut dyn FnMut(&Iterate),
    ) -> Result<(), RefineError> {
        let mut equations = self.observe(&state.pose, state.offset_px, pass, memory)?;
        state.renders += self.views.len();
        let mut damping = 1e-3;
        state.converged = false;
        for _ in 0..STEPS[pass.index] {
            let Some((step, more)) = self.step(&equations, damping, pass, &state.pose) else {
                return Err(RefineError::TooFar);
            };
            let pose = self.apply(&step, &state.pose);
            let offset = state.offset_px + more;
            let tried = self.observe(&pose, offset, pass, memory);
            state.renders += self.views.len();
            match tried {
                Ok(next) if next.loss() < equations.loss() => {
                    (state.pose, state.offset_px) = (pose, offset);
                    equations = next;
                    damping = (damping * 0.2).max(1e-9);
                    trace(&equations.iterate(pass, state));
                }
                _ => damping *= 8.0,
            }
            if step.is_small() {
                state.converged = true;
                break;
            }
        }
        equations.report(state);
        Ok(())
    }

    /// Undamped steps to the zero of the gradient. The loss of a pose is known no better than the
    /// pixels of its outline allow, and near its minimum that hides the way down; the gradient
    /// still shows it. A step longer than the one before is a sign of swinging to and fro, and
    /// the next are shortened.
    pub(super) fn polish(
        &self,
        pass: &Pass,
        state: &mut Refined,
        memory: &mut RefineMemory<'_>,
        trace: &mut dyn FnMut(&Iterate),
    ) -> Result<(), RefineError> {
        let mut next = *state;
        let (mut share, mut last) = (1.0, f64::INFINITY);
        for _ in 0..POLISHING {
            let equations = self.observe(&next.pose, next.offset_px, pass, memory)?;
            next.renders += self.views.len();
            let Some((step, more)) = self.step(&equations, 0.0, pass, &next.pose) else {
                break;
            };
            if step.size() > last {
                share *= 0.6;
            }
            last = step.size();
            next.pose = self.apply(&step.scaled(share), &next.pose);
            next.offset_px += share * more;
            next.converged = step.is_small();
            if next.converged {
                break;
            }
        }
        let equations = self.observe(&next.pose, next.offset_px, pass, memory)?;
        next.renders += self.views.len();
        let before = state.loss;
        state.renders = next.renders;
        if equations.loss() <= before * (1.0 + GRAIN) + GRAIN * GRAIN {
            *state = next;
            equations.report(state);
            trace(&equations.iterate(pass, state));
        }
        Ok(())
    }

    /// Whether an offset that was estimated with the pose is determined by the data: it differs
    /// from zero by more than its uncertainty, and the pose cannot take its part.
    pub(super) fn supports_offset(
        &self,
        pass: &Pass,
        state: &Refined,
        memory: &mut RefineMemory<'_>,
    ) -> Result<bool, RefineError> {
        let equations = self.observe(&state.pose, state.offset_px, pass, memory)?;
        Ok(equations.supports_offset(state.offset_px))
    }

    /// Draws the model in every view and measures how far its outline is from the target's.
    pub(super) fn observe(
        &self,
        pose: &Pose,
        offset: f64,
        pass: &Pass,
        memory: &mut RefineMemory<'_>,
    ) -> Result<Equations, RefineError> {
        let mut equations = Equations::new();
        for view in self.views {
            let stage = Stage::of(&view.target, pass.index, pass.spread);
            self.observe_view(view, pose, offset, &stage, memory, &mut equations)?;
        }
        Ok(equations)
    }

    /// The same in one view. Afterwards the first so many places of `memory.border` hold its
    /// samples, those with a counterpart a residual; gives their number.
    pub(super) fn observe_view(
        &self,
        view: &View<'_>,
        pose: &Pose,
        offset: f64,
        stage: &Stage,
        memory: &mut RefineMemory<'_>,
        equations: &mut Equations,
    ) -> Result<usize, RefineError> {
        let pose = view.placement.compose(pose);
        let (width, height) = view.target.size();
        let words = memory.drawn.get_mut(..words_needed(width, height));
        let mut drawn = MaskMut::new(words.unwrap_or_default(), width, height)?;
        render(self.mesh, view.camera, &pose, memory.projected, &mut drawn)?;
        let drawn = drawn.into_mask();
        let outliner = Outliner {
            mesh: self.mesh,
            pose: &pose,
            drawn: &drawn,
        };
        let places = memory.places.get_mut(..width * height);
        let border = outliner.border(memory.projected, places.unwrap_or_default(), memory.border);
        let centre = pose.transform(&self.middle);
        let count = border.len();
        for sample in border.iter_mut().filter(|sample| sample.is_on_surface()) {
            let length = f64::from(sample.weight);
            let Found::At(own) = probe::crossing(&(&drawn).into(), sample, OWN_RANGE) else {
                continue;
            };
            match find(&view.target, sample, own + offset, stage.range) {
                Found::Unknown => equations.add_unknown(length),
                Found::Nothing => equations.add_missing(stage.loss, stage.range, length),
                Found::At(theirs) => {
                    let residual = theirs - own - offset;
                    sample.residual = residual as f32;
                    let jacobian = Step::jacobian(view.camera, &centre, sample);
                    let jacobian = Step::in_world(jacobian, &view.placement);
                    sample.jacobian = jacobian.map(|value| value as f32);
                    equations.add(stage.loss, &jacobian, residual, length);
                }
            }
        }
        Ok(count)
    }
}

/// Where a target's outline crosses the normal of a sample, or where the frame has an edge.
fn find(target: &Target<'_>, sample: &BorderPixel, expected: f64, range: f64) -> Found {
    match target {
        Target::Silhouette(silhouette) => probe::crossing(silhouette, sample, range),
        Target::Image(image) => edge::edge(image, sample, expected, range),
    }
}
