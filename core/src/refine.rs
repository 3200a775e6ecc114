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

mod depth;
mod edge;
mod effort;
mod locks;
mod outline;
mod probe;
mod problem;
mod samples;
mod solve;
mod stages;
mod uncertainty;
mod view;

pub use effort::Effort;
pub use locks::Locks;
pub use outline::BorderPixel;
pub use samples::{OutlineSample, outline_samples};
pub use uncertainty::uncertainty;
pub use view::{ImageTarget, Polarity, Target, View};

use thiserror::Error;

use crate::camera::Camera;
use crate::image::mask::{MaskError, Word, words_needed};
use crate::mesh::Mesh;
use crate::pose::Pose;
use crate::render::{Projected, RenderError};
use problem::{Pass, Problem};
use stages::STAGES;

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
    /// [`crate::render::scratch_needed`] vertices.
    pub projected: &'a mut [Projected],
    /// [`crate::image::mask::words_needed`] words of the frame's size: the model as drawn.
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
    /// Standard deviation of the residuals as if they were normal, from their median: what lies
    /// far out does not count. Pixels.
    pub spread_px: f64,
    /// Robust loss by which rival poses are compared, square pixels.
    pub loss: f64,
    /// Times the model was drawn.
    pub renders: usize,
    /// Whether the last step was below 0.001 degrees or 0.005 mm, or both together; on a grey frame,
    /// a fiftieth of that; where it was to be swift, twenty times as much.
    pub converged: bool,
}

/// How a pose is refined.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RefineOptions {
    /// Estimates with the pose how far the target's edges lie beyond the model's outline, where
    /// the data can tell that from depth; see [`Refined::offset_px`].
    pub edge_offset: bool,
    /// Numbers of the pose that stay as they are at the start.
    pub locks: Locks,
    /// How exactly.
    pub effort: Effort,
}

/// A pose on the way, for who wants to see how refinement converges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iterate {
    /// Stage, from 0; the range and the scale of the loss shrink from one to the next.
    pub stage: usize,
    /// Times the model was drawn so far.
    pub renders: usize,
    /// The pose.
    pub pose: Pose,
    /// Its robust loss in this stage, square pixels: stages differ in scale.
    pub loss: f64,
    /// Its residual, pixels.
    pub residual_px: f64,
}

/// Refines `start` until the model's outline lies on those of `views`.
///
/// Draws the model at most 130 times in each view, usually 8 to 20 times. Never worse than
/// `start` by the loss of its last stage but for what drawing in whole pixels leaves unknown.
///
/// # Errors
/// [`RefineError`].
pub fn refine(
    mesh: &Mesh<'_>,
    views: &[View<'_>],
    start: &Pose,
    options: RefineOptions,
    memory: &mut RefineMemory<'_>,
) -> Result<Refined, RefineError> {
    refine_traced(mesh, views, start, options, memory, &mut |_| ())
}

/// The same, telling the start and every pose that is accepted on the way.
///
/// # Errors
/// [`RefineError`].
pub fn refine_traced(
    mesh: &Mesh<'_>,
    views: &[View<'_>],
    start: &Pose,
    options: RefineOptions,
    memory: &mut RefineMemory<'_>,
    trace: &mut dyn FnMut(&Iterate),
) -> Result<Refined, RefineError> {
    let mut problem = Problem::new(mesh, views, memory)?;
    problem.hold(options.locks, start);
    problem.effort = options.effort;
    let mut state = Refined {
        pose: *start,
        offset_px: 0.0,
        residual_px: 0.0,
        spread_px: 0.0,
        loss: 0.0,
        renders: 0,
        converged: false,
    };
    let mut pass = Pass::default();
    let mut seen = problem.run(&pass, &mut state, None, memory, trace)?;
    for index in 1..STAGES {
        pass = Pass {
            index,
            spread: state.spread_px,
            free: false,
        };
        seen = problem.run(&pass, &mut state, Some(seen), memory, trace)?;
    }
    problem.polish(&pass, &mut state, seen, memory, trace)?;
    if options.edge_offset {
        pass.free = true;
        let mut with_offset = state;
        let seen = problem.run(&pass, &mut with_offset, None, memory, trace)?;
        problem.polish(&pass, &mut with_offset, seen, memory, trace)?;
        if problem.supports_offset(&pass, &with_offset, memory)? {
            return Ok(with_offset);
        }
        state.renders = with_offset.renders;
    }
    Ok(state)
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
