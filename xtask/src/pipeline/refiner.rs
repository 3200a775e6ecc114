//! Refinement of located poses, with the memory that the core wants lent.

use fluoropose::camera::Camera;
use fluoropose::mask::{Mask, MaskMut, Word, words_needed};
use fluoropose::mesh::Mesh;
use fluoropose::mirror::mirror_pose;
use fluoropose::pose::Pose;
use fluoropose::raster::{Projected, scratch_needed};
use fluoropose::refine::{BorderPixel, RefineError, RefineMemory, Refined, refine};
use fluoropose::verify::unmatched_at;

/// Border pixels that are lent: the outline of an implant in a large frame has some thousands.
const BORDER: usize = 16_384;

/// A part looks symmetric when its mirrored pose leaves at most this part of the mask unmatched.
const SYMMETRIC_SHARE: f64 = 0.15;

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

    /// Refines a pose.
    ///
    /// # Errors
    /// Those of [`refine`].
    pub fn refine(&mut self, mask: &Mask<'_>, start: &Pose) -> Result<Refined, RefineError> {
        let mut memory = RefineMemory {
            projected: &mut self.projected,
            drawn: &mut self.drawn,
            places: &mut self.places,
            border: &mut self.border,
        };
        refine(&self.mesh, &self.camera, mask, start, &mut memory)
    }

    /// Refines the mirror images of a pose, for each axis of the model about which it looks
    /// symmetric from there: those at which the drawn model covers the mask nearly as well.
    pub fn refine_mirrored(&mut self, mask: &Mask<'_>, pose: &Pose) -> Vec<Refined> {
        let middle = self.mesh.bounds().centre;
        let limit = SYMMETRIC_SHARE * mask.area() as f64;
        (0..3)
            .map(|axis| mirror_pose(pose, &middle, axis))
            .filter_map(|mirrored| {
                let (width, height) = (mask.width(), mask.height());
                let mut drawn = MaskMut::new(&mut self.drawn, width, height).ok()?;
                let scratch = &mut self.projected;
                let (mesh, camera) = (&self.mesh, &self.camera);
                let unmatched = unmatched_at(mesh, camera, &mirrored, mask, scratch, &mut drawn);
                let near = unmatched.is_ok_and(|unmatched| unmatched as f64 <= limit);
                near.then(|| self.refine(mask, &mirrored).ok()).flatten()
            })
            .collect()
    }
}
