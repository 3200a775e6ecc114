//! The edges between the triangles of a closed surface, from which its silhouette can be drawn.

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
