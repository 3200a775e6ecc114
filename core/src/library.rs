//! The library: canonical silhouettes of one component over a grid of out-of-plane rotations.
//!
//! [`Library::open`] reads a library in place from bytes (flash, file, fetched buffer) after checking all of it once.
//! [`Builder`] draws the views, packs them, and writes an [`Assembly`] of them into borrowed bytes. `library/wire.rs`
//! describes the two layouts of the file.

mod assemble;
mod build;
mod compact;
mod error;
#[cfg(test)]
pub(crate) mod fake;
mod info;
mod open;
mod pack;
pub(crate) mod runs;
pub(crate) mod sketch;
mod wire;

pub use assemble::Assembly;
pub use build::{Builder, ViewScratch};
pub(crate) use compact::Sketches;
pub use error::{BuildError, LibraryError};
pub use info::{LibraryInfo, ViewAxis, ViewGrid, ViewRecord};
pub use open::Library;
pub(crate) use wire::digest_in;
pub use wire::{HEADER_BYTES, RECORD_BYTES, VERSION};
