//! Working memory of the finder.

use crate::locate::Workspace;
use crate::locate::partial::PartialMemory;
use crate::refine::RefineMemory;

/// Working memory of [`super::find()`]. With the feature `alloc`, `FinderBuffers` owns it.
#[derive(Debug)]
pub struct FinderMemory<'m> {
    /// To compare the silhouette with the library. Where it has no bytes, those of the drawing serve, of which nothing is
    /// needed before views are found.
    pub workspace: Workspace<'m>,
    /// To find poses of pieces of the outline.
    pub partial: PartialMemory<'m>,
    /// To draw and to refine.
    pub refine: RefineMemory<'m>,
}
