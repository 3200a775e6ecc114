//! A component's surface: triangles, the edges between them, and its planes of symmetry.

pub mod edges;
pub mod mirror;
mod surface;
pub mod symmetry;

pub use surface::*;
