//! Outlines matched against an open library.

mod answer;
mod follow;
mod from_here;
mod hand_verdict;
mod landscape;
mod nearest;
mod on_frame;
mod one_click;
mod readings;

pub use answer::OneClickAnswer;
pub use from_here::{HandFit, HiddenPixels};
pub use hand_verdict::HandVerdict;
pub use landscape::{Landscape, ViewPose};
pub use nearest::{Canonical, NearestView};
pub use one_click::OneClick;

use fluoropose::camera::Camera;
use fluoropose::canonical::reverse;
use fluoropose::film::FilmModel;
use fluoropose::finder::{FinderBuffers, Found, Goal, Verdict};
use fluoropose::image::mask::{Mask, Word};
use fluoropose::image::silhouette::Silhouette;
use fluoropose::library::Library;
use fluoropose::locate::{Located, locate};
use fluoropose::pose::{EulerPose, Pose};
use fluoropose::refine::{CameraView, ImageTarget, Polarity, polarity_across};
use fluoropose::search::kernels::Kernels;
use wasm_bindgen::prelude::*;

use crate::anatomy::ShapeAxes;
use crate::choice::{Chosen, Surroundings};
use crate::film::film_model;
use crate::found::{Candidate, Match};
use crate::squares::{look_in_squares, of_pixels};
use crate::working_model::{Ranked, WorkingModel};
use fluoropose_page::error::sentence;
use fluoropose_page::frame_image::FrameImage;
use fluoropose_page::pose_numbers::{from_numbers, to_numbers};
use fluoropose_page::traced::Traced;

self_cell::self_cell!(
    /// A library with its bytes, checked once.
    pub(crate) struct OpenLibrary {
        owner: Vec<u8>,
        #[covariant]
        dependent: Library,
    }
);

impl OpenLibrary {
    /// # Errors
    /// The core's sentence about what is damaged.
    pub(crate) fn of(bytes: Vec<u8>) -> Result<Self, JsError> {
        Self::try_new(bytes, |bytes| Library::open(bytes).map_err(sentence))
    }
}

/// A frame whose film is read in squares of pixels.
struct Squares<'f> {
    frame: &'f FrameImage,
    polarity: Polarity,
    film: FilmModel,
}

impl Squares<'_> {
    /// Brings what was found in the frame's own pixels to where its film puts the edges.
    ///
    /// # Errors
    /// The core's sentence about why none can be corrected.
    fn correct(
        &self,
        found: &mut Found,
        model: &mut WorkingModel,
        camera: &Camera,
        silhouette: &Silhouette<'_>,
    ) -> Result<(), JsError> {
        let side = self.film.constants.square_px;
        let unknown = silhouette.unknown().map(Mask::words);
        look_in_squares(
            side,
            self.frame,
            camera,
            unknown,
            |frame, camera, unknown| {
                let image = ImageTarget {
                    frame,
                    unknown,
                    polarity: self.polarity,
                    film: Some(self.film),
                };
                let view = CameraView::only(camera, image);
                model.correct_found(found, view)
            },
        )
    }
}

/// Local minima of the score surface that are looked at without a model.
const MINIMA: usize = 4;

/// Poses that are offered at most: the best, the rival that nothing ruled out, and the one that was ruled out last.
const OFFERED: usize = 3;

/// A rival with more than this many times the unmatched pixels, or the residual, of the best is none.
const RIVAL_WITHIN: f64 = 2.0;

/// An open library with the working memory to match against it.
#[wasm_bindgen]
pub struct Matcher {
    library: OpenLibrary,
    model: Option<WorkingModel>,
    /// While there is no model, which has memory of its own.
    buffers: FinderBuffers,
}

#[wasm_bindgen]
impl Matcher {
    /// Opens a library; its bytes stay in the module's memory.
    ///
    /// # Errors
    /// The core's sentence about what is damaged.
    #[wasm_bindgen(constructor)]
    pub fn new(bytes: Vec<u8>) -> Result<Matcher, JsError> {
        Ok(Self {
            library: OpenLibrary::of(bytes)?,
            model: None,
            buffers: FinderBuffers::default(),
        })
    }

