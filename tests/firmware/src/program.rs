//! Which way the program goes: to a library's pose, with the feature `finder` to a chosen and judged one, with `refine` from one pose
//! to the next.

use core::fmt::Write;

use crate::failure::Failure;
#[cfg(feature = "finder")]
use crate::finding as way;
use crate::inputs::POINTS;
#[cfg(not(any(feature = "finder", feature = "refine")))]
use crate::matching as way;
#[cfg(all(feature = "refine", not(feature = "finder")))]
use crate::refining as way;

pub use way::Memory;

/// What the implant's bytes in flash are, and how many.
#[cfg(not(any(feature = "finder", feature = "refine")))]
const BLOB: (&str, usize) = ("library", crate::inputs::LIBRARY.len());
#[cfg(any(feature = "finder", feature = "refine"))]
const BLOB: (&str, usize) = ("implant", crate::implanted::IMPLANT.0.len());

/// Bytes in flash that are no code: what is known of the implant, and the outline.
pub const DATA: [(&str, usize); 2] = [BLOB, ("outline", size_of_val(&POINTS))];

/// Runs it.
///
/// # Errors
/// A [`Failure`].
pub fn run(
    memory: &mut Memory,
    out: &mut dyn Write,
    stage: &mut dyn FnMut(&str),
) -> Result<(), Failure> {
    way::prove(&POINTS, memory, out, stage)
}
