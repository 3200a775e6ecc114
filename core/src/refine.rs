//! Refinement: the pose that brings the model's outline onto the mask's.
//!
//! Damped Gauss-Newton on the distance between two outlines, measured along the normals of the
//! model's: that of the mask, and that of the model drawn at the present pose. Both are sampled
//! by the same pixels and read by the same interpolation, so their bias cancels, and at the pose
//! at which the mask was drawn every residual is zero.
//!
//! The Jacobian is that of full perspective at the 3-D point behind each sample of the outline
//! (Fregly, Rahman and Banks, J. Biomech. Eng. 127, 2005, compare outlines alike).

mod outline;
mod probe;
mod solve;

pub use outline::BorderPixel;

use thiserror::Error;

use crate::camera::Camera;
use crate::mask::{Mask, MaskError, MaskMut, Word};
use crate::math::Vector3;
use crate::mesh::Mesh;
use crate::pose::Pose;
use crate::raster::{Projected, RenderError, render};
use outline::Outliner;
use solve::{Equations, Step};

/// Why a pose cannot be refined.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum RefineError {
    /// The model cannot be drawn at the pose to start from.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// The mask is empty or lent memory has the wrong length.
    #[error(transparent)]
    Mask(#[from] MaskError),
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
    /// Too little of the model's outline is near the mask's to say where the model is.
    #[error(
        "the model's outline and the mask's are too far apart to be brought together; trace again or start nearer"
    )]
    TooFar,
}

/// Working memory of [`refine`].
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
    /// `camera_from_model`.
    pub pose: Pose,
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

/// How far the outline of the mask is looked for and how the loss flattens, pixels: from coarse
/// to fine.
const STAGES: [Stage; 3] = [
    Stage {
        range: 48.0,
        flat_beyond: 8.0,
        steps: 10,
    },
    Stage {
        range: 16.0,
        flat_beyond: 2.5,
        steps: 8,
    },
    Stage {
        range: 10.0,
        flat_beyond: 1.0,
        steps: 14,
    },
];

#[derive(Clone, Copy)]
struct Stage {
    /// Largest distance between the outlines, pixels.
    range: f64,
    /// Scale of the Cauchy loss, pixels.
    flat_beyond: f64,
    /// Steps tried at most.
    steps: usize,
}

/// What is the same for every step.
struct Problem<'a> {
    mesh: &'a Mesh<'a>,
    camera: &'a Camera,
    mask: &'a Mask<'a>,
    /// Middle of the model: turns about it hardly move the image.
    middle: Vector3,
}

/// Refines `start` until the model's outline lies on that of `mask`.
///
/// Takes at most 33 drawings of the model. Never worse than `start` by the loss of its last
/// stage.
///
/// # Errors
/// [`RefineError`].
pub fn refine(
    mesh: &Mesh<'_>,
    camera: &Camera,
    mask: &Mask<'_>,
    start: &Pose,
    memory: &mut RefineMemory<'_>,
) -> Result<Refined, RefineError> {
    let problem = Problem {
        mesh,
        camera,
        mask,
        middle: mesh.bounds().centre,
    };
    problem.check(memory)?;
    let mut state = Refined {
        pose: *start,
        residual_px: 0.0,
        loss: 0.0,
        renders: 0,
        converged: false,
    };
    for stage in &STAGES {
        problem.run(stage, &mut state, memory)?;
    }
    Ok(state)
}

impl Problem<'_> {
    fn check(&self, memory: &RefineMemory<'_>) -> Result<(), RefineError> {
        let pixels = self.mask.width() * self.mask.height();
        let needed = [
            ("places", pixels, memory.places.len()),
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
        if self.mask.area() == 0 {
            return Err(MaskError::Empty.into());
        }
        if (self.mask.width(), self.mask.height()) != (self.camera.width(), self.camera.height()) {
            return Err(RenderError::Size.into());
        }
        Ok(())
    }

    /// Levenberg's and Marquardt's damping: a step that does not lower the loss is taken back
    /// and tried again more cautiously.
    fn run(
        &self,
        stage: &Stage,
        state: &mut Refined,
        memory: &mut RefineMemory<'_>,
    ) -> Result<(), RefineError> {
        let mut equations = self.observe(&state.pose, stage, memory)?;
        state.renders += 1;
        let mut damping = 1e-3;
        state.converged = false;
        for _ in 0..stage.steps {
            let Some(step) = equations.step(damping) else {
                return Err(RefineError::TooFar);
            };
            let pose = step.apply(&state.pose, &self.middle);
            let tried = self.observe(&pose, stage, memory);
            state.renders += 1;
            match tried {
                Ok(next) if next.loss() < equations.loss() => {
                    state.pose = pose;
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
        Ok(())
    }

    /// Draws the model and measures how far its outline is from the mask's.
    fn observe(
        &self,
        pose: &Pose,
        stage: &Stage,
        memory: &mut RefineMemory<'_>,
    ) -> Result<Equations, RefineError> {
        let (width, height) = (self.mask.width(), self.mask.height());
        let mut drawn = MaskMut::new(memory.drawn, width, height)?;
        render(self.mesh, self.camera, pose, memory.projected, &mut drawn)?;
        let drawn = drawn.into_mask();
        let outliner = Outliner {
            mesh: self.mesh,
            pose,
            drawn: &drawn,
        };
        let border = outliner.border(memory.projected, memory.places, memory.border);
        let centre = pose.transform(&self.middle);
        let mut equations = Equations::new(stage.flat_beyond, stage.range);
        for sample in border {
            let Some(own) = probe::crossing(&drawn, sample, 3.0) else {
                continue;
            };
            let residual =
                probe::crossing(self.mask, sample, stage.range).map(|theirs| theirs - own);
            let jacobian = Step::jacobian(self.camera, &centre, sample);
            equations.add(&jacobian, residual, f64::from(sample.weight));
        }
        Ok(equations)
    }
}