    /// Lends the model, so that rival poses are told apart by drawing it at each.
    ///
    /// # Errors
    /// A sentence when the library was made from another model.
    #[wasm_bindgen(js_name = takeModel)]
    pub fn take_model(&mut self, vertices: Vec<f32>, triangles: Vec<u32>) -> Result<(), JsError> {
        let model = WorkingModel::new(vertices, triangles)?;
        if model.model().digest() != self.library.borrow_dependent().info().model {
            return Err(JsError::new(
                "The library was made from another model: open the model that belongs to it, or build it again",
            ));
        }
        self.model = Some(model);
        Ok(())
    }

    /// What a person should know of the model that was lent, in sentences without their full stops: holes, a size that is no
    /// knee component's.
    #[wasm_bindgen(getter)]
    pub fn remarks(&self) -> Vec<String> {
        let model = self.model.as_ref();
        model.map_or_else(Vec::new, WorkingModel::remarks)
    }

    /// What the shape of the model that was lent tells of its axes, as a femoral component's or a tray's; nothing without a model.
    pub fn axes(&mut self, femoral: bool) -> Option<ShapeAxes> {
        self.model.as_mut().map(|model| model.axes(femoral))
    }

    /// A copy of the library's bytes.
    #[wasm_bindgen(getter)]
    pub fn bytes(&self) -> Vec<u8> {
        self.library.borrow_owner().clone()
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

    /// Finds the poses that explain an outline, as the library has them. Where a part of it is marked unknown or cut off
    /// by the frame, pieces of it lead to them, which needs the model.
    ///
    /// # Errors
    /// The core's sentence about the silhouette.
    #[wasm_bindgen(js_name = matchOutline)]
    pub fn match_outline(&mut self, traced: &Traced) -> Result<Match, JsError> {
        traced.look(|silhouette| {
            let located = self.locate(traced, silhouette)?;
            let score = |ranked: &Ranked| ranked.drawn.map_or(f64::MAX, |count| count as f64);
            let near = within(&located.ranked, score);
            let candidates = near.iter().take(OFFERED).map(|one| self.candidate(one));
            Ok(Match {
                candidates: candidates.collect(),
                compared: located.ranked.len(),
                clipped: located.clipped,
                partial: located.partial,
                chosen: None,
            })
        })
    }

    /// The same, and then brings the model's outline onto this one. The pose that is chosen comes first, then its rival:
    /// the next by misfit, where that is at most twice the least. Takes some twenty times as long. Without the model
    /// nothing can be refined, and the answer is that of `match_outline`.
    ///
    /// # Errors
    /// Those of `match_outline`, and the core's sentence when no rival can be refined.
    #[wasm_bindgen(js_name = refineOutline)]
    pub fn refine_outline(
        &mut self,
        traced: &Traced,
        around: &Surroundings,
    ) -> Result<Match, JsError> {
        self.refine(traced, Goal::Outline, None, around)
    }

    /// The same, and then brings the poses onto the edges of the grey frame that was traced. `film` is what the film makes of the
    /// component, as `FilmFacts.model` gives it, or empty: then depth is uncertain by millimetres. Where it is not said whether metal is
    /// brighter than what surrounds it, the frame tells it.
    ///
    /// # Errors
    /// Those of `refine_outline`, and a sentence about the film.
    #[wasm_bindgen(js_name = refineImage)]
    pub fn refine_image(
        &mut self,
        traced: &Traced,
        frame: &FrameImage,
        film: &[f64],
        bright_implant: Option<bool>,
        around: &Surroundings,
    ) -> Result<Match, JsError> {
        let film = film_model(film)?;
        let whole = frame;
        frame.look(|frame| {
            traced.look(|silhouette| {
                let polarity = bright_implant
                    .map_or_else(|| polarity_across(frame, silhouette.mask()), Polarity::of);
                let image = ImageTarget {
                    frame,
                    // What hides a side has edges of its own.
                    unknown: silhouette.unknown(),
                    polarity,
                    film: of_pixels(film),
                };
                let squares = film.filter(|film| film.constants.square_px > 1);
                let squares = squares.map(|film| Squares {
                    frame: whole,
                    polarity,
                    film,
                });
                self.refine(traced, Goal::Image(image), squares, around)
            })
        })
    }

    /// The poses by which refinement goes from a start (six numbers) onto an outline, ten numbers each: stage, times the
    /// model was drawn so far, loss (square pixels, each stage has its own scale), residual (pixels), x, y, z (mm), z, x
    /// and y rotation (degrees). Empty without the model.
    ///
    /// # Errors
    /// The core's sentence about why it cannot be refined.
    pub fn convergence(&mut self, traced: &Traced, start: &[f64]) -> Result<Vec<f64>, JsError> {
        let start = Pose::from(from_numbers(start)?);
        let Some(model) = &mut self.model else {
            return Ok(Vec::new());
        };
        let steps =
            traced.look(|silhouette| model.convergence(&start, &traced.camera(), silhouette))?;
        Ok(steps
            .iter()
            .flat_map(|step| {
                let head = [
                    step.stage as f64,
                    step.renders as f64,
                    step.loss,
                    step.residual_px,
                ];
                head.into_iter()
                    .chain(to_numbers(&EulerPose::from(step.pose)))
            })
            .collect())
    }
}

/// What an outline looks like to the library.
struct LocatedPoses {
    /// Best first.
    ranked: Vec<Ranked>,
    /// The canonical silhouette reaches its frame's border.
    clipped: bool,
    /// Pieces of the outline led to the poses.
    partial: bool,
}

impl Matcher {
    fn refine(
        &mut self,
        traced: &Traced,
        goal: Goal<'_>,
        squares: Option<Squares<'_>>,
        around: &Surroundings,
    ) -> Result<Match, JsError> {
        traced.look(|silhouette| {
            let library = self.library.borrow_dependent();
            let Some(model) = &mut self.model else {
                return self.match_outline(traced);
            };
            let camera = traced.camera();
            let mut found = model.find(library, &camera, silhouette, goal)?;
            if let Some(squares) = squares {
                squares.correct(&mut found, model, &camera, silhouette)?;
            }
            let chosen = Chosen::of(&found, around);
            let mut ranked = Vec::new();
            for index in 0..found.candidates.len() {
                ranked.extend(model.ranked(&found.candidates, index, &camera, silhouette)?);
            }
            let offered = offered(&ranked, chosen.as_ref());
            Ok(Match {
                candidates: offered.iter().map(|one| self.candidate(one)).collect(),
                compared: ranked.len(),
                clipped: found.clipped,
                partial: found.partial,
                chosen,
            })
        })
    }

