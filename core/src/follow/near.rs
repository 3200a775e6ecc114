//! Poses near an expected one, where refinement alone may not find the way: the model's outline slides over the frame,
//! turns in its plane and out of it, and the places with the strongest edges are kept.

use heapless::Vec;

use super::contrast::usual_step;
use super::subject::Subject;
use super::thinned::Thinned;
use crate::finder::nearby::about;
use crate::math::{Vector3, norm, radians, scale, sin_cos};
use crate::pose::Pose;
use crate::refine::edge::is_known;
use crate::refine::{
    ImageTarget, OutlineSample, Polarity, RefineError, RefineMemory, outline_samples,
};
use crate::shortlist::keep;

/// Most poses that are kept.
pub const NEAR: usize = 6;

/// Samples of an outline; of a longer one every second, every fourth and so on.
const SAMPLES: usize = 128;
/// Turns out of the image plane, degrees to either side.
const OUT_OF_PLANE_DEG: f64 = 5.0;
/// Steps of the turn in the image plane, degrees, and number to either side.
const IN_PLANE_DEG: f64 = 3.0;
const TURNS: i32 = 4;
/// Step of the places, pixels: refinement reaches farther.
const STEP_PX: f64 = 6.0;
/// Distance of the two readings from the outline, pixels.
const HALF_PX: f64 = 4.0;
/// A step in the wrong direction counts against a pose as much as this part of a full step.
const WRONG: f64 = -0.25;
/// Least part of the outline that must lie in the frame.
const LEAST_KNOWN: f64 = 0.4;
/// Places nearer to each other than this are one, pixels and degrees.
const SAME_PX: f64 = 10.0;
const SAME_DEG: f64 = 2.0 * IN_PLANE_DEG;
/// Places that are kept are moved by half of the steps, and then by a quarter: a plate is hardly thicker than a step, and refinement takes its
/// other side for it.
const FINER: [f64; 2] = [0.5, 0.25];
/// Moves of a place by each of them, at most.
const MOVES: usize = 4;

/// A place of the outline.
#[derive(Clone, Copy, Debug)]
struct Place {
    score: f64,
    /// Turn out of the plane about x and y, degrees.
    out: [f64; 2],
    /// In the plane, degrees.
    turn_deg: f64,
    shift: [f64; 2],
}

/// The poses near an expected one whose outlines have the strongest edges, each with the mean step along its outline in
/// usual ones: within `reach_px` pixels, 12 degrees in the image plane and 5 out of it. Before each that is turned out of it comes the same without
/// that. `step` is the usual step of grey values; where that is none, as of a pose that lies beside all edges, it is told by the frame.
///
/// # Errors
/// [`RefineError`] where the model cannot be drawn at the pose.
pub fn near_poses(
    subject: &Subject<'_>,
    image: &ImageTarget<'_>,
    expected: &Pose,
    reach_px: f64,
    step: f64,
    memory: &mut RefineMemory<'_>,
) -> Result<Vec<(f64, Pose), NEAR>, RefineError> {
    let middle = subject.model.bounds().centre;
    let step = if step > 0.0 {
        step
    } else {
        usual_step(image.frame)
    };
    let mut outline_at = |out: [f64; 2]| {
        let pose = about(&middle, expected, &turn_out(out), [0.0; 3]);
        Outline::of(subject, &pose, memory)
    };
    let mut best: Vec<Place, NEAR> = Vec::new();
    for x in [0.0, OUT_OF_PLANE_DEG, -OUT_OF_PLANE_DEG] {
        for y in [0.0, OUT_OF_PLANE_DEG, -OUT_OF_PLANE_DEG] {
            let outline = &outline_at([x, y])?;
            let sliding = Sliding {
                outline,
                image,
                step,
            };
            sliding.slide([x, y], reach_px, &mut best);
        }
    }
    let mut settled: Vec<Place, NEAR> = Vec::new();
    for place in best.into_iter().flat_map(Place::both) {
        let outline = &outline_at(place.out)?;
        let sliding = Sliding {
            outline,
            image,
            step,
        };
        let place = sliding.settled(place);
        if !settled.iter().any(|other| other.is(&place)) {
            // Those that are left out are the last.
            let _ = settled.push(place);
        }
    }
    let pose = |place: &Place| (place.score, place.pose(subject, expected));
    Ok(settled.iter().map(pose).collect())
}

