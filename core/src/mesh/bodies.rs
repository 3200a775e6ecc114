//! How many bodies a surface has.

use alloc::collections::BTreeMap;
use alloc::vec::Vec;

use super::owned::OwnedModel;
use crate::math::{cross, norm, subtract};

/// A body with a smaller part of the surface than one in this many is a marker or a splinter, however finely it is cut.
const SPLINTER: f64 = 20.0;

impl OwnedModel {
    /// Parts of the surface that share no vertex, but for splinters; at least one.
    #[must_use]
    pub fn bodies(&self) -> usize {
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
        let mut areas = BTreeMap::<usize, f64>::new();
        for triangle in triangles {
            let body = root(&mut joined, triangle[0] as usize);
            let [a, b, c] = triangle.map(|vertex| model.vertices()[vertex as usize].map(f64::from));
            *areas.entry(body).or_default() += norm(&cross(&subtract(&b, &a), &subtract(&c, &a)));
        }
        let whole: f64 = areas.values().sum();
        let large = areas.values().filter(|&&area| SPLINTER * area >= whole);
        large.count().max(1)
    }
}

/// The vertex that stands for all that are joined with one.
fn root(joined: &mut [usize], mut vertex: usize) -> usize {
    while joined[vertex] != vertex {
        joined[vertex] = joined[joined[vertex]];
        vertex = joined[vertex];
    }
    vertex
}
