//! The work, step by step.

use super::candidates::Start;
use super::error::OneClickError;
use super::memory::{OneClickMemory, OneClickNeeds};
use super::observation::Observation;
use super::state::{LOCATED, OneClick, REGIONS, STARTS, Stage};
use fluoropose::finder::Component;
use fluoropose::image::blank::{ONE_GREY, is_blank};

/// No further pass is needed where the outline of a first pose lies near edges by the first fraction, and covers its
/// region by the second.
const SEEN: [f64; 2] = [0.9, 0.85];
/// Once an answer is convincing, only first poses are refined whose score is at least this fraction of the best.
const RIVAL: f64 = 0.97;
/// A first pose whose score is below this fraction of the best is not refined.
const WORTH: f64 = 0.6;
/// The least fraction of the outline that must lie on edges for an answer to count.
const LEAST_FRACTION: f64 = 0.35;

/// How far the work is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Progress {
    /// Regions are searched; the fraction of the work that is done, 0 to 1.
    Regions(f64),
    /// Poses are refined; the fraction of the work that is done, 0 to 1.
    Poses(f64),
    /// Everything is done.
    Done,
}

impl OneClick {
    /// How far the work is.
    #[must_use]
    pub fn progress(&self) -> Progress {
        let passes = self.passes() as f64;
        let poses = |part: f64| Progress::Poses(self.done + (1.0 - self.done) * part);
        let done = |pass: usize, fraction: f64| match self.round {
            0 => {
                let part = 0.5 * (pass as f64 + fraction) / passes;
                Progress::Regions(self.done + (1.0 - self.done) * part)
            }
            _ => poses(0.62),
        };
        // After the joint.
        let least = if self.round == 0 { 0.0 } else { 0.62 };
        let left = |count: usize, of: usize| count as f64 / of as f64;
        match self.stage {
            Stage::Preprocess(pass) => done(pass, 0.0),
            Stage::Match(pass) => done(pass, 0.7 - 0.6 * left(self.regions.len(), REGIONS)),
            Stage::Score(pass) => done(pass, 1.0 - 0.3 * left(self.located.len(), LOCATED)),
            Stage::Refine(start) => {
                let part = 0.5 + 0.08 * (self.round as f64 + left(start, STARTS));
                poses(part.max(least))
            }
            Stage::Bends | Stage::Slide => poses(0.58 + 0.04 * self.slid()),
            Stage::InJoint(_) | Stage::Narrow => poses(0.62),
            Stage::Around(_) => poses((0.5 + 0.08 * self.round as f64).max(least)),
            Stage::Beyond(_) => poses(0.85),
            Stage::Mirror(_) | Stage::Beside(_) => poses(0.9),
            Stage::Done => Progress::Done,
        }
    }

    /// Does the next part of the work: a refinement, or something that takes some tens of milliseconds. Returns whether
    /// there is more to do. Observation, component and memory are the same from the first step to the last, and `memory`
    /// is not changed in between.
    ///
    /// # Errors
    /// [`OneClickError`], after which the work cannot go on.
    pub fn step(
        &mut self,
        observation: &Observation<'_>,
        component: Option<&Component<'_>>,
        memory: &mut OneClickMemory<'_>,
    ) -> Result<bool, OneClickError> {
        memory.borrow(&self.needs(observation.camera))?;
        let needs = OneClickNeeds::of(self.window.pixels(), observation.camera);
        let memory = &mut memory.borrow(&needs)?;
        self.stage = match component {
            Some(component) => self.pose_step(observation, component, memory)?,
            None => self.region_step(observation, memory)?,
        };
        Ok(self.stage != Stage::Done)
    }

    /// One step of the stages that need no component; what comes next.
    fn region_step(
        &mut self,
        observation: &Observation<'_>,
        memory: &mut OneClickMemory<'_>,
    ) -> Result<Stage, OneClickError> {
        match self.stage {
            Stage::Preprocess(pass) => Ok(self.preprocess_pass(pass, observation, memory)),
            Stage::Match(pass) => self.match_next(pass, observation, None, memory),
            Stage::Score(pass) => self.after_pass(pass, observation, false),
            _ => Ok(Stage::Done),
        }
    }