/// Out of the image plane by so many degrees about x and y, as a rotation vector.
fn turn_out(out_deg: [f64; 2]) -> Vector3 {
    let [x, y] = out_deg.map(radians);
    [x, y, 0.0]
}

impl Place {
    /// Whether another is the same but for less than the steps.
    fn is(&self, other: &Self) -> bool {
        let near = |k: usize| (other.shift[k] - self.shift[k]).abs() < SAME_PX;
        let turned = (other.turn_deg - self.turn_deg).abs() < SAME_DEG;
        near(0) && near(1) && turned && other.out == self.out
    }

    /// The same without a turn out of the plane, and as it is: a component hardly turns out of the plane from frame to frame, and a place
    /// that does tells how it turned in the plane.
    fn both(self) -> [Self; 2] {
        let level = Self {
            out: [0.0; 2],
            ..self
        };
        [level, self]
    }

    fn pose(&self, subject: &Subject<'_>, expected: &Pose) -> Pose {
        let middle = subject.model.bounds().centre;
        let pose = about(&middle, expected, &turn_out(self.out), [0.0; 3]);
        let centre = pose.transform(&middle);
        let ray = scale(&centre, -1.0 / norm(&centre));
        let turn = scale(&ray, radians(self.turn_deg));
        let [fx, fy] = subject.camera.focal();
        let [right, down] = self.shift;
        let depth = -centre[2];
        about(
            &middle,
            &pose,
            &turn,
            [right * depth / fx, -down * depth / fy, 0.0],
        )
    }
}

/// Samples of an outline about the image of the model's middle.
struct Outline {
    samples: Vec<[f64; 4], SAMPLES>,
    middle: [f64; 2],
    /// Height of a pixel divided by its width.
    aspect: f64,
}

impl Outline {
    fn of(
        subject: &Subject<'_>,
        pose: &Pose,
        memory: &mut RefineMemory<'_>,
    ) -> Result<Self, RefineError> {
        let [x, y, z] = pose.transform(&subject.model.bounds().centre);
        let ([fx, fy], [cx, cy]) = (subject.camera.focal(), subject.camera.principal_point());
        let middle = [cx + fx * x / -z, cy - fy * y / -z];
        let mut samples = Thinned::<[f64; 4], SAMPLES>::new();
        let mut add = |sample: &OutlineSample| {
            if samples.counts_next() {
                let [right, down] = sample.normal;
                let (column, row) = (sample.column - middle[0], sample.row - middle[1]);
                samples.keep([column, row, right, down]);
            }
        };
        outline_samples(subject.model, subject.camera, pose, memory, &mut add)?;
        let samples = samples.into_kept();
        Ok(Self {
            samples,
            middle,
            aspect: subject.camera.aspect(),
        })
    }

    /// Turned by an angle, counter-clockwise on the screen, where all is measured in widths of a pixel.
    fn turned(&self, radians: f64) -> Vec<[f64; 4], SAMPLES> {
        let ((sin, cos), aspect) = (sin_cos(radians), self.aspect);
        let turn = |right: f64, down: f64| [right * cos + down * sin, down * cos - right * sin];
        let turned = self.samples.iter().map(|&[column, row, right, down]| {
            let [column, row] = turn(column, row * aspect);
            // What is across an outline is longer the shorter the outline's pixels are.
            let [right, down] = turn(right, down / aspect);
            let normal = [right, down * aspect];
            let length = norm(&[normal[0], normal[1], 0.0]);
            let [right, down] = normal.map(|along| along / length);
            [column, row / aspect, right, down]
        });
        turned.collect()
    }
}

