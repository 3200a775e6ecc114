#![doc = include_str!("../EMBEDDING.md")]
//!
//! # Module
//!
//! One file for all that is known of an implant, read in place: its surface, the edges that it is drawn from, its planes of
//! symmetry, its library, and how much memory they take.
//!
//! A microcontroller keeps it in flash and needs no memory to open it. [`ImplantFile::open`] checks all of it,
//! [`ImplantCheck`] does so in slices of time, [`ImplantFile::intact`] asks its checksums alone, and [`ImplantFile::trusted`] reads the header alone, where something else, as
//! a boot loader, has checked the bytes.

mod arena;
mod check;
mod error;
mod header;
mod needs;
mod open;
mod wire;
#[cfg(feature = "alloc")]
mod write;

pub use arena::ArenaNeeds;
pub use check::ImplantCheck;
pub use error::ImplantError;
pub use needs::{ContourNeeds, contour_needed};
pub use open::{Aligned, ImplantFile};
pub use wire::{HEADER_BYTES, VERSION};
#[cfg(feature = "alloc")]
pub use write::write_implant;
