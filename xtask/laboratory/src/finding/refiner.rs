//! Refinement of poses, with the memory that the core wants lent.

use fluoropose::camera::Camera;
use fluoropose::finder::nearby::{WIDE_DEG, nearby};
use fluoropose::finder::rivals::{RefinedRival, refine_rivals};
use fluoropose::image::silhouette::Silhouette;
use fluoropose::mesh::Model;
use fluoropose::mesh::symmetry::{SymmetryPlane, symmetry_planes};
use fluoropose::pose::Pose;
use fluoropose::pose::covariance::PoseCovariance;
use fluoropose::refine::{
    CameraView, RefineBuffers, RefineError, RefineMemory, RefineOptions, Refined, uncertainty,
};

/// A model to be refined, with working memory that grows with the frames.
pub struct Refiner<'m> {
    model: Model<'m>,
    planes: Vec<SymmetryPlane>,
    options: RefineOptions,
    buffers: RefineBuffers,
}

impl<'m> Refiner<'m> {
    /// A model to be refined.
    pub fn new(model: Model<'m>, options: RefineOptions) -> Self {
        Self {
            model,
            planes: symmetry_planes(model.mesh()).to_vec(),
            options,
            buffers: RefineBuffers::default(),
        }
    }

    /// Refines otherwise from now on.
    pub fn set_options(&mut self, options: RefineOptions) {
        self.options = options;
    }

    /// The working memory for frames of a camera.
    pub fn memory(&mut self, camera: &Camera) -> RefineMemory<'_> {
        self.buffers.borrow(&self.model, camera)
    }

    /// Refines poses; see [`refine_rivals`].
    ///
    /// # Errors
    /// Those of [`refine_rivals`].
    pub fn refine(
        &mut self,
        views: &[CameraView<'_>],
        starts: &[Pose],
    ) -> Result<Vec<RefinedRival>, RefineError> {
        let mut memory = self.buffers.borrow_for(&self.model, views);
        let (model, planes, options) = (&self.model, &self.planes, self.options);
        refine_rivals(model, views, starts, planes, options, &mut memory)
            .map(|found| found.to_vec())
    }

    /// Refines poses without their mirror images.
    ///
    /// # Errors
    /// Those of [`refine_rivals`].
    pub fn refine_as_given(
        &mut self,
        views: &[CameraView<'_>],
        starts: &[Pose],
    ) -> Result<Vec<RefinedRival>, RefineError> {
        let mut memory = self.buffers.borrow_for(&self.model, views);
        let (model, options) = (&self.model, self.options);
        refine_rivals(model, views, starts, &[], options, &mut memory).map(|found| found.to_vec())
    }

    /// Starts round a roughly known pose; see [`nearby`].
    pub fn nearby(
        &mut self,
        camera: &Camera,
        silhouette: &Silhouette<'_>,
        start: &Pose,
    ) -> Vec<Pose> {
        let mut memory = self.buffers.borrow(&self.model, camera);
        nearby(
            &self.model,
            camera,
            silhouette,
            start,
            WIDE_DEG,
            &mut memory,
        )
        .to_vec()
    }

    /// How sure a refined pose is; see [`uncertainty`].
    ///
    /// # Errors
    /// Those of [`uncertainty`].
    pub fn uncertainty(
        &mut self,
        views: &[CameraView<'_>],
        refined: &Refined,
    ) -> Result<Option<PoseCovariance>, RefineError> {
        let mut memory = self.buffers.borrow_for(&self.model, views);
        uncertainty(&self.model, views, refined, &mut memory)
    }

    /// Planes of the model's near-symmetry.
    pub fn planes(&self) -> &[SymmetryPlane] {
        &self.planes
    }
}
