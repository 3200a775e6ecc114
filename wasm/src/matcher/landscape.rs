//! The scores of all views of a library for an outline, and the pose of any of them.

use fluoropose::canonical::CanonicalForm;
use fluoropose::image::silhouette::Silhouette;
use fluoropose::library::ViewAxis;
use fluoropose::locate::estimate::pose_from_view;
use fluoropose::locate::interpolate::FineView;
use fluoropose::locate::partial::known_fraction;
use fluoropose::locate::{LocatedPoses, locate, score_views};
use fluoropose::pose::EulerPose;
use fluoropose::search::Scores;
use fluoropose::search::kernels::Kernels;
use js_sys::Uint32Array;
use wasm_bindgen::prelude::*;

use super::{MINIMA, Matcher};
use fluoropose_page::error::sentence;
use fluoropose_page::pose_numbers::{PoseNumbers, to_numbers};
use fluoropose_page::traced::Traced;

/// Unmatched pixels of every view, the better direction of the principal axis.
#[wasm_bindgen]
pub struct Landscape {
    axes: [ViewAxis; 2],
    scores: Vec<u32>,
    minima: Vec<[f64; 3]>,
}

#[wasm_bindgen]
impl Landscape {
    /// First rotation and step (degrees) and number of views, about x and then about y.
    #[wasm_bindgen(getter)]
    pub fn axes(&self) -> Vec<f64> {
        let numbers = |axis: &ViewAxis| [axis.first, axis.step, axis.count as f64];
        self.axes.iter().flat_map(numbers).collect()
    }

    /// Unmatched canonical pixels of each view, in view order: x rotations run fastest.
    #[wasm_bindgen(getter)]
    pub fn scores(&self) -> Uint32Array {
        Uint32Array::from(&self.scores[..])
    }

    /// Local minima, best first: x and y rotation between the views (degrees) and unmatched pixels.
    #[wasm_bindgen(getter)]
    pub fn minima(&self) -> Vec<f64> {
        self.minima.concat()
    }
}

/// The pose of one view.
#[wasm_bindgen]
pub struct ViewPose {
    pose: PoseNumbers,
    unmatched: u32,
}

#[wasm_bindgen]
impl ViewPose {
    /// x, y, z (mm), z, x and y rotation (degrees).
    #[wasm_bindgen(getter)]
    pub fn pose(&self) -> Vec<f64> {
        self.pose.to_vec()
    }

    /// Unmatched canonical pixels.
    #[wasm_bindgen(getter)]
    pub fn unmatched(&self) -> u32 {
        self.unmatched
    }
}

#[wasm_bindgen]
impl Matcher {
    /// Scores of all views for an outline.
    ///
    /// # Errors
    /// A sentence where only a part of the outline is known, the core's about the silhouette.
    pub fn landscape(&mut self, traced: &Traced) -> Result<Landscape, JsError> {
        self.scored(traced, |found, (_, scores), _| {
            let grid = scores.grid();
            let pairs = scores.surface(false).iter().zip(scores.surface(true));
            let minimum = |located: &fluoropose::locate::Located| {
                let record = located.fine.record;
                let unmatched = f64::from(located.fine.unmatched);
                [record.x_deg, record.y_deg, unmatched]
            };
            Ok(Landscape {
                axes: [grid.x, grid.y],
                scores: pairs.map(|(&a, &b)| a.min(b)).collect(),
                minima: found.poses.iter().map(minimum).collect(),
            })
        })
    }

    /// The pose of a view for an outline, by the direction of the principal axis that fits better.
    ///
    /// # Errors
    /// Those of `landscape`, and a sentence for a view that the library does not have.
    #[wasm_bindgen(js_name = viewPose)]
    pub fn view_pose(&mut self, traced: &Traced, view: usize) -> Result<ViewPose, JsError> {
        let camera = traced.camera();
        self.scored(traced, |_, (form, scores), library| {
            let score = |reversed: bool| scores.surface(reversed).get(view).copied();
            let (Some(straight), Some(reversed)) = (score(false), score(true)) else {
                return Err(JsError::new("The library has no such view"));
            };
            let fine = FineView {
                record: library.record(view),
                reversed: reversed < straight,
                unmatched: straight.min(reversed),
                at_border: false,
            };
            let pose = pose_from_view(&camera, library.info(), form, &fine);
            Ok(ViewPose {
                pose: to_numbers(&EulerPose::from(pose)),
                unmatched: fine.unmatched,
            })
        })
    }
}

impl Matcher {
    /// Scores a whole outline and calls `with` with what was found.
    fn scored<T>(
        &mut self,
        traced: &Traced,
        with: impl FnOnce(
            &LocatedPoses<MINIMA>,
            &(CanonicalForm, Scores<'_>),
            &fluoropose::library::Library<'_>,
        ) -> Result<T, JsError>,
    ) -> Result<T, JsError> {
        traced.look(|silhouette: &Silhouette<'_>| {
            if traced.is_marked() || known_fraction(silhouette).is_partial() {
                return Err(JsError::new(
                    "Only a whole outline has a score for every view; of this one a part is unknown or cut off by the frame",
                ));
            }
            let (library, buffers) = self.buffers();
            let mut work = buffers.workspace(library, Kernels::PORTABLE);
            let (mask, camera) = (silhouette.mask(), traced.camera());
            let found = locate(mask, &camera, library, work.reborrow()).map_err(sentence)?;
            let scores = score_views(mask, &camera, library, work).map_err(sentence)?;
            with(&found, &scores, library)
        })
    }
}
