//! The edges of a surface, borrowed.

use super::boxes::{EdgeBox, EdgeGroup};

/// The edges of a closed surface, grouped so that those of a group are on the contour together or not at all, mostly.
#[derive(Clone, Copy, Debug)]
pub struct Edges<'e> {
    boxes: &'e [EdgeBox],
    groups: &'e [EdgeGroup],
}

impl<'e> Edges<'e> {
    /// Boxes and groups that [`super::link()`] gave, kept in other memory; `None` where their numbers differ.
    #[must_use]
    pub fn new(boxes: &'e [EdgeBox], groups: &'e [EdgeGroup]) -> Option<Self> {
        (boxes.len() == groups.len()).then_some(Self { boxes, groups })
    }

    /// The boxes and groups, to be kept in other memory.
    #[must_use]
    pub fn parts(&self) -> (&'e [EdgeBox], &'e [EdgeGroup]) {
        (self.boxes, self.groups)
    }

    /// Groups and their boxes.
    pub(crate) fn groups(&self) -> impl Iterator<Item = (&'e EdgeBox, &'e EdgeGroup)> {
        self.boxes.iter().zip(self.groups)
    }
}
