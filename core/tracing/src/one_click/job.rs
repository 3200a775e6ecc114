//! The work, step by step.

use heapless::Vec;

use super::candidates::{Answer, Find, Nearness, Region, Start};
use super::expect::Expected;
use super::looks::RADII;
use super::prompt::SEEDS;
use super::tally::CHOSEN;
use super::window::Window;
use super::{OneClickError, OneClickMemory, OneClickNeeds, Part, Prompt, Scene};
use fluoropose::camera::Camera;
use fluoropose::image::moments::Moments;

/// Finds of a look that are drawn at most.
const FINDS: usize = 8;
/// First poses that are refined at most.
pub const STARTS: usize = 4;
/// Refined poses that are kept at most.
pub const ANSWERS: usize = 8;

/// Passes of the binomial filter: variances of 1 and of 4 square pixels. Noise that hides a border
/// at the first does not at the second, which rounds what is thin.
pub(super) const SMOOTHING: [usize; 2] = [2, 8];
/// Regions of a look, at most.
const REGIONS: usize = RADII.len() * CHOSEN;

/// Finds and starts that are one lead to one answer.
pub(super) const SAME_START: Nearness = Nearness {
    degrees: 5.0,
    place: 0.04,
};

/// No further look is needed where the outline of a start lies near edges by this part, and
/// covers its region by that.
const SEEN: [f64; 2] = [0.9, 0.85];
/// Once an answer is convincing, only starts are refined whose score comes so near to the best.
const RIVAL: f64 = 0.97;
/// A start whose score is below this part of the best is not refined.
const WORTH: f64 = 0.6;
/// Least part of the outline that must lie on edges for an answer to be one.
const LEAST_SHARE: f64 = 0.35;

/// What is done next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Stage {
    /// A look is brought into memory.
    Look(usize),
    /// The regions of a look are matched, one by one.
    Match(usize),
    /// The finds of a look are drawn, one by one.
    Judge(usize),
    /// Starts are refined, one by one.
    Refine(usize),
    /// The window is narrowed to the best answer.
    Narrow,
    /// Rotations round about the best answer are judged, one by one.
    Around(usize),
    /// The mirror images of the best are refined, one by one.
    Mirror(usize),
    Done,
}

/// How far the work is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Progress {
    /// Regions are looked for; part of the work that is done, 0 to 1.
    Regions(f64),
    /// Poses are refined; part of the work that is done, 0 to 1.
    Poses(f64),
    /// All is done.
    Done,
}

/// The work from a prompt to outlines and poses.
#[derive(Clone, Debug)]
pub struct OneClick {
    pub(super) prompt: Prompt,
    pub(super) expected: Expected,
    pub(super) window: Window,
    /// Of the first window, which is the largest.
    pixels: usize,
    pub(super) stage: Stage,
    /// The look that is in memory.
    pub(super) current: Option<usize>,
    pub(super) seeds: Vec<usize, SEEDS>,
    /// Grey values a pixel.
    pub(super) slope: f64,
    /// Rounds that are done: regions in the window, regions near the best answer, turns of it.
    pub(super) round: usize,
    /// The box that the second round looks into, round the best answer of the first.
    pub(super) narrowed: Option<Prompt>,
    /// The answer that was turned last.
    pub(super) turned_from: Option<Answer>,
    /// Of this look, those still to be matched; the last is the next.
    pub(super) regions: Vec<Region, REGIONS>,
    /// Those that were looked at, of all looks.
    pub(super) matched: Vec<Moments, REGIONS>,
    /// Of this look.
    pub(super) finds: Vec<Find, FINDS>,
    /// The region with the sharpest border, and how sharp.
    pub(super) sharpest: Option<(f64, Region)>,
    pub(super) starts: Vec<Start, STARTS>,
    pub(super) answers: Vec<Answer, ANSWERS>,
}

impl OneClick {
    /// Begins the work for a component in frames of `camera`; without one, for a region alone.
    ///
    /// # Errors
    /// [`OneClickError::Outside`] and [`OneClickError::SmallBox`].
    pub fn new(
        prompt: Prompt,
        camera: &Camera,
        part: Option<&Part<'_>>,
    ) -> Result<Self, OneClickError> {
        let expected = part.map_or_else(
            || Expected::anything(camera),
            |part| Expected::of(part, camera),
        );
        let window = prompt.window(camera, expected.extent)?;
        Ok(Self {
            pixels: window.pixels(),
            window,
            prompt,
            expected,
            stage: Stage::Look(0),
            current: None,
            seeds: Vec::new(),
            slope: 0.0,
            round: 0,
            narrowed: None,
            turned_from: None,
            regions: Vec::new(),
            matched: Vec::new(),
            finds: Vec::new(),
            sharpest: None,
            starts: Vec::new(),
            answers: Vec::new(),
        })
    }

    /// Lengths of the memory to be lent.
    #[must_use]
    pub fn needs(&self, camera: &Camera) -> OneClickNeeds {
        OneClickNeeds::of(self.pixels, camera)
    }

    /// First poses, best first, as far as they are known.
    #[must_use]
    pub fn starts(&self) -> &[Start] {
        &self.starts
    }

