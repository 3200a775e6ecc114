//! The loops of matching, compiled for the machine at hand and chosen when the program runs.
//!
//! The loops themselves are those of [`fluoropose::search::kernels`]: safe and portable, written so that
//! the compiler makes wide instructions of them. Here they are compiled once more for each kind of
//! machine. All that is unsafe stands in `compiled.rs`: calling what was compiled for a machine that was found to be
//! this one; and in `usada8.rs`: an instruction that the compiler does not make.
#![cfg_attr(target_os = "none", no_std)]

mod compiled;
#[cfg(any(usada8, test))]
mod usada8;

use fluoropose::search::kernels::Kernels;

pub use compiled::available;

/// The fastest kernels for this machine.
#[must_use]
pub fn fastest() -> Kernels {
    #[cfg(usada8)]
    return usada8::KERNELS;
    // The slowest come first.
    #[cfg(not(usada8))]
    available().last().unwrap_or_default()
}

#[cfg(test)]
mod tests;
