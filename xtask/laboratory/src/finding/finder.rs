//! From what a camera saw to the poses that explain it, by the method asked for.

use anyhow::{Context, Result, ensure};
use clap::ValueEnum;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use fluoropose::camera::Camera;
use fluoropose::film::FilmModel;
use fluoropose::finder::nearby::{WIDE_DEG, nearby};
use fluoropose::finder::rivals::{RefinedRival, refine_rivals};
use fluoropose::finder::{
    Component, FindError, FinderBuffers, FirstPoses, Found, Goal, find, first_poses,
};
use fluoropose::image::silhouette::Silhouette;
use fluoropose::library::Library;
use fluoropose::mesh::Model;
use fluoropose::mesh::symmetry::{SymmetryPlane, symmetry_planes};
use fluoropose::pose::Pose;
use fluoropose::pose::covariance::PoseCovariance;
use fluoropose::refine::{
    CameraView, Fit, ImageTarget, RefineOptions, Refined, fit_at, uncertainty,
};
use serde::Serialize;

use crate::options::Shown;
use crate::progress::Stop;
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
    /// Reads those that need no grey frames.
    pub fn of_masks() -> impl TypedValueParser<Value = Self> {
        let all = Self::value_variants().iter();
        let words = all
            .filter(|method| **method != Self::Image)
            .filter_map(ValueEnum::to_possible_value);
        PossibleValuesParser::new(words)
            .map(|word| Self::from_str(&word, false).unwrap_or_default())
    }

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
    /// How frames show metal (method image).
    #[command(flatten)]
    pub shown: Shown,
    /// Estimate with each pose how far the edges lie outside the model's outline, where the data
    /// can tell that from depth (methods refined and image)
    #[arg(long)]
    pub edge_offset: bool,
}

impl EdgeOptions {
    /// Whether a method looks at edges as they are asked for.
    ///
    /// # Errors
    /// Names the option that it has no use for.
    pub fn check(&self, method: Method) -> Result<()> {
        ensure!(
            method == Method::Image || self.shown.stated().is_none(),
            "--bright-implant and --dark-implant say how grey frames show metal: for --method image, not {}",
            method.word()
        );
        ensure!(
            method != Method::Library || !self.edge_offset,
            "--edge-offset is estimated by --method refined and image, not library"
        );
        Ok(())
    }
}

/// A frame as a target of refinement; what is unknown of the silhouette is unknown there.
///
/// # Errors
/// Where there is no frame.
pub fn image<'a>(
    seen: &Seen<'a>,
    edges: EdgeOptions,
    film: Option<FilmModel>,
) -> Result<ImageTarget<'a>> {
    let frame = seen
        .frame
        .context("the method image needs the grey frames, not only masks")?;
    Ok(ImageTarget {
        frame,
        unknown: seen.silhouette.unknown(),
        polarity: edges.shown.stated().unwrap_or_default(),
        film,
    })
}

/// A library, its model and a camera, ready for frames. A copy has working memory of its own.
#[derive(Clone)]
pub struct Finder<'l> {
    library: Library<'l>,
    model: Model<'l>,
    planes: Vec<SymmetryPlane>,
    camera: Camera,
    method: Method,
    edges: EdgeOptions,
    stop: Stop,
    buffers: FinderBuffers,
}

impl<'l> Finder<'l> {
    /// Opens the bytes of a library of `model` for frames of `camera`.
    ///
    /// # Errors
    /// Those of [`Library::open`], and when the library was made from another model.
    pub fn open(bytes: &'l [u8], model: Model<'l>, camera: Camera, method: Method) -> Result<Self> {
        let library = Library::open(bytes)?;
        if library.info().model != model.digest() {
            return Err(FindError::OtherModel.into());
        }
        Ok(Self {
            library,
            planes: symmetry_planes(model.mesh()).to_vec(),
            model,
            camera,
            method,
            edges: EdgeOptions::default(),
            stop: Stop::default(),
            buffers: FinderBuffers::default(),
        })
    }

    /// The model.
    pub fn model(&self) -> Model<'l> {
        self.model
    }

    /// The same, by another method.
    pub fn with_method(mut self, method: Method) -> Self {
        self.method = method;
        self
    }

    /// The same, with edges looked for otherwise.
    pub fn with_edges(mut self, edges: EdgeOptions) -> Self {
        self.edges = edges;
        self
    }

    /// The same, which ends with an error in each frame that comes after a wish to stop.
    pub fn stopped_by(mut self, stop: Stop) -> Self {
        self.stop = stop;
        self
    }

    fn options(&self) -> RefineOptions {
        RefineOptions {
            edge_offset: self.edges.edge_offset,
            ..RefineOptions::default()
        }
    }

    /// All poses that explain a frame, best first; see [`find`].
    ///
    /// # Errors
    /// Those of [`find`], where the method needs a frame and there is none, and where the work was to stop.
    pub fn all(&mut self, seen: &Seen<'_>) -> Result<Found> {
        self.stop.check()?;
        let goal = match self.method {
            Method::Library => Goal::Library,
            Method::Refined => Goal::Outline,
            Method::Image => Goal::Image(image(seen, self.edges, None)?),
        };
        let options = self.options();
        let component = Component {
            library: &self.library,
            model: &self.model,
            planes: &self.planes,
        };
        let kernels = fluoropose_kernels::fastest();
        let mut memory = self.buffers.borrow(&component, &self.camera, kernels);
        let silhouette = &seen.silhouette;
        Ok(find(
            &component,
            &self.camera,
            silhouette,
            goal,
            options,
            &mut memory,
        )?)
    }

    /// First poses of a frame; see [`first_poses`].
    ///
    /// # Errors
    /// Those of [`first_poses`].
    pub fn first(&mut self, seen: &Seen<'_>) -> Result<FirstPoses> {
        let component = Component {
            library: &self.library,
            model: &self.model,
            planes: &self.planes,
        };
        let kernels = fluoropose_kernels::fastest();
        let mut memory = self.buffers.borrow(&component, &self.camera, kernels);
        Ok(first_poses(
            &component,
            &self.camera,
            &seen.silhouette,
            &mut memory,
        )?)
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
        let options = self.options();
        let model = &self.model;
        let mut memory = self.buffers.refine().borrow_for(model, views);
        let found = refine_rivals(model, views, starts, &self.planes, options, &mut memory)?;
        let mut sure = |found: &RefinedRival| {
            let covariance = uncertainty(model, views, &found.refined, &mut memory)?;
            Ok((found.refined, covariance))
        };
        found.iter().map(&mut sure).collect()
    }

    /// How well a pose fits what several cameras saw, of all together.
    ///
    /// # Errors
    /// Where the model cannot be drawn there.
    pub fn fit_views(&mut self, views: &[CameraView<'_>], pose: &Pose) -> Result<Fit> {
        let mut memory = self.buffers.refine().borrow_for(&self.model, views);
        Ok(fit_at(&self.model, views, pose, &mut memory)?)
    }

    /// Starts round a pose that is only roughly known; see [`nearby`].
    pub fn nearby(&mut self, silhouette: &Silhouette<'_>, start: &Pose) -> Vec<Pose> {
        let (model, camera) = (&self.model, &self.camera);
        let mut memory = self.buffers.refine().borrow(model, camera);
        nearby(model, camera, silhouette, start, WIDE_DEG, &mut memory).to_vec()
    }
}
