//! Which way the program goes: to a library's pose, with the feature `finder` to a chosen and judged one, with `refine` from one pose
//! to the next.

#[cfg(not(feature = "outlines"))]
use crate::failure::Failure;
#[cfg(feature = "finder")]
pub(crate) use crate::finding as way;
#[cfg(not(feature = "outlines"))]
use crate::inputs::POINTS;
#[cfg(not(any(feature = "finder", feature = "refine")))]
pub(crate) use crate::matching as way;
#[cfg(all(feature = "refine", not(feature = "finder")))]
pub(crate) use crate::refining as way;

pub use way::Memory;

/// What the implant's bytes in flash are, and how many.
#[cfg(not(any(feature = "finder", feature = "refine")))]
const BLOB: (&str, usize) = ("library", crate::inputs::LIBRARY.len());
#[cfg(any(feature = "finder", feature = "refine"))]
const BLOB: (&str, usize) = ("implant", crate::implanted::IMPLANT.0.len());

/// Bytes of the outline there; random ones are made.
#[cfg(not(feature = "outlines"))]
const OUTLINE: usize = size_of_val(&POINTS);
#[cfg(feature = "outlines")]
const OUTLINE: usize = 0;

/// Bytes in flash that are no code: what is known of the implant, and the outline.
pub const DATA: [(&str, usize); 2] = [BLOB, ("outline", OUTLINE)];

/// Runs it.
///
/// # Errors
/// A [`Failure`].
#[cfg(not(feature = "outlines"))]
pub fn run(
    memory: &mut Memory,
    out: &mut dyn crate::writing::Write,
    stage: &mut dyn FnMut(&str),
) -> Result<(), Failure> {
    let known = way::opened(stage)?;
    way::pose_of(&known, &POINTS, memory, out, stage)
}

#[cfg(feature = "outlines")]
pub use crate::outlines::prove as run;
