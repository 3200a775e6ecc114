//! How many bodies a surface has.

use alloc::collections::BTreeMap;
use alloc::vec::Vec;

use super::owned::OwnedModel;
use crate::math::{Vector3, cross, dot, norm, subtract};

/// A body with a smaller part of the surface than one in this many is a marker or a splinter, however finely it is cut.
const SPLINTER: f64 = 20.0;

impl OwnedModel {
    /// Bodies that lie apart, but for splinters; at least one. Those that overlap are one, as pegs and a box are that a design program left as bodies of
    /// their own: told by how far they reach in thirteen directions, so that some that merely lie close around each other are one, too.
    #[must_use]
    pub fn bodies(&self) -> usize {
        let bodies: Vec<Piece> = self.pieces().filter(|piece| piece.is_body).collect();
        let mut joined: Vec<usize> = (0..bodies.len()).collect();
        for (a, b) in (0..bodies.len()).flat_map(|b| (0..b).map(move |a| (a, b))) {
            if bodies[a].overlaps(&bodies[b]) {
                let [one, other] = [a, b].map(|body| root(&mut joined, body));
                joined[one] = other;
            }
        }
        let firsts = joined
            .iter()
            .enumerate()
            .filter(|&(at, &first)| at == first);
        firsts.count().max(1)
    }

    /// How far a splinter lies outside the box around the bodies, mm: 0 without any.
    #[must_use]
    pub fn splinters_beyond_mm(&self) -> f64 {
        let pieces: Vec<Piece> = self.pieces().collect();
        let [bodies, all] = [true, false].map(|bodies| {
            let pieces = pieces.iter().filter(|piece| piece.is_body || !bodies);
            pieces.fold(NOWHERE, |reach, piece| union(reach, piece.reach))
        });
        let beyond = (0..3).map(|k| (bodies[0][k] - all[0][k]).max(all[1][k] - bodies[1][k]));
        beyond.filter(|mm| mm.is_finite()).fold(0.0, f64::max)
    }

    /// The parts of the surface that share no vertex.
    fn pieces(&self) -> impl Iterator<Item = Piece> {
        let model = self.as_model();
        let triangles = model.triangles();
        let mut joined: Vec<usize> = (0..model.vertices().len()).collect();
        for [a, b, c] in triangles {
            let first = root(&mut joined, *a as usize);
            for vertex in [*b, *c] {
                let other = root(&mut joined, vertex as usize);
                joined[other] = first;
            }
        }
        let mut pieces = BTreeMap::<usize, (f64, Reach, Extents)>::new();
        for triangle in triangles {
            let body = root(&mut joined, triangle[0] as usize);
            let corners = triangle.map(|vertex| model.vertices()[vertex as usize].map(f64::from));
            let [a, b, c] = corners;
            let none = (0.0, NOWHERE, [[f64::INFINITY, f64::NEG_INFINITY]; 13]);
            let (area, reach, extents) = pieces.entry(body).or_insert(none);
            *area += norm(&cross(&subtract(&b, &a), &subtract(&c, &a)));
            *reach = corners
                .iter()
                .fold(*reach, |reach, point| union(reach, [*point; 2]));
            for (extent, direction) in extents.iter_mut().zip(&DIRECTIONS) {
                let along = corners.map(|point| dot(direction, &point));
                *extent = along
                    .iter()
                    .fold(*extent, |[low, high], &at| [low.min(at), high.max(at)]);
            }
        }
        let whole: f64 = pieces.values().map(|(area, ..)| area).sum();
        let piece = move |(area, reach, extents)| Piece {
            is_body: SPLINTER * area >= whole,
            reach,
            extents,
        };
        pieces.into_values().map(piece)
    }
}

/// A part of the surface that shares no vertex with the others.
struct Piece {
    /// Whether it is more than a splinter.
    is_body: bool,
    reach: Reach,
    extents: Extents,
}

impl Piece {
    /// Whether nothing tells that it lies apart from another.
    fn overlaps(&self, other: &Self) -> bool {
        let both = self.extents.iter().zip(&other.extents);
        both.into_iter()
            .all(|([low, high], [other_low, other_high])| low <= other_high && other_low <= high)
    }
}

/// The least and the greatest along each of [`DIRECTIONS`], in their lengths.
type Extents = [[f64; 2]; 13];

/// Sides, edges and corners of a cube, one of each two opposite ones.
const DIRECTIONS: [Vector3; 13] = [
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [1.0, 1.0, 0.0],
    [1.0, -1.0, 0.0],
    [1.0, 0.0, 1.0],
    [1.0, 0.0, -1.0],
    [0.0, 1.0, 1.0],
    [0.0, 1.0, -1.0],
    [1.0, 1.0, 1.0],
    [1.0, 1.0, -1.0],
    [1.0, -1.0, 1.0],
    [-1.0, 1.0, 1.0],
];

/// The least and the greatest coordinates, mm.
type Reach = [Vector3; 2];

const NOWHERE: Reach = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];

fn union([low, high]: Reach, [other_low, other_high]: Reach) -> Reach {
    [
        core::array::from_fn(|k| low[k].min(other_low[k])),
        core::array::from_fn(|k| high[k].max(other_high[k])),
    ]
}

