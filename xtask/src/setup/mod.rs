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
use std::sync::{Mutex, MutexGuard, PoisonError};

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

/// Says what is being done now: every slow step has such a line.
pub(crate) fn announce(what: &str) {
    command::say(&format!("==> {what}"));
}

/// What only one step at a time may do where several run side by side.
struct Alone(Mutex<()>);

impl Alone {
    const fn new() -> Self {
        Self(Mutex::new(()))
    }

    /// Waits for its turn, which lasts as long as what is returned.
    fn turn(&self) -> MutexGuard<'_, ()> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Changing the Rust toolchain.
static RUSTUP: Alone = Alone::new();
/// Installing packages of the system.
static APT: Alone = Alone::new();
/// Installing packages of npm.
static NPM: Alone = Alone::new();
