//! Refined poses that go along with an outline while it changes.

use fluoropose::image::silhouette::Silhouette;
use fluoropose::locate::Located;
use fluoropose::pose::{Pose, geodesic_deg};
use fluoropose::refine::{CameraView, Effort, RefineOptions};
use wasm_bindgen::prelude::*;

use super::Matcher;
use crate::found::Match;
use crate::working_model::{Fit, Ranked};
use fluoropose_page::pose_numbers::{PoseNumbers, from_numbers};
use fluoropose_page::traced::Traced;

/// Where a pose leaves more than so many times what it left before, and more than so many pixels, the outline may show
/// another view by now.
const WORSE: f64 = 2.0;
const WORSE_PX: f64 = 1.0;

/// A view of the library that is turned against a pose by more than this, degrees, does not show the same.
const FAR_DEG: f64 = 5.0;

/// Views that explain the outline are looked for as many as a near-symmetric component has.
const RIVALS: usize = 2;

#[wasm_bindgen]
impl Matcher {
    /// Brings poses that were refined for an outline (six numbers each) onto what it has become, each from where it was.
    /// Other poses are not looked for, and how sure these are is not told. `residuals` are what they left before, pixels.
    ///
    /// Nothing without the model, where a part of the outline is unknown, and where the first pose fits much worse than
    /// before or lies away from the library's best views of the outline: then `match_outline` has to look everywhere.
    ///
    /// # Errors
    /// The core's sentence about the silhouette.
    pub fn follow(
        &mut self,
        traced: &Traced,
        starts: &[f64],
        residuals: &[f64],
    ) -> Result<Option<Match>, JsError> {
        if self.model.is_none() || traced.is_marked() {
            return Ok(None);
        }
        traced.look(|silhouette| {
            let (views, clipped) = self.near_views::<RIVALS>(traced, silhouette)?;
            let mut followed = Vec::new();
            for (start, before) in starts.as_chunks().0.iter().zip(residuals) {
                match self.follow_one(traced, silhouette, start, &views) {
                    Some(pose) if left(&pose) <= WORSE_PX.max(WORSE * before) => {
                        followed.push(pose)
                    }
                    _ if followed.is_empty() => return Ok(None),
                    // A rival that is none any more.
                    _ => {}
                }
            }
            let candidates: Vec<_> = followed.iter().map(|pose| self.candidate(pose)).collect();
            Ok((!candidates.is_empty()).then_some(Match {
                compared: candidates.len(),
                candidates,
                clipped,
                partial: false,
                chosen: None,
            }))
        })
    }
}

impl Matcher {
    /// Nothing where it leads nowhere, or away from all views that explain the outline.
    fn follow_one(
        &mut self,
        traced: &Traced,
        silhouette: &Silhouette<'_>,
        start: &PoseNumbers,
        views: &[Located],
    ) -> Option<Ranked> {
        let (camera, model) = (traced.camera(), self.model.as_mut()?);
        let start = Pose::from(from_numbers(start).ok()?);
        let view = CameraView::only(&camera, *silhouette);
        let options = RefineOptions {
            effort: Effort::Interactive,
            ..RefineOptions::default()
        };
        let refined = model.refine_from(&start, view, options).ok()?;
        let away = |view: &Located| geodesic_deg(&view.pose.rotation, &refined.pose.rotation);
        let located = *views.iter().min_by(|a, b| away(a).total_cmp(&away(b)))?;
        (away(&located) <= FAR_DEG).then_some(Ranked {
            pose: refined.pose,
            drawn: model.draw(&refined.pose, &camera, silhouette).ok()?,
            fit: Some(Fit { refined, start }),
            ..Ranked::undrawn(located)
        })
    }
}

/// Residual, pixels.
fn left(pose: &Ranked) -> f64 {
    pose.fit
        .map_or(f64::INFINITY, |fit| fit.refined.residual_px)
}
