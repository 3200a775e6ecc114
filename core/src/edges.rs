//! Which triangles share an edge: what a closed surface's silhouette can be drawn from.

use crate::mesh::Mesh;

/// An edge along which two triangles run in opposite directions. Made by [`link`] alone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MeshEdge {
    pub(crate) from: u32,
    pub(crate) to: u32,
    /// The triangle that runs `from` -> `to`.
    pub(crate) forth: u32,
    /// The triangle that runs `to` -> `from`.
    pub(crate) back: u32,
}

/// In place of a triangle while edges are being paired.
const NONE: u32 = u32::MAX;

/// Room that [`link`] needs for `mesh`.
#[must_use]
pub fn edges_needed(mesh: &Mesh<'_>) -> usize {
    3 * mesh.triangles().len()
}

/// Pairs the sides of the triangles of `mesh` in lent memory ([`edges_needed`]) and gives the
/// edges, to be lent to [`Mesh::with_edges`]. Where more than two triangles meet at an edge they
/// are paired in any way.
///
/// `None` where the surface is not closed or not consistently oriented (an edge is run along
/// more often in one direction than in the other), and where the memory is too short: such a
/// mesh is drawn triangle by triangle.
pub fn link<'e>(mesh: &Mesh<'_>, room: &'e mut [MeshEdge]) -> Option<&'e [MeshEdge]> {
    let mut count = 0;
    for (index, &[a, b, c]) in (0..NONE).zip(mesh.triangles()) {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            if from != to {
                *room.get_mut(count)? = half(from, to, index);
                count += 1;
            }
        }
    }
    let halves = room.get_mut(..count)?;
    halves.sort_unstable_by_key(|edge| (edge.from, edge.to, edge.forth));
    let paired = pair(halves)?;
    room.get(..paired)
}

/// One side of a triangle, from the lower to the higher vertex.
fn half(from: u32, to: u32, triangle: u32) -> MeshEdge {
    let (forth, back) = if from < to {
        (triangle, NONE)
    } else {
        (NONE, triangle)
    };
    MeshEdge {
        from: from.min(to),
        to: from.max(to),
        forth,
        back,
    }
}

/// Joins sides that follow each other, sorted by their vertices and then those forth before those
/// back, and moves the pairs to the front.
fn pair(halves: &mut [MeshEdge]) -> Option<usize> {
    let (mut paired, mut start) = (0, 0);
    while let Some(first) = halves.get(start).copied() {
        let same = |edge: &&MeshEdge| (edge.from, edge.to) == (first.from, first.to);
        let run = halves.get(start..)?.iter().take_while(same);
        let (mut length, mut forth) = (0, 0);
        for edge in run {
            length += 1;
            forth += usize::from(edge.forth != NONE);
        }
        if length != 2 * forth {
            return None;
        }
        for k in 0..forth {
            let (a, b) = (*halves.get(start + k)?, *halves.get(start + forth + k)?);
            *halves.get_mut(paired)? = MeshEdge { back: b.back, ..a };
            paired += 1;
        }
        start += length;
    }
    Some(paired)
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [[f32; 3]; 4] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    const CLOSED: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];

    fn linked(triangles: &[[u32; 3]]) -> Option<std::vec::Vec<MeshEdge>> {
        let mesh = Mesh::new(&CORNERS, triangles).expect("valid");
        let mut room = std::vec![MeshEdge::default(); edges_needed(&mesh)];
        link(&mesh, &mut room).map(<[MeshEdge]>::to_vec)
    }

    /// Oracle: every triangle beside an edge runs along it in the direction that is said.
    fn assert_sides(edges: &[MeshEdge], triangles: &[[u32; 3]]) {
        let runs = |triangle: u32, from: u32, to: u32| {
            let [a, b, c] = triangles[triangle as usize];
            [(a, b), (b, c), (c, a)].contains(&(from, to))
        };
        for edge in edges {
            assert!(runs(edge.forth, edge.from, edge.to));
            assert!(runs(edge.back, edge.to, edge.from));
        }
    }

    #[test]
    fn a_closed_surface_has_an_edge_for_every_two_sides() {
        let edges = linked(&CLOSED).expect("closed");
        assert_eq!(edges.len(), 6);
        assert_sides(&edges, &CLOSED);
        // Two surfaces on the same vertices: four triangles at each edge.
        let twice: std::vec::Vec<_> = CLOSED.iter().chain(&CLOSED).copied().collect();
        let edges = linked(&twice).expect("closed");
        assert_eq!(edges.len(), 12);
        assert_sides(&edges, &twice);
    }

    #[test]
    fn open_and_inconsistent_surfaces_have_none() {
        assert_eq!(linked(&CLOSED[..3]), None);
        let mut turned = CLOSED;
        turned[0].swap(0, 1);
        assert_eq!(linked(&turned), None);
    }

    #[test]
    fn a_triangle_without_area_does_no_harm() {
        let with_sliver: std::vec::Vec<_> = CLOSED.iter().copied().chain([[1, 1, 2]]).collect();
        assert_eq!(linked(&with_sliver).expect("closed").len(), 7);
    }

    #[test]
    fn too_little_room_is_no_panic() {
        let mesh = Mesh::new(&CORNERS, &CLOSED).expect("valid");
        assert_eq!(link(&mesh, &mut [MeshEdge::default(); 11]), None);
    }
}
