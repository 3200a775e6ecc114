//! From a mask to its poses by the method asked for.

use anyhow::{Context, Result};
use fluoropose::camera::Camera;
use fluoropose::mask::Mask;
use fluoropose::mesh::Mesh;
use fluoropose::pose::Pose;
use fluoropose::refine::Refined;
use fluoropose::rivals::RefinedRival;
use fluoropose::verify::Verified;
use serde::Serialize;

use super::locator::Locator;
use super::refiner::Refiner;

/// How poses are found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Method {
    /// The best view of the library, interpolated
    #[default]
    Library,
    /// That, then the model's outline brought onto the mask's
    Refined,
}

impl Method {
    /// The word for it in tables.
    pub fn word(self) -> &'static str {
        match self {
            Self::Library => "library",
            Self::Refined => "refined",
        }
    }
}

/// A pose that explains a mask.
#[derive(Clone, Copy, Debug)]
pub struct Answer {
    /// `camera_from_model`, as good as the method makes it.
    pub pose: Pose,
    /// What the library said.
    pub located: Verified,
    /// What refinement made of it, where it was asked for.
    pub refined: Option<Refined>,
}

/// A library, its model and a camera, ready for masks.
pub struct Finder<'l> {
    locator: Locator<'l>,
    refiner: Option<Refiner<'l>>,
    camera: Camera,
}

impl<'l> Finder<'l> {
    /// Opens the bytes of a library of `mesh` for frames of `camera`.
    ///
    /// # Errors
    /// Those of [`Locator::open`].
    pub fn open(bytes: &'l [u8], mesh: Mesh<'l>, camera: Camera, method: Method) -> Result<Self> {
        Ok(Self {
            locator: Locator::open(bytes, mesh)?,
            refiner: (method == Method::Refined).then(|| Refiner::new(mesh, camera)),
            camera,
        })
    }

    /// All poses that explain a mask, best first: by the loss after refinement, or by the
    /// pixels that differ when the model is drawn.
    ///
    /// # Errors
    /// Those of [`Locator::locate`], and of refinement where no rival can be refined.
    pub fn all(&mut self, mask: &Mask<'_>) -> Result<Vec<Answer>> {
        let rivals = self.locator.locate(mask, &self.camera)?;
        let Some(refiner) = &mut self.refiner else {
            return Ok(rivals.iter().map(Answer::unrefined).collect());
        };
        let answers = refiner.refine(mask, &rivals)?;
        Ok(answers.map(Answer::refined).collect())
    }

    /// The best pose of a mask.
    ///
    /// # Errors
    /// Those of [`Self::all`].
    pub fn best(&mut self, mask: &Mask<'_>) -> Result<Answer> {
        let answers = self.all(mask)?;
        answers.first().copied().context("the library has no views")
    }
}

impl Answer {
    fn refined(answer: RefinedRival) -> Self {
        Self {
            pose: answer.refined.pose,
            located: answer.rival,
            refined: Some(answer.refined),
        }
    }

    fn unrefined(located: &Verified) -> Self {
        Self {
            pose: located.located.pose,
            located: *located,
            refined: None,
        }
    }
}
