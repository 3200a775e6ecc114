//! The model that a library was made from: rivals are drawn with it, ranked and refined.

use fluoropose::camera::Camera;
use fluoropose::finder::rivals::{RefinedRival, refine_rivals, worth_refining};
use fluoropose::image::frame::Grey;
use fluoropose::image::mask::{MaskMut, Word, words_needed};
use fluoropose::image::silhouette::Silhouette;
use fluoropose::library::Library;
use fluoropose::locate::Located;
use fluoropose::locate::partial::{PartialBuffers, locate_partial};
use fluoropose::locate::rerank::{Reranked, unmatched_at_pose};
use fluoropose::mesh::mirror::mirror_pose;
use fluoropose::mesh::symmetry::{SymmetryPlane, symmetry_planes};
use fluoropose::mesh::{Model, OwnedModel};
use fluoropose::pose::covariance::Deviations;
use fluoropose::pose::{Pose, geodesic_deg};
use fluoropose::refine::{
    CameraView, Iterate, Polarity, RefineBuffers, RefineMemory, RefineOptions, Refined,
    outline_samples, refine, refine_traced, uncertainty,
};
use fluoropose::render::{Projected, render, scratch_needed};
use wasm_bindgen::JsError;

use fluoropose_page::error::sentence;

/// Poses that are looked for from a part of an outline.
const RIVALS: usize = 6;

/// So far from the outline a pixel is surely inside or outside of an implant that was set by hand, px.
const ASIDE: f64 = 5.0;

/// A pose that explains an outline.
#[derive(Clone, Copy)]
pub(crate) struct Ranked {
    /// What the library said.
    pub(crate) located: Located,
    /// Whether pieces of the outline led to it, so that there is no score of whole silhouettes.
    pub(crate) by_pieces: bool,
    /// The pose, as good as it is known.
    pub(crate) pose: Pose,
    /// Known frame pixels that differ from the outline when the model is drawn there; nothing where it was not, or cannot
    /// be.
    pub(crate) drawn: Option<u64>,
    /// What refinement made of it.
    pub(crate) fit: Option<Fit>,
}

/// A refined pose.
#[derive(Clone, Copy)]
pub(crate) struct Fit {
    pub(crate) refined: Refined,
    /// The pose that it was refined from.
    pub(crate) start: Pose,
}

impl Ranked {
    /// A pose of the library, the model not drawn.
    pub(crate) fn undrawn(located: Located) -> Self {
        Self {
            located,
            by_pieces: false,
            pose: located.pose,
            drawn: None,
            fit: None,
        }
    }

    fn by_pieces(Reranked { located, unmatched }: Reranked) -> Self {
        Self {
            by_pieces: true,
            drawn: Some(unmatched),
            ..Self::undrawn(located)
        }
    }
}

/// A model with the working memory to draw and refine it. The memory grows with the first frame and stays.
pub(crate) struct WorkingModel {
    owned: OwnedModel,
    buffers: RefineBuffers,
    partial: PartialBuffers,
    /// The model as drawn, where nothing is refined.
    drawn: Vec<Word>,
    projected: Vec<Projected>,
    /// Found with the first refinement: it takes some tens of milliseconds.
    planes: Option<Vec<SymmetryPlane>>,
}

impl WorkingModel {
    /// Takes vertices (x, y, z by turns, mm) and triangles (three vertex indices each).
    ///
    /// # Errors
    /// The core's sentence about the vertex or triangle at fault.
    pub(crate) fn new(vertices: Vec<f32>, triangles: Vec<u32>) -> Result<Self, JsError> {
        let owned = OwnedModel::new(vertices, triangles).map_err(sentence)?;
        let projected = scratch_needed(&owned.as_model());
        Ok(Self {
            owned,
            buffers: RefineBuffers::default(),
            partial: PartialBuffers::default(),
            drawn: Vec::new(),
            projected: vec![Projected::default(); projected],
            planes: None,
        })
    }

