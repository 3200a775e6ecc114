//! Which of two ways the program goes: to a library's pose, or, with the feature `finder`, to a chosen and judged one.

use core::fmt::Write;

#[cfg(not(feature = "finder"))]
mod way {
    use super::Write;
    use crate::OUTLINE;
    pub use crate::memory::Memory;
    use crate::proof::Failure;

    /// Bytes in flash that are no code: the library and the outline.
    pub const DATA: [(&str, usize); 2] = [
        ("library", crate::LIBRARY.len()),
        ("outline", OUTLINE.len()),
    ];

    /// Runs it.
    ///
    /// # Errors
    /// A [`Failure`], in words through `Display`.
    pub fn run(
        memory: &mut Memory,
        out: &mut dyn Write,
        stage: &mut dyn FnMut(&str),
    ) -> Result<(), Failure> {
        crate::prove(crate::LIBRARY, OUTLINE, memory, out, stage)
    }
}

#[cfg(feature = "finder")]
mod way {
    use super::Write;
    pub use crate::finding::FindingMemory as Memory;
    use crate::finding::{FindingFailure, IMPLANT, find_pose};
    use crate::inputs::POINTS;

    /// Bytes in flash that are no code: the implant and the outline.
    pub const DATA: [(&str, usize); 2] = [
        ("implant", IMPLANT.0.len()),
        ("outline", size_of_val(&POINTS)),
    ];

    /// Runs it.
    ///
    /// # Errors
    /// A [`FindingFailure`], in words through `Display`.
    pub fn run(
        memory: &mut Memory,
        out: &mut dyn Write,
        stage: &mut dyn FnMut(&str),
    ) -> Result<(), FindingFailure> {
        find_pose(&POINTS, memory, out, stage)
    }
}

pub use way::{DATA, Memory, run};
