//! Packing the edges of a surface.

use super::edge::PackedEdge;
use super::list::Edges;
use super::packed::{PackedBox, PackedEdges, PackedRim};
use crate::memory::{TooLittleMemory, first};

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
    Ok(PackedEdges::new(boxes, packed, rims).filter(|_| small))
}
