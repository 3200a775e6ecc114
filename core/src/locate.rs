//! First poses of a silhouette from a library: whole outlines, views between views, partial outlines.

mod bands;
pub mod estimate;
pub mod interpolate;
pub mod partial;
pub mod rerank;
mod whole;

pub use whole::*;
