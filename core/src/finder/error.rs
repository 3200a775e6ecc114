//! Why nothing was found.

use thiserror::Error;

use crate::image::mask::MaskError;
use crate::locate::LocateError;
use crate::locate::partial::PartialError;
use crate::refine::RefineError;
use crate::render::RenderError;

/// Why nothing was found.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum FindError {
    /// The silhouette has no canonical form, or working memory of the library is too short.
    #[error(transparent)]
    Locate(#[from] LocateError),
    /// No pose came from the known pieces of the outline.
    #[error(transparent)]
    Partial(#[from] PartialError),
    /// The model cannot be drawn.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// Working memory is no mask of the frame's size.
    #[error(transparent)]
    Mask(#[from] MaskError),
    /// No first pose could be refined.
    #[error(transparent)]
    Refine(#[from] RefineError),
    /// The library was made from another model.
    #[error("the library was made from another model: build it again")]
    OtherModel,
    /// No view of the library explains the silhouette.
    #[error("no view of the library explains the silhouette")]
    NoView,
}
