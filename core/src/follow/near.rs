//! Poses near an expected one, where refinement alone may not find the way: the model's outline slides over the frame,
//! turns in its plane and out of it, and the places with the strongest edges are kept.

use heapless::Vec;

use super::subject::Subject;
use crate::finder::nearby::about;
use crate::image::profile::grey_across;
use crate::math::{norm, radians, scale, sin_cos};
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
/// Places nearer to each other than this are one, pixels and steps of the turn.
const SAME_PX: f64 = 10.0;
const SAME_TURNS: i32 = 2;

/// A place of the outline.
#[derive(Clone, Copy, Debug)]
struct Place {
    score: f64,
    /// Turn out of the plane about x and y, degrees.
    out: [f64; 2],
    turns: i32,
    shift: [f64; 2],
}

/// The poses near an expected one whose outlines have the strongest edges, best first, each with the mean step along its outline in
/// usual ones: within `reach_px` pixels, 12 degrees in the image plane and 5 out of it. `step` is the usual step of grey values.
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
    let mut best: Vec<Place, NEAR> = Vec::new();
    for x in [0.0, OUT_OF_PLANE_DEG, -OUT_OF_PLANE_DEG] {
        for y in [0.0, OUT_OF_PLANE_DEG, -OUT_OF_PLANE_DEG] {
            let turn = [radians(x), radians(y), 0.0];
            let pose = about(&middle, expected, &turn, [0.0; 3]);
            let outline = Outline::of(subject, &pose, memory)?;
            let sliding = Sliding {
                outline: &outline,
                image,
                step,
            };
            sliding.slide([x, y], reach_px, &mut best);
        }
    }
    Ok(best
        .iter()
        .map(|place| (place.score, place.pose(subject, expected)))
        .collect())
}

impl Place {
    fn pose(&self, subject: &Subject<'_>, expected: &Pose) -> Pose {
        let middle = subject.model.bounds().centre;
        let [x, y] = self.out.map(radians);
        let pose = about(&middle, expected, &[x, y, 0.0], [0.0; 3]);
        let centre = pose.transform(&middle);
        let ray = scale(&centre, -1.0 / norm(&centre));
        let turn = scale(&ray, radians(IN_PLANE_DEG * f64::from(self.turns)));
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
        let mut samples: Vec<[f64; 4], SAMPLES> = Vec::new();
        let (mut every, mut number) = (1, 0usize);
        let mut add = |sample: &OutlineSample| {
            number += 1;
            if !number.is_multiple_of(every) {
                return;
            }
            let [right, down] = sample.normal;
            let (column, row) = (sample.column - middle[0], sample.row - middle[1]);
            if samples.push([column, row, right, down]).is_err() {
                for at in 0..SAMPLES / 2 {
                    samples[at] = samples[2 * at];
                }
                samples.truncate(SAMPLES / 2);
                every *= 2;
            }
        };
        outline_samples(subject.model, subject.camera, pose, memory, &mut add)?;
        Ok(Self { samples, middle })
    }

    /// Turned by an angle, counter-clockwise on the screen.
    fn turned(&self, radians: f64) -> Vec<[f64; 4], SAMPLES> {
        let (sin, cos) = sin_cos(radians);
        let turn = |right: f64, down: f64| [right * cos + down * sin, down * cos - right * sin];
        let turned = self.samples.iter().map(|&[column, row, right, down]| {
            let ([column, row], [right, down]) = (turn(column, row), turn(right, down));
            [column, row, right, down]
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
            let turned = self
                .outline
                .turned(radians(IN_PLANE_DEG * f64::from(turns)));
            for down in -steps..=steps {
                for right in -steps..=steps {
                    let shift = [right, down].map(|k| STEP_PX * f64::from(k));
                    if let Some(score) = self.score(&turned, shift) {
                        insert(
                            best,
                            Place {
                                score,
                                out,
                                turns,
                                shift,
                            },
                        );
                    }
                }
            }
        }
    }

    /// Mean step along the outline, in usual steps; `None` where too little of it lies in the frame.
    fn score(&self, samples: &[[f64; 4]], shift: [f64; 2]) -> Option<f64> {
        let (mut sum, mut known) = (0.0, 0usize);
        for &[column, row, right, down] in samples {
            let place = [0, 1].map(|k| [column, row][k] + self.outline.middle[k] + shift[k]);
            let grey = |t| {
                is_known(self.image, place, [right, down], t)
                    .then(|| grey_across(self.image.frame, place, [right, down], &[1.0], t))
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
    let same = |other: &Place| {
        let near = |k: usize| (other.shift[k] - place.shift[k]).abs() < SAME_PX;
        let turned = (other.turns - place.turns).abs() < SAME_TURNS;
        near(0) && near(1) && turned && other.out == place.out
    };
    if best
        .iter()
        .any(|other| same(other) && other.score >= place.score)
    {
        return;
    }
    best.retain(|other| !same(other));
    keep(best, place, |other| -other.score);
}