    /// Memory to compare silhouettes with the library.
    fn buffers(&mut self) -> (&Library<'_>, &mut FinderBuffers) {
        let buffers = match &mut self.model {
            Some(model) => &mut model.buffers,
            None => &mut self.buffers,
        };
        (self.library.borrow_dependent(), buffers)
    }

    /// Looks the library through: the poses that come near the best, by the pixels that differ where the model is there to
    /// be drawn.
    fn locate(
        &mut self,
        traced: &Traced,
        silhouette: &Silhouette<'_>,
    ) -> Result<LocatedPoses, JsError> {
        if let Some(model) = &mut self.model {
            let library = self.library.borrow_dependent();
            let first = model.first_poses(library, &traced.camera(), silhouette)?;
            return Ok(LocatedPoses {
                ranked: first.poses.iter().map(Ranked::from).collect(),
                clipped: first.clipped,
                partial: first.partial,
            });
        }
        if traced.is_marked() {
            return Err(JsError::new(
                "A part of the outline is marked unknown; a pose from the rest needs the model, not only its library: open it too",
            ));
        }
        let (near, clipped) = self.near_views::<MINIMA>(traced, silhouette)?;
        Ok(LocatedPoses {
            ranked: near.into_iter().map(Ranked::undrawn).collect(),
            clipped,
            partial: false,
        })
    }

