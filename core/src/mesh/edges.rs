//! Which triangles share an edge: what a surface's silhouette can be drawn from.

mod boxes;
mod edge;
#[cfg(test)]
pub(crate) mod fake;
mod link;
mod list;
mod measured;
mod orient;
mod pack;
mod packed;
mod tight;
#[cfg(any(feature = "alloc", test))]
mod tighten;

pub(crate) use boxes::IN_BOX;
pub use boxes::{EdgeBox, EdgeGroup};
pub use edge::{MeshEdge, PackedEdge, RimEdge};
#[cfg(feature = "alloc")]
pub(super) use link::turn;
pub use link::{LinkMemory, LinkNeeds, SurfaceFaults, link, link_needed};
pub use list::Edges;
pub(crate) use measured::{Facing, ROUNDINGS};
pub use pack::{PackMemory, PackedNeeds, pack_edges, packed_needed};
pub(crate) use packed::unpacked;
pub use packed::{PackedBox, PackedEdges, PackedRim};
#[cfg(any(feature = "alloc", test))]
pub use tighten::tightened;
