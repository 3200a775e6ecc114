//! The state of the work from one step to the next.

use heapless::Vec;

use super::candidates::{Answer, LocatedPose, Region, Start};
use super::error::OneClickError;
use super::expected::Expected;
use super::memory::OneClickNeeds;
use super::observation::Observation;
use super::prompt::{Prompt, SEEDS};
use super::scoring::PoseScorer;
use super::statistics::CHOSEN;
use super::window::Window;
use fluoropose::camera::Camera;
use fluoropose::finder::Component;
use fluoropose::follow::JointPlaces;
use fluoropose::image::moments::Moments;

/// The greatest number of located poses of a preprocessing pass that are drawn.
pub(super) const LOCATED: usize = 8;
/// The greatest number of first poses that are refined.
pub const STARTS: usize = 4;
/// The greatest number of refined poses that are kept.
pub const ANSWERS: usize = 8;

/// How a window is read: passes of the binomial filter (variances of 1 and of 4 square pixels: noise that hides a border at the
/// first does not at the second, which rounds off what is thin), and whether against the background.
pub(super) const READINGS: [(usize, bool); 3] = [(2, false), (8, false), (4, true)];
/// Side of the square that tells the background from the implant, in expected sizes.
pub(crate) const SQUARE: f64 = 1.2;
/// Radii of the discs that cut bridges, as fractions of the expected size.
pub(super) const RADII: [f64; 4] = [0.0, 0.03, 0.06, 0.1];
/// What was done in vain counts so much of the work, 0 to 1: all before its end ([`super::Progress`]).
const IN_VAIN: f64 = 0.9;
/// The greatest number of regions of a preprocessing pass.
pub(super) const REGIONS: usize = RADII.len() * CHOSEN;

/// What is done next. A pass is the frame preprocessed for one seed with one reading.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Stage {
    /// A pass is brought into memory.
    Preprocess(usize),
    /// The regions of a pass are matched with the library, one by one.
    Match(usize),
    /// The located poses of a pass are drawn and scored, one by one.
    Score(usize),
    /// First poses are refined, one by one.
    Refine(usize),
    /// The window is narrowed to the best answer.
    Narrow,
    /// Rotations around the best answer are scored, one by one.
    Around(usize),
    /// Bends of the knee are left out by what was pointed at.
    Bends,
    /// The outline slides over the frame where the joint leaves the component, one bend after the other.
    Slide,
    /// The best of those places are refined, one by one.
    InJoint(usize),
    /// Outer rims are looked for beyond the answers, one by one.
    Beyond(usize),
    /// The mirror images of the best answer are refined, one by one.
    Mirror(usize),
    /// Poses some degrees beside the best answer are refined, one by one.
    Beside(usize),
    /// Nothing is left to do.
    Done,
}

/// The work from a prompt to outlines and poses.
#[derive(Clone, Debug)]
pub struct OneClick {
    pub(super) prompt: Prompt,
    pub(super) expected: Expected,
    /// What is expected where nothing is found so.
    pub(super) otherwise: Option<Expected>,
    /// Part of the work that was done in vain, 0 to 1.
    pub(super) done: f64,
    pub(super) window: Window,
    /// Pixels of the first window, which is the largest.
    pixels: usize,
    pub(super) stage: Stage,
    /// The pass that is in memory.
    pub(super) current: Option<usize>,
    pub(super) seeds: Vec<usize, SEEDS>,
    /// Slope of an edge of metal, grey values a pixel.
    pub(super) slope: f64,
    /// Number of rounds that are done: regions in the window, regions near the best answer, rotations of it.
    pub(super) round: usize,
    /// The box around the best answer of the first round, which the second round searches.
    pub(super) narrowed: Option<Prompt>,
    /// The answer around which poses were scored last.
    pub(super) rotated_from: Option<Answer>,
    /// The regions of this pass that are still to be matched; the last one is the next.
    pub(super) regions: Vec<Region, REGIONS>,
    /// Moments of the regions of all passes that were matched.
    pub(super) matched: Vec<Moments, REGIONS>,
    /// Poses that the library has for the regions of this pass.
    pub(super) located: Vec<LocatedPose, LOCATED>,
    /// The region with the sharpest border, and the sharpness.
    pub(super) sharpest: Option<(f64, Region)>,
    pub(super) starts: Vec<Start, STARTS>,
    pub(super) answers: Vec<Answer, ANSWERS>,
    /// Where its joint leaves the component, where the other one is known.
    pub(super) joint: Option<JointPlaces>,
    /// The answers beyond which outer rims are looked for.
    pub(super) inner: Vec<Answer, ANSWERS>,
}

