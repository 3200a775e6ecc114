//! First poses of a silhouette from a library: of whole outlines, interpolated between views, and of partial outlines.

mod arena;
mod bands;
pub mod estimate;
pub mod interpolate;
pub mod partial;
pub mod rerank;
mod whole;

pub use arena::LocateNeeds;
pub use whole::*;
