//! How many bodies a surface has.

use alloc::collections::BTreeMap;
use alloc::vec::Vec;

use super::owned::OwnedModel;
use crate::math::{Vector3, cross, norm, subtract};

/// A body with a smaller part of the surface than one in this many is a marker or a splinter, however finely it is cut.
const SPLINTER: f64 = 20.0;

impl OwnedModel {
    /// Parts of the surface that share no vertex, but for splinters; at least one.
    #[must_use]
    pub fn bodies(&self) -> usize {
        self.pieces().filter(|piece| piece.is_body).count().max(1)
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
        let mut pieces = BTreeMap::<usize, (f64, Reach)>::new();
        for triangle in triangles {
            let body = root(&mut joined, triangle[0] as usize);
            let corners = triangle.map(|vertex| model.vertices()[vertex as usize].map(f64::from));
            let [a, b, c] = corners;
            let (area, reach) = pieces.entry(body).or_insert((0.0, NOWHERE));
            *area += norm(&cross(&subtract(&b, &a), &subtract(&c, &a)));
            *reach = corners
                .iter()
                .fold(*reach, |reach, point| union(reach, [*point; 2]));
        }
        let whole: f64 = pieces.values().map(|(area, _)| area).sum();
        let piece = move |(area, reach)| Piece {
            is_body: SPLINTER * area >= whole,
            reach,
        };
        pieces.into_values().map(piece)
    }
}

/// A part of the surface that shares no vertex with the others.
struct Piece {
    /// Whether it is more than a splinter.
    is_body: bool,
    reach: Reach,
}

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
            prop_assert_eq!(model.bodies(), large.count().max(1));
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
}
