//! Finding the edges of a surface.

use super::boxes::{self, EdgeBox, EdgeGroup, IN_BOX};
use super::edge::{MeshEdge, RimEdge};
use super::list::Edges;
use super::orient::{Orientation, run_end, weld};
use crate::memory::{TooLittleMemory, first};
use crate::mesh::surface::Mesh;

/// Memory of [`link`]: what it works in, and what the edges are kept in.
#[derive(Debug)]
pub struct LinkMemory<'e, 'm> {
    /// Working memory: [`LinkNeeds::halves`] sides of triangles.
    pub halves: &'m mut [MeshEdge],
    /// Working memory: [`LinkNeeds::numbers`] numbers.
    pub numbers: &'m mut [u32],
    /// [`LinkNeeds::groups`] boxes at most are kept.
    pub boxes: &'e mut [EdgeBox],
    /// [`LinkNeeds::groups`] groups.
    pub groups: &'e mut [EdgeGroup],
    /// Edges of one triangle alone: none of a closed surface, [`LinkNeeds::halves`] at most.
    pub rims: &'e mut [RimEdge],
}

/// Lengths of a [`LinkMemory`]'s slices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LinkNeeds {
    /// Of `halves`, and of `rims` at most.
    pub halves: usize,
    /// Of `numbers`.
    pub numbers: usize,
    /// Of `boxes` and `groups`.
    pub groups: usize,
}

/// How much memory [`link`] needs for `mesh`.
#[must_use]
pub fn link_needed(mesh: &Mesh<'_>) -> LinkNeeds {
    let (vertices, triangles) = (mesh.vertices().len(), mesh.triangles().len());
    LinkNeeds {
        halves: 3 * triangles,
        numbers: 2 * vertices + triangles,
        groups: (3 * triangles).div_ceil(2).div_ceil(IN_BOX),
    }
}

/// What a surface is like, as counted while its edges were found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SurfaceFaults {
    /// Vertices at the place of another.
    pub welded: usize,
    /// Triangles with two corners at one place, which cover nothing.
    pub degenerate: usize,
    /// Triangles that run against their neighbours.
    pub flipped: usize,
    /// Sides of triangles without a neighbour: rims of holes, cracks and sheets.
    pub rims: usize,
}

impl SurfaceFaults {
    /// Whether the surface encloses a volume.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.rims == 0
    }
}

/// Pairs the sides of the triangles of `mesh` and writes its edges to borrowed memory, for
/// [`crate::mesh::Model::with_edges`]. Any mesh has edges: vertices at one place count as one, triangles are turned to run
/// as their neighbours do, more than two at an edge are paired in any way, and what finds no partner is kept as a rim.
/// Nothing of this changes a pixel of what is drawn.
///
/// # Errors
/// [`TooLittleMemory`] names the slice.
pub fn link<'e>(
    mesh: &Mesh<'_>,
    memory: LinkMemory<'e, '_>,
) -> Result<(Edges<'e>, SurfaceFaults), TooLittleMemory> {
    let needs = link_needed(mesh);
    let halves = first("sides of triangles", needs.halves, memory.halves)?;
    let numbers = first("numbers", needs.numbers, memory.numbers)?;
    let (vertices, parents) = numbers.split_at_mut(2 * mesh.vertices().len());
    let (order, same) = vertices.split_at_mut(mesh.vertices().len());
    let mut faults = SurfaceFaults {
        welded: weld(mesh, order, same),
        ..SurfaceFaults::default()
    };
    let count = write_halves(mesh, same, halves, &mut faults);
    let halves = &mut halves[..count];
    halves.sort_unstable_by_key(|half| (half.from, half.to, half.order, half.back));
    orient(halves, parents, &mut faults);
    let (paired, rims) = pair(halves, memory.rims)?;
    faults.rims = rims;
    let edges = &mut halves[..paired];
    let groups = paired.div_ceil(IN_BOX);
    let boxes = first("boxes of edges", groups, memory.boxes)?;
    let groups = first("groups of edges", groups, memory.groups)?;
    boxes::gather(mesh, edges, boxes, groups);
    let kept = Edges::new(boxes, groups, &memory.rims[..rims], mesh.mark());
    // They are as many, because both were cut to one length.
    kept.map(|edges| (edges, faults)).ok_or(TooLittleMemory {
        what: "groups of edges",
        needed: boxes.len(),
        given: groups.len(),
    })
}

/// Makes the triangles that run against their neighbours run as these do; `numbers` as [`link`] left them.
#[cfg(feature = "alloc")]
pub(in crate::mesh) fn turn(vertices: usize, numbers: &mut [u32], triangles: &mut [[u32; 3]]) {
    let mut orientation = Orientation::of(numbers.get_mut(2 * vertices..).unwrap_or_default());
    for (number, [_, b, c]) in (0..).zip(triangles) {
        if orientation.root(number).1 {
            core::mem::swap(b, c);
        }
    }
}

