//! How many bodies a surface has.

use alloc::collections::BTreeMap;
use alloc::vec::Vec;

use super::owned::OwnedModel;

/// A body with fewer of the triangles than one in this many is a marker or a splinter.
const SPLINTER: usize = 20;

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
        let mut sizes = BTreeMap::<usize, usize>::new();
        for [a, ..] in triangles {
            *sizes.entry(root(&mut joined, *a as usize)).or_default() += 1;
        }
        let large = sizes
            .values()
            .filter(|&&size| SPLINTER * size >= triangles.len());
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
