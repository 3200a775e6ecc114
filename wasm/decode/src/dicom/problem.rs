//! Problems of DICOM files.

use crate::error::Problem;

/// The format, as people call it.
pub(crate) const FORMAT: &str = "DICOM";

/// Broken content, with what is wrong and where.
pub(super) fn damaged(detail: impl Into<String>) -> Problem {
    Problem::damaged(FORMAT, detail)
}
