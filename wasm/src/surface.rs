//! A model's surface as the page's modules own it.

use fluoropose::edges::{EdgeBox, EdgeGroup, Edges, MeshEdge, edges_needed, groups_needed, link};
use fluoropose::mesh::Mesh;
use wasm_bindgen::JsError;

use crate::error::sentence;

/// Vertices, triangles and, of a closed surface, the edges that its silhouettes are drawn from.
pub(crate) struct Surface {
    vertices: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
    edges: Option<(Vec<EdgeBox>, Vec<EdgeGroup>)>,
}

impl Surface {
    /// Takes vertices (x, y, z by turns, mm) and triangles (three vertex indices each).
    pub(crate) fn new(vertices: &[f32], triangles: &[u32]) -> Result<Self, JsError> {
        let vertices = vertices.as_chunks().0.to_vec();
        let triangles = triangles.as_chunks().0.to_vec();
        let mesh = Mesh::new(&vertices, &triangles).map_err(sentence)?;
        let mut room = vec![MeshEdge::default(); edges_needed(&mesh)];
        let mut boxes = vec![EdgeBox::default(); groups_needed(&mesh)];
        let mut groups = vec![EdgeGroup::default(); groups_needed(&mesh)];
        let edges = link(&mesh, &mut room, &mut boxes, &mut groups).map(|edges| edges.parts());
        let edges = edges.map(|(boxes, groups)| (boxes.to_vec(), groups.to_vec()));
        Ok(Self {
            vertices,
            triangles,
            edges,
        })
    }

    /// Number of triangles.
    pub(crate) fn triangles(&self) -> usize {
        self.triangles.len()
    }

    /// The core's view of it.
    pub(crate) fn mesh(&self) -> Result<Mesh<'_>, JsError> {
        let mesh = Mesh::new(&self.vertices, &self.triangles).map_err(sentence)?;
        let edges = self.edges.as_ref();
        let edges = edges.and_then(|(boxes, groups)| Edges::new(boxes, groups));
        Ok(edges.map_or(mesh, |edges| mesh.with_edges(edges)))
    }
}
