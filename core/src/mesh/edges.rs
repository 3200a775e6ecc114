//! Which triangles share an edge: what a closed surface's silhouette can be drawn from.

mod boxes;
mod edge;
#[cfg(test)]
pub(crate) mod fake;
mod link;
mod list;

pub use boxes::{EdgeBox, EdgeGroup};
pub(crate) use boxes::{IN_BOX, place};
pub use edge::MeshEdge;
pub use link::{edges_needed, groups_needed, link};
pub use list::Edges;
