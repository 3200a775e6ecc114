//! Why bytes are no library, and why none can be built.

use thiserror::Error;

use super::wire::{PLAIN_VERSION, VERSION};
use crate::camera::CameraError;
use crate::canonical::CanonicalError;
use crate::image::mask::MaskError;
use crate::memory::TooLittleMemory;
use crate::render::RenderError;

/// Why bytes are not a library.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum LibraryError {
    /// The first bytes are not those of a library.
    #[error("this is not a library file: it does not begin with FLUOROPL")]
    Magic,
    /// The layout is unknown.
    #[error(
        "the library has version {0}; this program reads versions {PLAIN_VERSION} and {VERSION}. Build it again"
    )]
    Version(u16),
    /// The file is shorter or longer than its header says.
    #[error("the library has {given} bytes but should have {needed}: the file is cut or padded")]
    Length {
        /// Bytes by the header.
        needed: u64,
        /// Bytes that were given.
        given: u64,
    },
    /// A checksum is wrong.
    #[error("the library's {0} is damaged: its checksum does not fit. Build or fetch it again")]
    Checksum(&'static str),
    /// A number in it is impossible although the checksum fits.
    #[error("the library's {0} is not possible; the file was written wrongly. Build it again")]
    Value(&'static str),
    /// The canonical frame is impossible.
    #[error(transparent)]
    Canonical(#[from] CanonicalError),
    /// The camera is impossible.
    #[error(transparent)]
    Camera(#[from] CameraError),
}

/// Why a library cannot be built.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum BuildError {
    /// A parameter is impossible.
    #[error("{0}")]
    Parameter(LibraryError),
    /// The model would touch the focus.
    #[error(
        "the distance of {distance} mm is shorter than the model's radius of {radius:.1} mm; are the model's lengths in mm?"
    )]
    TooNear {
        /// Distance asked for, mm.
        distance: f64,
        /// Of the model, mm.
        radius: f64,
    },
    /// Working memory is too short.
    #[error(transparent)]
    Memory(#[from] TooLittleMemory),
    /// Fewer or more packed views than the grid has.
    #[error("the grid has {needed} views but {given} were packed")]
    Views {
        /// Views of the grid.
        needed: usize,
        /// Packed views.
        given: usize,
    },
    /// The bytes given for a packed view are not one.
    #[error("view {0} was not packed, or not whole: pack it again")]
    Packed(usize),
    /// A view has no canonical form.
    #[error(transparent)]
    Canonical(#[from] CanonicalError),
    /// A mask could not be made.
    #[error(transparent)]
    Mask(#[from] MaskError),
    /// A view could not be drawn.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// The views' camera is impossible.
    #[error(transparent)]
    Camera(#[from] CameraError),
}
