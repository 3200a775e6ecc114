//! Working memory of the finder that grows with what needs it, for callers that have an allocator.

use alloc::vec::Vec;

use super::component::Component;
use super::memory::FinderMemory;
use crate::camera::Camera;
use crate::image::mask::Word;
use crate::library::Library;
use crate::locate::partial::PartialBuffers;
use crate::locate::{Workspace, workspace_needed};
use crate::memory::grow;
use crate::refine::RefineBuffers;
use crate::search::kernels::Kernels;

/// Owns what a [`FinderMemory`] borrows.
#[derive(Clone, Debug, Default)]
pub struct FinderBuffers {
    canonical: Vec<Word>,
    rotated: Vec<Word>,
    scores: Vec<u32>,
    bytes: Vec<u8>,
    partial: PartialBuffers,
    refine: RefineBuffers,
}

impl FinderBuffers {
    /// Memory to find a component in frames of a camera; `kernels` are the inner loops, [`Kernels::PORTABLE`] or those of a
    /// crate that knows the machine. It never shrinks.
    pub fn borrow(
        &mut self,
        component: &Component<'_>,
        camera: &Camera,
        kernels: Kernels,
    ) -> FinderMemory<'_> {
        self.make_room(component.library);
        FinderMemory {
            workspace: Workspace {
                canonical: &mut self.canonical,
                rotated: &mut self.rotated,
                scores: &mut self.scores,
                bytes: &mut self.bytes,
                kernels,
            },
            partial: self
                .partial
                .borrow(component.library, camera, component.model),
            refine: self.refine.borrow(component.model, camera),
        }
    }

    /// Memory to compare silhouettes with a library, without its model.
    pub fn workspace(&mut self, library: &Library<'_>, kernels: Kernels) -> Workspace<'_> {
        self.make_room(library);
        Workspace {
            canonical: &mut self.canonical,
            rotated: &mut self.rotated,
            scores: &mut self.scores,
            bytes: &mut self.bytes,
            kernels,
        }
    }

    /// The canonical form of the last silhouette that was compared.
    #[must_use]
    pub fn canonical(&self) -> &[Word] {
        &self.canonical
    }

    fn make_room(&mut self, library: &Library<'_>) {
        let needs = workspace_needed(library);
        grow(&mut self.canonical, needs.words);
        grow(&mut self.rotated, needs.words);
        grow(&mut self.scores, needs.scores);
        grow(&mut self.bytes, needs.bytes);
    }

    /// Memory of refinement alone, for several views of a model.
    pub fn refine(&mut self) -> &mut RefineBuffers {
        &mut self.refine
    }
}