    /// The core's view of the model.
    pub(crate) fn model(&self) -> Model<'_> {
        self.owned.as_model()
    }

    /// Poses from pieces of the outline, best first.
    ///
    /// # Errors
    /// The core's sentence about the outline.
    pub(crate) fn locate_pieces(
        &mut self,
        library: &Library<'_>,
        camera: &Camera,
        silhouette: &Silhouette<'_>,
    ) -> Result<Vec<Ranked>, JsError> {
        let model = self.owned.as_model();
        let memory = self.partial.borrow(library, camera, &model);
        let found = locate_partial::<RIVALS>(silhouette, camera, library, &model, memory);
        let found = found.map_err(sentence)?;
        Ok(found.into_iter().map(Ranked::by_pieces).collect())
    }

    /// Puts rivals in order by drawing the model at each. A pose that cannot be drawn comes last, without a figure.
    ///
    /// # Errors
    /// The core's sentence about the model.
    pub(crate) fn rank(
        &mut self,
        rivals: Vec<Located>,
        camera: &Camera,
        silhouette: &Silhouette<'_>,
    ) -> Result<Vec<Ranked>, JsError> {
        let mut ranked = Vec::with_capacity(rivals.len());
        for located in rivals {
            let drawn = self.draw(&located.pose, camera, silhouette)?;
            ranked.push(Ranked {
                drawn,
                ..Ranked::undrawn(located)
            });
        }
        ranked.sort_by_key(|ranked| ranked.drawn.unwrap_or(u64::MAX));
        Ok(ranked)
    }

    /// Refines ranked rivals: the poses by rising loss, each once.
    ///
    /// # Errors
    /// The core's sentence about the model, or why none can be refined.
    pub(crate) fn refine(
        &mut self,
        ranked: &[Ranked],
        camera: &Camera,
        silhouette: &Silhouette<'_>,
    ) -> Result<Vec<Ranked>, JsError> {
        let drawn = ranked.iter().filter(|rival| rival.drawn.is_some());
        let drawn: Vec<Ranked> = drawn.copied().collect();
        let verified: Vec<Reranked> = drawn.iter().map(Reranked::from).collect();
        let worth = worth_refining(&verified);
        let starts: Vec<Pose> = worth.iter().map(|rival| rival.located.pose).collect();
        let model = self.owned.as_model();
        let planes = self
            .planes
            .get_or_insert_with(|| symmetry_planes(model.mesh()).to_vec())
            .clone();
        let view = CameraView::only(camera, *silhouette);
        let mut memory = self.buffers.borrow(&model, camera);
        let options = RefineOptions::default();
        let answers = refine_rivals(&model, &[view], &starts, &planes, options, &mut memory)
            .map_err(sentence)?;
        let mut refined = Vec::with_capacity(answers.len());
        for answer in &answers {
            let pose = answer.refined.pose;
            refined.push(Ranked {
                pose,
                drawn: self.draw(&pose, camera, silhouette)?,
                fit: Some(Fit {
                    refined: answer.refined,
                    start: start_of(answer, &answers, &starts, &planes),
                }),
                ..drawn[answer.start]
            });
        }
        Ok(refined)
    }

    /// Calls `with` with the model, its planes of near-symmetry and memory to refine it.
    ///
    /// # Errors
    /// The core's sentence about the model, and that of `with`.
    pub(crate) fn lend<T>(
        &mut self,
        camera: &Camera,
        with: impl FnOnce(&Model<'_>, &[SymmetryPlane], RefineMemory<'_>) -> Result<T, JsError>,
    ) -> Result<T, JsError> {
        let model = self.owned.as_model();
        let planes = self
            .planes
            .get_or_insert_with(|| symmetry_planes(model.mesh()).to_vec());
        with(&model, planes, self.buffers.borrow(&model, camera))
    }

    /// Standard deviations of a refined pose's numbers; nothing where the outline does not determine it.
    ///
    /// # Errors
    /// The core's sentence about the model.
    pub(crate) fn deviations(
        &mut self,
        refined: &Refined,
        camera: &Camera,
        silhouette: &Silhouette<'_>,
    ) -> Result<Option<Deviations>, JsError> {
        self.deviations_in(refined, CameraView::only(camera, *silhouette))
    }

    /// The same for what any camera saw.
    ///
    /// # Errors
    /// The core's sentence about the model.
    pub(crate) fn deviations_in(
        &mut self,
        refined: &Refined,
        view: CameraView<'_>,
    ) -> Result<Option<Deviations>, JsError> {
        let model = self.owned.as_model();
        let mut memory = self.buffers.borrow(&model, view.camera);
        let covariance = uncertainty(&model, &[view], refined, &mut memory).map_err(sentence)?;
        let middle = model.bounds().centre;
        Ok(covariance.map(|covariance| covariance.deviations(&refined.pose, &middle)))
    }

    /// Brings one pose onto what was seen, without rivals or mirror images: somebody chose where to start.
    ///
    /// # Errors
    /// The core's sentence about why it cannot be refined.
    pub(crate) fn refine_from(
        &mut self,
        start: &Pose,
        view: CameraView<'_>,
        options: RefineOptions,
    ) -> Result<Refined, JsError> {
        let model = self.owned.as_model();
        let mut memory = self.buffers.borrow(&model, view.camera);
        refine(&model, &[view], start, options, &mut memory).map_err(sentence)
    }

    /// Whether the implant is darker or brighter than what surrounds it, by the pixels on both sides of its outline.
    ///
    /// # Errors
    /// The core's sentence about a pose at which the model cannot be drawn.
    pub(crate) fn polarity(
        &mut self,
        pose: &Pose,
        camera: &Camera,
        frame: &dyn Grey,
    ) -> Result<Polarity, JsError> {
        let model = self.owned.as_model();
        let mut memory = self.buffers.borrow(&model, camera);
        let mut darker_inside = 0.0;
        outline_samples(&model, camera, pose, &mut memory, |sample| {
            let [right, down] = sample.normal;
            let grey = |away: f64| frame.at(sample.column + away * right, sample.row + away * down);
            if let (Some(inside), Some(outside)) = (grey(-ASIDE), grey(ASIDE)) {
                darker_inside += sample.length * (outside - inside).signum();
            }
        })
        .map_err(sentence)?;
        Ok(if darker_inside < 0.0 {
            Polarity::BrightImplant
        } else {
            Polarity::DarkImplant
        })
    }

    /// The model's silhouette at a pose.
    ///
    /// # Errors
    /// The core's sentence about a pose at which the model cannot be drawn.
    pub(crate) fn drawn_at(&mut self, pose: &Pose, camera: &Camera) -> Result<&[Word], JsError> {
        let (width, height) = (camera.width(), camera.height());
        self.drawn.resize(words_needed(width, height), 0);
        let model = self.owned.as_model();
        let mut mask = MaskMut::new(&mut self.drawn, width, height).map_err(sentence)?;
        render(&model, camera, pose, &mut self.projected, &mut mask).map_err(sentence)?;
        Ok(&self.drawn)
    }

    /// The poses by which refinement goes from `start`.
    ///
    /// # Errors
    /// The core's sentence about why it cannot be refined.
    pub(crate) fn convergence(
        &mut self,
        start: &Pose,
        camera: &Camera,
        silhouette: &Silhouette<'_>,
    ) -> Result<Vec<Iterate>, JsError> {
        let model = self.owned.as_model();
        let view = CameraView::only(camera, *silhouette);
        let mut memory = self.buffers.borrow(&model, camera);
        let mut steps = Vec::new();
        let mut note = |step: &Iterate| steps.push(*step);
        let options = RefineOptions::default();
        refine_traced(&model, &[view], start, options, &mut memory, &mut note).map_err(sentence)?;
        Ok(steps)
    }

    /// Known frame pixels that differ from the silhouette when the model is drawn at a pose; nothing where it cannot be
    /// drawn.
    pub(crate) fn draw(
        &mut self,
        pose: &Pose,
        camera: &Camera,
        silhouette: &Silhouette<'_>,
    ) -> Result<Option<u64>, JsError> {
        let (width, height) = (camera.width(), camera.height());
        self.drawn.resize(words_needed(width, height), 0);
        let model = self.owned.as_model();
        let mut drawn = MaskMut::new(&mut self.drawn, width, height).map_err(sentence)?;
        Ok(unmatched_at_pose(
            &model,
            camera,
            pose,
            silhouette,
            &mut self.projected,
            &mut drawn,
        )
        .ok())
    }
}

impl From<&Ranked> for Reranked {
    fn from(ranked: &Ranked) -> Self {
        Self {
            located: ranked.located,
            unmatched: ranked.drawn.unwrap_or(u64::MAX),
        }
    }
}

/// The pose that an answer was refined from. Of a mirrored one it is not told: it is the mirror image of another answer,
/// and of all those the nearest.
fn start_of(
    answer: &RefinedRival,
    answers: &[RefinedRival],
    starts: &[Pose],
    planes: &[SymmetryPlane],
) -> Pose {
    let own = starts[answer.start];
    if !answer.mirrored {
        return own;
    }
    let turn = |pose: &Pose| geodesic_deg(&pose.rotation, &answer.refined.pose.rotation);
    let others = answers.iter().filter(|other| !other.mirrored);
    others
        .flat_map(|other| {
            planes
                .iter()
                .map(|plane| mirror_pose(&other.refined.pose, plane))
        })
        .min_by(|a, b| turn(a).total_cmp(&turn(b)))
        .unwrap_or(own)
}
