//! The same program twice: for the board ([`board`]) and for the host ([`host`]).
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod board;
#[cfg(not(any(target_os = "none", nothing_to_run)))]
mod host;

#[cfg(not(any(target_os = "none", nothing_to_run)))]
fn main() -> std::process::ExitCode {
    host::main()
}

/// What it is to run is not made yet (`build.rs`).
#[cfg(nothing_to_run)]
fn main() {}
