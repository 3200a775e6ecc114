//! Problems of TIFF files.

use crate::error::Problem;

/// The format, as people call it.
pub(super) const FORMAT: &str = "TIFF";
/// What a person can do about a page of a rare kind.
pub(super) const REMEDY: &str = "Save it as 8- or 16-bit grey";

/// Broken content of a page, counted from 0.
pub(super) fn damaged(page: usize, error: impl std::fmt::Display) -> Problem {
    Problem::damaged(FORMAT, format!("page {}: {error}", page + 1))
}

/// What the library says of a page, counted from 0.
pub(super) fn failed(page: usize, error: tiff::TiffError) -> Problem {
    match error {
        tiff::TiffError::UnsupportedError(what) => {
            let what = format!("a rare variant on page {} ({what})", page + 1);
            Problem::unsupported(FORMAT, what, REMEDY)
        }
        other => damaged(page, other),
    }
}
