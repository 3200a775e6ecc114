//! Refinement of poses, with the memory that the core wants lent.

use fluoropose::camera::Camera;
use fluoropose::covariance::PoseCovariance;
use fluoropose::mask::{Word, words_needed};
use fluoropose::mesh::Mesh;
use fluoropose::nearby::{WIDE_DEG, nearby};
use fluoropose::pose::Pose;
use fluoropose::raster::{Projected, scratch_needed};
use fluoropose::refine::{
    BorderPixel, RefineError, RefineMemory, RefineOptions, Refined, View, uncertainty,
};
use fluoropose::rivals::{RefinedRival, refine_rivals};
use fluoropose::silhouette::Silhouette;
use fluoropose::symmetry::{SymmetryPlane, symmetry_planes};

/// Border pixels that are lent: the outline of an implant in a large frame has some thousands.
const BORDER: usize = 16_384;

/// A model to be refined, with working memory.
pub struct Refiner<'m> {
    mesh: Mesh<'m>,
    planes: Vec<SymmetryPlane>,
    options: RefineOptions,
    projected: Vec<Projected>,
    drawn: Vec<Word>,
    places: Vec<u16>,
    border: Vec<BorderPixel>,
}

impl<'m> Refiner<'m> {
    /// Working memory for a model and frames as large as those of `cameras`.
    pub fn new(mesh: Mesh<'m>, cameras: &[Camera], options: RefineOptions) -> Self {
        let largest = |size: fn(usize, usize) -> usize| {
            let sizes = cameras.iter().map(|c| size(c.width(), c.height()));
            sizes.max().unwrap_or(0)
        };
        Self {
            mesh,
            planes: symmetry_planes(&mesh).to_vec(),
            options,
            projected: vec![Projected::default(); scratch_needed(&mesh)],
            drawn: vec![0; largest(words_needed)],
            places: vec![0; largest(|width, height| width * height)],
            border: vec![BorderPixel::default(); BORDER],
        }
    }

    /// Makes room for frames of another camera.
    pub fn make_room(&mut self, camera: &Camera) {
        let (width, height) = (camera.width(), camera.height());
        let words = self.drawn.len().max(words_needed(width, height));
        self.drawn.resize(words, 0);
        let places = self.places.len().max(width * height);
        self.places.resize(places, 0);
    }

    /// Refines otherwise from now on.
    pub fn set_options(&mut self, options: RefineOptions) {
        self.options = options;
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
        let (mesh, planes, options) = (self.mesh, self.planes.clone(), self.options);
        refine_rivals(&mesh, views, starts, &planes, options, &mut self.memory())
            .map(|found| found.to_vec())
    }

    /// Refines poses without their mirror images.
    ///
    /// # Errors
    /// Those of [`refine_rivals`].
    pub fn refine_as_given(
        &mut self,
        views: &[View<'_>],
        starts: &[Pose],
    ) -> Result<Vec<RefinedRival>, RefineError> {
        let (mesh, options) = (self.mesh, self.options);
        refine_rivals(&mesh, views, starts, &[], options, &mut self.memory())
            .map(|found| found.to_vec())
    }

    /// Starts round a roughly known pose; see [`nearby`].
    pub fn nearby(
        &mut self,
        camera: &Camera,
        silhouette: &Silhouette<'_>,
        start: &Pose,
    ) -> Vec<Pose> {
        let mesh = self.mesh;
        nearby(
            &mesh,
            camera,
            silhouette,
            start,
            WIDE_DEG,
            &mut self.memory(),
        )
        .to_vec()
    }

    /// How sure a refined pose is; see [`uncertainty`].
    ///
    /// # Errors
    /// Those of [`uncertainty`].
    pub fn uncertainty(
        &mut self,
        views: &[View<'_>],
        refined: &Refined,
    ) -> Result<Option<PoseCovariance>, RefineError> {
        let mesh = self.mesh;
        uncertainty(&mesh, views, refined, &mut self.memory())
    }

    /// Planes of the model's near-symmetry.
    pub fn planes(&self) -> &[SymmetryPlane] {
        &self.planes
    }
}
