//! The edges of a surface, borrowed.

use super::boxes::{EdgeBox, EdgeGroup};
use super::edge::RimEdge;
use crate::mesh::surface::SurfaceMark;

/// The edges of a surface: those between two triangles, together where their triangles turn from the camera together, and
/// those that belong to one triangle alone.
#[derive(Clone, Copy, Debug)]
pub struct Edges<'e> {
    boxes: &'e [EdgeBox],
    groups: &'e [EdgeGroup],
    rims: &'e [RimEdge],
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
            mark,
        })
    }

    /// The mark of the surface that they are of.
    #[must_use]
    pub fn mark(&self) -> SurfaceMark {
        self.mark
    }

    /// The boxes and groups, to be kept in other memory.
    #[must_use]
    pub fn parts(&self) -> (&'e [EdgeBox], &'e [EdgeGroup], &'e [RimEdge]) {
        (self.boxes, self.groups, self.rims)
    }

    /// Groups of edges between two triangles, and their boxes.
    pub(crate) fn groups(&self) -> impl Iterator<Item = (&'e EdgeBox, &'e EdgeGroup)> {
        self.boxes.iter().zip(self.groups)
    }

    /// Edges of one triangle alone; none of a closed surface.
    pub(crate) fn rims(&self) -> &'e [RimEdge] {
        self.rims
    }
}
