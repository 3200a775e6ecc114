//! The work, step by step.

use heapless::Vec;

use super::expect::Expected;
use super::grow::grow;
use super::propose::{SEEDS, agreement, is_possible, overlap, poses_of, seeds_in};
use super::shape::Shaper;
use super::support::{Support, support};
use super::tally::{CHOSEN, Tally};
use super::window::{BLOCKED, LEVELS, Window, look};
use super::{OneClickError, OneClickMemory, OneClickNeeds, Part, Prompt, Scene};
use crate::camera::Camera;
use crate::contour::Point;
use crate::mask::{Mask, MaskMut, words_needed};
use crate::mirror::mirror_pose;
use crate::moments::Moments;
use crate::pose::{Pose, geodesic_deg};
use crate::refine::{ImageTarget, RefineOptions, Refined, View, refine};
use crate::silhouette::Silhouette;

/// First poses that are refined at most.
pub const STARTS: usize = 6;
/// Refined poses that are kept at most.
pub const ANSWERS: usize = 8;

/// Passes of the binomial filter: variances of 1 and of 4 square pixels. Noise that hides a border
/// at the first does not at the second, which rounds what is thin.
const SMOOTHING: [usize; 2] = [2, 8];
/// Radii of the discs that cut bridges, in parts of the expected size.
const RADII: [f64; 5] = [0.0, 0.02, 0.04, 0.07, 0.1];
/// Regions that are looked at, at most.
const REGIONS: usize = 48;

/// Sides of a box are at least so long, pixels.
const LEAST_BOX: f64 = 16.0;
/// A box is widened by this part of its sides: it may be drawn a little too tight.
const WIDEN: f64 = 0.03;
/// How far round a click the darkest pixel is taken for the seed.
const DARKEST: isize = 3;

/// Edges are looked for so near to a refined outline, pixels.
const CLOSE: f64 = 1.5;
/// Of poses that differ by less than this, degrees and parts of the distance, the better is kept.
const SAME_DEG: f64 = 2.0;
const SAME_PLACE: f64 = 0.01;
/// A start whose score is below this part of the best is not refined.
const WORTH: f64 = 0.6;
/// Least part of the outline that must lie on edges for an answer to be one.
const LEAST_SHARE: f64 = 0.35;

/// What a region is judged by.
pub(super) struct Goal<'g> {
    pub(super) prompt: &'g Prompt,
    pub(super) expected: &'g Expected,
    /// Slope of an edge of metal, grey values a pixel.
    pub(super) slope: f64,
    pub(super) region: Region,
}

/// How a region was cut out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Region {
    look: usize,
    level: u16,
    radius: f64,
}

/// A first pose and what speaks for it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// `camera_from_model`.
    pub pose: Pose,
    pub(super) region: Region,
    /// What the region and the model drawn at the pose have in common, 0 to 1.
    pub overlap: f64,
    /// What the frame says of the outline there.
    pub support: Support,
    /// Overlap and strength of edges together, 0 to 2, where the prompt agrees.
    pub score: f64,
}

/// A refined pose and what speaks for it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Answer {
    /// The pose, refined on the frame.
    pub refined: Refined,
    /// The first pose that led to it.
    pub start: Pose,
    /// What the frame says of the outline.
    pub support: Support,
    /// What the region of the start and the silhouette have in common, 0 to 1.
    pub overlap: f64,
    /// Whether it was refined from the mirror image of another answer.
    pub mirrored: bool,
    /// Strength of edges, where the prompt agrees: answers are in its order.
    pub score: f64,
}

