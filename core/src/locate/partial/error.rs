//! Why no pose was found from a part of an outline.

use thiserror::Error;

use crate::image::mask::MaskError;
use crate::math::Decimal;
use crate::memory::TooLittleMemory;
use crate::render::RenderError;

/// Why no pose was found from a part of an outline.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum PartialError {
    /// No side of the mask has two known pixels, in pieces long enough to use.
    #[error(
        "nothing of the outline is known: all of it lies in unknown pixels, beyond the frame's border, or in pieces shorter than {least} pixel sides"
    )]
    NothingKnown {
        /// Sides of the shortest piece that is used.
        least: usize,
    },
    /// Too little is known.
    #[error(
        "{} pixels of the outline are known, but a first pose needs {}; trace more of it", Decimal::new(*known, 0), Decimal::new(*needed, 0)
    )]
    TooShort {
        /// Length known, pixel widths.
        known: f64,
        /// Length needed, pixel widths.
        needed: f64,
    },
    /// The outline is no implant's.
    #[error(
        "the mask's outline has more than {0} pixel sides; drop the specks and fill the holes of the mask"
    )]
    TooRough(usize),
    /// No view of the library is like the known part.
    #[error(
        "no view of the library fits the known part of the outline; is it the right model, side and nominal view?"
    )]
    NoFit,
    /// This program was built without them.
    #[error(
        "a part of the outline is unknown or cut off, and this program was built without the feature `pieces`, which makes poses of the rest"
    )]
    LeftOut,
    /// Working memory is too short.
    #[error(transparent)]
    Memory(#[from] TooLittleMemory),
    /// A mask is not possible.
    #[error(transparent)]
    Mask(#[from] MaskError),
    /// The model cannot be drawn, or mask and camera differ in size.
    #[error(transparent)]
    Render(#[from] RenderError),
}
