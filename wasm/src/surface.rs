//! A model's surface as the page's modules own it.

use fluoropose::edges::{MeshEdge, edges_needed, link};
use fluoropose::mesh::Mesh;
use wasm_bindgen::JsError;

use crate::error::sentence;

/// Vertices, triangles and, of a closed surface, the edges that its silhouettes are drawn from.
pub(crate) struct Surface {
    vertices: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
    edges: Option<Vec<MeshEdge>>,
}

impl Surface {
    /// Takes vertices (x, y, z by turns, mm) and triangles (three vertex indices each).
    pub(crate) fn new(vertices: &[f32], triangles: &[u32]) -> Result<Self, JsError> {
        let vertices = vertices.as_chunks().0.to_vec();
        let triangles = triangles.as_chunks().0.to_vec();
        let mesh = Mesh::new(&vertices, &triangles).map_err(sentence)?;
        let mut room = vec![MeshEdge::default(); edges_needed(&mesh)];
        let edges = link(&mesh, &mut room).map(<[MeshEdge]>::to_vec);
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
        Ok(match &self.edges {
            Some(edges) => mesh.with_edges(edges),
            None => mesh,
        })
    }
}
