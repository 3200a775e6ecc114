//! The edges of a surface, borrowed.

use super::boxes::{EdgeBox, EdgeGroup};
use super::edge::RimEdge;
use super::measured::{Facing, contour_of};
use super::packed::PackedEdges;
use crate::mesh::surface::SurfaceMark;

/// The edges of a surface: those between two triangles, together where their triangles turn from the camera together, and
/// those that belong to one triangle alone.
#[derive(Clone, Copy, Debug)]
pub struct Edges<'e> {
    boxes: &'e [EdgeBox],
    groups: &'e [EdgeGroup],
    rims: &'e [RimEdge],
    /// Instead of all of these, where edges were packed.
    packed: PackedEdges<'e>,
    /// Tells of packed edges; a program that opens no packed ones has no code for them.
    faces: Option<Facing>,
    mark: SurfaceMark,
}

impl<'e> Edges<'e> {
    /// What [`super::link`] gave, kept in other memory, with the mark of their surface; `None` where there are not as many
    /// boxes as groups.
    #[must_use]
    pub fn new(
        boxes: &'e [EdgeBox],
        groups: &'e [EdgeGroup],
        rims: &'e [RimEdge],
        mark: SurfaceMark,
    ) -> Option<Self> {
        (boxes.len() == groups.len()).then_some(Self {
            boxes,
            groups,
            rims,
            packed: PackedEdges::default(),
            faces: None,
            mark,
        })
    }

    /// Packed edges, with the mark of their surface.
    #[must_use]
    pub fn of_packed(packed: PackedEdges<'e>, mark: SurfaceMark) -> Self {
        Self {
            boxes: &[],
            groups: &[],
            rims: &[],
            packed,
            faces: Some(contour_of),
            mark,
        }
    }

    /// The mark of the surface that they are of.
    #[must_use]
    pub fn mark(&self) -> SurfaceMark {
        self.mark
    }

    /// The boxes, groups and rims, to be kept in other memory; none of packed edges.
    #[must_use]
    pub fn parts(&self) -> (&'e [EdgeBox], &'e [EdgeGroup], &'e [RimEdge]) {
        (self.boxes, self.groups, self.rims)
    }

    /// Groups of edges between two triangles, and their boxes.
    pub(crate) fn groups(&self) -> impl Iterator<Item = (&'e EdgeBox, &'e EdgeGroup)> {
        self.boxes.iter().zip(self.groups)
    }

    /// Packed edges, and how to tell which way a triangle faces; none of those that were just linked.
    pub(crate) fn packed(&self) -> Option<(&PackedEdges<'e>, Facing)> {
        self.faces.map(|faces| (&self.packed, faces))
    }

    /// Edges of one triangle alone; none of a closed surface.
    pub(crate) fn rims(&self) -> impl Iterator<Item = RimEdge> + use<'e> {
        self.rims.iter().copied().chain(self.packed.rims())
    }
}
