//! From a mask to its poses by the method asked for.

use anyhow::{Context, Result};
use fluoropose::camera::Camera;
use fluoropose::mask::Mask;
use fluoropose::mesh::Mesh;
use fluoropose::pose::{Pose, geodesic_deg};
use fluoropose::refine::Refined;
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

/// Rivals are refined when the model drawn at them leaves at most this many times the unmatched
/// pixels of the best: the library stage is some pixels off, so near rivals are still open.
const WORTH_REFINING: f64 = 4.0;

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
        let least = rivals.first().map_or(0, |best| best.unmatched);
        let limit = WORTH_REFINING * least as f64;
        let worth = |rival: &Verified| rival.unmatched as f64 <= limit;
        let mut answers: Vec<Answer> = Vec::new();
        let mut failure = None;
        for rival in rivals.iter().filter(|rival| worth(rival)) {
            match refiner.refine(mask, &rival.located.pose) {
                Ok(refined) => answers.push(Answer::refined(rival, refined)),
                Err(error) => failure = Some(error),
            }
        }
        // The mirror image of a pose may lie between the same views and be no rival of its own.
        for answer in answers.clone() {
            let mirrored = refiner.refine_mirrored(mask, &answer.pose);
            answers.extend(
                mirrored
                    .into_iter()
                    .map(|refined| Answer::refined(&answer.located, refined)),
            );
        }
        match (answers.is_empty(), failure) {
            (true, Some(error)) => Err(error.into()),
            _ => Ok(distinct(answers)),
        }
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

/// Poses by rising loss, each once: of poses nearer to each other than this, degrees, the best.
const SAME_DEG: f64 = 0.5;

fn distinct(mut answers: Vec<Answer>) -> Vec<Answer> {
    let loss = |answer: &Answer| answer.refined.map_or(f64::MAX, |refined| refined.loss);
    answers.sort_by(|a, b| loss(a).total_cmp(&loss(b)));
    let mut kept: Vec<Answer> = Vec::new();
    for answer in answers {
        let same =
            |other: &Answer| geodesic_deg(&other.pose.rotation, &answer.pose.rotation) < SAME_DEG;
        if !kept.iter().any(same) {
            kept.push(answer);
        }
    }
    kept
}

impl Answer {
    fn refined(located: &Verified, refined: Refined) -> Self {
        Self {
            pose: refined.pose,
            located: *located,
            refined: Some(refined),
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
