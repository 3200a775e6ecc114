//! Poses scored and refined, round after round.

use super::candidates::{Answer, LocatedPose, SAME_ANSWER, SAME_START, Start, keep};
use super::drawn::drawn_at;
use super::error::OneClickError;
use super::memory::OneClickMemory;
use super::observation::Observation;
use super::prompt::Prompt;
use super::state::{OneClick, Stage};
use fluoropose::finder::Component;
use fluoropose::image::contour::Point;
use fluoropose::math::{Vector3, apply, multiply, radians, rotation_by, sin_cos};
use fluoropose::mesh::Model;
use fluoropose::mesh::mirror::mirror_pose;
use fluoropose::mesh::symmetry::is_nearly_symmetric;
use fluoropose::pose::Pose;

/// Once an answer has this score, no further round is tried.
const CONVINCING: f64 = 0.6;
/// The same of a component beside the other one of its joint: a tray that is faint has 0.46 to 0.66, what lies elsewhere 0.33 at most.
const IN_JOINT: f64 = 0.45;
/// From the third round on the best answer is rotated about the camera's x and y axes by up to this number of steps to
/// either side,
const TURNS: i32 = 2;
/// each of this many degrees,
const TURN_DEG: f64 = 7.0;
/// and placed at these multiples of its distance, which is wrong where the region lacked a faint part of the implant or held
/// something else.
const DISTANCES: [f64; 3] = [1.0, 0.96, 1.04];
/// The box of the second round is wider than the best answer's silhouette by this fraction of its longer side, like a box
/// that a person draws.
const MARGIN: f64 = 0.1;
/// The greatest number of rounds.
const ROUNDS: usize = 4;
/// The best answer is refined from so many sides, turned out of the image plane by so many degrees.
const BESIDE: usize = 6;
const BESIDE_DEG: f64 = 9.0;
/// A mirror image is refined where the edges near its outline have at least this fraction of the strength of the best
/// answer's.
const MIRRORED: f64 = 0.8;

impl OneClick {
    pub(super) fn is_convinced(&self) -> bool {
        self.answers
            .first()
            .is_some_and(|best| best.score >= CONVINCING)
    }

    /// What to do when no first pose is left: search where the joint leaves the component, where that is known, and more closely, unless
    /// the best answer is convincing.
    pub(super) fn next_round(&mut self) -> Stage {
        self.round += 1;
        match self.joint {
            Some(_) if !self.is_convinced() => Stage::Bends,
            _ => self.search_closer(),
        }
    }

    /// What to do when the joint has told all.
    pub(super) fn after_joint(&mut self) -> Stage {
        self.joint = None;
        match self.answers.first() {
            Some(best) if best.score >= IN_JOINT => Stage::Beyond(0),
            _ => self.search_closer(),
        }
    }

    fn search_closer(&mut self) -> Stage {
        let hopeless = self.answers.is_empty() && self.round > 1;
        if hopeless || self.is_convinced() {
            return Stage::Beyond(0);
        }
        self.starts.clear();
        match self.round {
            1 => {
                self.matched.clear();
                Stage::Narrow
            }
            2..ROUNDS if self.answers.first() != self.rotated_from.as_ref() => {
                self.rotated_from = self.answers.first().copied();
                Stage::Around(0)
            }
            _ => Stage::Beyond(0),
        }
    }

    /// Narrows the window to a rough box around the silhouette of the best answer: what regions have leaked into lies
    /// beyond it, and fainter parts of the implant can be reached. Where there is no answer, the box is one around the
    /// click of at most the component's size: the click may have hit a faint part, and the dark parts around it lead on.
    pub(super) fn narrow(
        &mut self,
        observation: &Observation<'_>,
        component: &Component<'_>,
        memory: &mut OneClickMemory<'_>,
    ) {
        let sides = match (self.answers.first(), self.prompt) {
            (Some(best), _) => sides_of(&best.refined.pose, observation, component, memory),
            (None, Prompt::Click(Point { column, row })) => {
                let reach = self.expected.extent / 2.0;
                Some([column - reach, row - reach, column + reach, row + reach])
            }
            (None, Prompt::Box(..)) => None,
        };
        let Some([left, top, right, bottom]) = sides else {
            return;
        };
        let within =
            |at: f64, first: usize, length: usize| at.clamp(first as f64, (first + length) as f64);
        let column = |at: f64| within(at, self.window.left, self.window.width);
        let row = |at: f64| within(at, self.window.top, self.window.height);
        let low = Point::new(column(left), row(top));
        let narrowed = Prompt::Box(low, Point::new(column(right), row(bottom)));
        if let Ok(window) = narrowed.window(observation.camera, 0.0)
            && window.pixels() <= self.window.pixels()
        {
            self.window = window;
            self.narrowed = Some(narrowed);
            self.seeds.clear();
            self.current = None;
        }
    }

