//! Why a catalogue cannot be made.

use thiserror::Error;

use crate::memory::TooLittleMemory;

/// Why libraries are no catalogue.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum CatalogueError {
    /// There is none.
    #[error("a catalogue needs at least one library")]
    Empty,
    /// A library has no sketches.
    #[error("library {0} of the catalogue is of the plain kind; build it again")]
    Plain(usize),
    /// Libraries differ in their canonical frames.
    #[error(
        "library {0} of the catalogue has another canonical frame than the first; build it again with the first one's size and area"
    )]
    Canonical(usize),
    /// Working memory is too short.
    #[error(transparent)]
    Memory(#[from] TooLittleMemory),
}
