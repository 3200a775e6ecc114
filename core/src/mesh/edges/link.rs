//! Finding the edges of a closed surface.

use super::boxes::{self, EdgeBox, EdgeGroup, IN_BOX};
use super::edge::MeshEdge;
use super::list::Edges;
use crate::mesh::surface::Mesh;

/// In place of a vertex while edges are being paired.
const NONE: u32 = u32::MAX;

/// Edges of working memory that [`link`] needs for `mesh`.
#[must_use]
pub fn edges_needed(mesh: &Mesh<'_>) -> usize {
    3 * mesh.triangles().len()
}

/// Boxes and groups that [`link`] needs for `mesh` at most.
#[must_use]
pub fn groups_needed(mesh: &Mesh<'_>) -> usize {
    edges_needed(mesh).div_ceil(2).div_ceil(IN_BOX)
}

/// Finds the edges of a closed surface: pairs the sides of the triangles of `mesh` in working memory `room`
/// ([`edges_needed`]) and writes them to `boxes` and `groups` ([`groups_needed`] each), for
/// [`crate::mesh::Model::with_edges`]. Where more than two triangles meet at an edge any pairing serves.
///
/// `None` where the surface is not closed or not consistently oriented (an edge is run along
/// more often in one direction than in the other), and where the memory is too short: such a
/// mesh is drawn triangle by triangle.
pub fn link<'e>(
    mesh: &Mesh<'_>,
    room: &mut [MeshEdge],
    boxes: &'e mut [EdgeBox],
    groups: &'e mut [EdgeGroup],
) -> Option<Edges<'e>> {
    let mut count = 0;
    for &[a, b, c] in mesh.triangles() {
        for (from, to, third) in [(a, b, c), (b, c, a), (c, a, b)] {
            if from != to {
                *room.get_mut(count)? = half(from, to, third);
                count += 1;
            }
        }
    }
    let halves = room.get_mut(..count)?;
    halves.sort_unstable_by_key(|edge| (edge.from, edge.to, edge.forth, edge.back));
    let paired = pair(halves)?;
    let edges = room.get_mut(..paired)?;
    let count = paired.div_ceil(IN_BOX);
    let (boxes, groups) = (boxes.get_mut(..count)?, groups.get_mut(..count)?);
    boxes::gather(mesh, edges, boxes, groups);
    Edges::new(boxes, groups)
}

/// One side of a triangle, from the lower to the higher vertex.
fn half(from: u32, to: u32, third: u32) -> MeshEdge {
    let (forth, back) = if from < to {
        (third, NONE)
    } else {
        (NONE, third)
    };
    MeshEdge {
        from: from.min(to),
        to: from.max(to),
        forth,
        back,
        order: 0,
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
        let mut boxes = std::vec![EdgeBox::default(); groups_needed(&mesh)];
        let mut groups = std::vec![EdgeGroup::default(); groups_needed(&mesh)];
        let edges = link(&mesh, &mut room, &mut boxes, &mut groups)?;
        Some(
            edges
                .groups()
                .flat_map(|(_, group)| group.edges())
                .collect(),
        )
    }

    /// Oracle: both triangles beside an edge are there and run along it as is said.
    fn assert_sides(edges: &[MeshEdge], triangles: &[[u32; 3]]) {
        let is_there = |from: u32, to: u32, third: u32| {
            let turned = |&[a, b, c]: &[u32; 3]| [[a, b, c], [b, c, a], [c, a, b]];
            let mut all = triangles.iter().flat_map(turned);
            all.any(|triangle| triangle == [from, to, third])
        };
        for edge in edges {
            assert!(is_there(edge.from, edge.to, edge.forth));
            assert!(is_there(edge.to, edge.from, edge.back));
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
        let (mut boxes, mut groups) = ([EdgeBox::default()], [EdgeGroup::default()]);
        let mut room = [MeshEdge::default(); 12];
        assert!(link(&mesh, &mut room[..11], &mut boxes, &mut groups).is_none());
        assert!(link(&mesh, &mut room, &mut [], &mut groups).is_none());
        assert!(link(&mesh, &mut room, &mut boxes, &mut []).is_none());
        assert!(link(&mesh, &mut room, &mut boxes, &mut groups).is_some());
    }
}
