//! The ranges of the protocol of Walker et al. 1996.

/// Rotation errors above this are failures, degrees.
pub(super) const FAILURE_DEG: f64 = 4.0;
/// Half range of x and y, mm.
pub(super) const LATERAL_MM: f64 = 40.0;
/// Half range of z about the library's distance, mm.
pub(super) const DEPTH_MM: f64 = 50.0;
