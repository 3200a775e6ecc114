//! From what a camera saw to the poses that explain it, by the method asked for.

use anyhow::{Context, Result};
use fluoropose::camera::Camera;
use fluoropose::finder::rivals::{RefinedRival, worth_refining};
use fluoropose::image::silhouette::Silhouette;
use fluoropose::locate::rerank::Reranked;
use fluoropose::mesh::Model;
use fluoropose::pose::Pose;
use fluoropose::pose::covariance::PoseCovariance;
use fluoropose::refine::{CameraView, ImageTarget, Polarity, RefineOptions, Refined};
use serde::Serialize;

use super::locator::Locator;
use super::refiner::Refiner;
use crate::sequence::Seen;

/// How poses are found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Method {
    /// The best view of the library, interpolated
    #[default]
    Library,
    /// That, then the model's outline brought onto the mask's
    Refined,
    /// That, then onto the edges of the grey frame
    Image,
}

impl Method {
    /// The word for it in tables.
    pub fn word(self) -> &'static str {
        match self {
            Self::Library => "library",
            Self::Refined => "refined",
            Self::Image => "image",
        }
    }
}

/// How edges are looked for and understood.
#[derive(clap::Args, Clone, Copy, Debug, Default)]
pub struct EdgeOptions {
    /// The implant is brighter than what surrounds it, as on a radiograph's film (method image)
    #[arg(long)]
    pub bright_implant: bool,
    /// Estimate with each pose how far the edges lie outside the model's outline, where the data
    /// can tell that from depth (methods refined and image)
    #[arg(long)]
    pub edge_offset: bool,
}

impl EdgeOptions {
    fn polarity(self) -> Polarity {
        if self.bright_implant {
            Polarity::BrightImplant
        } else {
            Polarity::DarkImplant
        }
    }
}

/// Poses of an outline that are brought onto the grey frame: the best of them.
const ON_IMAGE: usize = 3;

/// A frame as a target of refinement; what is unknown of the silhouette is unknown there.
///
/// # Errors
/// Where there is no frame.
fn image<'a>(seen: &Seen<'a>, edges: EdgeOptions) -> Result<ImageTarget<'a>> {
    let frame = seen
        .frame
        .context("the method image needs the grey frames, not only masks")?;
    Ok(ImageTarget {
        frame,
        unknown: seen.silhouette.unknown(),
        polarity: edges.polarity(),
    })
}

/// A pose that explains a frame.
#[derive(Clone, Copy, Debug)]
pub struct Answer {
    /// `camera_from_model`, as good as the method makes it.
    pub pose: Pose,
    /// What the library said.
    pub located: Reranked,
    /// What refinement made of it, where it was asked for.
    pub refined: Option<Refined>,
    /// How sure the refined pose is.
    pub covariance: Option<PoseCovariance>,
}

/// A library, its model and a camera, ready for frames.
pub struct Finder<'l> {
    locator: Locator<'l>,
    refiner: Refiner<'l>,
    camera: Camera,
    method: Method,
    edges: EdgeOptions,
}

impl<'l> Finder<'l> {
    /// Opens the bytes of a library of `mesh` for frames of `camera`.
    ///
    /// # Errors
    /// Those of [`Locator::open`].
    pub fn open(bytes: &'l [u8], mesh: Model<'l>, camera: Camera, method: Method) -> Result<Self> {
        Ok(Self {
            locator: Locator::open(bytes, mesh)?,
            refiner: Refiner::new(mesh, RefineOptions::default()),
            camera,
            method,
            edges: EdgeOptions::default(),
        })
    }

    /// The same, with edges looked for otherwise.
    pub fn with_edges(mut self, edges: EdgeOptions) -> Self {
        self.edges = edges;
        self.refiner.set_options(RefineOptions {
            edge_offset: edges.edge_offset,
            ..RefineOptions::default()
        });
        self
    }

    /// All poses that explain a frame, best first: by the loss after refinement, or by the
    /// pixels that differ when the model is drawn.
    ///
    /// # Errors
    /// Those of [`Locator::locate`], of refinement where no rival can be refined, and where the
    /// method needs a frame and there is none.
    pub fn all(&mut self, seen: &Seen<'_>) -> Result<Vec<Answer>> {
        let rivals = self.locator.locate(&seen.silhouette, &self.camera)?;
        if self.method == Method::Library {
            return Ok(rivals.iter().map(Answer::unrefined).collect());
        }
        let camera = self.camera;
        let worth = worth_refining(&rivals);
        let starts: Vec<Pose> = worth.iter().map(|rival| rival.located.pose).collect();
        let view = CameraView::only(&camera, seen.silhouette);
        let refined = self.refiner.refine(&[view], &starts)?;
        if self.method == Method::Refined {
            return self.answers(&view, &refined, |found| worth[found.start]);
        }
        // Their mirror images are among them.
        let poses = refined
            .iter()
            .take(ON_IMAGE)
            .map(|found| found.refined.pose);
        let poses: Vec<Pose> = poses.collect();
        let on_image = self.refine_on_image(seen, &poses)?;
        let view = CameraView::only(&camera, image(seen, self.edges)?);
        self.answers(&view, &on_image, |found| worth[refined[found.start].start])
    }

    /// Refined poses with what led to them and how sure they are.
    fn answers(
        &mut self,
        view: &CameraView<'_>,
        refined: &[RefinedRival],
        located: impl Fn(&RefinedRival) -> Reranked,
    ) -> Result<Vec<Answer>> {
        let answer = |found: &RefinedRival| {
            let covariance = self.refiner.uncertainty(&[*view], &found.refined)?;
            Ok(Answer {
                pose: found.refined.pose,
                located: located(found),
                refined: Some(found.refined),
                covariance,
            })
        };
        refined.iter().map(answer).collect()
    }

    /// Refines poses against what several cameras saw, without the library; best first.
    ///
    /// # Errors
    /// Where none can be refined.
    pub fn refine_views(
        &mut self,
        views: &[CameraView<'_>],
        starts: &[Pose],
    ) -> Result<Vec<(Refined, Option<PoseCovariance>)>> {
        let found = self.refiner.refine(views, starts)?;
        let sure = |found: &RefinedRival| {
            let covariance = self.refiner.uncertainty(views, &found.refined)?;
            Ok((found.refined, covariance))
        };
        found.iter().map(sure).collect()
    }

    /// Starts round a pose that is only roughly known; see [`fluoropose::finder::nearby::nearby`].
    pub fn nearby(&mut self, silhouette: &Silhouette<'_>, start: &Pose) -> Vec<Pose> {
        let camera = self.camera;
        self.refiner.nearby(&camera, silhouette, start)
    }

    /// Brings poses onto the edges of the frame; best first.
    ///
    /// # Errors
    /// Where there is no frame, and where none can be refined.
    pub fn refine_on_image(
        &mut self,
        seen: &Seen<'_>,
        starts: &[Pose],
    ) -> Result<Vec<RefinedRival>> {
        let view = CameraView::only(&self.camera, image(seen, self.edges)?);
        Ok(self.refiner.refine_as_given(&[view], starts)?)
    }

    /// The best pose of a frame.
    ///
    /// # Errors
    /// Those of [`Self::all`].
    pub fn best(&mut self, seen: &Seen<'_>) -> Result<Answer> {
        let answers = self.all(seen)?;
        answers.first().copied().context("the library has no views")
    }
}

impl Answer {
    fn unrefined(located: &Reranked) -> Self {
        Self {
            pose: located.located.pose,
            located: *located,
            refined: None,
            covariance: None,
        }
    }
}
