//! A triangle's corners and normal.

use crate::math::{Vector3, cross, norm, scale, subtract};
use crate::mesh::surface::Mesh;

/// The corners of a triangle relative to `origin`.
pub(super) fn corners(mesh: &Mesh<'_>, triangle: &[u32; 3], origin: &Vector3) -> [Vector3; 3] {
    triangle.map(|index| {
        // Indices were checked when the mesh was made.
        let vertex = mesh.vertices().get(index as usize).copied();
        let vertex = vertex.unwrap_or_default();
        core::array::from_fn(|k| f64::from(vertex[k]) - origin[k])
    })
}

/// Unit normal, or zero for a triangle without area.
pub(super) fn normal(&[a, b, c]: &[Vector3; 3]) -> Vector3 {
    let product = cross(&subtract(&b, &a), &subtract(&c, &a));
    let length = norm(&product);
    if length > 0.0 {
        scale(&product, 1.0 / length)
    } else {
        [0.0; 3]
    }
}