    /// At most `K` views between the library's that come near the best one, best first, and whether the canonical silhouette
    /// reaches its frame's border.
    fn near_views<const K: usize>(
        &mut self,
        traced: &Traced,
        silhouette: &Silhouette<'_>,
    ) -> Result<(Vec<Located>, bool), JsError> {
        let camera = traced.camera();
        let (library, buffers) = self.buffers();
        let work = buffers.workspace(library, Kernels::PORTABLE);
        let found = locate::<K>(silhouette.mask(), &camera, library, work).map_err(sentence)?;
        let near = within(&found.poses, |located| f64::from(located.fine.unmatched));
        Ok((near, found.form.clipped))
    }

    fn candidate(&self, ranked: &Ranked) -> Candidate {
        let located = ranked.located;
        let by_pieces = located.by_pieces;
        let (input, library) = if by_pieces {
            (Vec::new(), Vec::new())
        } else {
            self.pictures(ranked)
        };
        Candidate {
            pose: to_numbers(&EulerPose::from(ranked.pose)),
            unmatched: (!by_pieces).then_some(located.fine.unmatched),
            drawn: ranked.drawn,
            residual_px: ranked.fit.map(|fit| fit.refined.residual_px),
            misfit: ranked.judged.map(|judged| judged.misfit),
            verdict: ranked.judged.map(|judged| judged.verdict),
            uncertainty: self
                .model
                .as_ref()
                .and_then(|model| model.uncertainty_of(ranked)),
            start: ranked
                .fit
                .map(|fit| to_numbers(&EulerPose::from(fit.start))),
            view: [located.fine.record.x_deg, located.fine.record.y_deg],
            at_border: located.fine.at_border && self.has_border(),
            input,
            library,
        }
    }

    /// Bits of the outline's canonical silhouette, turned as the view, and of the view's.
    fn pictures(&self, ranked: &Ranked) -> (Vec<Word>, Vec<Word>) {
        let buffers = match &self.model {
            Some(model) => &model.buffers,
            None => &self.buffers,
        };
        let library = self.library.borrow_dependent();
        let words = library.info().canonical.words_needed();
        // The next outline is drawn over the matcher's own.
        let straight = buffers.canonical().get(..words).unwrap_or_default();
        let mut input = straight.to_vec();
        if ranked.located.fine.reversed {
            reverse(straight, &mut input);
        }
        let mut view = vec![0; words];
        library.draw(ranked.located.view, &mut view);
        (input, view)
    }

    /// Whether views are missing beyond those at its ends: there are none beyond all directions.
    fn has_border(&self) -> bool {
        !self.library.borrow_dependent().info().grid.is_around()
    }
}

/// The chosen one, then the rival that is still open, or else those that fit and whose misfit comes near the least.
fn offered(refined: &[Ranked], chosen: Option<&Chosen>) -> Vec<Ranked> {
    let first = chosen.map_or(0, Chosen::index);
    let open = chosen.and_then(Chosen::open);
    let misfit = |ranked: &Ranked| ranked.judged.map_or(f64::MAX, |judged| judged.misfit);
    let least = refined.iter().map(misfit).fold(f64::MAX, f64::min);
    let fits = |ranked: &Ranked| {
        let judged = ranked.judged;
        judged.is_some_and(|judged| !matches!(judged.verdict, Verdict::NoFit(_)))
    };
    let is_rival = |at: usize| {
        let rival = refined.get(at).filter(|rival| fits(rival));
        Some(at) != open && rival.is_some_and(|rival| misfit(rival) <= RIVAL_WITHIN * least)
    };
    let rivals = (0..refined.len()).filter(|&at| at != first && is_rival(at));
    let order = [first].into_iter().chain(open).chain(rivals);
    let offered = order.filter_map(|at| refined.get(at)).take(OFFERED);
    offered.copied().collect()
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
