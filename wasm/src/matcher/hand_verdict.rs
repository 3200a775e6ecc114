//! How far a pose that a person set is to be trusted: by itself, and beside what had been found there.

use fluoropose::finder::choice::RivalPose;
use fluoropose::finder::{Limits, Refusal, Verdict, judge_fit};
use fluoropose::pose::{Pose, geodesic_deg};
use fluoropose::refine::{CameraView, Fit};
use wasm_bindgen::prelude::*;

use crate::choice::Surroundings;
use crate::working_model::WorkingModel;

/// Poses that lie nearer together than this are one, degrees: a hand does not turn more exactly than so.
const ONE_DEG: f64 = 4.0;

/// How far a pose that somebody set is to be trusted. It stays whatever the verdict, so there are two words.
#[wasm_bindgen]
#[derive(Clone)]
pub struct HandVerdict {
    alone: Verdict,
    /// Which pose that had been found is at least as likely, in a sentence without its full stop.
    against: Option<String>,
}

#[wasm_bindgen]
impl HandVerdict {
    /// `good` or `doubtful`.
    #[wasm_bindgen(getter)]
    pub fn word(&self) -> String {
        let word = match (&self.alone, &self.against) {
            (Verdict::Good, None) => "good",
            _ => "doubtful",
        };
        word.to_owned()
    }

    /// Why, in a sentence without its full stop.
    #[wasm_bindgen(getter)]
    pub fn because(&self) -> String {
        match (&self.alone, &self.against) {
            (Verdict::NoFit(Refusal::NoFit { misfit_px, met }), _) => {
                let percent = 100.0 * met;
                format!(
                    "at this pose only {percent:.0} % of the model's outline is met ({misfit_px:.1} px): bring it nearer, then refine from there"
                )
            }
            (Verdict::Good, Some(against)) => against.clone(),
            (alone, _) => alone.to_string(),
        }
    }
}

impl HandVerdict {
    /// On a pose that was set and not refined.
    pub(super) fn at(
        model: &mut WorkingModel,
        pose: &Pose,
        view: CameraView<'_>,
        around: &Surroundings,
    ) -> Result<Self, JsError> {
        let fit = model.fit_at(pose, view)?;
        Ok(Self::beside(model, (pose, &fit, true), view, around))
    }

    /// On a pose with its fit, and whether what was seen determines it. What was found before is looked at in the same view: a person may know better, and is told what speaks
    /// against it.
    pub(super) fn beside(
        model: &mut WorkingModel,
        (pose, fit, determined): (&Pose, &Fit, bool),
        view: CameraView<'_>,
        around: &Surroundings,
    ) -> Self {
        let alone = judge_fit(fit, determined, &Limits::USUAL);
        let rivals = around.rivals();
        let others = rivals
            .iter()
            .filter(|other| geodesic_deg(&pose.rotation, &other.rotation) >= ONE_DEG);
        let others = others.filter_map(|other| {
            let fit = model.fit_at(other, view).ok()?;
            let fits = !matches!(judge_fit(&fit, true, &Limits::USUAL), Verdict::NoFit(_));
            fits.then_some(RivalPose {
                pose: *other,
                residual_px: fit.misfit_px,
            })
        });
        let own = RivalPose {
            pose: *pose,
            residual_px: fit.misfit_px,
        };
        let all: Vec<RivalPose> = core::iter::once(own).chain(others).collect();
        Self {
            alone,
            against: around.against(&all),
        }
    }
}
