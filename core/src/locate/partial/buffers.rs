//! Working memory for partial outlines that grows with what needs it, for callers that have an allocator.

use alloc::vec::Vec;

use super::hypothesis::Hypothesis;
use super::memory::{PartialMemory, partial_needed};
use super::outline::OutlinePoint;
use super::trace::PixelSide;
use crate::camera::Camera;
use crate::image::mask::Word;
use crate::library::Library;
use crate::memory::grow;
use crate::mesh::Model;
use crate::render::Projected;

/// Owns what a [`PartialMemory`] borrows.
#[derive(Clone, Debug, Default)]
pub struct PartialBuffers {
    words: Vec<Word>,
    sides: Vec<PixelSide>,
    points: Vec<OutlinePoint>,
    cells: Vec<u16>,
    numbers: Vec<f32>,
    hypotheses: Vec<Hypothesis>,
    projected: Vec<Projected>,
}

impl PartialBuffers {
    /// Memory for a library, a camera and a model. It never shrinks.
    pub fn borrow(
        &mut self,
        library: &Library<'_>,
        camera: &Camera,
        model: &Model<'_>,
    ) -> PartialMemory<'_> {
        let needs = partial_needed(library, camera, model);
        grow(&mut self.words, needs.words);
        grow(&mut self.sides, needs.sides);
        grow(&mut self.points, needs.points);
        grow(&mut self.cells, needs.cells);
        grow(&mut self.numbers, needs.numbers);
        grow(&mut self.hypotheses, needs.hypotheses);
        grow(&mut self.projected, needs.projected);
        PartialMemory {
            words: &mut self.words,
            sides: &mut self.sides,
            points: &mut self.points,
            cells: &mut self.cells,
            numbers: &mut self.numbers,
            hypotheses: &mut self.hypotheses,
            projected: &mut self.projected,
        }
    }
}
