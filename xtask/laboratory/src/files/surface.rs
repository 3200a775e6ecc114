//! Models.

use std::path::Path;

use anyhow::Result;
use fluoropose::edges::{EdgeBox, EdgeGroup, Edges, MeshEdge, edges_needed, groups_needed, link};
use fluoropose::mesh::Mesh;
use fluoropose_decode::decode_model;
use fluoropose_phantom::implant::Triangles;

use super::text::{name_of, read};

/// A model's surface.
#[derive(Clone, Debug)]
pub struct Surface {
    vertices: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
    /// Of a closed surface: what its silhouettes are drawn from.
    edges: Option<(Vec<EdgeBox>, Vec<EdgeGroup>)>,
}

impl Surface {
    fn new(vertices: Vec<[f32; 3]>, triangles: Vec<[u32; 3]>) -> Result<Self> {
        let mesh = Mesh::new(&vertices, &triangles)?;
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

    /// As the core takes it.
    ///
    /// # Errors
    /// Those of [`Mesh::new`].
    pub fn mesh(&self) -> Result<Mesh<'_>> {
        let mesh = Mesh::new(&self.vertices, &self.triangles)?;
        let edges = self.edges.as_ref();
        let edges = edges.and_then(|(boxes, groups)| Edges::new(boxes, groups));
        Ok(edges.map_or(mesh, |edges| mesh.with_edges(edges)))
    }
}

impl TryFrom<Triangles> for Surface {
    type Error = anyhow::Error;

    fn try_from(made: Triangles) -> Result<Self> {
        Self::new(made.vertices, made.triangles)
    }
}

/// Reads an STL, OBJ or PLY model. What was left out of the file is said on standard error.
///
/// # Errors
/// Names the file and what is wrong with it.
pub fn read_model(path: &Path) -> Result<Surface> {
    let model = decode_model(&read(path)?, &name_of(path))?;
    for note in &model.notes {
        eprintln!("{}: {note}", path.display());
    }
    Surface::new(model.vertices, model.triangles)
}
