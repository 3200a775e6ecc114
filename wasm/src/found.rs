//! What was found for an outline, as the page reads it.

use fluoropose::finder::Verdict;
use fluoropose::image::mask::Word;
use fluoropose::math::Vector3;
use fluoropose::pose::Pose;
use fluoropose::pose::covariance::PoseCovariance;
use js_sys::{Uint8Array, Uint32Array};
use wasm_bindgen::prelude::*;

use crate::choice::Chosen;
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

/// How uncertain a pose is, as it leaves: the standard deviations of its six numbers, in their order and units, and then the
/// covariance that they come from, [`PoseCovariance::matrix`] from its diagonal on, row by row; then what of it is the film's
/// (`film_steps` of the core), zero where nothing is known of that.
pub(crate) type Uncertainty = [f64; 6 + UPPER + FILM];
/// Numbers of the upper half of a covariance.
pub(crate) const UPPER: usize = 21;
/// Numbers of the film's part of it.
pub(crate) const FILM: usize = 12;

pub(crate) fn uncertainty(
    covariance: &PoseCovariance,
    film_steps: &[[f64; 6]; 2],
    pose: &Pose,
    middle: &Vector3,
) -> Uncertainty {
    let deviations = covariance.deviations(pose, middle);
    let six = [
        deviations.x_mm,
        deviations.y_mm,
        deviations.z_mm,
        deviations.z_rot_deg,
        deviations.x_rot_deg,
        deviations.y_rot_deg,
    ];
    let upper = (0..6).flat_map(|row| covariance.matrix[row][row..].iter().copied());
    let mut all = [0.0; 6 + UPPER + FILM];
    let film = film_steps.as_flattened().iter().copied();
    for (place, number) in all.iter_mut().zip(six.into_iter().chain(upper).chain(film)) {
        *place = number;
    }
    all
}

impl Candidate {
    /// Of the pose, where it is known.
    pub(crate) fn covariance(&self) -> Option<PoseCovariance> {
        self.uncertainty.as_ref()?[6..]
            .first_chunk()
            .map(covariance_of)
    }
}

/// The covariance of which this is the upper half.
pub(crate) fn covariance_of(upper: &[f64; UPPER]) -> PoseCovariance {
    let mut matrix = [[0.0; 6]; 6];
    let places = (0..6).flat_map(|row| (row..6).map(move |column| (row, column)));
    for ((row, column), &number) in places.zip(upper) {
        matrix[row][column] = number;
        matrix[column][row] = number;
    }
    PoseCovariance { matrix }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_covariance_comes_back_whole() {
        let matrix = core::array::from_fn(|a| {
            core::array::from_fn(|b| if a == b { 9.0 } else { (a + b) as f64 / 10.0 })
        });
        let numbers = uncertainty(
            &PoseCovariance { matrix },
            &[[7.0; 6], [8.0; 6]],
            &Pose::IDENTITY,
            &[0.0; 3],
        );
        // Without a middle apart from the origin, its shift is that of the numbers.
        assert_eq!(numbers[..3], [3.0; 3]);
        assert_eq!(numbers[27..], [[7.0; 6], [8.0; 6]].concat());
        let upper = numbers[6..27].try_into().unwrap();
        assert_eq!(covariance_of(upper), PoseCovariance { matrix });
    }
}
