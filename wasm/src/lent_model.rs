//! The model that a library was made from: rivals are drawn with it, ranked and refined.

use fluoropose::camera::Camera;
use fluoropose::locate::Located;
use fluoropose::mask::{Mask, MaskMut, Word, words_needed};
use fluoropose::mesh::Mesh;
use fluoropose::pose::Pose;
use fluoropose::raster::Projected;
use fluoropose::refine::{BorderPixel, RefineMemory, RefineOptions, View};
use fluoropose::rivals::{RefinedRival, refine_rivals, worth_refining};
use fluoropose::symmetry::{SymmetryPlane, symmetry_planes};
use fluoropose::verify::{Verified, unmatched_at};
use wasm_bindgen::JsError;

use crate::error::sentence;

/// Border pixels that are lent: the outline of an implant in a large frame has some thousands.
const BORDER: usize = 16_384;

/// A pose that explains an outline.
#[derive(Clone, Copy)]
pub(crate) struct Ranked {
    /// What the library said.
    pub(crate) located: Located,
    /// The pose, as good as it is known.
    pub(crate) pose: Pose,
    /// Frame pixels that differ from the outline when the model is drawn there; nothing where it was not, or cannot be.
    pub(crate) drawn: Option<u64>,
    /// What remains between the outlines after refinement, pixels.
    pub(crate) residual_px: Option<f64>,
}

impl Ranked {
    /// A pose of the library, the model not drawn.
    pub(crate) fn undrawn(located: Located) -> Self {
        Self {
            located,
            pose: located.pose,
            drawn: None,
            residual_px: None,
        }
    }
}

/// A model with the working memory to draw and refine it. The memory grows with the first frame and stays.
pub(crate) struct LentModel {
    vertices: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
    /// Planes of its near-symmetry, found with the first refinement.
    planes: Option<Vec<SymmetryPlane>>,
    projected: Vec<Projected>,
    drawn: Vec<Word>,
    places: Vec<u16>,
    border: Vec<BorderPixel>,
}

impl LentModel {
    /// Takes vertices (x, y, z by turns, mm) and triangles (three vertex indices each).
    pub(crate) fn new(vertices: &[f32], triangles: &[u32]) -> Self {
        Self {
            projected: vec![Projected::default(); vertices.len() / 3],
            vertices: vertices.as_chunks().0.to_vec(),
            triangles: triangles.as_chunks().0.to_vec(),
            planes: None,
            drawn: Vec::new(),
            places: Vec::new(),
            border: Vec::new(),
        }
    }

    /// The core's view of the model.
    ///
    /// # Errors
    /// The core's sentence about the vertex or triangle at fault.
    pub(crate) fn mesh(&self) -> Result<Mesh<'_>, JsError> {
        Mesh::new(&self.vertices, &self.triangles).map_err(sentence)
    }

    /// Puts rivals in order by drawing the model at each. A pose that cannot be drawn comes last, without a figure.
    ///
    /// # Errors
    /// The core's sentence about the model.
    pub(crate) fn rank(
        &mut self,
        rivals: Vec<Located>,
        camera: &Camera,
        mask: &Mask<'_>,
    ) -> Result<Vec<Ranked>, JsError> {
        let mut ranked = Vec::with_capacity(rivals.len());
        for located in rivals {
            let drawn = self.draw(&located.pose, camera, mask)?;
            ranked.push(Ranked {
                drawn,
                ..Ranked::undrawn(located)
            });
        }
        ranked.sort_by_key(|ranked| ranked.drawn.unwrap_or(u64::MAX));
        Ok(ranked)
    }

    /// Refines the rivals: the poses by rising loss, each once.
    ///
    /// # Errors
    /// The core's sentence about the model, or why none can be refined.
    pub(crate) fn refine(
        &mut self,
        rivals: Vec<Located>,
        camera: &Camera,
        mask: &Mask<'_>,
    ) -> Result<Vec<Ranked>, JsError> {
        let ranked = self.rank(rivals, camera, mask)?;
        let verified: Vec<Verified> = ranked
            .iter()
            .filter_map(|&Ranked { located, drawn, .. }| {
                drawn.map(|unmatched| Verified { located, unmatched })
            })
            .collect();
        self.places.resize(mask.width() * mask.height(), 0);
        self.border.resize(BORDER, BorderPixel::default());
        let mesh = Mesh::new(&self.vertices, &self.triangles).map_err(sentence)?;
        let mut memory = RefineMemory {
            projected: &mut self.projected,
            drawn: &mut self.drawn,
            places: &mut self.places,
            border: &mut self.border,
        };
        let planes = self
            .planes
            .get_or_insert_with(|| symmetry_planes(&mesh).to_vec());
        let worth = worth_refining(&verified);
        let starts: Vec<Pose> = worth.iter().map(|rival| rival.located.pose).collect();
        let view = View::only(camera, mask);
        let answers = refine_rivals(
            &mesh,
            &[view],
            &starts,
            planes,
            RefineOptions::default(),
            &mut memory,
        )
        .map_err(sentence)?;
        let mut ranked = Vec::with_capacity(answers.len());
        for RefinedRival { start, refined, .. } in answers {
            ranked.push(Ranked {
                located: worth[start].located,
                pose: refined.pose,
                drawn: self.draw(&refined.pose, camera, mask)?,
                residual_px: Some(refined.residual_px),
            });
        }
        Ok(ranked)
    }

    /// Frame pixels that differ from the mask when the model is drawn at a pose; nothing where it cannot be drawn.
    fn draw(
        &mut self,
        pose: &Pose,
        camera: &Camera,
        mask: &Mask<'_>,
    ) -> Result<Option<u64>, JsError> {
        let (width, height) = (mask.width(), mask.height());
        self.drawn.resize(words_needed(width, height), 0);
        let mesh = Mesh::new(&self.vertices, &self.triangles).map_err(sentence)?;
        let mut drawn = MaskMut::new(&mut self.drawn, width, height).map_err(sentence)?;
        let scratch = &mut self.projected;
        Ok(unmatched_at(&mesh, camera, pose, &mask.into(), scratch, &mut drawn).ok())
    }
}
