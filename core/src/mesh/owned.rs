//! A model that owns its memory, for callers that have an allocator.

use alloc::vec;
use alloc::vec::Vec;

use crate::mesh::edges::{EdgeBox, EdgeGroup, Edges, MeshEdge, edges_needed, groups_needed, link};
use crate::mesh::model::Model;
use crate::mesh::surface::{Bounds, Mesh, MeshError};

/// Vertices, triangles and, of a closed surface, the edges that its silhouettes are drawn from.
///
/// It keeps the two vectors that it was given and reads them three numbers at a time.
#[derive(Clone, Debug)]
pub struct OwnedModel {
    vertices: Vec<f32>,
    triangles: Vec<u32>,
    bounds: Bounds,
    edges: Option<(Vec<EdgeBox>, Vec<EdgeGroup>)>,
}

impl OwnedModel {
    /// Takes vertices (x, y and z of each, mm) and triangles (three vertex numbers each). One or two numbers left over at
    /// the end are ignored.
    ///
    /// # Errors
    /// [`MeshError`] names the vertex or triangle at fault.
    pub fn new(vertices: Vec<f32>, triangles: Vec<u32>) -> Result<Self, MeshError> {
        let mesh = Mesh::new(vertices.as_chunks().0, triangles.as_chunks().0)?;
        let (bounds, edges) = (mesh.bounds(), linked(&mesh));
        Ok(Self {
            vertices,
            triangles,
            bounds,
            edges,
        })
    }

    /// The model, borrowed.
    #[must_use]
    pub fn as_model(&self) -> Model<'_> {
        let mesh = Mesh::checked(
            self.vertices.as_chunks().0,
            self.triangles.as_chunks().0,
            self.bounds,
        );
        let edges = self.edges.as_ref();
        match edges.and_then(|(boxes, groups)| Edges::new(boxes, groups)) {
            Some(edges) => Model::with_edges(mesh, edges),
            None => Model::new(mesh),
        }
    }
}

/// Nothing where the surface is not closed.
fn linked(mesh: &Mesh<'_>) -> Option<(Vec<EdgeBox>, Vec<EdgeGroup>)> {
    let mut room = vec![MeshEdge::default(); edges_needed(mesh)];
    let mut boxes = vec![EdgeBox::default(); groups_needed(mesh)];
    let mut groups = vec![EdgeGroup::default(); groups_needed(mesh)];
    // A closed surface has exactly this number of edges, unless some triangles have two equal corners.
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
    fn numbers_stay_where_they_came_and_a_closed_surface_has_edges() {
        let vertices = vec![0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
        let triangles = vec![0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3];
        let (first, address) = (vertices[3], vertices.as_ptr());
        let owned = OwnedModel::new(vertices, triangles).expect("valid");
        let model = owned.as_model();
        assert_eq!(model.vertices().as_ptr().cast(), address);
        assert_eq!(
            (model.vertices()[1][0], model.triangles().len()),
            (first, 4)
        );
        assert!(model.edges().is_some());
    }

    #[test]
    fn an_open_surface_has_no_edges() {
        let vertices = vec![0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
        let owned = OwnedModel::new(vertices, vec![0, 1, 2]).expect("valid");
        assert!(owned.as_model().edges().is_none());
    }
}
