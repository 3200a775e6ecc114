//! Gets what the page and the tests need and a newcomer's machine may lack.
//!
//! Each part first looks whether the thing is there, then tries to get it, and else says in one line what
//! could not be had and how to get it ([`Missing`]).

pub(crate) mod command;
pub(crate) mod components;
pub(crate) mod debian;
pub(crate) mod node;
pub(crate) mod programs;
pub(crate) mod rust_target;

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

/// Says on standard error what is being done now: every slow step has such a line.
pub(crate) fn announce(what: &str) {
    eprintln!("==> {what}");
}
