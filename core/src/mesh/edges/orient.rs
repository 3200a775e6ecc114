//! Vertices welded and triangles turned alike, so that the sides of neighbours can be paired.
//!
//! Neither changes what is drawn. Equal vertices have equal images, and a triangle covers the same pixels whichever way it
//! runs.

use core::cmp::Ordering;

use super::edge::MeshEdge;
use crate::mesh::surface::Mesh;

/// Writes for each vertex the first one at the same place; `order` is working memory. Both have a number for each vertex.
/// Gives how many were welded to another.
pub(super) fn weld(mesh: &Mesh<'_>, order: &mut [u32], same: &mut [u32]) -> usize {
    let vertices = mesh.vertices();
    let place = |vertex: u32| place(vertices, vertex);
    for (number, slot) in order.iter_mut().enumerate() {
        *slot = number as u32;
    }
    order.sort_unstable_by(|&a, &b| by_place(vertices, a, b));
    let (mut first, mut welded) = (None, 0);
    for &vertex in &*order {
        let of = match first {
            Some(first) if place(first) == place(vertex) => {
                welded += 1;
                first
            }
            _ => vertex,
        };
        first = Some(of);
        same[vertex as usize] = of;
    }
    welded
}

/// Adding zero makes -0 and 0 alike.
fn place(vertices: &[[f32; 3]], vertex: u32) -> [f32; 3] {
    vertices[vertex as usize].map(|x| x + 0.0)
}

/// Vertices at one place beside each other. Written out at each of the hundred places where a sort compares numbers, it would be 18 KB of
/// the page's first load.
#[inline(never)]
fn by_place(vertices: &[[f32; 3]], a: u32, b: u32) -> Ordering {
    let key = |vertex: u32| (place(vertices, vertex).map(f32::to_bits), vertex);
    key(a).cmp(&key(b))
}

/// Trees of triangles that are joined along edges; each number is the parent's, doubled, with a lowest bit that says whether
/// the triangle runs against it (union-find with parity; Tarjan, J. ACM 22, 1975).
pub(super) struct Orientation<'m> {
    parents: &'m mut [u32],
}

impl<'m> Orientation<'m> {
    /// Every triangle by itself, as it was given.
    pub(super) fn new(parents: &'m mut [u32]) -> Self {
        for (triangle, parent) in parents.iter_mut().enumerate() {
            *parent = (triangle as u32) << 1;
        }
        Self { parents }
    }

    /// As [`super::link`] left it.
    #[cfg(feature = "alloc")]
    pub(super) fn of(parents: &'m mut [u32]) -> Self {
        Self { parents }
    }

    /// The root of a triangle's tree, and whether the triangle runs against it.
    pub(super) fn root(&mut self, triangle: u32) -> (u32, bool) {
        let (mut at, mut against) = (triangle, 0);
        loop {
            let link = self.parents[at as usize];
            let (parent, turn) = (link >> 1, link & 1);
            if parent == at {
                return (at, against == 1);
            }
            // Halving the path: the grandparent becomes the parent.
            let above = self.parents[parent as usize];
            self.parents[at as usize] = above ^ turn;
            against ^= turn ^ (above & 1);
            at = above >> 1;
        }
    }

    /// Joins two neighbours, of which one has to be turned where they run along their edge in one direction.
    pub(super) fn join(&mut self, a: u32, b: u32, in_one_direction: bool) {
        let ((a, turn_a), (b, turn_b)) = (self.root(a), self.root(b));
        if a != b {
            let turn = turn_a ^ turn_b ^ in_one_direction;
            let (low, high) = (a.min(b), a.max(b));
            self.parents[high as usize] = low << 1 | u32::from(turn);
        }
    }
}

/// Sides that run along one edge, of a list sorted by their vertices: where the run that begins at `start` ends.
pub(super) fn run_end(halves: &[MeshEdge], start: usize) -> usize {
    let Some(first) = halves.get(start) else {
        return start;
    };
    let same = |edge: &&MeshEdge| (edge.from, edge.to) == (first.from, first.to);
    start + halves[start..].iter().take_while(same).count()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::collection::vec;
    use proptest::prelude::*;
    use std::vec;
    use std::vec::Vec;

    const COUNT: u32 = 40;

    properties! {
        /// Oracle: every vertex beside every other.
        #[test]
        fn a_vertex_is_welded_to_the_first_at_its_place(
            places in vec(proptest::array::uniform3(prop_oneof![Just(0.0f32), Just(-0.0), Just(1.0), Just(-1.0)]), 2..30),
        ) {
            let Ok(mesh) = Mesh::new(&places, &[[0, 0, 1]]) else { return Ok(()) };
            let (mut order, mut same) = (vec![0; places.len()], vec![0; places.len()]);
            let welded = weld(&mesh, &mut order, &mut same);
            let first = |place: &[f32; 3]| places.iter().position(|other| other == place);
            let expected: Vec<usize> = places.iter().filter_map(first).collect();
            let same: Vec<usize> = same.iter().map(|&vertex| vertex as usize).collect();
            prop_assert_eq!(&same, &expected);
            prop_assert_eq!(welded, (0..).zip(&same).filter(|(own, first)| own != *first).count());
        }

        /// Which way each triangle runs is drawn first and tells what neighbours say of each other. Oracle: numbers of pieces, written anew at each
        /// join.
        #[test]
        fn triangles_that_are_joined_run_as_their_neighbours_say(
            ways in vec(any::<bool>(), COUNT as usize), pairs in vec((0..COUNT, 0..COUNT), 0..60),
        ) {
            let mut parents = vec![0; COUNT as usize];
            let mut orientation = Orientation::new(&mut parents);
            let mut pieces: Vec<u32> = (0..COUNT).collect();
            let way = |triangle: u32| ways[triangle as usize];
            for (a, b) in pairs {
                orientation.join(a, b, way(a) != way(b));
                let [one, other] = [a, b].map(|triangle| pieces[triangle as usize]);
                for piece in pieces.iter_mut().filter(|piece| **piece == one.max(other)) {
                    *piece = one.min(other);
                }
            }
            for (triangle, &lowest) in (0..).zip(&pieces) {
                let (root, against) = orientation.root(triangle);
                prop_assert_eq!((root, against), (lowest, way(triangle) != way(lowest)));
            }
        }
    }
}
