//! The edges of a surface as plain numbers, a sixth of what [`super::link()`] leaves: to be kept in a file and read in place.
//!
//! What is left out, the planes of the triangles beside each edge, is found again from their vertices where a box does not
//! tell that none of its edges is on the contour.

use super::boxes::{EdgeBox, IN_BOX};
use super::edge::{MeshEdge, PackedEdge, RimEdge};
use super::tight::{Group, GroupRoom, TightGroups};

/// A box as numbers: middle and reach of its triangles' duals, greatest reciprocals of a height and of a doubled area.
pub type PackedBox = [f32; 10];
/// A rim as vertices: from, to, and the third one of its triangle.
pub type PackedRim = [u16; 3];

/// Edges as plain numbers.
#[derive(Clone, Copy, Debug, Default)]
pub struct PackedEdges<'e> {
    boxes: &'e [PackedBox],
    edges: &'e [PackedEdge],
    /// Instead of boxes and edges.
    tight: TightGroups<'e>,
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
        (boxes.len() == edges.len().div_ceil(IN_BOX)).then_some(Self {
            boxes,
            edges,
            tight: TightGroups::default(),
            rims,
        })
    }

    /// So many edges in so many boxes, as `tightened` wrote them. Of other bytes there are fewer: [`Self::fit`] tells.
    #[must_use]
    pub fn tight(bytes: &'e [u8], boxes: usize, edges: usize, rims: &'e [PackedRim]) -> Self {
        Self {
            boxes: &[],
            edges: &[],
            tight: TightGroups::new(bytes, boxes, edges),
            rims,
        }
    }

    /// The numbers themselves; rims alone of what was tightened.
    #[must_use]
    pub fn parts(&self) -> (&'e [PackedBox], &'e [PackedEdge], &'e [PackedRim]) {
        (self.boxes, self.edges, self.rims)
    }

    /// Whether there are any: else nothing is drawn.
    #[must_use]
    pub fn are_some(&self) -> bool {
        !self.edges.is_empty() || self.tight.edges() > 0 || !self.rims.is_empty()
    }

    /// Whether all are edges of a surface of so many vertices.
    #[must_use]
    pub fn fit(&self, vertices: usize) -> bool {
        let known = |&vertex: &u16| usize::from(vertex) < vertices;
        self.edges.iter().flatten().all(known)
            && self.rims.iter().flatten().all(known)
            && self.tight.fit(vertices)
    }

    /// Edges of one triangle alone.
    pub(crate) fn rims(&self) -> impl Iterator<Item = RimEdge> + use<'e> {
        self.rims.iter().map(|&rim| {
            let [from, to, third] = rim.map(u32::from);
            RimEdge { from, to, third }
        })
    }
}

impl PackedEdges<'_> {
    /// Calls `visit` with the edges of each box that is wanted.
    pub(crate) fn for_each_group(
        &self,
        mut is_wanted: impl FnMut(&EdgeBox) -> bool,
        mut visit: impl FnMut(&Group<'_>),
    ) {
        let mut room = GroupRoom::EMPTY;
        // Two lists side by side without `zip`, which asks how many parts there are and divides for that.
        let mut parts = self.edges.chunks(IN_BOX);
        for numbers in self.boxes {
            let edges = parts.next().unwrap_or_default();
            if is_wanted(&EdgeBox::of_numbers(numbers)) {
                visit(&room.listed(edges));
            }
        }
        for (halves, group) in self.tight {
            if is_wanted(&EdgeBox::of_halves(halves)) {
                visit(&group.unpacked(&mut room));
            }
        }
    }

    fn for_each_packed(&self, mut visit: impl FnMut(&PackedEdge)) {
        let each = |group: &Group<'_>| {
            for &edge in group.edges() {
                visit(&group.edge(edge));
            }
        };
        self.for_each_group(|_| true, each);
    }

    /// Calls `visit` with each edge.
    pub(crate) fn for_each_edge(&self, mut visit: impl FnMut(MeshEdge)) {
        self.for_each_packed(|edge| visit(unpacked(edge)));
    }

    /// Calls `visit` with each triangle of the surface, run as its neighbours are. Of its three edges one does: that before
    /// which its highest vertex lies.
    pub(crate) fn for_each_triangle(&self, mut visit: impl FnMut(&[u32; 3])) {
        let mut side = |[from, to, third]: [u16; 3]| {
            if third > from && third > to {
                visit(&[from, to, third].map(u32::from));
            }
        };
        self.for_each_packed(|&[from, to, forth, back]| {
            side([from, to, forth]);
            side([to, from, back]);
        });
        self.rims.iter().copied().for_each(side);
    }
}

/// An edge as it was before it was packed, but for what its triangles need of a margin.
pub(crate) fn unpacked(edge: &PackedEdge) -> MeshEdge {
    // One after the other: `map` makes a loop of it, which some compilers leave one.
    let &[from, to, forth, back] = edge;
    MeshEdge {
        from: from.into(),
        to: to.into(),
        forth: forth.into(),
        back: back.into(),
        order: 0,
    }
}

#[cfg(test)]
mod tests {
    use crate::mesh::edges::fake::Linked;
    use crate::mesh::{Mesh, Model};
    use proptest::prelude::*;
    use std::vec::Vec;

    /// Places of the corners of triangles that cover anything, in any order.
    fn places(vertices: &[[f32; 3]], triangles: &[[u32; 3]]) -> Vec<[[u32; 3]; 3]> {
        let place = |vertex: u32| vertices[vertex as usize].map(f32::to_bits);
        let places = triangles.iter().map(|triangle| {
            let mut places = triangle.map(place);
            places.sort_unstable();
            places
        });
        let mut places: Vec<_> = places.filter(|[a, b, c]| a != b && b != c).collect();
        places.sort_unstable();
        places
    }

    properties! {
        /// Holes, several triangles at an edge, vertices at one place, windings of both kinds.
        #[test]
        fn triangles_are_found_again_from_their_edges(
            vertices in proptest::collection::vec([0u8..3, 0u8..3, 0u8..2], 4..20),
            corners in proptest::collection::vec([0u32..20, 0u32..20, 0u32..20], 1..30),
        ) {
            let vertices: Vec<[f32; 3]> = vertices.iter().map(|place| place.map(f32::from)).collect();
            let triangles: Vec<[u32; 3]> =
                corners.iter().map(|corners| corners.map(|corner| corner % vertices.len() as u32)).collect();
            let Ok(mesh) = Mesh::new(&vertices, &triangles) else { return Ok(()) };
            let packed = Linked::new(&mesh).packed();
            // As a file keeps it, which leaves the triangles out.
            let digest = mesh.digest();
            let alone = Mesh::known(&vertices, &[], mesh.bounds(), &digest);
            for edges in [packed.edges(), packed.tight_edges()] {
                let (packed, _) = edges.packed().expect("packed");
                let visited = |mesh: Mesh<'_>| {
                    let mut found = Vec::new();
                    Model::packed(mesh, *packed).for_each_triangle(|&triangle| found.push(triangle));
                    found
                };
                let found = visited(alone);
                prop_assert_eq!(places(&vertices, &found), places(&vertices, &triangles));
                prop_assert_eq!(&visited(mesh), &triangles);
                prop_assert_eq!(packed.are_some(), !found.is_empty());
                let needed = found.iter().flatten().max().map_or(0, |&highest| highest as usize + 1);
                prop_assert!(packed.fit(needed) && (0..needed).all(|fewer| !packed.fit(fewer)));
            }
        }
    }
}