    /// One step of the work for a component; what comes next.
    fn pose_step(
        &mut self,
        observation: &Observation<'_>,
        component: &Component<'_>,
        memory: &mut OneClickMemory<'_>,
    ) -> Result<Stage, OneClickError> {
        Ok(match self.stage {
            Stage::Preprocess(pass) => self.preprocess_pass(pass, observation, memory),
            Stage::Match(pass) => self.match_next(pass, observation, Some(component), memory)?,
            Stage::Score(pass) => match self.located.pop() {
                Some(located) => {
                    self.score(&located, observation, component, memory)?;
                    Stage::Score(pass)
                }
                None => self.after_pass(pass, observation, true)?,
            },
            Stage::Refine(at) => match self.worth_refining(at) {
                Some(start) => {
                    self.refine(&start, observation, component, memory)?;
                    Stage::Refine(at + 1)
                }
                None => self.next_round(),
            },
            Stage::Narrow => {
                self.narrow(observation, component, memory);
                Stage::Preprocess(0)
            }
            Stage::Around(at) => match self.rotated(at, component) {
                Some(located) => {
                    self.score(&located, observation, component, memory)?;
                    Stage::Around(at + 1)
                }
                None => Stage::Refine(0),
            },
            Stage::Bends => {
                self.begin_in_joint(observation, component, memory);
                Stage::Slide
            }
            Stage::Slide => match self.slide(observation, component, memory) {
                true => Stage::Slide,
                false => Stage::InJoint(0),
            },
            Stage::InJoint(_) | Stage::Beyond(_) | Stage::Mirror(_) | Stage::Beside(_) => {
                self.farther_step(observation, component, memory)?
            }
            Stage::Done => Stage::Done,
        })
    }

    /// One step of the stages that look at poses away from those that the place led to; what comes next.
    fn farther_step(
        &mut self,
        observation: &Observation<'_>,
        component: &Component<'_>,
        memory: &mut OneClickMemory<'_>,
    ) -> Result<Stage, OneClickError> {
        Ok(match self.stage {
            Stage::InJoint(at) => {
                if self.refine_in_joint(at, observation, component, memory)? {
                    Stage::InJoint(at + 1)
                } else {
                    self.after_joint()
                }
            }
            Stage::Beyond(at) => {
                if self.look_beyond(at, observation, component, memory)? {
                    Stage::Beyond(at + 1)
                } else {
                    Stage::Mirror(0)
                }
            }
            Stage::Mirror(at) => {
                if self.mirror(at, observation, component, memory)? {
                    Stage::Mirror(at + 1)
                } else {
                    self.rotated_from = self.answers.first().copied();
                    Stage::Beside(0)
                }
            }
            Stage::Beside(at) => {
                if self.look_beside(at, observation, component, memory)? {
                    Stage::Beside(at + 1)
                } else {
                    self.end(observation)?
                }
            }
            stage => stage,
        })
    }

    fn preprocess_pass(
        &mut self,
        pass: usize,
        observation: &Observation<'_>,
        memory: &mut OneClickMemory<'_>,
    ) -> Stage {
        let step = self.preprocess(pass, observation, memory);
        self.list_regions(pass, step, memory);
        Stage::Match(pass)
    }

    fn match_next(
        &mut self,
        pass: usize,
        observation: &Observation<'_>,
        component: Option<&Component<'_>>,
        memory: &mut OneClickMemory<'_>,
    ) -> Result<Stage, OneClickError> {
        let Some(region) = self.regions.pop() else {
            return Ok(Stage::Score(pass));
        };
        self.try_region(region, observation, component, memory)?;
        Ok(Stage::Match(pass))
    }

    fn after_pass(
        &mut self,
        pass: usize,
        observation: &Observation<'_>,
        with_component: bool,
    ) -> Result<Stage, OneClickError> {
        let [near, covered] = SEEN;
        let seen = |best: &Start| best.support.fraction >= near && best.overlap >= covered;
        let enough = self.starts.first().is_some_and(seen);
        if !enough && pass + 1 < self.passes() {
            return Ok(Stage::Preprocess(pass + 1));
        }
        if self.sharpest.is_none() && !with_component {
            return Err(blank_or(OneClickError::NoRegion, observation));
        }
        Ok(Stage::Refine(0))
    }

    /// First pose number `at`, where it is worth refining.
    fn worth_refining(&self, at: usize) -> Option<Start> {
        let best = self.starts.first()?.score;
        let least = best * if self.is_convinced() { RIVAL } else { WORTH };
        let worth = |start: &Start| start.score > 0.0 && start.score >= least;
        self.starts.get(at).copied().filter(worth)
    }

    fn end(&mut self, observation: &Observation<'_>) -> Result<Stage, OneClickError> {
        self.answers
            .retain(|answer| answer.score > 0.0 && answer.support.fraction >= LEAST_FRACTION);
        match self.answers.is_empty() {
            false => Ok(Stage::Done),
            true if self.begin_otherwise(observation.camera)? => Ok(Stage::Preprocess(0)),
            true if self.sharpest.is_none() => Err(blank_or(OneClickError::NoRegion, observation)),
            true => Err(blank_or(OneClickError::NoFit, observation)),
        }
    }
}

/// Why there is no answer: noise of a frame that shows nothing has regions too.
fn blank_or(why: OneClickError, observation: &Observation<'_>) -> OneClickError {
    match is_blank(observation.frame, ONE_GREY) {
        true => OneClickError::Blank,
        false => why,
    }
}
