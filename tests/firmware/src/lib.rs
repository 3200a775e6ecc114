//! A pose from an outline in static memory: what boards and the host both run.
//!
//! The board and the host call [`run`] with the same bytes; each line it writes must be the same on both.
#![no_std]
#![cfg(not(nothing_to_run))]
#![forbid(unsafe_code)]

mod failure;
#[cfg(feature = "finder")]
mod finding;
#[cfg(any(feature = "finder", feature = "refine"))]
mod implanted;
mod inputs;
#[cfg(not(any(feature = "finder", feature = "refine")))]
mod matching;
#[cfg(feature = "outlines")]
mod outlines;
mod program;
#[cfg(all(feature = "refine", not(feature = "finder")))]
mod refining;
pub mod writing;

pub use failure::Failure;
pub use program::{DATA, Memory, run};
