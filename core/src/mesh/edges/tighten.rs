//! Writing packed edges as a stream of bytes, for callers that have an allocator.

use alloc::vec;
use alloc::vec::Vec;

use super::boxes::{EdgeBox, IN_BOX};
use super::edge::PackedEdge;
use super::packed::PackedBox;
use super::tight::bits_for;

/// The stream of bytes of the edges in some boxes: [`super::PackedEdges::tight`] reads it.
#[must_use]
pub fn tightened(boxes: &[PackedBox], edges: &[PackedEdge]) -> Vec<u8> {
    let mut bytes = Vec::new();
    for (bounds, edges) in boxes.iter().zip(edges.chunks(IN_BOX)) {
        let mut vertices = edges.as_flattened().to_vec();
        vertices.sort_unstable();
        vertices.dedup();
        let group = [places(edges, &vertices), steps(&vertices)].concat();
        bytes.extend(EdgeBox::of_numbers(bounds).halves().as_flattened());
        // 48 and 192 bytes at most.
        bytes.extend([group.len() as u8, vertices.len() as u8]);
        bytes.extend(group);
    }
    bytes
}

/// The places of edges' vertices in their list, in as few bits as hold them.
fn places(edges: &[PackedEdge], vertices: &[u16]) -> Vec<u8> {
    let bits = bits_for(vertices.len());
    let mut bytes = vec![0; edges.len().div_ceil(2) * bits];
    for (number, vertex) in edges.as_flattened().iter().enumerate() {
        let place = vertices.partition_point(|other| other < vertex);
        for bit in 0..bits {
            let at = number * bits + bit;
            bytes[at / 8] |= ((place >> bit & 1) as u8) << (at % 8);
        }
    }
    bytes
}

/// How much each of a rising list is more than the one before it.
fn steps(vertices: &[u16]) -> Vec<u8> {
    let mut before = u16::MAX;
    let mut bytes = Vec::new();
    for &vertex in vertices {
        let step = vertex.wrapping_sub(before);
        before = vertex;
        match u8::try_from(step) {
            Ok(step) if step > 0 => bytes.push(step),
            _ => {
                bytes.push(0);
                bytes.extend(step.to_le_bytes());
            }
        }
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::edges::PackedEdges;
    use proptest::prelude::*;

    /// Edges of vertices that lie in some ranges, as those of a group mostly do.
    fn edges() -> impl Strategy<Value = Vec<PackedEdge>> {
        let vertex = prop_oneof![0u16..40, 300u16..380, any::<u16>(), Just(u16::MAX)];
        let edge = proptest::array::uniform4(vertex);
        let edge = edge.prop_filter("three vertices", |[a, b, c, _]| a != b && b != c && a != c);
        proptest::collection::vec(edge, 1..60)
    }

    fn all_of(edges: &PackedEdges<'_>) -> (Vec<EdgeBox>, Vec<PackedEdge>) {
        let (mut boxes, mut all) = (Vec::new(), Vec::new());
        let keep = |own: &EdgeBox| {
            boxes.push(*own);
            true
        };
        edges.for_each_group(keep, |group| {
            all.extend(group.edges().iter().map(|&edge| group.edge(edge)))
        });
        (boxes, all)
    }

    /// Whether a box lies around another, and is no larger than it must be.
    fn holds(own: &EdgeBox, other: &EdgeBox) -> bool {
        let around = (0..4).all(|k| {
            let [low, high] = [-1.0, 1.0].map(|side| {
                let end = |of: &EdgeBox| f64::from(of.middle[k]) + side * f64::from(of.reach[k]);
                side * (end(own) - end(other))
            });
            let spare = 0.02 * f64::from(other.middle[k].abs() + other.reach[k]) + 1e-30;
            low >= 0.0 && high >= 0.0 && low + high <= 2.0 * spare
        });
        let needs = |of: &EdgeBox| [of.thin, of.small];
        let mut needs = needs(own).into_iter().zip(needs(other));
        around && needs.all(|(own, other)| own >= other && own <= 1.02 * other + 1e-30)
    }

    properties! {
        #[test]
        fn what_is_tightened_is_read_again(edges in edges(), seed in any::<u32>()) {
            let count = edges.len().div_ceil(IN_BOX);
            // Of any size; middles with both signs.
            let number = |k: usize| {
                let bits = seed.wrapping_mul(2 * k as u32 + 1) >> 4;
                let sign = if k % 10 < 4 && k.is_multiple_of(2) { 1 << 31 } else { 0 };
                f32::from_bits((0x3000_0000 + bits) | sign)
            };
            let boxes: Vec<PackedBox> =
                (0..count).map(|k| core::array::from_fn(|at| number(10 * k + at))).collect();
            let bytes = tightened(&boxes, &edges);
            let highest = edges.as_flattened().iter().copied().max().map_or(0, usize::from);
            let tight = PackedEdges::tight(&bytes, count, edges.len(), &[]);
            prop_assert!(tight.fit(highest + 1) && !tight.fit(highest));
            let plain = PackedEdges::new(&boxes, &edges, &[]).expect("as many");
            let ((wide, expected), (own, found)) = (all_of(&plain), all_of(&tight));
            prop_assert_eq!(found, expected);
            for (own, wide) in own.iter().zip(&wide) {
                prop_assert!(holds(own, wide), "{own:?} {wide:?}");
            }
            let cut = &bytes[..bytes.len() - 1];
            prop_assert!(!PackedEdges::tight(cut, count, edges.len(), &[]).fit(1 << 16));
            prop_assert!(!PackedEdges::tight(&bytes, count + 1, edges.len(), &[]).fit(1 << 16));
        }

        /// Whatever the bytes, they are read without a panic, and what fits is of known vertices.
        #[test]
        fn any_bytes_are_refused_or_read(
            bytes in proptest::collection::vec(prop_oneof![0u8..6, any::<u8>()], 0..120),
            edges in 0usize..40,
        ) {
            let tight = PackedEdges::tight(&bytes, edges.div_ceil(IN_BOX), edges, &[]);
            let fits = tight.fit(500);
            let (_, edges) = all_of(&tight);
            let known = edges.as_flattened().iter().all(|&vertex| vertex < 500);
            prop_assert!(known || !fits);
        }
    }
}
