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
