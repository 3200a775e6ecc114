//! Problems of TIFF files.

use crate::error::Problem;

/// The format, as people call it.
pub(super) const FORMAT: &str = "TIFF";

/// Broken content of a page, counted from 0.
pub(super) fn damaged(page: usize, error: impl std::fmt::Display) -> Problem {
    Problem::damaged(FORMAT, format!("page {}: {error}", page + 1))
}