/// The sides of all triangles that cover anything, from the lower to the higher vertex: `forth` has the third vertex, `back`
/// the triangle, `order` whether it runs that way. Gives their number.
fn write_halves(
    mesh: &Mesh<'_>,
    same: &[u32],
    halves: &mut [MeshEdge],
    faults: &mut SurfaceFaults,
) -> usize {
    let mut count = 0;
    for (triangle, corners) in mesh.triangles().iter().enumerate() {
        let [a, b, c] = corners.map(|vertex| same[vertex as usize]);
        if a == b || b == c || c == a {
            faults.degenerate += 1;
            continue;
        }
        for (from, to, third) in [(a, b, c), (b, c, a), (c, a, b)] {
            halves[count] = MeshEdge {
                from: from.min(to),
                to: from.max(to),
                forth: third,
                back: triangle as u32,
                order: u32::from(from < to),
            };
            count += 1;
        }
    }
    count
}

/// Turns the triangles of a connected piece alike, as most edges between two of them allow.
fn orient(halves: &mut [MeshEdge], parents: &mut [u32], faults: &mut SurfaceFaults) {
    let triangles = parents.len();
    let mut orientation = Orientation::new(parents);
    let mut start = 0;
    while start < halves.len() {
        let end = run_end(halves, start);
        if let [a, b] = halves[start..end] {
            orientation.join(a.back, b.back, a.order == b.order);
        }
        start = end;
    }
    for half in &mut *halves {
        half.order ^= u32::from(orientation.root(half.back).1);
    }
    let turned = (0..triangles as u32).filter(|&triangle| orientation.root(triangle).1);
    faults.flipped = turned.count();
}

/// Joins sides that run along one edge in opposite directions and moves the pairs to the front; writes the others to `rims`.
/// Gives the numbers of both.
fn pair(halves: &mut [MeshEdge], rims: &mut [RimEdge]) -> Result<(usize, usize), TooLittleMemory> {
    let (mut paired, mut alone, mut start) = (0, 0, 0);
    while start < halves.len() {
        let end = run_end(halves, start);
        let run = &mut halves[start..end];
        run.sort_unstable_by_key(|half| (half.order == 0, half.forth));
        let forth = run.iter().take_while(|half| half.order == 1).count();
        let pairs = forth.min(end - start - forth);
        for k in 0..pairs {
            let (a, b) = (halves[start + k], halves[start + forth + k]);
            halves[paired] = MeshEdge { back: b.forth, ..a };
            paired += 1;
        }
        for k in (start + pairs..start + forth).chain(start + forth + pairs..end) {
            let half = halves[k];
            let room = rims.len();
            *rims.get_mut(alone).ok_or(TooLittleMemory {
                what: "rims of triangles",
                needed: room + 1,
                given: room,
            })? = rim(&half);
            alone += 1;
        }
        start = end;
    }
    Ok((paired, alone))
}

