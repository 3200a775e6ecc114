//! The mesh of a part.

/// An indexed triangle mesh in millimetres, wound so that normals point outwards.
#[derive(Clone, Debug, PartialEq)]
pub struct Triangles {
    /// Vertices `[x, y, z]` in mm.
    pub vertices: Vec<[f32; 3]>,
    /// Vertex indices of each triangle, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}
