//! Errors as Python's.

use std::io::ErrorKind;

use pyo3::PyErr;
use pyo3::exceptions::{PyFileNotFoundError, PyOSError, PyValueError};

/// A sentence as the exception that a Python program would expect.
pub(crate) fn python_error(error: impl Into<anyhow::Error>) -> PyErr {
    let error = error.into();
    let words = format!("{error:#}");
    let kind = error
        .chain()
        .find_map(|cause| Some(cause.downcast_ref::<std::io::Error>()?.kind()));
    match kind {
        Some(ErrorKind::NotFound) => PyFileNotFoundError::new_err(words),
        Some(_) => PyOSError::new_err(words),
        None => PyValueError::new_err(words),
    }
}
