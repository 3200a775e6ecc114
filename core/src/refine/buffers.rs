//! Working memory of refinement that grows with what needs it, for callers that have an allocator.

use alloc::vec::Vec;

use super::border::BorderPixel;
use super::memory::RefineMemory;
use crate::camera::Camera;
use crate::image::mask::{Word, words_needed};
use crate::memory::grow;
use crate::mesh::Model;
use crate::render::{Projected, scratch_needed};

/// Border pixels there is room for: the outline of an implant in a large frame has some thousands.
const BORDER: usize = 16_384;

/// Owns what a [`RefineMemory`] borrows.
#[derive(Clone, Debug, Default)]
pub struct RefineBuffers {
    projected: Vec<Projected>,
    drawn: Vec<Word>,
    places: Vec<u16>,
    border: Vec<BorderPixel>,
}

impl RefineBuffers {
    /// Memory for a model and one camera. It never shrinks.
    pub fn borrow(&mut self, model: &Model<'_>, camera: &Camera) -> RefineMemory<'_> {
        let (width, height) = (camera.width(), camera.height());
        grow(&mut self.projected, scratch_needed(model));
        grow(&mut self.drawn, words_needed(width, height));
        grow(&mut self.places, width * height);
        grow(&mut self.border, BORDER);
        RefineMemory {
            projected: &mut self.projected,
            drawn: &mut self.drawn,
            places: &mut self.places,
            border: &mut self.border,
        }
    }
}
