//! Refinement of poses, with the memory that the core wants lent.

use fluoropose::camera::Camera;
use fluoropose::mask::{Word, words_needed};
use fluoropose::mesh::Mesh;
use fluoropose::pose::Pose;
use fluoropose::raster::{Projected, scratch_needed};
use fluoropose::refine::{BorderPixel, RefineError, RefineMemory, View};
use fluoropose::rivals::{RefinedRival, refine_rivals};

/// Border pixels that are lent: the outline of an implant in a large frame has some thousands.
const BORDER: usize = 16_384;

/// A model to be refined, with working memory.
pub struct Refiner<'m> {
    mesh: Mesh<'m>,
    projected: Vec<Projected>,
    drawn: Vec<Word>,
    places: Vec<u16>,
    border: Vec<BorderPixel>,
}

impl<'m> Refiner<'m> {
    /// Working memory for a model and frames as large as those of `cameras`.
    pub fn new(mesh: Mesh<'m>, cameras: &[Camera]) -> Self {
        let largest = |size: fn(usize, usize) -> usize| {
            let sizes = cameras.iter().map(|c| size(c.width(), c.height()));
            sizes.max().unwrap_or(0)
        };
        Self {
            mesh,
            projected: vec![Projected::default(); scratch_needed(&mesh)],
            drawn: vec![0; largest(words_needed)],
            places: vec![0; largest(|width, height| width * height)],
            border: vec![BorderPixel::default(); BORDER],
        }
    }

    /// The working memory, lent.
    pub fn memory(&mut self) -> RefineMemory<'_> {
        RefineMemory {
            projected: &mut self.projected,
            drawn: &mut self.drawn,
            places: &mut self.places,
            border: &mut self.border,
        }
    }

    /// Refines poses; see [`refine_rivals`].
    ///
    /// # Errors
    /// Those of [`refine_rivals`].
    pub fn refine(
        &mut self,
        views: &[View<'_>],
        starts: &[Pose],
    ) -> Result<Vec<RefinedRival>, RefineError> {
        let mesh = self.mesh;
        refine_rivals(&mesh, views, starts, &mut self.memory()).map(|found| found.to_vec())
    }
}
