//! Outlines matched against an open library.

use fluoropose::camera::Camera;
use fluoropose::canonical::reverse;
use fluoropose::contour::{Outline, Point};
use fluoropose::library::Library;
use fluoropose::locate::{Located, Workspace, locate, workspace_needed};
use fluoropose::mask::{Mask, MaskMut, Word, words_needed};
use fluoropose::pose::EulerPose;
use wasm_bindgen::prelude::*;

use crate::calibration::camera;
use crate::error::sentence;
use crate::lent_model::{LentModel, Ranked};
use crate::pose_numbers::{PoseNumbers, to_numbers};

self_cell::self_cell!(
    /// A library with its bytes, checked once.
    struct OpenLibrary {
        owner: Vec<u8>,
        #[covariant]
        dependent: Library,
    }
);

/// Local minima of the score surface that are looked at.
const MINIMA: usize = 4;

/// Poses that are offered: the best and one rival.
const OFFERED: usize = 2;

/// A rival with more than this many times the unmatched pixels of the best is none.
const RIVAL_WITHIN: f64 = 2.0;

/// An open library with the working memory to match against it.
#[wasm_bindgen]
pub struct Matcher {
    library: OpenLibrary,
    model: Option<LentModel>,
    mask: Vec<Word>,
    canonical: Vec<Word>,
    turned: Vec<Word>,
    scores: Vec<u32>,
}

#[wasm_bindgen]
impl Matcher {
    /// Opens a library; its bytes stay in the module's memory.
    ///
    /// # Errors
    /// The core's sentence about what is damaged.
    #[wasm_bindgen(constructor)]
    pub fn new(bytes: Vec<u8>) -> Result<Matcher, JsError> {
        let library = OpenLibrary::try_new(bytes, |bytes| Library::open(bytes).map_err(sentence))?;
        let (words, scores) = workspace_needed(library.borrow_dependent());
        Ok(Self {
            library,
            model: None,
            mask: Vec::new(),
            canonical: vec![0; words],
            turned: vec![0; words],
            scores: vec![0; scores],
        })
    }

    /// Lends the model, so that rival poses are told apart by drawing it at each.
    ///
    /// # Errors
    /// A sentence when the library was made from another model.
    #[wasm_bindgen(js_name = lendModel)]
    pub fn lend_model(&mut self, vertices: &[f32], triangles: &[u32]) -> Result<(), JsError> {
        let model = LentModel::new(vertices, triangles);
        if model.mesh()?.digest() != self.library.borrow_dependent().info().model {
            return Err(JsError::new(
                "The library was made from another model: open the model that belongs to it, or build it again",
            ));
        }
        self.model = Some(model);
        Ok(())
    }

    /// Number of views.
    #[wasm_bindgen(getter)]
    pub fn views(&self) -> usize {
        self.library.borrow_dependent().views()
    }

    /// Side of the canonical frame, pixels.
    #[wasm_bindgen(getter, js_name = canonicalSize)]
    pub fn canonical_size(&self) -> usize {
        self.library.borrow_dependent().info().canonical.size()
    }

    /// Area of every canonical silhouette, pixels.
    #[wasm_bindgen(getter, js_name = canonicalArea)]
    pub fn canonical_area(&self) -> u32 {
        self.library.borrow_dependent().info().canonical.area()
    }

    /// Finds the poses that explain an outline (columns and rows by turns) on a frame of `width` x `height` pixels, seen by
    /// the camera of a calibration text.
    ///
    /// # Errors
    /// The core's sentence about the outline, the calibration or the silhouette.
    #[wasm_bindgen(js_name = matchOutline)]
    pub fn match_outline(
        &mut self,
        outline: &[f64],
        calibration: &str,
        width: u32,
        height: u32,
    ) -> Result<Match, JsError> {
        let camera = camera(calibration, width, height)?;
        let (near, clipped) = self.locate(outline, &camera)?;
        let ranked = match &mut self.model {
            Some(model) => {
                let mask = held(&self.mask, &camera)?;
                let ranked = model.rank(near, &camera, &mask)?;
                within(&ranked, |ranked| {
                    ranked.drawn.map_or(f64::MAX, |count| count as f64)
                })
            }
            None => near.into_iter().map(Ranked::undrawn).collect(),
        };
        Ok(self.offer(&ranked, clipped))
    }

    /// The same, and then brings the model's outline onto this one: the rivals by rising loss, with their residuals. Takes
    /// some twenty times as long. Without the model nothing can be refined, and the answer is that of `match_outline`.
    ///
    /// # Errors
    /// Those of `match_outline`, and the core's sentence when no rival can be refined.
    #[wasm_bindgen(js_name = refineOutline)]
    pub fn refine_outline(
        &mut self,
        outline: &[f64],
        calibration: &str,
        width: u32,
        height: u32,
    ) -> Result<Match, JsError> {
        if self.model.is_none() {
            return self.match_outline(outline, calibration, width, height);
        }
        let camera = camera(calibration, width, height)?;
        let (near, clipped) = self.locate(outline, &camera)?;
        let mask = held(&self.mask, &camera)?;
        let refined = match &mut self.model {
            Some(model) => model.refine(near, &camera, &mask)?,
            None => Vec::new(),
        };
        let near_best = within(&refined, |ranked| ranked.residual_px.unwrap_or(f64::MAX));
        Ok(self.offer(&near_best, clipped))
    }
}

/// The mask of a camera's frames in memory that was filled for it.
fn held<'w>(words: &'w [Word], camera: &Camera) -> Result<Mask<'w>, JsError> {
    Mask::new(words, camera.width(), camera.height()).map_err(sentence)
}

