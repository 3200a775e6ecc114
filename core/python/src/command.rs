//! The command line.

use std::ffi::OsString;

use fluoropose_laboratory::cli;
use pyo3::prelude::*;

/// Runs a command line, the program's name first; the code to exit with.
#[pyfunction]
pub(crate) fn command(py: Python<'_>, words: Vec<OsString>) -> u8 {
    py.detach(|| cli::run(words))
}