    /// The best answer rotated and moved in way number `at`; `None` after the last way.
    pub(super) fn rotated(&self, at: usize, component: &Component<'_>) -> Option<LocatedPose> {
        let best = self.answers.first()?;
        let side = 2 * TURNS + 1;
        let number = i32::try_from(at)
            .ok()
            .filter(|&number| number < side * side * DISTANCES.len() as i32)?;
        let distance = DISTANCES[(number / (side * side)) as usize];
        let number = number % (side * side);
        let steps = [number % side - TURNS, number / side - TURNS];
        let [x, y] = steps.map(|steps| radians(TURN_DEG * f64::from(steps)));
        Some(LocatedPose {
            pose: turned(&best.refined.pose, &[x, y, 0.0], distance, component.model),
            region: None,
            mismatch: 0.0,
        })
    }

    /// Draws the model at a located pose and puts it among the first poses.
    pub(super) fn score(
        &mut self,
        located: &LocatedPose,
        observation: &Observation<'_>,
        component: &Component<'_>,
        memory: &mut OneClickMemory<'_>,
    ) -> Result<(), OneClickError> {
        if let Some(region) = located.region {
            self.draw(&region, observation, memory)?;
        }
        if let Some(start) = self.scorer(observation, component).score(located, memory)? {
            keep(&mut self.starts, start, SAME_START, component.model);
        }
        Ok(())
    }

    /// Refines a first pose and puts the result among the answers.
    pub(super) fn refine(
        &mut self,
        start: &Start,
        observation: &Observation<'_>,
        component: &Component<'_>,
        memory: &mut OneClickMemory<'_>,
    ) -> Result<(), OneClickError> {
        if let Some(region) = start.region {
            self.draw(&region, observation, memory)?;
        }
        if let Some(answer) = self.scorer(observation, component).refine(start, memory)? {
            keep(&mut self.answers, answer, SAME_ANSWER, component.model);
        }
        Ok(())
    }

    /// Refines one mirror image of the best answer, its rival, where it lies near edges too. Returns whether there may be
    /// another.
    pub(super) fn mirror(
        &mut self,
        at: usize,
        observation: &Observation<'_>,
        component: &Component<'_>,
        memory: &mut OneClickMemory<'_>,
    ) -> Result<bool, OneClickError> {
        let own = |answer: &&Answer| !answer.mirrored;
        let best = self.answers.iter().find(own).copied();
        let (Some(best), Some(plane)) = (best, component.planes.get(at)) else {
            return Ok(false);
        };
        let pose = mirror_pose(&best.refined.pose, plane);
        let scorer = self.scorer(observation, component);
        if scorer.strength(&pose, memory)? < MIRRORED * best.support.strength {
            return Ok(true);
        }
        if let Some(answer) = scorer.onto_frame(&pose, memory)? {
            let mirrored = Answer {
                mirrored: true,
                ..answer
            };
            keep(&mut self.answers, mirrored, SAME_ANSWER, component.model);
        }
        Ok(true)
    }

    /// Refines one pose beside the best answer of a part that is nearly its own mirror image: a tray's outline may fit a second time some degrees
    /// off, where no mirror image of the one is the other. Returns whether there may be another.
    pub(super) fn look_beside(
        &mut self,
        at: usize,
        observation: &Observation<'_>,
        component: &Component<'_>,
        memory: &mut OneClickMemory<'_>,
    ) -> Result<bool, OneClickError> {
        let is_like_its_image = || is_nearly_symmetric(component.model, component.planes);
        let Some(best) = self
            .rotated_from
            .filter(|_| at < BESIDE && is_like_its_image())
        else {
            return Ok(false);
        };
        let (sin, cos) = sin_cos(core::f64::consts::TAU * at as f64 / BESIDE as f64);
        let turn = radians(BESIDE_DEG);
        let pose = turned(
            &best.refined.pose,
            &[turn * cos, turn * sin, 0.0],
            1.0,
            component.model,
        );
        if let Some(answer) = self
            .scorer(observation, component)
            .onto_frame(&pose, memory)?
        {
            keep(&mut self.answers, answer, SAME_ANSWER, component.model);
        }
        Ok(true)
    }
}

/// A pose turned about the middle of its model, which then stands so many times as far away.
fn turned(pose: &Pose, turn: &Vector3, times: f64, model: &Model<'_>) -> Pose {
    let middle = model.bounds().centre;
    let rotation = multiply(&rotation_by(turn), &pose.rotation);
    let moved = apply(&rotation, &middle);
    let centre = pose.transform(&middle);
    Pose {
        rotation,
        translation: core::array::from_fn(|k| times * centre[k] - moved[k]),
    }
}

/// Left, top, right and bottom of a rough box around the model at a pose.
fn sides_of(
    pose: &Pose,
    observation: &Observation<'_>,
    component: &Component<'_>,
    memory: &mut OneClickMemory<'_>,
) -> Option<[f64; 4]> {
    let drawn = drawn_at(
        pose,
        component.model,
        observation.camera,
        &mut memory.refine,
    )?;
    let (columns, rows) = drawn.bounds();
    let margin = MARGIN * columns.len().max(rows.len()) as f64;
    let [low, high] = [-margin, margin];
    Some([
        columns.start as f64 + low,
        rows.start as f64 + low,
        columns.end as f64 + high,
        rows.end as f64 + high,
    ])
}

#[cfg(test)]
mod tests;
