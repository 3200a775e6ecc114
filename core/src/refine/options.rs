//! How a pose is refined.

use super::effort::Effort;
use super::locks::Locks;

/// How a pose is refined.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RefineOptions {
    /// Estimates with the pose how far the target's edges lie beyond the model's outline, where
    /// the data can tell that from depth; see [`super::Refined::offset_px`].
    pub edge_offset: bool,
    /// Numbers of the pose that stay as they are at the start.
    pub locks: Locks,
    /// How exactly.
    pub effort: Effort,
}
