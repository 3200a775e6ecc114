//! Who installs something while others want to.

use std::sync::{Mutex, MutexGuard, PoisonError};

/// What only one step at a time may do where several run side by side.
pub(super) struct Alone(Mutex<()>);

impl Alone {
    const fn new() -> Self {
        Self(Mutex::new(()))
    }

    /// Waits for its turn, which lasts as long as what is returned.
    pub(super) fn turn(&self) -> MutexGuard<'_, ()> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Changing the Rust toolchain.
pub(super) static RUSTUP: Alone = Alone::new();
/// Installing packages of the system.
pub(super) static APT: Alone = Alone::new();
/// Installing packages of npm.
pub(super) static NPM: Alone = Alone::new();