impl OneClick {
    /// Begins the work for a component in frames of `camera`; without a component, for a region alone.
    ///
    /// # Errors
    /// [`OneClickError::Outside`] and [`OneClickError::SmallBox`].
    pub fn new(
        prompt: Prompt,
        camera: &Camera,
        component: Option<&Component<'_>>,
    ) -> Result<Self, OneClickError> {
        let expected = component.map_or_else(
            || Expected::anything(camera),
            |component| Expected::of(component, camera),
        );
        Self::expecting(expected, prompt, camera)
    }

    /// Where nothing is found the component is looked for once more, farther away: for a library at a distance that nobody told.
    #[must_use]
    pub fn or_farther(mut self, camera: &Camera, component: &Component<'_>) -> Self {
        self.otherwise = Some(Expected::farther(component, camera));
        self
    }

    /// Begins anew with what is expected otherwise; whether there is anything.
    pub(super) fn begin_otherwise(&mut self, camera: &Camera) -> Result<bool, OneClickError> {
        let Some(expected) = self.otherwise.take() else {
            return Ok(false);
        };
        let (pixels, again) = (self.pixels, Self::expecting(expected, self.prompt, camera)?);
        *self = Self {
            // The window is no larger, and memory was borrowed for the first.
            pixels,
            done: IN_VAIN,
            ..again
        };
        Ok(true)
    }

    fn expecting(
        expected: Expected,
        prompt: Prompt,
        camera: &Camera,
    ) -> Result<Self, OneClickError> {
        let window = prompt.window(camera, expected.extent)?;
        Ok(Self {
            pixels: window.pixels(),
            window,
            prompt,
            expected,
            otherwise: None,
            done: 0.0,
            stage: Stage::Preprocess(0),
            current: None,
            seeds: Vec::new(),
            slope: 0.0,
            round: 0,
            narrowed: None,
            rotated_from: None,
            regions: Vec::new(),
            matched: Vec::new(),
            located: Vec::new(),
            sharpest: None,
            starts: Vec::new(),
            answers: Vec::new(),
            joint: None,
            inner: Vec::new(),
        })
    }

    /// Lengths of the memory that [`OneClick::step`] borrows.
    #[must_use]
    pub fn needs(&self, camera: &Camera) -> OneClickNeeds {
        OneClickNeeds::of(self.pixels, camera)
    }

    /// First poses, the best first, as far as they are known.
    #[must_use]
    pub fn starts(&self) -> &[Start] {
        &self.starts
    }

    /// Refined poses, the best first, as far as they are known.
    #[must_use]
    pub fn answers(&self) -> &[Answer] {
        &self.answers
    }

    /// Number of preprocessing passes: one for each seed and reading. The first pass of a box finds its seeds.
    pub(super) fn passes(&self) -> usize {
        READINGS.len() * self.seeds.len().max(1)
    }

    /// What scores poses in the state that is reached.
    pub(super) fn scorer<'s>(
        &'s self,
        observation: &'s Observation<'s>,
        component: &'s Component<'s>,
    ) -> PoseScorer<'s> {
        PoseScorer {
            observation,
            component,
            prompt: &self.prompt,
            expected: &self.expected,
            slope: self.slope,
        }
    }
}
