//! What a click comes to that does not convince: whether its pose leads a film, or what the film finds without it.

use fluoropose::follow::{
    BesideClick, ClickOutcome, FramePose, click_outcome, frame_pose_at, leads_by_itself,
};
use fluoropose::pose::Pose;
use fluoropose::refine::{Polarity, polarity_near};
use wasm_bindgen::prelude::*;

use super::FrameSearch;
use super::walk::Walk;
use crate::held::holds;
use fluoropose_page::error::sentence;
use fluoropose_page::frame_image::FrameImage;
use fluoropose_page::pose_numbers::from_numbers;

/// How a pose that a click led to lies in its frame.
#[wasm_bindgen]
pub struct ClickStanding {
    /// By what poses that were found are compared, the greatest first.
    pub score: f64,
    /// It leads without being compared with anything.
    pub convinces: bool,
}

#[wasm_bindgen]
impl FrameSearch {
    /// Whether metal is brighter than what surrounds it, by a place in it.
    ///
    /// # Errors
    /// A sentence about a frame of another size.
    #[wasm_bindgen(js_name = isBrightNear)]
    pub fn is_bright_near(
        &self,
        frame: &FrameImage,
        column: f64,
        row: f64,
    ) -> Result<bool, JsError> {
        let told = frame.look(|frame| Ok(polarity_near(frame, [column, row])))?;
        Ok(told == Polarity::BrightImplant)
    }

    /// How a pose that a click led to (six numbers) lies in its frame.
    ///
    /// # Errors
    /// A sentence about the numbers, and the core's about a pose that cannot be drawn.
    #[wasm_bindgen(js_name = clickStands)]
    pub fn click_stands(
        &mut self,
        frame: &FrameImage,
        pose: &[f64],
    ) -> Result<ClickStanding, JsError> {
        let found = self.found_at(frame, &from_numbers(pose)?.into())?;
        Ok(ClickStanding {
            score: found.score(),
            convinces: leads_by_itself(&found),
        })
    }

    /// Begins to follow the component from a frame in which its pose (six numbers) is known to that of a click, for `clickOutcome`.
    ///
    /// # Errors
    /// A sentence about the numbers.
    #[wasm_bindgen(js_name = beginWalkTo)]
    pub fn begin_walk_to(
        &mut self,
        goal: usize,
        frame: usize,
        pose: &[f64],
    ) -> Result<(), JsError> {
        self.walk = Some(Walk::up_to(goal, frame, from_numbers(pose)?.into()));
        Ok(())
    }

    /// Compares the pose of a click (six numbers) in its frame with what the walk there led to: `same` or `outdone` where that leads,
    /// `leads` where the click does. `place`: column and row that were pointed at.
    ///
    /// # Errors
    /// A sentence about the numbers, and the core's about a pose that cannot be drawn.
    #[wasm_bindgen(js_name = clickOutcome)]
    pub fn click_outcome(
        &mut self,
        frame: &FrameImage,
        number: usize,
        pose: &[f64],
        column: f64,
        row: f64,
    ) -> Result<String, JsError> {
        let clicked = self.found_at(frame, &from_numbers(pose)?.into())?;
        let walk = self.walk.as_ref();
        let there = walk.and_then(|walk| walk.at(number)).copied();
        let Some(found) = there.or_else(|| walk?.begun().copied()) else {
            return Ok(word(ClickOutcome::Leads));
        };
        let model = self.model.as_model();
        let is_held = |one: &FramePose| holds(&model, &self.whole, &one.pose, [column, row]);
        let holds = there.as_ref().map(is_held).transpose()?;
        let own = is_held(&clicked)?;
        let other = BesideClick {
            found: &found,
            holds,
        };
        Ok(word(click_outcome(&clicked, own, other)))
    }
}

impl FrameSearch {
    fn found_at(&mut self, frame: &FrameImage, pose: &Pose) -> Result<FramePose, JsError> {
        self.look(frame, |subject, image, memory| {
            frame_pose_at(subject, image, pose, memory).map_err(sentence)
        })
    }
}

fn word(outcome: ClickOutcome) -> String {
    let word = match outcome {
        ClickOutcome::Same => "same",
        ClickOutcome::Leads => "leads",
        ClickOutcome::Outdone => "outdone",
    };
    word.to_owned()
}
