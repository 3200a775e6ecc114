//! Refinement: the pose that brings the model's outline onto what the cameras saw.
//!
//! Damped Gauss-Newton on the distance between two outlines, measured along the normals of the
//! model's as it is drawn at the present pose. Against a silhouette both outlines are sampled by
//! the same pixels and read by the same interpolation, so their bias cancels, and at the pose at
//! which a mask was drawn every residual is zero. Against a grey frame the target is the edge
//! that the outline predicts ([`edge`]).
//!
//! The Jacobian is that of full perspective at the 3-D point behind each sample of the outline
//! (Fregly, Rahman and Banks, J. Biomech. Eng. 127, 2005, compare outlines alike). Cameras that
//! saw the implant at once add their residuals to the same equations.

mod edge;
mod outline;
mod probe;
mod solve;
mod stages;
mod view;

pub use outline::BorderPixel;
pub use view::{ImageTarget, Polarity, Target, View};

use thiserror::Error;

use crate::camera::Camera;
use crate::mask::{MaskError, MaskMut, Word, words_needed};
use crate::math::Vector3;
use crate::mesh::Mesh;
use crate::pose::Pose;
use crate::raster::{Projected, RenderError, render};
use outline::Outliner;
use probe::Found;
use solve::{Equations, Step};
use stages::{STAGES, STEPS, Stage};

/// Why a pose cannot be refined.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum RefineError {
    /// The model cannot be drawn at the pose to start from.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// The mask is empty or lent memory has the wrong length.
    #[error(transparent)]
    Mask(#[from] MaskError),
    /// There is nothing to refine against.
    #[error("refinement needs at least one view")]
    NoView,
    /// Lent memory has the wrong length.
    #[error("refinement needs {needed} {what} but {given} were lent")]
    Memory {
        /// Which memory.
        what: &'static str,
        /// Length needed.
        needed: usize,
        /// Length lent.
        given: usize,
    },
    /// Too little of the model's outline is near the target's to say where the model is.
    #[error(
        "the model's outline and the target's are too far apart, or too little of it is known, to be brought together; trace again or start nearer"
    )]
    TooFar,
}

/// Working memory of [`refine`], for the largest of its views.
#[derive(Debug)]
pub struct RefineMemory<'a> {
    /// [`crate::raster::scratch_needed`] vertices.
    pub projected: &'a mut [Projected],
    /// [`crate::mask::words_needed`] words of the frame's size: the model as drawn.
    pub drawn: &'a mut [Word],
    /// One number a pixel of the frame.
    pub places: &'a mut [u16],
    /// Samples of the outline. One for each border pixel is wanted; of more, the first are
    /// taken. 65 535 at most are used.
    pub border: &'a mut [BorderPixel],
}

/// A refined pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refined {
    /// `world_from_model`; of a single camera, `camera_from_model`.
    pub pose: Pose,
    /// Distance of the target's edges beyond the model's outline that was estimated with the
    /// pose, pixels; zero where it was not asked for or the data do not support it.
    pub offset_px: f64,
    /// Root mean square of what remains between the outlines, weighted by arc length as the
    /// robust loss does, pixels.
    pub residual_px: f64,
    /// Robust loss by which rival poses are compared, square pixels.
    pub loss: f64,
    /// Times the model was drawn.
    pub renders: usize,
    /// Whether the last steps were below 0.0001 degrees and 0.001 mm.
    pub converged: bool,
}

/// How far the drawn model's own outline may be from the middle of a border pixel, pixels.
const OWN_RANGE: f64 = 3.0;

/// What is the same for every step.
struct Problem<'a> {
    mesh: &'a Mesh<'a>,
    views: &'a [View<'a>],
    /// Middle of the model: turns about it hardly move the image.
    middle: Vector3,
}

/// One stage as it applies to all views.
#[derive(Clone, Copy)]
struct Pass {
    index: usize,
    /// Standard deviation of the residuals before, pixels.
    spread: f64,
    /// Whether the offset is estimated.
    free: bool,
}

/// Refines `start` until the model's outline lies on those of `views`.
///
/// Draws the model at most 46 times in each view. Never worse than `start` by the loss of its
/// last stage.
///
/// # Errors
/// [`RefineError`].
pub fn refine(
    mesh: &Mesh<'_>,
    views: &[View<'_>],
    start: &Pose,
    memory: &mut RefineMemory<'_>,
) -> Result<Refined, RefineError> {
    let problem = Problem {
        mesh,
        views,
        middle: mesh.bounds().centre,
    };
    problem.check(memory)?;
    let mut state = Refined {
        pose: *start,
        offset_px: 0.0,
        residual_px: 0.0,
        loss: 0.0,
        renders: 0,
        converged: false,
    };
    let mut pass = Pass {
        index: 0,
        spread: 0.0,
        free: false,
    };
    for index in 0..STAGES {
        pass.index = index;
        pass.spread = problem.run(&pass, &mut state, memory)?;
    }
    Ok(state)
}

/// A piece of the model's occluding contour as one camera sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OutlineSample {
    /// Continuous image coordinates, pixels.
    pub column: f64,
    /// Downwards.
    pub row: f64,
    /// Outward unit normal, to the right and downwards.
    pub normal: [f64; 2],
    /// Arc length, pixels.
    pub length: f64,
    /// How fast the contour moves along the normal, pixels per radian of three turns about the
    /// middle of the model's box and per mm of three shifts, all along the camera's axes.
    pub jacobian: [f64; 6],
}

