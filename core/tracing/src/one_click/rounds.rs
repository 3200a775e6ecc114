//! Poses judged and refined, round after round.

use super::candidates::{Answer, Find, Nearness, Start, keep};
use super::eye::Eye;
use super::job::{OneClick, SAME_START, Stage};
use super::{OneClickError, OneClickMemory, Part, Prompt, Scene};
use fluoropose::image::contour::Point;
use fluoropose::image::mask::{MaskMut, words_needed};
use fluoropose::math::{apply, multiply, radians, rotation_by};
use fluoropose::mesh::mirror::mirror_pose;
use fluoropose::pose::Pose;
use fluoropose::render::render;

/// Answers that are one: up to what refinement leaves.
const SAME_ANSWER: Nearness = Nearness {
    degrees: 2.0,
    place: 0.01,
};

/// Once the score of an answer exceeds this, nothing else is tried.
const CONVINCING: f64 = 0.6;
/// In the third round the best answer is turned about the camera's x and y by so many steps of so
/// many degrees to either side.
const TURNS: i32 = 2;
const TURN_DEG: f64 = 7.0;
/// And stands at these parts of its distance: a region that lacks a faint part of the implant, or
/// holds something else, has led to a wrong one.
const DISTANCES: [f64; 3] = [1.0, 0.96, 1.04];
/// The box of the second round is wider than the best answer's silhouette by this part of its
/// longer side, as a box that a person draws.
const MARGIN: f64 = 0.1;
/// Rounds at most.
const ROUNDS: usize = 4;
/// A mirror image is refined where its outline lies near edges as strongly, but for this part.
const MIRRORED: f64 = 0.8;

impl OneClick {
    pub(super) fn is_convinced(&self) -> bool {
        self.answers
            .first()
            .is_some_and(|best| best.score >= CONVINCING)
    }

    /// What to do when no start is left: look more closely, where the best answer is not good.
    pub(super) fn next_round(&mut self) -> Stage {
        self.round += 1;
        let hopeless = self.answers.is_empty() && self.round > 1;
        if hopeless || self.is_convinced() {
            return Stage::Mirror(0);
        }
        self.starts.clear();
        match self.round {
            1 => {
                self.matched.clear();
                Stage::Narrow
            }
            2..ROUNDS if self.answers.first() != self.turned_from.as_ref() => {
                self.turned_from = self.answers.first().copied();
                Stage::Around(0)
            }
            _ => Stage::Mirror(0),
        }
    }