/// The vertex that stands for all that are joined with one.
fn root(joined: &mut [usize], mut vertex: usize) -> usize {
    while joined[vertex] != vertex {
        joined[vertex] = joined[joined[vertex]];
        vertex = joined[vertex];
    }
    vertex
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::edges::fake::add_box;
    use proptest::collection::vec;
    use proptest::prelude::*;

    fn of(vertices: &[[f32; 3]], triangles: &[[u32; 3]]) -> OwnedModel {
        OwnedModel::drawn(vertices.concat(), triangles.concat()).expect("valid")
    }

    properties! {
        /// Triangles in a row, of which some share a corner, in any order. Oracle: numbers of pieces, written anew until none changes.
        #[test]
        fn parts_that_share_no_vertex_are_bodies(corners in vec(proptest::array::uniform3(0u32..30), 1..14)) {
            // On a parabola in space no three of them lie on a line.
            let vertices: Vec<[f32; 3]> = (0u8..30).map(f32::from).map(|x| [x, x * x, 900.0 - x]).collect();
            let distinct = |[a, b, c]: &[u32; 3]| a != b && b != c && c != a;
            let triangles: Vec<[u32; 3]> = corners.into_iter().filter(distinct).collect();
            prop_assume!(!triangles.is_empty());
            let mut pieces: Vec<usize> = (0..triangles.len()).collect();
            for _ in 0..triangles.len() {
                for (a, b) in (0..triangles.len()).flat_map(|a| (0..triangles.len()).map(move |b| (a, b))) {
                    if triangles[a].iter().any(|vertex| triangles[b].contains(vertex)) {
                        pieces[a] = pieces[a].min(pieces[b]);
                    }
                }
            }
            let model = of(&vertices, &triangles);
            let area = |[a, b, c]: &[u32; 3]| {
                let [a, b, c] = [a, b, c].map(|vertex| vertices[*vertex as usize].map(f64::from));
                norm(&cross(&subtract(&b, &a), &subtract(&c, &a)))
            };
            let whole: f64 = triangles.iter().map(area).sum();
            let large = (0..triangles.len()).filter(|piece| {
                let own = triangles.iter().zip(&pieces).filter(|(_, other)| *other == piece);
                let areas: f64 = own.map(|(triangle, _)| area(triangle)).sum();
                areas * 20.0 >= whole * (1.0 - 1e-12) && areas > 0.0
            });
            prop_assert_eq!(model.pieces().filter(|piece| piece.is_body).count().max(1), large.count().max(1));
        }

        /// Of two boxes that are alike but for their size, along any axis and on either side.
        #[test]
        fn a_splinter_lies_as_far_beyond_as_it_reaches(axis in 0..3usize, side in any::<bool>(), away in 0u8..90, large in 5u8..20) {
            let size = f32::from(large);
            let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
            add_box([0.0; 3], [size; 3], &mut vertices, &mut triangles);
            let mut low = [1.0; 3];
            low[axis] = if side { size + f32::from(away) } else { -f32::from(away) - 1.0 };
            add_box(low, low.map(|x| x + 1.0), &mut vertices, &mut triangles);
            let model = of(&vertices, &triangles);
            prop_assert_eq!((model.bodies(), model.splinters_beyond_mm()), (1, f64::from(away) + 1.0));
        }
    }

    /// One part in twenty of the surface is a body, less is a splinter.
    #[test]
    fn a_twentieth_of_the_surface_is_a_body() {
        let with = |width: f32| {
            let flat = [
                [0.0f32, 0.0],
                [width, 0.0],
                [0.0, 1.0],
                [40.0, 0.0],
                [59.0, 0.0],
                [40.0, 1.0],
            ];
            of(&flat.map(|[x, y]| [x, y, 0.0]), &[[0, 1, 2], [3, 4, 5]]).bodies()
        };
        assert_eq!((with(1.0), with(0.999)), (2, 1));
    }

    /// A plate with a keel through it and pegs on it, and a part beside.
    #[test]
    fn bodies_that_overlap_are_one() {
        let bodies = |boxes: &[[[f32; 3]; 2]]| {
            let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
            for &[low, high] in boxes {
                add_box(low, high, &mut vertices, &mut triangles);
            }
            of(&vertices, &triangles).bodies()
        };
        let plate = [[0.0; 3], [60.0, 4.0, 40.0]];
        let keel = [[20.0, -40.0, 15.0], [35.0, 2.0, 25.0]];
        let peg = [[5.0, 4.0, 5.0], [15.0, 20.0, 15.0]];
        let beside = [[0.0, -40.0, 60.0], [60.0, -30.0, 100.0]];
        assert_eq!(bodies(&[plate, keel, peg]), 1);
        assert_eq!(bodies(&[plate, beside, keel, peg]), 2);
        // Joined by the last alone.
        let bridge = [[20.0, -38.0, 20.0], [30.0, -32.0, 70.0]];
        assert_eq!(bodies(&[plate, beside, keel, bridge]), 1);
    }
}
