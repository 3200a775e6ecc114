//! In which order components are looked for that nobody pointed at; see the core's `SearchPlan`.

use fluoropose::follow::{self, Ends, KnownFrame, Places, Search, Sought};
use fluoropose::mesh::anatomy::KneeComponent;
use fluoropose::pose::{EulerPose, Pose};
use wasm_bindgen::prelude::*;

use fluoropose_page::pose_numbers::{from_numbers, to_numbers};

/// The order of work, for components that are numbered as they are added.
#[wasm_bindgen]
pub struct SearchPlan {
    plan: follow::SearchPlan,
    added: Vec<Sought>,
    /// Way after way, once the first step was asked for.
    parts: Vec<Sought>,
}

/// What is to be done next.
#[wasm_bindgen]
pub struct SearchStep {
    step: follow::SearchStep,
    /// The pose that is known: of the other component, or of the one that is to be followed.
    known: Option<Pose>,
}

#[wasm_bindgen]
impl SearchPlan {
    /// For a film of so many frames; whether it is told how it shows metal.
    #[wasm_bindgen(constructor)]
    pub fn new(frames: usize, is_told: bool) -> Self {
        Self {
            plan: follow::SearchPlan::new(frames, is_told),
            added: Vec::new(),
            parts: Vec::new(),
        }
    }

    /// Adds a component: whether it is the femoral one, whether its shape tells its axes, and the middle of its model's box, mm.
    pub fn add(&mut self, femoral: bool, is_limb: bool, x: f64, y: f64, z: f64) {
        let role = match femoral {
            true => KneeComponent::Femur,
            false => KneeComponent::Tibia,
        };
        self.added.push(Sought::new(Some(role), is_limb, [x, y, z]));
    }

    /// Says that the component that was added last is known in a frame (the six numbers of its pose).
    ///
    /// # Errors
    /// A sentence about the numbers.
    pub fn know(&mut self, frame: usize, pose: &[f64]) -> Result<(), JsError> {
        let pose = Pose::from(from_numbers(pose)?);
        if let Some(part) = self.added.last_mut() {
            part.know(KnownFrame::new(frame, pose, 1.0));
        }
        Ok(())
    }

    /// What is to be done next, the same until it is answered; nothing where all is done.
    pub fn wanted(&mut self) -> Option<SearchStep> {
        if self.parts.is_empty() {
            let each = core::iter::repeat_n(&self.added, self.plan.ways());
            self.parts = each.flatten().cloned().collect();
        }
        let step = self.plan.next(&mut self.parts)?;
        let known = match step.search {
            Search::Whole { .. } => None,
            Search::Joint(other) | Search::Beside { other, .. } => Some(other.pose),
            Search::Follow { from } => {
                let part = &self.parts[step.way * self.added.len() + step.part];
                part.known().get(from).map(|known| known.pose)
            }
        };
        Some(SearchStep { step, known })
    }

    /// What came of a search: the six numbers of a pose and its score, or nothing.
    ///
    /// # Errors
    /// A sentence about the numbers.
    pub fn found(&mut self, pose: Option<Vec<f64>>, score: f64) -> Result<(), JsError> {
        let pose = pose.map(|pose| from_numbers(&pose)).transpose()?;
        let found = pose.map(|pose| (Pose::from(pose), score));
        self.plan.found(found, &mut self.parts);
        Ok(())
    }

    /// What came of following, as `FrameSearch.walkEnds` gives it.
    ///
    /// # Errors
    /// A sentence about the numbers.
    pub fn followed(&mut self, ends: &[f64]) -> Result<(), JsError> {
        let mut all: Ends = [None, None];
        for (end, numbers) in all.iter_mut().zip(ends.chunks(7)) {
            if let [frame, pose @ ..] = numbers
                && frame.is_finite()
            {
                *end = Some((*frame as usize, from_numbers(pose)?.into()));
            }
        }
        self.plan.followed(all, &mut self.parts);
        Ok(())
    }

    /// The way that counts, once nothing is left to do: 0 dark, 1 bright; of one that was told always 0.
    #[wasm_bindgen(getter)]
    pub fn way(&self) -> Option<usize> {
        self.plan.way()
    }

    /// Where a component is known first in a way: the frame, and the six numbers of the pose.
    pub fn known(&self, way: usize, part: usize) -> Option<Vec<f64>> {
        let part = self.parts.get(way * self.added.len() + part)?;
        let known = part.known().first()?;
        let numbers = to_numbers(&EulerPose::from(known.pose));
        Some([known.frame as f64].into_iter().chain(numbers).collect())
    }
}

#[wasm_bindgen]
impl SearchStep {
    /// 0 dark, 1 bright; of one way that was told always 0.
    #[wasm_bindgen(getter)]
    pub fn way(&self) -> usize {
        self.step.way
    }

    /// Number of the component.
    #[wasm_bindgen(getter)]
    pub fn part(&self) -> usize {
        self.step.part
    }

    /// Number of the frame.
    #[wasm_bindgen(getter)]
    pub fn frame(&self) -> usize {
        self.step.frame
    }

    /// Where a whole frame is searched: `shaped`, `dark` or `all`.
    #[wasm_bindgen(getter)]
    pub fn places(&self) -> String {
        let word = match self.step.search {
            Search::Whole { places, .. } => match places {
                Places::Shaped => "shaped",
                Places::Dark => "dark",
                Places::All => "all",
            },
            _ => "all",
        };
        word.to_owned()
    }

    /// `whole`, `joint`, `beside` or `follow`.
    #[wasm_bindgen(getter)]
    pub fn search(&self) -> String {
        let word = match self.step.search {
            Search::Whole { .. } => "whole",
            Search::Joint(_) => "joint",
            Search::Beside { .. } => "beside",
            Search::Follow { .. } => "follow",
        };
        word.to_owned()
    }

    /// About how far away it is, mm, where another one tells that.
    #[wasm_bindgen(getter)]
    pub fn depth(&self) -> Option<f64> {
        match self.step.search {
            Search::Whole { depth_mm, .. } => depth_mm,
            Search::Beside { depth_mm, .. } => Some(depth_mm),
            Search::Joint(_) | Search::Follow { .. } => None,
        }
    }

    /// Six numbers of the pose that is known there: of the other component, or of the one that is to be followed.
    #[wasm_bindgen(getter)]
    pub fn known(&self) -> Option<Vec<f64>> {
        Some(to_numbers(&EulerPose::from(self.known?)).to_vec())
    }
}