/// What is done next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stage {
    Look(usize),
    Match(usize),
    Refine(usize),
    Mirror,
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
    prompt: Prompt,
    expected: Expected,
    window: Window,
    stage: Stage,
    /// The look that is in memory.
    current: Option<usize>,
    /// Of a box.
    seeds: Vec<usize, SEEDS>,
    /// Grey values a pixel.
    slope: f64,
    regions: Vec<Region, REGIONS>,
    /// Of the regions that were matched in this look, so that none is matched twice.
    matched: Vec<Moments, REGIONS>,
    best_region: Option<(f64, Region)>,
    starts: Vec<Start, STARTS>,
    answers: Vec<Answer, ANSWERS>,
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
        Ok(Self {
            window: window_of(&prompt, camera, expected.extent)?,
            prompt,
            expected,
            stage: Stage::Look(0),
            current: None,
            seeds: Vec::new(),
            slope: 0.0,
            regions: Vec::new(),
            matched: Vec::new(),
            best_region: None,
            starts: Vec::new(),
            answers: Vec::new(),
        })
    }

    /// Lengths of the memory to be lent.
    #[must_use]
    pub fn needs(&self, camera: &Camera) -> OneClickNeeds {
        OneClickNeeds::of(self.window.pixels(), camera)
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

    /// Slope of an edge of metal here, grey values a pixel.
    #[must_use]
    pub fn slope(&self) -> f64 {
        self.slope
    }

    /// How far the work is.
    #[must_use]
    pub fn progress(&self) -> Progress {
        let looks = self.looks() as f64;
        match self.stage {
            Stage::Look(look) => Progress::Regions(0.4 * look as f64 / looks),
            Stage::Match(look) => {
                let left = self.regions.len() as f64 / REGIONS as f64;
                Progress::Regions(0.4 * (look as f64 + 1.0 - left) / looks)
            }
            Stage::Refine(start) => Progress::Poses(0.4 + 0.1 * start as f64),
            Stage::Mirror => Progress::Poses(0.9),
            Stage::Done => Progress::Done,
        }
    }

    /// Ways the film is looked at; of a box it shows with the first.
    fn looks(&self) -> usize {
        SMOOTHING.len() * self.seeds.len().max(1)
    }

    /// Does the next part of the work, some tens of milliseconds of it. Gives whether there is more to
    /// do. Scene, part and memory are the same from the first step to the last, and nobody else
    /// uses `memory` in between.
    ///
    /// # Errors
    /// [`OneClickError`]; the work cannot go on then.
    pub fn step(
        &mut self,
        scene: &Scene<'_>,
        part: Option<&Part<'_>>,
        memory: &mut OneClickMemory<'_>,
    ) -> Result<bool, OneClickError> {
        memory.check(&self.needs(scene.camera))?;
        self.stage = match self.stage {
            Stage::Look(look) => {
                let step = self.look(look, scene, memory);
                self.list_regions(look, step, memory);
                Stage::Match(look)
            }
            Stage::Match(look) => match (self.regions.pop(), part) {
                (Some(region), Some(part)) => {
                    self.try_region(region, scene, part, memory)?;
                    Stage::Match(look)
                }
                _ => self.after_look(look, part)?,
            },
            Stage::Refine(at) => match (self.starts.get(at).copied(), part) {
                (Some(start), Some(part)) if self.is_worth(&start) => {
                    self.refine_start(&start, scene, part, memory)?;
                    Stage::Refine(at + 1)
                }
                _ => Stage::Mirror,
            },
            Stage::Mirror => {
                if let Some(part) = part {
                    self.mirror(scene, part, memory);
                    self.answers.retain(|answer| answer.support.share >= LEAST_SHARE);
                    if self.answers.is_empty() {
                        return Err(OneClickError::NoFit);
                    }
                }
                Stage::Done
            }
            Stage::Done => Stage::Done,
        };
        Ok(self.stage != Stage::Done)
    }

    fn is_worth(&self, start: &Start) -> bool {
        let best = self.starts.first().map_or(0.0, |best| best.score);
        start.score > 0.0 && start.score >= WORTH * best
    }

    fn after_look(&mut self, look: usize, part: Option<&Part<'_>>) -> Result<Stage, OneClickError> {
        if look + 1 < self.looks() {
            return Ok(Stage::Look(look + 1));
        }
        if self.best_region.is_none() {
            return Err(OneClickError::NoRegion);
        }
        match part {
            Some(_) if self.starts.is_empty() => Err(OneClickError::NoFit),
            Some(_) => Ok(Stage::Refine(0)),
            None => Ok(Stage::Done),
        }
    }

    /// Brings a look into memory: the film smoothed, and grown from its seed. Gives the grey values that a step of it
    /// stands for.
    fn look(&mut self, at: usize, scene: &Scene<'_>, memory: &mut OneClickMemory<'_>) -> f64 {
        let passes = SMOOTHING[at % SMOOTHING.len()];
        let how = (scene.polarity, passes);
        let histogram = memory.tallies.get_mut(..LEVELS).unwrap_or_default();
        let (window, grey) = (&self.window, &mut *memory.grey);
        let step = look(scene.frame, window, how, scene.excluded, grey, histogram);
        if self.seeds.is_empty() {
            match self.prompt {
                Prompt::Click(click) => {
                    let _ = self.seeds.push(darkest_near(click, window, grey));
                }
                Prompt::Box(..) => self.seeds = seeds_in(window, memory),
            }
        }
        let seed = self.seed(at);
        grow(memory.grey, &self.window, seed, memory.reached, memory.links);
        self.current = Some(at);
        step
    }

    fn seed(&self, look: usize) -> usize {
        self.seeds.get(look / SMOOTHING.len()).copied().unwrap_or(0)
    }

    /// Lists the regions of a look that are worth matching, the best last.
    fn list_regions(&mut self, look: usize, step: f64, memory: &mut OneClickMemory<'_>) {
        let seed = self.seed(look);
        let base = memory.reached.get(seed).copied().unwrap_or(BLOCKED);
        let (grey, reached) = (&*memory.grey, &*memory.reached);
        let tally = Tally::new(grey, reached, &self.window, base, memory.tallies);
        if let Some(peak) = tally.peak(self.expected.areas) {
            self.slope = self.slope.max(step * tally.sharpness(peak));
        }
        let levels: Vec<u16, CHOSEN> = tally.levels(self.expected.areas);
        self.regions.clear();
        for share in RADII.into_iter().rev() {
            let radius = share * self.expected.size;
            for &level in levels.iter().rev() {
                if radius == 0.0 || radius >= 1.0 {
                    // There is room for all radii of all levels.
                    let _ = self.regions.push(Region {
                        look,
                        level,
                        radius,
                    });
                }
            }
        }
    }

    /// Draws a region, and what is in doubt of it.
    fn draw(
        &mut self,
        region: &Region,
        scene: &Scene<'_>,
        memory: &mut OneClickMemory<'_>,
    ) -> Result<(), OneClickError> {
        if self.current != Some(region.look) {
            self.look(region.look, scene, memory);
        }
        let (width, height) = (scene.camera.width(), scene.camera.height());
        let (a, b) = memory.words.split_at_mut(words_needed(width, height));
        let mut shape = MaskMut::new(a, width, height)?;
        let mut doubt = MaskMut::new(b, width, height)?;
        let mut shaper = Shaper {
            window: self.window,
            reached: &*memory.reached,
            distance: &mut *memory.distance,
            marks: &mut *memory.marks,
            stack: &mut *memory.links,
        };
        let (seed, level) = (self.seed(region.look), region.level);
        shaper.shape(seed, level, region.radius, &mut shape, &mut doubt);
        Ok(())
    }

    /// Draws a region and adds the poses that the library has for it to the starts.
    fn try_region(
        &mut self,
        region: Region,
        scene: &Scene<'_>,
        part: &Part<'_>,
        memory: &mut OneClickMemory<'_>,
    ) -> Result<(), OneClickError> {
        self.draw(&region, scene, memory)?;
        let moments = region_of(scene, memory)?.moments();
        let [least, most] = self.expected.areas;
        if !(least..=most).contains(&(moments.area as f64)) || self.was_matched(&moments) {
            return Ok(());
        }
        self.best_region.get_or_insert((0.0, region));
        // Of more regions than are remembered some may be matched twice.
        let _ = self.matched.push(moments);
        let goal = Goal {
            prompt: &self.prompt,
            expected: &self.expected,
            slope: self.slope,
            region,
        };
        for start in poses_of(scene, part, &goal, memory)? {
            self.keep_start(start, part);
        }
        Ok(())
    }

    fn was_matched(&self, moments: &Moments) -> bool {
        let at = moments.centroid();
        self.matched.iter().any(|other| {
            let there = other.centroid();
            let apart = libm::hypot(at.column - there.column, at.row - there.row);
            let ratio = moments.area as f64 / other.area.max(1) as f64;
            (ratio - 1.0).abs() < SAME_PLACE && apart < 1.0
        })
    }

    fn keep_start(&mut self, start: Start, part: &Part<'_>) {
        let starts = &mut self.starts;
        let twin = starts.iter().position(|other| same(&other.pose, &start.pose, part));
        match twin {
            Some(at) if starts[at].score >= start.score => return,
            Some(at) => {
                starts.remove(at);
            }
            None => {}
        }
        let place = starts.partition_point(|other| other.score >= start.score);
        if starts.is_full() && place < starts.len() {
            starts.pop();
        }
        // Of more starts than are kept the worst is lost.
        let _ = starts.insert(place, start);
    }

    /// Brings a start onto the outline of its region and then onto the frame.
    fn refine_start(
        &mut self,
        start: &Start,
        scene: &Scene<'_>,
        part: &Part<'_>,
        memory: &mut OneClickMemory<'_>,
    ) -> Result<(), OneClickError> {
        self.draw(&start.region, scene, memory)?;
        let (width, height) = (scene.camera.width(), scene.camera.height());
        let (a, b) = memory.words.split_at(words_needed(width, height));
        let (shape, doubt) = (Mask::new(a, width, height)?, Mask::new(b, width, height)?);
        let silhouette = Silhouette::new(&shape, &doubt)?;
        let view = View::only(scene.camera, silhouette);
        let options = RefineOptions::default();
        let onto = refine(part.mesh, &[view], &start.pose, options, &mut memory.refine);
        let from = [onto.map(|refined| refined.pose).ok(), Some(start.pose)];
        for pose in from.into_iter().flatten() {
            if let Some(answer) = self.onto_frame(&pose, start, scene, part, memory) {
                self.keep_answer(answer, part);
            }
        }
        Ok(())
    }

    /// Refines a pose on the frame and judges what comes of it.
    fn onto_frame(
        &self,
        pose: &Pose,
        start: &Start,
        scene: &Scene<'_>,
        part: &Part<'_>,
        memory: &mut OneClickMemory<'_>,
    ) -> Option<Answer> {
        let target = ImageTarget {
            frame: scene.frame,
            unknown: scene.excluded,
            polarity: scene.polarity,
        };
        let view = View::only(scene.camera, target);
        let options = RefineOptions::default();
        let refined = refine(part.mesh, &[view], pose, options, &mut memory.refine).ok()?;
        if !is_possible(&refined.pose, part, &self.expected) {
            return None;
        }
        let how = (CLOSE, self.slope);
        let support = support(scene, part.mesh, &refined.pose, how, &mut memory.refine).ok()?;
        let (width, height) = (scene.camera.width(), scene.camera.height());
        let drawn = memory.refine.drawn.get(..words_needed(width, height))?;
        let drawn = Mask::new(drawn, width, height).ok()?;
        Some(Answer {
            refined,
            start: start.pose,
            support,
            overlap: overlap(&region_of(scene, memory).ok()?, &drawn),
            mirrored: false,
            score: agreement(&self.prompt, &drawn) * support.strength,
        })
    }

    fn keep_answer(&mut self, answer: Answer, part: &Part<'_>) {
        let answers = &mut self.answers;
        let pose = &answer.refined.pose;
        let twin = answers.iter().position(|other| same(&other.refined.pose, pose, part));
        match twin {
            Some(at) if answers[at].score >= answer.score => return,
            Some(at) => {
                answers.remove(at);
            }
            None => {}
        }
        let place = answers.partition_point(|other| other.score >= answer.score);
        if answers.is_full() && place < answers.len() {
            answers.pop();
        }
        // Of more answers than are kept the worst is lost.
        let _ = answers.insert(place, answer);
    }

    /// Refines the mirror images of the best answer: its rivals.
    fn mirror(&mut self, scene: &Scene<'_>, part: &Part<'_>, memory: &mut OneClickMemory<'_>) {
        let Some(best) = self.answers.first().copied() else {
            return;
        };
        let Some(start) = self.starts.first().copied() else {
            return;
        };
        for plane in part.planes {
            let pose = mirror_pose(&best.refined.pose, plane);
            if let Some(answer) = self.onto_frame(&pose, &start, scene, part, memory) {
                let mirrored = Answer {
                    start: pose,
                    mirrored: true,
                    ..answer
                };
                self.keep_answer(mirrored, part);
            }
        }
    }
}