impl Matcher {
    /// Fills the mask with an outline and looks the library through: the poses that come near the best, and whether the
    /// canonical silhouette is clipped.
    fn locate(
        &mut self,
        outline: &[f64],
        camera: &Camera,
    ) -> Result<(Vec<Located>, bool), JsError> {
        let (width, height) = (camera.width(), camera.height());
        let points: Vec<Point> = outline
            .as_chunks()
            .0
            .iter()
            .map(|&[column, row]| Point::new(column, row))
            .collect();
        let outline = Outline::new(&points, width, height).map_err(sentence)?;
        self.mask.resize(words_needed(width, height), 0);
        let mut mask = MaskMut::new(&mut self.mask, width, height).map_err(sentence)?;
        mask.fill_outline(&outline);
        let library = self.library.borrow_dependent();
        let work = Workspace {
            canonical: &mut self.canonical,
            turned: &mut self.turned,
            scores: &mut self.scores,
        };
        let found = locate::<MINIMA>(&mask.into_mask(), camera, library, work).map_err(sentence)?;
        let near = within(&found.poses, |located| f64::from(located.fine.unmatched));
        Ok((near, found.form.clipped))
    }

    fn offer(&self, ranked: &[Ranked], clipped: bool) -> Match {
        let candidates = ranked
            .iter()
            .take(OFFERED)
            .map(|ranked| self.candidate(ranked))
            .collect();
        Match {
            candidates,
            clipped,
        }
    }
}

/// The first of `items` and those that come near it: at most [`RIVAL_WITHIN`] times its score.
fn within<T: Copy>(items: &[T], score: impl Fn(&T) -> f64) -> Vec<T> {
    let limit = items.first().map_or(0.0, &score) * RIVAL_WITHIN;
    items
        .iter()
        .copied()
        .filter(|item| score(item) <= limit)
        .collect()
}

impl Matcher {
    fn candidate(&self, ranked: &Ranked) -> Candidate {
        let located = ranked.located;
        let mut input = self.canonical.clone();
        if located.fine.reversed {
            reverse(&self.canonical, &mut input);
        }
        let library = self.library.borrow_dependent();
        Candidate {
            pose: to_numbers(&EulerPose::from(ranked.pose)),
            unmatched: located.fine.unmatched,
            drawn: ranked.drawn,
            residual_px: ranked.residual_px,
            view: [located.fine.record.x_deg, located.fine.record.y_deg],
            at_border: located.fine.at_border,
            input: input.iter().flat_map(|word| word.to_le_bytes()).collect(),
            library: library.bits(located.view).to_vec(),
        }
    }
}

struct Candidate {
    pose: PoseNumbers,
    unmatched: u32,
    drawn: Option<u64>,
    residual_px: Option<f64>,
    view: [f64; 2],
    at_border: bool,
    input: Vec<u8>,
    library: Vec<u8>,
}

/// What was found for one outline: the best pose first, then its rival, if there is one. Asked beyond `count`, the
/// methods answer nothing.
#[wasm_bindgen]
pub struct Match {
    candidates: Vec<Candidate>,
    clipped: bool,
}

#[wasm_bindgen]
impl Match {
    /// How many candidates there are.
    #[wasm_bindgen(getter)]
    pub fn count(&self) -> usize {
        self.candidates.len()
    }

    /// Whether the canonical silhouette reaches its frame's border, where the score does not see all of it.
    #[wasm_bindgen(getter)]
    pub fn clipped(&self) -> bool {
        self.clipped
    }

    /// x, y, z (mm), z, x and y rotation (degrees).
    pub fn pose(&self, index: usize) -> Option<Vec<f64>> {
        self.candidates
            .get(index)
            .map(|candidate| candidate.pose.to_vec())
    }

    /// Unmatched canonical pixels.
    pub fn unmatched(&self, index: usize) -> Option<u32> {
        self.candidates
            .get(index)
            .map(|candidate| candidate.unmatched)
    }

    /// Frame pixels that differ from the outline when the model is drawn at the pose; nothing without the model.
    pub fn drawn(&self, index: usize) -> Option<f64> {
        let drawn = self.candidates.get(index)?.drawn?;
        Some(drawn as f64)
    }

    /// Root mean square of what remains between the outlines after refinement, pixels; nothing for a pose of the library.
    pub fn residual(&self, index: usize) -> Option<f64> {
        self.candidates.get(index)?.residual_px
    }

    /// Rotations about x and y of the view that fits, between the library's own, degrees.
    pub fn view(&self, index: usize) -> Option<Vec<f64>> {
        self.candidates
            .get(index)
            .map(|candidate| candidate.view.to_vec())
    }

    /// Whether that view lies at the border of the library: the truth may lie beyond it.
    #[wasm_bindgen(js_name = atBorder)]
    pub fn at_border(&self, index: usize) -> Option<bool> {
        self.candidates
            .get(index)
            .map(|candidate| candidate.at_border)
    }

    /// The outline's canonical silhouette, turned as the view: one bit a pixel, row by row, least significant leftmost.
    #[wasm_bindgen(js_name = inputBits)]
    pub fn input_bits(&self, index: usize) -> Option<Vec<u8>> {
        self.candidates
            .get(index)
            .map(|candidate| candidate.input.clone())
    }

    /// The library view's canonical silhouette, in the same form.
    #[wasm_bindgen(js_name = viewBits)]
    pub fn view_bits(&self, index: usize) -> Option<Vec<u8>> {
        self.candidates
            .get(index)
            .map(|candidate| candidate.library.clone())
    }
}
