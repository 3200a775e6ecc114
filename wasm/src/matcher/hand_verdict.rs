//! How far a pose that a person set is to be trusted: by itself, and beside what had been found there.

use fluoropose::finder::choice::{DECISIVE_RATIO, RivalPose};
use fluoropose::finder::{Limits, OTHER_DEG, Refusal, Verdict, judge_fit};
use fluoropose::pose::{Pose, geodesic_deg};
use fluoropose::refine::{CameraView, Fit};
use wasm_bindgen::prelude::*;

use crate::choice::Surroundings;
use crate::working_model::WorkingModel;

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

/// A pose that a person set, and what was seen there.
pub(super) struct Held<'h> {
    pub(super) pose: &'h Pose,
    pub(super) fit: &'h Fit,
    /// Whether what was seen determines the pose, or was not asked whether it does.
    pub(super) determined: bool,
    /// Whether all six numbers were refined from where the person set them.
    pub(super) refined: bool,
}

/// Whole pixels leave some hundredths of a pixel, more or less, at one and the same pose.
const ROUNDING_PX: f64 = 0.05;

impl Held<'_> {
    /// Whether another pose is not this one: turned away from it, or, of what was refined, leaving so much less that both did not come to one end. What a hand set
    /// leaves more than that because hands are not exact.
    fn is_beside(&self, other: &Pose, misfit_px: f64) -> bool {
        let turn_deg = geodesic_deg(&self.pose.rotation, &other.rotation);
        let less = DECISIVE_RATIO * misfit_px + ROUNDING_PX;
        turn_deg >= OTHER_DEG || self.refined && less <= self.fit.misfit_px
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
        let held = Held {
            pose,
            fit: &model.fit_at(pose, view)?,
            determined: true,
            refined: false,
        };
        Ok(Self::beside(model, &held, view, around))
    }

    /// What was found before is looked at in the same view: a person may know better, and is told what speaks against it.
    pub(super) fn beside(
        model: &mut WorkingModel,
        held: &Held<'_>,
        view: CameraView<'_>,
        around: &Surroundings,
    ) -> Self {
        let others = around.rivals().iter().filter_map(|other| {
            let fit = model.fit_at(other, view).ok()?;
            let fits = !matches!(judge_fit(&fit, true, &Limits::USUAL), Verdict::NoFit(_));
            let is_rival = fits && held.is_beside(other, fit.misfit_px);
            is_rival.then_some(RivalPose {
                pose: *other,
                residual_px: fit.misfit_px,
            })
        });
        let own = RivalPose {
            pose: *held.pose,
            residual_px: held.fit.misfit_px,
        };
        let all: Vec<RivalPose> = core::iter::once(own).chain(others).collect();
        Self {
            alone: judge_fit(held.fit, held.determined, &Limits::USUAL),
            against: around.against(&all),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fluoropose::pose::EulerPose;

    #[test]
    fn a_pose_that_leaves_far_less_is_another_however_near_unless_a_hand_was_not_exact() {
        let pose = |z_mm, x_rot_deg| {
            Pose::from(EulerPose {
                z_mm,
                x_rot_deg,
                ..EulerPose::default()
            })
        };
        let (own, fit) = (
            pose(-1000.0, 0.0),
            Fit {
                misfit_px: 1.0,
                ..Fit::default()
            },
        );
        let held = |refined| Held {
            pose: &own,
            fit: &fit,
            determined: true,
            refined,
        };
        let [deeper, turned] = [pose(-1030.0, 0.0), pose(-1000.0, 5.0)];
        assert!(held(true).is_beside(&deeper, 0.7) && !held(false).is_beside(&deeper, 0.7));
        // Both came to one end.
        assert!(!held(true).is_beside(&deeper, 0.8));
        let exact = Fit {
            misfit_px: 0.004,
            ..Fit::default()
        };
        let drawn = Held {
            fit: &exact,
            ..held(true)
        };
        assert!(!drawn.is_beside(&pose(-1000.1, 0.0), 0.001) && drawn.is_beside(&turned, 0.001));
        assert!(held(true).is_beside(&turned, 2.0) && held(false).is_beside(&turned, 0.5));
    }
}
