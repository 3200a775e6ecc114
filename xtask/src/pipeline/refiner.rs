//! Refinement of located poses, with the memory that the core wants lent.

use fluoropose::camera::Camera;
use fluoropose::mask::{Mask, Word, words_needed};
use fluoropose::mesh::Mesh;
use fluoropose::raster::{Projected, scratch_needed};
use fluoropose::refine::{BorderPixel, RefineError, RefineMemory};
use fluoropose::rivals::{RefinedRival, refine_rivals};
use fluoropose::verify::Verified;

/// Border pixels that are lent: the outline of an implant in a large frame has some thousands.
const BORDER: usize = 16_384;

/// A model to be refined in frames of one camera.
pub struct Refiner<'m> {
    mesh: Mesh<'m>,
    camera: Camera,
    projected: Vec<Projected>,
    drawn: Vec<Word>,
    places: Vec<u16>,
    border: Vec<BorderPixel>,
}

impl<'m> Refiner<'m> {
    /// Working memory for a model and a camera.
    pub fn new(mesh: Mesh<'m>, camera: Camera) -> Self {
        let (width, height) = (camera.width(), camera.height());
        Self {
            mesh,
            camera,
            projected: vec![Projected::default(); scratch_needed(&mesh)],
            drawn: vec![0; words_needed(width, height)],
            places: vec![0; width * height],
            border: vec![BorderPixel::default(); BORDER],
        }
    }

    /// Refines the rivals that explain a mask; see [`refine_rivals`].
    ///
    /// # Errors
    /// Those of [`refine_rivals`].
    pub fn refine(
        &mut self,
        mask: &Mask<'_>,
        rivals: &[Verified],
    ) -> Result<impl Iterator<Item = RefinedRival>, RefineError> {
        let mut memory = RefineMemory {
            projected: &mut self.projected,
            drawn: &mut self.drawn,
            places: &mut self.places,
            border: &mut self.border,
        };
        refine_rivals(&self.mesh, &self.camera, mask, rivals, &mut memory)
            .map(IntoIterator::into_iter)
    }
}
