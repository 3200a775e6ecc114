//! Something that could not be had.

use std::fmt;

/// Something needed that is not on this machine and could not be got.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Missing {
    /// The thing, as in "no Chromium".
    pub what: String,
    /// Why it could not be got.
    pub why: String,
    /// What a person can do about it.
    pub remedy: String,
    /// Whether getting it was tried and failed (a source that does not offer it, no network). Otherwise this
    /// machine gave no way to try, which its owner can change.
    pub tried: bool,
}

impl fmt::Display for Missing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "no {}: {}; {}", self.what, self.why, self.remedy)
    }
}

impl std::error::Error for Missing {}