    /// Refined poses, best first, as far as they are known.
    #[must_use]
    pub fn answers(&self) -> &[Answer] {
        &self.answers
    }

    /// How far the work is.
    #[must_use]
    pub fn progress(&self) -> Progress {
        let looks = self.looks() as f64;
        let done = |look: usize, share: f64| match self.round {
            0 => Progress::Regions(0.5 * (look as f64 + share) / looks),
            _ => Progress::Poses(0.58),
        };
        let left = |count: usize, of: usize| count as f64 / of as f64;
        match self.stage {
            Stage::Look(look) => done(look, 0.0),
            Stage::Match(look) => done(look, 0.7 - 0.6 * left(self.regions.len(), REGIONS)),
            Stage::Judge(look) => done(look, 1.0 - 0.3 * left(self.finds.len(), FINDS)),
            Stage::Refine(start) => {
                Progress::Poses(0.5 + 0.08 * (self.round as f64 + left(start, STARTS)))
            }
            Stage::Narrow => Progress::Poses(0.58),
            Stage::Around(_) => Progress::Poses(0.5 + 0.08 * self.round as f64),
            Stage::Mirror(_) => Progress::Poses(0.9),
            Stage::Done => Progress::Done,
        }
    }

    /// Ways the film is looked at: from each seed, smoothed each way. Of a box the first shows
    /// how many seeds there are.
    fn looks(&self) -> usize {
        SMOOTHING.len() * self.seeds.len().max(1)
    }

    /// Does the next part of the work, some tens of milliseconds of it, or one refinement. Gives
    /// whether there is more to do. Scene, part and memory are the same from the first step to the
    /// last, and nobody else uses `memory` in between.
    ///
    /// # Errors
    /// [`OneClickError`]; the work cannot go on then.
    pub fn step(
        &mut self,
        scene: &Scene<'_>,
        part: Option<&Part<'_>>,
        memory: &mut OneClickMemory<'_>,
    ) -> Result<bool, OneClickError> {
        memory.check(&OneClickNeeds::of(self.pixels, scene.camera))?;
        let memory = &mut memory.cut(self.window.pixels());
        self.stage = match (self.stage, part) {
            (Stage::Look(look), _) => {
                let step = self.look(look, scene, memory);
                self.list_regions(look, step, memory);
                Stage::Match(look)
            }
            (Stage::Match(look), _) => match self.regions.pop() {
                Some(region) => {
                    self.try_region(region, scene, part, memory)?;
                    Stage::Match(look)
                }
                None => Stage::Judge(look),
            },
            (Stage::Judge(look), Some(part)) => match self.finds.pop() {
                Some(find) => {
                    self.judge(&find, scene, part, memory)?;
                    Stage::Judge(look)
                }
                None => self.after_look(look, true)?,
            },
            (Stage::Judge(look), None) => self.after_look(look, false)?,
            (Stage::Refine(at), Some(part)) => match self.next_start(at) {
                Some((at, start)) => {
                    self.refine(&start, scene, part, memory)?;
                    Stage::Refine(at + 1)
                }
                None => self.next_round(),
            },
            (Stage::Narrow, Some(part)) => {
                self.narrow(scene, part, memory);
                Stage::Look(0)
            }
            (Stage::Around(at), Some(part)) => match self.turned(at, part) {
                Some(find) => {
                    self.judge(&find, scene, part, memory)?;
                    Stage::Around(at + 1)
                }
                None => Stage::Refine(0),
            },
            (Stage::Mirror(at), Some(part)) => {
                if self.mirror(at, scene, part, memory)? {
                    Stage::Mirror(at + 1)
                } else {
                    self.end()?
                }
            }
            (
                Stage::Refine(_)
                | Stage::Around(_)
                | Stage::Narrow
                | Stage::Mirror(_)
                | Stage::Done,
                _,
            ) => Stage::Done,
        };
        Ok(self.stage != Stage::Done)
    }

    fn after_look(&mut self, look: usize, with_part: bool) -> Result<Stage, OneClickError> {
        let [near, covered] = SEEN;
        let seen = |best: &Start| best.support.share >= near && best.overlap >= covered;
        let enough = self.starts.first().is_some_and(seen);
        if !enough && look + 1 < self.looks() {
            return Ok(Stage::Look(look + 1));
        }
        if self.sharpest.is_none() && !with_part {
            return Err(OneClickError::NoRegion);
        }
        Ok(Stage::Refine(0))
    }

    /// The next start from number `at` on that is worth refining.
    fn next_start(&self, at: usize) -> Option<(usize, Start)> {
        let best = self.starts.first()?.score;
        let least = best * if self.is_convinced() { RIVAL } else { WORTH };
        let worth = |start: &Start| start.score > 0.0 && start.score >= least;
        let start = self.starts.get(at).copied().filter(worth);
        start.map(|start| (at, start))
    }

    fn end(&mut self) -> Result<Stage, OneClickError> {
        self.answers
            .retain(|answer| answer.score > 0.0 && answer.support.share >= LEAST_SHARE);
        match self.answers.first() {
            Some(_) => Ok(Stage::Done),
            None if self.sharpest.is_none() => Err(OneClickError::NoRegion),
            None => Err(OneClickError::NoFit),
        }
    }
}
