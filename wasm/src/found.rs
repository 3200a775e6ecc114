//! What was found for an outline, as the page reads it.

use fluoropose::finder::Verdict;
use fluoropose::image::mask::Word;
use fluoropose::pose::covariance::PoseCovariance;
use js_sys::{Uint8Array, Uint32Array};
use wasm_bindgen::prelude::*;

use crate::choice::Chosen;
use crate::uncertainty::{Uncertainty, covariance_of};
use fluoropose_page::pose_numbers::PoseNumbers;

pub(crate) struct Candidate {
    pub(crate) pose: PoseNumbers,
    pub(crate) unmatched: Option<u32>,
    pub(crate) drawn: Option<u64>,
    pub(crate) residual_px: Option<f64>,
    pub(crate) misfit: Option<f64>,
    pub(crate) verdict: Option<Verdict>,
    pub(crate) uncertainty: Option<Uncertainty>,
    pub(crate) start: Option<PoseNumbers>,
    pub(crate) view: [f64; 2],
    pub(crate) at_border: bool,
    pub(crate) input: Vec<Word>,
    pub(crate) library: Vec<Word>,
}

impl Candidate {
    /// Of the pose, where it is known.
    pub(crate) fn covariance(&self) -> Option<PoseCovariance> {
        self.uncertainty.as_ref()?[6..]
            .first_chunk()
            .map(covariance_of)
    }
}

/// What was found for one outline: the best pose first, then its rival, if there is one. Asked beyond `count`, the
/// methods answer nothing.
#[wasm_bindgen]
pub struct Match {
    pub(crate) candidates: Vec<Candidate>,
    pub(crate) compared: usize,
    pub(crate) clipped: bool,
    pub(crate) partial: bool,
    pub(crate) chosen: Option<Chosen>,
}

#[wasm_bindgen]
impl Match {
    /// How many candidates there are.
    #[wasm_bindgen(getter)]
    pub fn count(&self) -> usize {
        self.candidates.len()
    }

    /// How many poses were found and compared: the candidates are the best of them.
    #[wasm_bindgen(getter)]
    pub fn compared(&self) -> usize {
        self.compared
    }

    /// Whether the canonical silhouette reaches its frame's border, where the score does not see all of it.
    #[wasm_bindgen(getter)]
    pub fn clipped(&self) -> bool {
        self.clipped
    }

    /// Whether only a part of the outline is known, so that pieces of it led to the poses.
    #[wasm_bindgen(getter)]
    pub fn partial(&self) -> bool {
        self.partial
    }

    /// Why the first candidate was chosen, in a sentence; nothing for poses of the library.
    #[wasm_bindgen(getter)]
    pub fn reason(&self) -> Option<String> {
        self.chosen.as_ref().map(Chosen::sentence)
    }

    /// Whether that choice can be relied on.
    #[wasm_bindgen(getter)]
    pub fn decided(&self) -> bool {
        self.chosen.as_ref().is_some_and(Chosen::decided)
    }

    /// How far the first candidate is to be trusted: `good`, `doubtful`, or `none` where no pose of the model explains the
    /// outline. Nothing for poses of the library.
    #[wasm_bindgen(getter)]
    pub fn verdict(&self) -> Option<String> {
        let (word, _) = self.chosen.as_ref()?.verdict()?;
        Some(word.to_owned())
    }

    /// Why it has that verdict, in a sentence without its full stop.
    #[wasm_bindgen(getter)]
    pub fn because(&self) -> Option<String> {
        let (_, because) = self.chosen.as_ref()?.verdict()?;
        Some(because)
    }

    /// x, y, z (mm), z, x and y rotation (degrees).
    pub fn pose(&self, index: usize) -> Option<Vec<f64>> {
        let candidate = self.candidates.get(index)?;
        Some(candidate.pose.to_vec())
    }

    /// Unmatched canonical pixels; nothing where pieces of the outline led to the pose.
    pub fn unmatched(&self, index: usize) -> Option<u32> {
        self.candidates.get(index)?.unmatched
    }

    /// Known frame pixels that differ from the outline when the model is drawn at the pose; nothing without the model.
    pub fn drawn(&self, index: usize) -> Option<f64> {
        let drawn = self.candidates.get(index)?.drawn?;
        Some(drawn as f64)
    }

    /// Root mean square of what remains between the outlines after refinement, pixels; nothing for a pose of the library.
    pub fn residual(&self, index: usize) -> Option<f64> {
        self.candidates.get(index)?.residual_px
    }

    /// By what candidates are compared, pixels: beside the residual it counts outline that has no counterpart. Nothing where
    /// it was not compared.
    pub fn misfit(&self, index: usize) -> Option<f64> {
        self.candidates.get(index)?.misfit
    }

    /// The verdict on one candidate by itself, whatever other poses do.
    #[wasm_bindgen(js_name = verdictOf)]
    pub fn verdict_of(&self, index: usize) -> Option<String> {
        let verdict = self.candidates.get(index)?.verdict?;
        Some(verdict.word().to_owned())
    }

    /// Why one candidate has that verdict, in a sentence without its full stop.
    #[wasm_bindgen(js_name = becauseOf)]
    pub fn because_of(&self, index: usize) -> Option<String> {
        let verdict = self.candidates.get(index)?.verdict?;
        Some(verdict.to_string())
    }

    /// Standard deviations of the pose's numbers, in their order and units, and the upper half of its covariance, as
    /// `KneeJoint` takes it; nothing for a pose of the library or one that the outline does not determine.
    pub fn uncertainty(&self, index: usize) -> Option<Vec<f64>> {
        let uncertainty = self.candidates.get(index)?.uncertainty?;
        Some(uncertainty.to_vec())
    }

    /// The pose that the refined one was refined from.
    pub fn start(&self, index: usize) -> Option<Vec<f64>> {
        let start = self.candidates.get(index)?.start?;
        Some(start.to_vec())
    }

    /// Rotations about x and y of the view that fits, between the library's own, degrees.
    pub fn view(&self, index: usize) -> Option<Vec<f64>> {
        let candidate = self.candidates.get(index)?;
        Some(candidate.view.to_vec())
    }

    /// Whether that view lies at the border of the library: the truth may lie beyond it.
    #[wasm_bindgen(js_name = atBorder)]
    pub fn at_border(&self, index: usize) -> Option<bool> {
        let candidate = self.candidates.get(index)?;
        Some(candidate.at_border)
    }

    /// The outline's canonical silhouette, turned as the view: one bit a pixel, row by row, least significant leftmost.
    /// Empty where pieces of the outline led to the pose.
    #[wasm_bindgen(js_name = inputBits)]
    pub fn input_bits(&self, index: usize) -> Option<Uint8Array> {
        let candidate = self.candidates.get(index)?;
        Some(bits_of(&candidate.input))
    }

    /// The library view's canonical silhouette, in the same form.
    #[wasm_bindgen(js_name = viewBits)]
    pub fn view_bits(&self, index: usize) -> Option<Uint8Array> {
        let candidate = self.candidates.get(index)?;
        Some(bits_of(&candidate.library))
    }
}

/// Words of a mask are little-endian in JavaScript's memory as in the module's.
fn bits_of(words: &[Word]) -> Uint8Array {
    Uint8Array::new(&Uint32Array::from(words).buffer())
}
