//! What is drawn: a mesh and, of a closed one, its edges.

use thiserror::Error;

use crate::math::Vector3;
use crate::mesh::edges::{Edges, PackedEdges};
use crate::mesh::revolution::Revolution;
use crate::mesh::surface::{Bounds, Mesh, MeshError, ModelDigest, SurfaceMark};

/// Edges were given with a mesh that they are not of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("the edges are those of another mesh: link this one's")]
pub struct OtherEdges;

/// A component's CAD model, ready to be drawn. It borrows its vertices, triangles and edges, so a copy is cheap.
///
/// Without edges every triangle is drawn. With edges the same pixels come sooner: see
/// [`crate::mesh::edges::link`], which finds those of a closed surface.
#[derive(Clone, Copy, Debug)]
pub struct Model<'a> {
    mesh: Mesh<'a>,
    edges: Option<Edges<'a>>,
    revolution: Option<&'a Revolution>,
}

impl<'a> Model<'a> {
    /// A model that is drawn triangle by triangle.
    #[must_use]
    pub fn new(mesh: Mesh<'a>) -> Self {
        Self {
            mesh,
            edges: None,
            revolution: None,
        }
    }

    /// A model that is drawn triangle by triangle, from vertices (mm) and three vertex indices for each triangle.
    ///
    /// # Errors
    /// [`MeshError`] names the vertex or triangle at fault.
    pub fn from_triangles(
        vertices: &'a [[f32; 3]],
        triangles: &'a [[u32; 3]],
    ) -> Result<Self, MeshError> {
        Mesh::new(vertices, triangles).map(Self::new)
    }

    /// A model that is drawn from the edges of its mesh, as [`crate::mesh::edges::link`] found them.
    ///
    /// # Errors
    /// [`OtherEdges`] where they are another mesh's: the silhouette would be no model's.
    pub fn with_edges(mesh: Mesh<'a>, edges: Edges<'a>) -> Result<Self, OtherEdges> {
        match edges.mark() == mesh.mark() {
            true => Ok(Self::linked(mesh, edges)),
            false => Err(OtherEdges),
        }
    }

    /// The same of edges that were kept with their mesh.
    pub(super) fn linked(mesh: Mesh<'a>, edges: Edges<'a>) -> Self {
        Self {
            mesh,
            edges: Some(edges),
            revolution: None,
        }
    }

    /// A model that is drawn from packed edges, which were kept with its mesh.
    pub(crate) fn packed(mesh: Mesh<'a>, edges: PackedEdges<'a>) -> Self {
        Self::linked(mesh, Edges::of_packed(edges, SurfaceMark::NONE))
    }

    /// The same of a part that is round, as [`crate::mesh::symmetry::revolution`] found: what no outline tells of its poses is then in their
    /// uncertainty.
    #[must_use]
    pub fn with_revolution(self, revolution: Option<&'a Revolution>) -> Self {
        Self { revolution, ..self }
    }

    /// The axis of a body of revolution, where that was told.
    #[must_use]
    pub fn revolution(&self) -> Option<&'a Revolution> {
        self.revolution
    }

    /// The surface.
    #[must_use]
    pub fn mesh(&self) -> &Mesh<'a> {
        &self.mesh
    }

    /// The surface's edges; none where it is drawn triangle by triangle.
    #[must_use]
    pub fn edges(&self) -> Option<Edges<'a>> {
        self.edges
    }

    /// Vertices, mm.
    #[must_use]
    pub fn vertices(&self) -> &'a [[f32; 3]] {
        self.mesh.vertices()
    }

    /// Triangles, three vertex indices each; none of a model that was kept without them ([`Self::for_each_triangle`]).
    #[must_use]
    pub fn triangles(&self) -> &'a [[u32; 3]] {
        self.mesh.triangles()
    }

    /// Calls `visit` with each triangle that covers anything: those of the mesh, or where it was kept without them
    /// ([`crate::implant::ImplantFile`]) those that its edges are of.
    pub fn for_each_triangle(&self, mut visit: impl FnMut(&[u32; 3])) {
        let edges = self.edges.as_ref();
        match edges.and_then(Edges::packed) {
            Some((packed, _)) if self.triangles().is_empty() => packed.for_each_triangle(visit),
            _ => self.triangles().iter().for_each(&mut visit),
        }
    }

    /// Where the model lies in its own coordinates.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        self.mesh.bounds()
    }

    /// Middle of the model's box, model coordinates, mm: rotations about it hardly move the image.
    #[must_use]
    pub fn centre(&self) -> Vector3 {
        self.mesh.bounds().centre
    }

    /// See [`Mesh::digest`].
    #[must_use]
    pub fn digest(&self) -> ModelDigest {
        self.mesh.digest()
    }
}

impl<'a> From<Mesh<'a>> for Model<'a> {
    fn from(mesh: Mesh<'a>) -> Self {
        Self::new(mesh)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::edges::fake::Linked;

    #[test]
    fn edges_of_another_mesh_are_refused() {
        let mut vertices = [
            [0.0f32, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
        ];
        let triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let other = vertices;
        vertices[3] = [0.0, 0.0, 2.0];
        let mesh = Mesh::new(&vertices, &triangles).expect("valid");
        let linked = Linked::new(&mesh);
        assert!(Model::with_edges(mesh, linked.edges()).is_ok());
        let other = Mesh::new(&other, &triangles).expect("valid");
        assert_eq!(
            Model::with_edges(other, linked.edges()).err(),
            Some(OtherEdges)
        );
    }
}
