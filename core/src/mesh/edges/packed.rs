//! The edges of a surface as plain numbers, a sixth of what [`super::link()`] leaves: to be kept in a file and read in place.
//!
//! What is left out, the planes of the triangles beside each edge, is found again from their vertices where a box does not
//! tell that none of its edges is on the contour.

use super::boxes::{EdgeBox, IN_BOX};
use super::edge::{MeshEdge, RimEdge};
use super::list::Edges;
use crate::memory::{TooLittleMemory, first};

/// A box as numbers: middle and reach of its triangles' duals, greatest reciprocals of a height and of a doubled area.
pub type PackedBox = [f32; 10];
/// An edge as vertices: from, to, and the third ones of the triangles that run it forth and back.
pub type PackedEdge = [u16; 4];
/// A rim as vertices: from, to, and the third one of its triangle.
pub type PackedRim = [u16; 3];

/// Memory of [`pack_edges`].
#[derive(Debug)]
pub struct PackMemory<'m> {
    /// [`PackedNeeds::boxes`].
    pub boxes: &'m mut [PackedBox],
    /// [`PackedNeeds::edges`].
    pub edges: &'m mut [PackedEdge],
    /// [`PackedNeeds::rims`].
    pub rims: &'m mut [PackedRim],
}

/// Lengths of a [`PackMemory`]'s slices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PackedNeeds {
    /// Of `boxes`.
    pub boxes: usize,
    /// Of `edges`.
    pub edges: usize,
    /// Of `rims`.
    pub rims: usize,
}

/// What the edges of a surface take when they are packed.
#[must_use]
pub fn packed_needed(edges: &Edges<'_>) -> PackedNeeds {
    let linked = edges.groups().flat_map(|(_, group)| group.edges());
    PackedNeeds {
        boxes: edges.groups().count(),
        edges: linked.count(),
        rims: edges.rims().count(),
    }
}

/// Writes edges that [`super::link()`] found as plain numbers, of which all have the same order as before. `None` where a
/// vertex has a number above 65 535.
///
/// # Errors
/// [`TooLittleMemory`] names the slice.
pub fn pack_edges<'m>(
    edges: &Edges<'_>,
    memory: PackMemory<'m>,
) -> Result<Option<PackedEdges<'m>>, TooLittleMemory> {
    let needs = packed_needed(edges);
    let boxes = first("boxes of edges", needs.boxes, memory.boxes)?;
    let packed = first("packed edges", needs.edges, memory.edges)?;
    let rims = first("packed rims", needs.rims, memory.rims)?;
    let mut small = true;
    let mut number = |vertex: u32| {
        small &= vertex <= u32::from(u16::MAX);
        vertex as u16
    };
    for (place, (bounds, _)) in boxes.iter_mut().zip(edges.groups()) {
        *place = bounds.numbers();
    }
    let linked = edges.groups().flat_map(|(_, group)| group.edges());
    for (place, edge) in packed.iter_mut().zip(linked) {
        *place = [edge.from, edge.to, edge.forth, edge.back].map(&mut number);
    }
    for (place, rim) in rims.iter_mut().zip(edges.rims()) {
        *place = [rim.from, rim.to, rim.third].map(&mut number);
    }
    Ok(small.then_some(PackedEdges {
        boxes,
        edges: packed,
        rims,
    }))
}

/// Edges as plain numbers.
#[derive(Clone, Copy, Debug, Default)]
pub struct PackedEdges<'e> {
    boxes: &'e [PackedBox],
    edges: &'e [PackedEdge],
    rims: &'e [PackedRim],
}

impl<'e> PackedEdges<'e> {
    /// What [`pack_edges`] wrote; `None` where boxes and edges do not belong together.
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
