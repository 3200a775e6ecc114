//! How a pose is refined.

use super::effort::Effort;
use super::locks::Locks;

/// How a pose is refined.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RefineOptions {
    /// Estimates with the pose how far the target's edges lie beyond the model's outline, where
    /// the data separate that from depth; see [`super::Refined::offset_px`].
    pub edge_offset: bool,
    /// Numbers of the pose that keep their values of the start.
    pub locks: Locks,
    /// How exactly the pose is refined.
    pub effort: Effort,
}
