//! A model's surface as the page's modules own it.

use fluoropose::mesh::Mesh;
use fluoropose::mesh::edges::{
    EdgeBox, EdgeGroup, Edges, MeshEdge, edges_needed, groups_needed, link,
};
use wasm_bindgen::JsError;

use crate::error::sentence;

/// Vertices, triangles and, of a closed surface, the edges that its silhouettes are drawn from. The numbers stay as they
/// came from JavaScript and are looked at in threes.
pub(crate) struct Surface {
    vertices: Vec<f32>,
    triangles: Vec<u32>,
    edges: Option<(Vec<EdgeBox>, Vec<EdgeGroup>)>,
}

impl Surface {
    /// Takes vertices (x, y, z by turns, mm) and triangles (three vertex indices each).
    pub(crate) fn new(vertices: Vec<f32>, triangles: Vec<u32>) -> Result<Self, JsError> {
        let edges = edges_of(&mesh_of(&vertices, &triangles)?);
        Ok(Self {
            vertices,
            triangles,
            edges,
        })
    }

    /// Number of triangles.
    pub(crate) fn triangles(&self) -> usize {
        self.triangles.len() / 3
    }

    /// The core's view of it.
    pub(crate) fn mesh(&self) -> Result<Mesh<'_>, JsError> {
        let mesh = mesh_of(&self.vertices, &self.triangles)?;
        let edges = self.edges.as_ref();
        let edges = edges.and_then(|(boxes, groups)| Edges::new(boxes, groups));
        Ok(edges.map_or(mesh, |edges| mesh.with_edges(edges)))
    }
}

fn mesh_of<'s>(vertices: &'s [f32], triangles: &'s [u32]) -> Result<Mesh<'s>, JsError> {
    Mesh::new(vertices.as_chunks().0, triangles.as_chunks().0).map_err(sentence)
}

/// Nothing where the surface is not closed.
fn edges_of(mesh: &Mesh<'_>) -> Option<(Vec<EdgeBox>, Vec<EdgeGroup>)> {
    let mut room = vec![MeshEdge::default(); edges_needed(mesh)];
    let mut boxes = vec![EdgeBox::default(); groups_needed(mesh)];
    let mut groups = vec![EdgeGroup::default(); groups_needed(mesh)];
    // Of a closed surface there are as many as room was made for, but where triangles have equal corners.
    let (used, _) = link(mesh, &mut room, &mut boxes, &mut groups)?.parts();
    let used = used.len();
    boxes.truncate(used);
    groups.truncate(used);
    Some((boxes, groups))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_core_sees_the_numbers_where_they_came_and_the_edges_of_a_closed_surface() {
        let vertices = vec![0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
        let triangles = vec![0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3];
        let (first, address) = (vertices[3], vertices.as_ptr());
        let surface = Surface::new(vertices, triangles).ok().unwrap();
        let mesh = surface.mesh().ok().unwrap();
        assert_eq!(mesh.vertices().as_ptr().cast(), address);
        assert_eq!((mesh.vertices()[1][0], surface.triangles()), (first, 4));
        assert!(surface.edges.is_some());
    }

    #[test]
    fn an_open_surface_has_no_edges() {
        let vertices = vec![0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
        let surface = Surface::new(vertices, vec![0, 1, 2]).ok().unwrap();
        assert!(surface.edges.is_none());
    }
}
