//! Why a pose cannot be refined.

use thiserror::Error;

use crate::image::mask::MaskError;
use crate::memory::TooLittleMemory;
use crate::render::RenderError;

/// Why a pose cannot be refined.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum RefineError {
    /// At this pose the model reaches beyond the part of the frame that is looked at.
    #[error(
        "the model reaches beyond the part of the frame that was cropped around the silhouette: it lies elsewhere, or the margin is too small"
    )]
    BeyondCrop,
    /// The model cannot be drawn at the pose to start from.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// The mask is empty, or its words are not those of a mask.
    #[error(transparent)]
    Mask(#[from] MaskError),
    /// There is nothing to refine against.
    #[error("refinement needs at least one view")]
    NoView,
    /// Working memory is too short.
    #[error(transparent)]
    Memory(#[from] TooLittleMemory),
    /// Too little of the model's outline is near the target's to say where the model is.
    #[error(
        "the model's outline and the target's are too far apart, or too little of it is known, to be brought together; trace again or start nearer"
    )]
    TooFar,
}

impl RefineError {
    /// What came of one of several poses: nothing where it cannot be refined, since others may be.
    ///
    /// # Errors
    /// Where memory is too short. Poses that need more of it than others would be missing among these, and a worse one would stand for them.
    pub fn passed_over<T>(tried: Result<T, Self>) -> Result<Option<T>, Self> {
        match tried {
            Ok(refined) => Ok(Some(refined)),
            Err(short @ Self::Memory(_)) => Err(short),
            Err(_) => Ok(None),
        }
    }
}