    /// Narrows the window to a rough box round the silhouette of the best answer: whatever regions
    /// have leaked into lies beyond it, and fainter parts of the implant can be reached. Where
    /// there is no answer, to one round the click that is as large as the component at most: the
    /// click may have met a faint part, and what is dark round about leads on.
    pub(super) fn narrow(
        &mut self,
        scene: &Scene<'_>,
        part: &Part<'_>,
        memory: &mut OneClickMemory<'_>,
    ) {
        let sides = match (self.answers.first(), self.prompt) {
            (Some(best), _) => sides_of(&best.refined.pose, scene, part, memory),
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
        if let Ok(window) = narrowed.window(scene.camera, 0.0)
            && window.pixels() <= self.window.pixels()
        {
            self.window = window;
            self.narrowed = Some(narrowed);
            self.seeds.clear();
            self.current = None;
        }
    }

    /// The best answer turned the `at`-th way; `None` after the last.
    pub(super) fn turned(&self, at: usize, part: &Part<'_>) -> Option<Find> {
        let best = self.answers.first()?;
        let side = 2 * TURNS + 1;
        let number = i32::try_from(at)
            .ok()
            .filter(|&number| number < side * side * DISTANCES.len() as i32)?;
        let distance = DISTANCES[(number / (side * side)) as usize];
        let number = number % (side * side);
        let steps = [number % side - TURNS, number / side - TURNS];
        let [x, y] = steps.map(|steps| radians(TURN_DEG * f64::from(steps)));
        let (pose, middle) = (&best.refined.pose, part.model.bounds().centre);
        let rotation = multiply(&rotation_by(&[x, y, 0.0]), &pose.rotation);
        let moved = apply(&rotation, &middle);
        let centre = pose.transform(&middle);
        Some(Find {
            pose: Pose {
                rotation,
                translation: core::array::from_fn(|k| distance * centre[k] - moved[k]),
            },
            region: None,
            mismatch: 0.0,
        })
    }

    pub(super) fn eye<'e>(&'e self, scene: &'e Scene<'e>, part: &'e Part<'e>) -> Eye<'e> {
        Eye {
            scene,
            part,
            prompt: &self.prompt,
            expected: &self.expected,
            slope: self.slope,
        }
    }

    /// Draws the model at a find and puts it among the starts.
    pub(super) fn judge(
        &mut self,
        find: &Find,
        scene: &Scene<'_>,
        part: &Part<'_>,
        memory: &mut OneClickMemory<'_>,
    ) -> Result<(), OneClickError> {
        if let Some(region) = find.region {
            self.draw(&region, scene, memory)?;
        }
        if let Some(start) = self.eye(scene, part).judge(find, memory)? {
            keep(&mut self.starts, start, SAME_START, part.model);
        }
        Ok(())
    }

    /// Refines a start and puts what comes of it among the answers.
    pub(super) fn refine(
        &mut self,
        start: &Start,
        scene: &Scene<'_>,
        part: &Part<'_>,
        memory: &mut OneClickMemory<'_>,
    ) -> Result<(), OneClickError> {
        if let Some(region) = start.region {
            self.draw(&region, scene, memory)?;
        }
        if let Some(answer) = self.eye(scene, part).refine(start, memory)? {
            keep(&mut self.answers, answer, SAME_ANSWER, part.model);
        }
        Ok(())
    }

    /// Refines one mirror image of the best answer, its rival, where it lies near edges too. Gives
    /// whether there may be another.
    pub(super) fn mirror(
        &mut self,
        at: usize,
        scene: &Scene<'_>,
        part: &Part<'_>,
        memory: &mut OneClickMemory<'_>,
    ) -> Result<bool, OneClickError> {
        let own = |answer: &&Answer| !answer.mirrored;
        let best = self.answers.iter().find(own).copied();
        let (Some(best), Some(plane)) = (best, part.planes.get(at)) else {
            return Ok(false);
        };
        let pose = mirror_pose(&best.refined.pose, plane);
        let eye = self.eye(scene, part);
        if eye.strength(&pose, memory) < MIRRORED * best.support.strength {
            return Ok(true);
        }
        if let Some(answer) = eye.onto_frame(&pose, memory)? {
            let mirrored = Answer {
                mirrored: true,
                ..answer
            };
            keep(&mut self.answers, mirrored, SAME_ANSWER, part.model);
        }
        Ok(true)
    }
}

/// Left, top, right and bottom of a rough box round the model at a pose.
fn sides_of(
    pose: &Pose,
    scene: &Scene<'_>,
    part: &Part<'_>,
    memory: &mut OneClickMemory<'_>,
) -> Option<[f64; 4]> {
    let (width, height) = (scene.camera.width(), scene.camera.height());
    let words = memory.refine.drawn.get_mut(..words_needed(width, height))?;
    let mut drawn = MaskMut::new(words, width, height).ok()?;
    let projected = &mut *memory.refine.projected;
    render(part.model, scene.camera, pose, projected, &mut drawn).ok()?;
    let (columns, rows) = drawn.as_mask().bounds();
    let margin = MARGIN * columns.len().max(rows.len()) as f64;
    let [low, high] = [-margin, margin];
    Some([
        columns.start as f64 + low,
        rows.start as f64 + low,
        columns.end as f64 + high,
        rows.end as f64 + high,
    ])
}
