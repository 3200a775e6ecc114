//! The edges of a surface as plain numbers, a sixth of what [`super::link()`] leaves: to be kept in a file and read in place.
//!
//! What is left out, the planes of the triangles beside each edge, is found again from their vertices where a box does not
//! tell that none of its edges is on the contour.

use super::boxes::{EdgeBox, IN_BOX};
use super::edge::{MeshEdge, RimEdge};

/// A box as numbers: middle and reach of its triangles' duals, greatest reciprocals of a height and of a doubled area.
pub type PackedBox = [f32; 10];
/// An edge as vertices: from, to, and the third ones of the triangles that run it forth and back.
pub type PackedEdge = [u16; 4];
/// A rim as vertices: from, to, and the third one of its triangle.
pub type PackedRim = [u16; 3];

/// Edges as plain numbers.
#[derive(Clone, Copy, Debug, Default)]
pub struct PackedEdges<'e> {
    boxes: &'e [PackedBox],
    edges: &'e [PackedEdge],
    rims: &'e [PackedRim],
}

impl<'e> PackedEdges<'e> {
    /// What [`super::pack_edges`] wrote; `None` where boxes and edges do not belong together.
    #[must_use]
    pub fn new(
        boxes: &'e [PackedBox],
        edges: &'e [PackedEdge],
        rims: &'e [PackedRim],
    ) -> Option<Self> {
        (boxes.len() == edges.len().div_ceil(IN_BOX)).then_some(Self { boxes, edges, rims })
    }

    /// The numbers themselves.
    #[must_use]
    pub fn parts(&self) -> (&'e [PackedBox], &'e [PackedEdge], &'e [PackedRim]) {
        (self.boxes, self.edges, self.rims)
    }

    /// Whether all are edges of a surface of so many vertices.
    #[must_use]
    pub fn fit(&self, vertices: usize) -> bool {
        let known = |&vertex: &u16| usize::from(vertex) < vertices;
        self.edges.iter().flatten().all(known) && self.rims.iter().flatten().all(known)
    }

    /// Boxes and the edges in each.
    pub(crate) fn groups(&self) -> impl Iterator<Item = (EdgeBox, &'e [PackedEdge])> + use<'e> {
        let boxes = self.boxes.iter().map(EdgeBox::of_numbers);
        boxes.zip(self.edges.chunks(IN_BOX))
    }

    /// All edges.
    pub(crate) fn edges(&self) -> impl Iterator<Item = MeshEdge> + use<'e> {
        self.edges.iter().map(unpacked)
    }

    /// Edges of one triangle alone.
    pub(crate) fn rims(&self) -> impl Iterator<Item = RimEdge> + use<'e> {
        self.rims.iter().map(|&rim| {
            let [from, to, third] = rim.map(u32::from);
            RimEdge { from, to, third }
        })
    }
}

/// An edge as it was before it was packed, but for what its triangles need of a margin.
pub(crate) fn unpacked(edge: &PackedEdge) -> MeshEdge {
    let [from, to, forth, back] = edge.map(u32::from);
    MeshEdge {
        from,
        to,
        forth,
        back,
        order: 0,
    }
}
