//! A program that failed, and by what.

use std::fmt;

/// A program failed. The lines of its output that tell by what are told once more at the end: of a long log often nothing else is kept.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Failed {
    /// A sentence.
    pub what: String,
    /// Names of tests, and what they say.
    pub lines: Vec<String>,
}

impl fmt::Display for Failed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.what)
    }
}

impl std::error::Error for Failed {}
