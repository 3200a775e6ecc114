//! One edge of a surface and the triangles on its two sides, or on its only side.

/// An edge along which two triangles run in opposite directions. Only [`super::link()`] makes it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MeshEdge {
    pub(crate) from: u32,
    pub(crate) to: u32,
    /// Third vertex of the triangle that runs `from` -> `to`.
    pub(crate) forth: u32,
    /// Third vertex of the triangle that runs `to` -> `from`.
    pub(crate) back: u32,
    /// Its number among the edges.
    pub(crate) order: u32,
}

/// A side of a triangle that no other triangle runs along in the opposite direction: the rim of a hole, of a crack or of a
/// sheet. Only [`super::link()`] makes it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RimEdge {
    pub(crate) from: u32,
    pub(crate) to: u32,
    /// Third vertex of its triangle, which runs `from` -> `to`.
    pub(crate) third: u32,
}