fn rim(half: &MeshEdge) -> RimEdge {
    let (from, to) = match half.order {
        1 => (half.from, half.to),
        _ => (half.to, half.from),
    };
    RimEdge {
        from,
        to,
        third: half.forth,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::collection::vec as vec_of;
    use proptest::prelude::*;
    use std::vec;
    use std::vec::Vec;

    const CORNERS: [[f32; 3]; 4] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    const CLOSED: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];

    fn linked(
        vertices: &[[f32; 3]],
        triangles: &[[u32; 3]],
    ) -> (Vec<MeshEdge>, Vec<RimEdge>, SurfaceFaults) {
        let mesh = Mesh::new(vertices, triangles).expect("valid");
        let needs = link_needed(&mesh);
        let mut boxes = vec![EdgeBox::default(); needs.groups];
        let mut groups = vec![EdgeGroup::default(); needs.groups];
        let mut rims = vec![RimEdge::default(); needs.halves];
        let memory = LinkMemory {
            halves: &mut vec![MeshEdge::default(); needs.halves],
            numbers: &mut vec![0; needs.numbers],
            boxes: &mut boxes,
            groups: &mut groups,
            rims: &mut rims,
        };
        let (edges, faults) = link(&mesh, memory).expect("enough memory");
        let pairs = edges.groups().flat_map(|(_, group)| group.edges());
        (pairs.collect(), edges.rims().collect(), faults)
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
        let (edges, rims, faults) = linked(&CORNERS, &CLOSED);
        assert_eq!((edges.len(), rims.len()), (6, 0));
        assert_eq!(faults, SurfaceFaults::default());
        assert_sides(&edges, &CLOSED);
        // Two surfaces on the same vertices: four triangles at each edge.
        let twice: Vec<_> = CLOSED.iter().chain(&CLOSED).copied().collect();
        let (edges, rims, _) = linked(&CORNERS, &twice);
        assert_eq!((edges.len(), rims.len()), (12, 0));
        assert_sides(&edges, &twice);
    }

    #[test]
    fn a_hole_has_a_rim_and_a_turned_triangle_none() {
        let (edges, rims, faults) = linked(&CORNERS, &CLOSED[..3]);
        assert_eq!((edges.len(), rims.len(), faults.rims), (3, 3, 3));
        assert!(!faults.is_closed());
        let mut turned = CLOSED;
        turned[2].swap(0, 1);
        let (edges, rims, faults) = linked(&CORNERS, &turned);
        assert_eq!((edges.len(), rims.len(), faults.flipped), (6, 0, 1));
        assert!(faults.is_closed());
    }

    #[test]
    fn vertices_at_one_place_are_one() {
        let corners: Vec<[f32; 3]> = CLOSED
            .iter()
            .flatten()
            .map(|&vertex| CORNERS[vertex as usize].map(|x| if x == 0.0 { -0.0 } else { x }))
            .collect();
        let triangles: Vec<[u32; 3]> = (0..4).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
        let (edges, rims, faults) = linked(&corners, &triangles);
        assert_eq!((edges.len(), rims.len(), faults.welded), (6, 0, 8));
    }

    #[test]
    fn a_triangle_without_area_is_left_out() {
        let with_sliver: Vec<_> = CLOSED.iter().copied().chain([[1, 1, 2]]).collect();
        let (edges, rims, faults) = linked(&CORNERS, &with_sliver);
        assert_eq!((edges.len(), rims.len(), faults.degenerate), (6, 0, 1));
    }

    #[test]
    fn too_little_memory_is_an_error() {
        let mesh = Mesh::new(&CORNERS, &CLOSED[..3]).expect("valid");
        let needs = link_needed(&mesh);
        let link_with = |halves: usize, numbers: usize, groups: usize, rims: usize| {
            let memory = LinkMemory {
                halves: &mut vec![MeshEdge::default(); halves],
                numbers: &mut vec![0; numbers],
                boxes: &mut vec![EdgeBox::default(); groups],
                groups: &mut vec![EdgeGroup::default(); groups],
                rims: &mut vec![RimEdge::default(); rims],
            };
            link(&mesh, memory).map(|_| ())
        };
        let LinkNeeds {
            halves,
            numbers,
            groups,
        } = needs;
        assert_eq!(link_with(halves, numbers, groups, 3), Ok(()));
        let error = |what, needed, given| {
            Err(TooLittleMemory {
                what,
                needed,
                given,
            })
        };
        for (given, expected) in [
            (
                [halves - 1, numbers, groups, 3],
                error("sides of triangles", 9, 8),
            ),
            ([halves, numbers - 1, groups, 3], error("numbers", 11, 10)),
            ([halves, numbers, 0, 3], error("boxes of edges", 1, 0)),
            // It is not known before how many there are: one more than there was room for.
            (
                [halves, numbers, groups, 1],
                error("rims of triangles", 2, 1),
            ),
        ] {
            let [halves, numbers, groups, rims] = given;
            assert_eq!(link_with(halves, numbers, groups, rims), expected);
        }
    }

    properties! {
        /// Holes, several triangles at an edge, vertices at one place, windings of both kinds.
        #[test]
        fn every_side_is_of_one_edge_or_rim_and_no_two_rims_could_be_paired(
            places in vec_of(proptest::array::uniform3(0u8..3), 3..12),
            corners in vec_of(proptest::array::uniform3(0u32..12), 1..30),
        ) {
            let vertices: Vec<[f32; 3]> = places.iter().map(|place| place.map(f32::from)).collect();
            let count = vertices.len() as u32;
            let triangles: Vec<[u32; 3]> = corners.iter().map(|corners| corners.map(|corner| corner % count)).collect();
            prop_assume!(Mesh::new(&vertices, &triangles).is_ok());
            let (edges, rims, faults) = linked(&vertices, &triangles);
            let at = |vertex: u32| places[vertex as usize];
            // Sides with their third corners as places, whichever way they are run.
            let side = |from: u32, to: u32, third: u32| {
                let (from, to) = (at(from), at(to));
                (from.min(to), from.max(to), at(third))
            };
            let of_edges = edges.iter().flat_map(|edge| [side(edge.from, edge.to, edge.forth), side(edge.from, edge.to, edge.back)]);
            let of_rims = rims.iter().map(|rim| side(rim.from, rim.to, rim.third));
            let mut found: Vec<_> = of_edges.chain(of_rims).collect();
            let covers = |[a, b, c]: &&[u32; 3]| at(*a) != at(*b) && at(*b) != at(*c) && at(*c) != at(*a);
            let sides = triangles.iter().filter(covers);
            let mut expected: Vec<_> = sides.flat_map(|&[a, b, c]| [side(a, b, c), side(b, c, a), side(c, a, b)]).collect();
            found.sort_unstable();
            expected.sort_unstable();
            prop_assert_eq!(found, expected);
            prop_assert_eq!(faults.degenerate, triangles.iter().filter(|triangle| !covers(triangle)).count());
            prop_assert_eq!(faults.rims, rims.len());
            for rim in &rims {
                prop_assert!(rims.iter().all(|other| (other.from, other.to) != (rim.to, rim.from)));
            }
        }
    }
}
