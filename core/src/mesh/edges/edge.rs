//! One edge of a surface and the triangles on its two sides, or on its only side.

/// An edge along which two triangles run in opposite directions. Made by [`super::link`] alone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MeshEdge {
    pub(crate) from: u32,
    pub(crate) to: u32,
    /// Third vertex of the triangle that runs `from` -> `to`.
    pub(crate) forth: u32,
    /// Third vertex of the triangle that runs `to` -> `from`.
    pub(crate) back: u32,
    /// Its number among the edges; in a group, [`MeshEdge::needs`].
    pub(crate) order: u32,
}

impl MeshEdge {
    /// Keeps what the edge's triangles need of a margin: reciprocals of the least height and of the doubled area, each
    /// rounded up to 16 bits.
    pub(crate) fn keep_needs(&mut self, needs: [f32; 2]) {
        const INFINITE: u32 = f32::INFINITY.to_bits() >> 16;
        let [thin, small] = needs.map(|need| ((need.to_bits() >> 16) + 1).min(INFINITE));
        self.order = thin << 16 | small;
    }

    /// What was kept, no less than it was.
    pub(crate) fn needs(&self) -> [f32; 2] {
        [self.order & 0xffff_0000, self.order << 16].map(f32::from_bits)
    }
}

/// A side of a triangle that no other triangle runs along in the opposite direction: the rim of a hole, of a crack or of a
/// sheet. Made by [`super::link`] alone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RimEdge {
    pub(crate) from: u32,
    pub(crate) to: u32,
    /// Third vertex of its triangle, which runs `from` -> `to`.
    pub(crate) third: u32,
}

/// An edge as vertices: from, to, and the third ones of the triangles that run it forth and back.
pub type PackedEdge = [u16; 4];

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    properties! {
        #[test]
        fn what_is_kept_of_needs_is_no_less_and_hardly_more(
            needs in proptest::array::uniform2(prop_oneof![0.0..1e-3f32, 0.0..9.0f32, 0.0..1e30f32]),
        ) {
            let mut edge = MeshEdge::default();
            edge.keep_needs(needs);
            for (kept, need) in edge.needs().into_iter().zip(needs) {
                prop_assert!(kept >= need && kept <= 1.01 * need + f32::MIN_POSITIVE, "{} {}", kept, need);
            }
        }
    }

    #[test]
    fn a_need_beyond_all_numbers_stays_so() {
        let mut edge = MeshEdge::default();
        edge.keep_needs([f32::INFINITY, f32::MAX]);
        assert_eq!(edge.needs(), [f32::INFINITY; 2]);
    }
}