/// Samples the occluding contour of `mesh` at `pose` (`camera_from_model`), one sample for each
/// border pixel of its silhouette; what the frame's border cuts off is left out.
///
/// # Errors
/// [`RefineError`] where the model cannot be drawn or memory is too short.
pub fn outline_samples(
    mesh: &Mesh<'_>,
    camera: &Camera,
    pose: &Pose,
    memory: &mut RefineMemory<'_>,
    mut visit: impl FnMut(&OutlineSample),
) -> Result<(), RefineError> {
    check_memory(camera, memory)?;
    let (width, height) = (camera.width(), camera.height());
    let words = memory.drawn.get_mut(..words_needed(width, height));
    let mut drawn = MaskMut::new(words.unwrap_or_default(), width, height)?;
    render(mesh, camera, pose, memory.projected, &mut drawn)?;
    let drawn = drawn.into_mask();
    let outliner = Outliner {
        mesh,
        pose,
        drawn: &drawn,
    };
    let places = memory.places.get_mut(..width * height);
    let border = outliner.border(memory.projected, places.unwrap_or_default(), memory.border);
    let centre = pose.transform(&mesh.bounds().centre);
    for sample in border {
        let Found::At(own) = probe::crossing(&(&drawn).into(), sample, OWN_RANGE) else {
            continue;
        };
        let normal = sample.normal.map(f64::from);
        let [column, row] = sample.place();
        visit(&OutlineSample {
            column: column + own * normal[0],
            row: row + own * normal[1],
            normal,
            length: f64::from(sample.weight),
            jacobian: Step::jacobian(camera, &centre, sample),
        });
    }
    Ok(())
}

fn check_memory(camera: &Camera, memory: &RefineMemory<'_>) -> Result<(), RefineError> {
    let (width, height) = (camera.width(), camera.height());
    let needed = [
        ("words", words_needed(width, height), memory.drawn.len()),
        ("places", width * height, memory.places.len()),
        ("border pixels (at least)", 64, memory.border.len()),
    ];
    for (what, needed, given) in needed {
        if given < needed {
            return Err(RefineError::Memory {
                what,
                needed,
                given,
            });
        }
    }
    Ok(())
}

impl Problem<'_> {
    fn check(&self, memory: &RefineMemory<'_>) -> Result<(), RefineError> {
        if self.views.is_empty() {
            return Err(RefineError::NoView);
        }
        for view in self.views {
            let (width, height) = view.target.size();
            if (width, height) != (view.camera.width(), view.camera.height()) {
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

    /// Levenberg's and Marquardt's damping: a step that does not lower the loss is taken back
    /// and tried again more cautiously. Gives the spread of the residuals, pixels.
    fn run(
        &self,
        pass: &Pass,
        state: &mut Refined,
        memory: &mut RefineMemory<'_>,
    ) -> Result<f64, RefineError> {
        let mut equations = self.observe(&state.pose, state.offset_px, pass, memory)?;
        state.renders += self.views.len();
        let mut damping = 1e-3;
        state.converged = false;
        for _ in 0..STEPS[pass.index] {
            let Some((step, more)) = equations.step(damping, pass.free) else {
                return Err(RefineError::TooFar);
            };
            let pose = step.apply(&state.pose, &self.middle);
            let offset = state.offset_px + more;
            let tried = self.observe(&pose, offset, pass, memory);
            state.renders += self.views.len();
            match tried {
                Ok(next) if next.loss() < equations.loss() => {
                    (state.pose, state.offset_px) = (pose, offset);
                    equations = next;
                    damping = (damping * 0.2).max(1e-9);
                }
                _ => damping *= 8.0,
            }
            if step.is_small() {
                state.converged = true;
                break;
            }
        }
        state.loss = equations.loss();
        state.residual_px = equations.residual_px();
        Ok(equations.spread_px())
    }

    /// Draws the model in every view and measures how far its outline is from the target's.
    fn observe(
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

    fn observe_view(
        &self,
        view: &View<'_>,
        pose: &Pose,
        offset: f64,
        stage: &Stage,
        memory: &mut RefineMemory<'_>,
        equations: &mut Equations,
    ) -> Result<(), RefineError> {
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
        for sample in border {
            let length = f64::from(sample.weight);
            let Found::At(own) = probe::crossing(&(&drawn).into(), sample, OWN_RANGE) else {
                continue;
            };
            let (found, certainty) = find(&view.target, sample, own + offset, stage.range);
            match found {
                Found::Unknown => equations.add_unknown(length),
                Found::Nothing => equations.add_missing(stage.loss, stage.range, length),
                Found::At(theirs) => {
                    let residual = theirs - own - offset;
                    sample.residual = residual as f32;
                    let jacobian = Step::jacobian(view.camera, &centre, sample);
                    let jacobian = Step::in_world(jacobian, &view.placement);
                    equations.add(stage.loss, &jacobian, residual, length * certainty);
                }
            }
        }
        Ok(())
    }
}

/// Where a target's outline crosses the normal of a sample, and how much that counts, 0 to 1.
fn find(target: &Target<'_>, sample: &BorderPixel, expected: f64, range: f64) -> (Found, f64) {
    match target {
        Target::Silhouette(silhouette) => (probe::crossing(silhouette, sample, range), 1.0),
        Target::Image(image) => {
            let edge = edge::edge(image, sample, expected, range);
            (edge.found, 1.0)
        }
    }
}
