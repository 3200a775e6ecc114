//! A pose from an outline in static memory: what boards and the host both run.
//!
//! The board and the host call [`prove`] with the same bytes; each line it writes must be the same on both.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(feature = "finder")]
mod finding;
mod inputs;
mod memory;
mod program;
mod proof;

#[cfg(feature = "finder")]
pub use finding::{FindingFailure, FindingMemory, find_pose};
pub use inputs::{LIBRARY, OUTLINE};
pub use memory::{FRAME_SIDE, MAX_POINTS, MAX_VIEWS};
pub use program::{DATA, Memory, run};
pub use proof::{Failure, prove};