struct Sliding<'s> {
    outline: &'s Outline,
    image: &'s ImageTarget<'s>,
    step: f64,
}

impl Sliding<'_> {
    fn slide(&self, out: [f64; 2], reach_px: f64, best: &mut Vec<Place, NEAR>) {
        let steps = (reach_px / STEP_PX) as i32;
        for turns in -TURNS..=TURNS {
            let turn_deg = IN_PLANE_DEG * f64::from(turns);
            let turned = self.outline.turned(radians(turn_deg));
            for down in -steps..=steps {
                for right in -steps..=steps {
                    let shift = [right, down].map(|k| STEP_PX * f64::from(k));
                    let least = match best.is_full() {
                        true => best.last().map_or(f64::MIN, |worst| worst.score),
                        false => f64::MIN,
                    };
                    if let Some(score) = self.score_above(least, &turned, shift) {
                        insert(
                            best,
                            Place {
                                score,
                                out,
                                turn_deg,
                                shift,
                            },
                        );
                    }
                }
            }
        }
    }

    /// A place after moves by finer steps, each to where edges are stronger.
    fn settled(&self, mut best: Place) -> Place {
        for part in FINER {
            let (px, deg) = (part * STEP_PX, part * IN_PLANE_DEG);
            for _ in 0..MOVES {
                let from = best;
                for turn in [-deg, 0.0, deg] {
                    let turn_deg = from.turn_deg + turn;
                    let turned = self.outline.turned(radians(turn_deg));
                    for [right, down] in [[0.0, 0.0], [px, 0.0], [-px, 0.0], [0.0, px], [0.0, -px]]
                    {
                        let shift = [from.shift[0] + right, from.shift[1] + down];
                        let score = self.score(&turned, shift).unwrap_or(f64::MIN);
                        if score > best.score {
                            best = Place {
                                score,
                                turn_deg,
                                shift,
                                ..from
                            };
                        }
                    }
                }
                if best.score <= from.score {
                    break;
                }
            }
        }
        best
    }

    /// Mean step along the outline, in usual steps; `None` where too little of it lies in the frame.
    fn score(&self, samples: &[[f64; 4]], shift: [f64; 2]) -> Option<f64> {
        self.score_above(f64::MIN, samples, shift)
    }

    /// The same; `None` also where it cannot be more than `least`, which mostly half of the samples tell.
    fn score_above(&self, least: f64, samples: &[[f64; 4]], shift: [f64; 2]) -> Option<f64> {
        let (mut sum, mut known) = (0.0, 0usize);
        for (number, &[column, row, right, down]) in samples.iter().enumerate() {
            // A full step, the most there is, at each of the rest.
            let rest = (samples.len() - number) as f64;
            if sum + rest < least * (known as f64 + rest) {
                return None;
            }
            let place = [0, 1].map(|k| [column, row][k] + self.outline.middle[k] + shift[k]);
            let grey = |t| {
                let [column, row] = [place[0] + t * right, place[1] + t * down];
                is_known(self.image, place, [right, down], t)
                    .then(|| self.image.frame.at(column, row))
                    .flatten()
            };
            let (Some(outside), Some(inside)) = (grey(HALF_PX), grey(-HALF_PX)) else {
                continue;
            };
            let step = match self.image.polarity {
                Polarity::DarkImplant => outside - inside,
                Polarity::BrightImplant => inside - outside,
            };
            known += 1;
            sum += (step / self.step).clamp(WRONG, 1.0);
        }
        let enough = known as f64 >= LEAST_KNOWN * samples.len() as f64 && known > 0;
        enough.then(|| sum / known as f64)
    }
}

/// Keeps the best of the places that are one.
fn insert(best: &mut Vec<Place, NEAR>, place: Place) {
    if best
        .iter()
        .any(|other| other.is(&place) && other.score >= place.score)
    {
        return;
    }
    best.retain(|other| !other.is(&place));
    keep(best, place, |other| -other.score);
}

#[cfg(test)]
mod tests;