/// Whether two poses are one, up to what refinement leaves.
fn same(a: &Pose, b: &Pose, part: &Part<'_>) -> bool {
    let middle = part.mesh.bounds().centre;
    let (here, there) = (a.transform(&middle), b.transform(&middle));
    let apart = crate::math::norm(&core::array::from_fn(|k| here[k] - there[k]));
    geodesic_deg(&a.rotation, &b.rotation) < SAME_DEG && apart < SAME_PLACE * here[2].abs()
}

/// The region that was drawn last.
fn region_of<'m>(
    scene: &Scene<'_>,
    memory: &'m OneClickMemory<'_>,
) -> Result<Mask<'m>, OneClickError> {
    let (width, height) = (scene.camera.width(), scene.camera.height());
    let words = memory.words.get(..words_needed(width, height));
    Ok(Mask::new(words.unwrap_or_default(), width, height)?)
}

/// The part of the frame to look at.
fn window_of(prompt: &Prompt, camera: &Camera, extent: f64) -> Result<Window, OneClickError> {
    let size = (camera.width(), camera.height());
    let (width, height) = (size.0 as f64, size.1 as f64);
    match *prompt {
        Prompt::Click(Point { column, row }) => {
            if !((0.0..width).contains(&column) && (0.0..height).contains(&row)) {
                return Err(OneClickError::Outside("click"));
            }
            let sides = [column - extent, row - extent, column + extent, row + extent];
            Ok(Window::cut(sides, size))
        }
        Prompt::Box(low, high) => {
            let cut = |a: f64, b: f64, most: f64| (a.min(b).max(0.0), a.max(b).min(most));
            let (left, right) = cut(low.column, high.column, width);
            let (top, bottom) = cut(low.row, high.row, height);
            // A NaN is in no range.
            let large = |side: f64| (LEAST_BOX..=f64::INFINITY).contains(&side);
            if !(large(right - left) && large(bottom - top)) {
                return Err(OneClickError::SmallBox {
                    width: right - left,
                    height: bottom - top,
                    least: LEAST_BOX,
                });
            }
            let (x, y) = (WIDEN * (right - left), WIDEN * (bottom - top));
            Ok(Window::cut([left - x, top - y, right + x, bottom + y], size))
        }
    }
}

/// The darkest pixel near a click: it may have met a speck of noise, or missed a thin part.
fn darkest_near(click: Point, window: &Window, grey: &[u16]) -> usize {
    let middle = window.index(click.column, click.row);
    let mut best = (grey.get(middle).copied().unwrap_or(BLOCKED), middle);
    for down in -DARKEST..=DARKEST {
        for right in -DARKEST..=DARKEST {
            let at = window.index(click.column + right as f64, click.row + down as f64);
            let value = grey.get(at).copied().unwrap_or(BLOCKED);
            if value < best.0 {
                best = (value, at);
            }
        }
    }
    best.1
}
