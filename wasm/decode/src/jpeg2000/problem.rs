//! Problems of JPEG 2000 images.

use crate::error::Problem;

/// The format, as people call it.
pub(super) const FORMAT: &str = "JPEG 2000";
/// What a person can do about an image of a rare kind.
pub(super) const REMEDY: &str = "Export it as PNG, TIFF or uncompressed DICOM";

/// Broken content, with what is wrong and where.
pub(super) fn damaged(detail: impl Into<String>) -> Problem {
    Problem::damaged(FORMAT, detail)
}
