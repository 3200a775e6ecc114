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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Mesh;
    use crate::mesh::edges::fake::Linked;
    use std::vec;
    use std::vec::Vec;

    /// What is left of the memory that two triangles with a side in common take, with the last of its corners at a number.
    fn packed(highest: usize, fewer: [usize; 3]) -> Result<bool, TooLittleMemory> {
        let mut vertices: Vec<[f32; 3]> = vec![[0.0; 3]; highest + 1];
        vertices[1] = [1.0, 0.0, 0.0];
        vertices[2] = [0.0, 1.0, 0.0];
        vertices[highest] = [1.0, 1.0, 0.0];
        let triangles = [[0, 1, 2], [2, 1, highest as u32]];
        let linked = Linked::new(&Mesh::new(&vertices, &triangles).expect("valid"));
        let needs = packed_needed(&linked.edges());
        assert_eq!((needs.boxes, needs.edges, needs.rims), (1, 1, 4));
        let memory = PackMemory {
            boxes: &mut vec![[0.0; 10]; needs.boxes - fewer[0]],
            edges: &mut vec![[0; 4]; needs.edges - fewer[1]],
            rims: &mut vec![[0; 3]; needs.rims - fewer[2]],
        };
        pack_edges(&linked.edges(), memory).map(|edges| edges.is_some())
    }

    #[test]
    fn a_vertex_beyond_sixteen_bits_is_not_packed_and_too_little_memory_is_an_error() {
        assert_eq!(packed(65_535, [0; 3]), Ok(true));
        assert_eq!(packed(65_536, [0; 3]), Ok(false));
        for slice in 0..3 {
            let mut fewer = [0; 3];
            fewer[slice] = 1;
            assert!(packed(9, fewer).is_err());
        }
    }
}
