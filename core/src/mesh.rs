//! A component's surface: triangles, the edges between them, and its planes of symmetry.

pub mod anatomy;
#[cfg(feature = "alloc")]
mod bodies;
#[cfg(feature = "alloc")]
mod coarse;
pub mod edges;
pub mod mirror;
mod model;
#[cfg(feature = "alloc")]
mod owned;
#[cfg(feature = "alloc")]
mod remarks;
mod revolution;
mod surface;
pub mod symmetry;
mod unit;

#[cfg(feature = "alloc")]
pub use coarse::{clustered, coarser};
pub use model::{Model, OtherEdges};
#[cfg(feature = "alloc")]
pub use owned::OwnedModel;
pub use revolution::Revolution;
pub use surface::*;
pub use unit::{SuspectedUnit, has_knee_size, suspected_unit};
