//! Places of a component where its joint leaves it beside the other one: its outline slides over the frame around each pose that the joint
//! leaves it ([`InJoint`]), and those with the strongest edges are kept. That needs no region that stands out.

use heapless::Vec;

use super::in_joint::{BENDS, InJoint, Limb};
use super::near::near_poses;
use super::subject::Subject;
use crate::image::grey::Grey;
use crate::pose::Pose;
use crate::refine::{ImageTarget, RefineMemory};
use crate::shortlist::keep;

/// So many places are kept.
pub const JOINT_PLACES: usize = 12;

/// How far around an expected place it is looked for, mm.
const REACH_MM: f64 = 25.0;
/// Places at which a frame is asked how much it changes, to a side.
const ASKED: usize = 64;
/// Across which it is asked, pixels to either side, and how many times the mean change a step of metal is.
const HALF_PX: f64 = 4.0;
const STEPS: f64 = 3.0;

/// The places of a frame, looked for in steps: one for each pose that the joint leaves.
#[derive(Clone, Debug)]
pub struct JointPlaces {
    expected: Vec<Pose, { 2 * BENDS }>,
    at: usize,
    /// Step of grey values that edges are measured by.
    step: f64,
    places: Vec<(f64, Pose), JOINT_PLACES>,
}

impl JointPlaces {
    /// Begins to look for a component in a frame, where its joint leaves it.
    #[must_use]
    pub fn new(frame: &dyn Grey, joint: &InJoint, sought: &Limb<'_>) -> Self {
        Self {
            expected: joint.poses(sought).collect(),
            at: 0,
            step: usual_step(frame),
            places: Vec::new(),
        }
    }

    /// From now on only those poses that the joint leaves are looked around for which `wanted` says so; it is told how far around, pixels.
    pub fn keep_bends(
        &mut self,
        subject: &Subject<'_>,
        mut wanted: impl FnMut(&Pose, f64) -> bool,
    ) {
        self.expected
            .retain(|pose| wanted(pose, reach_px(subject, pose)));
    }

    /// The steps that are done, and of how many.
    #[must_use]
    pub fn done(&self) -> (usize, usize) {
        (self.at, self.expected.len())
    }

    /// The places that were found by now, with the mean step along the outline of each, the strongest first.
    #[must_use]
    pub fn found(&self) -> &[(f64, Pose)] {
        &self.places
    }

    /// The next part of the work; only places that are `wanted` are kept. What is the other component's should be unknown in `image`.
    /// Returns whether anything was left to do.
    pub fn step(
        &mut self,
        subject: &Subject<'_>,
        image: &ImageTarget<'_>,
        memory: &mut RefineMemory<'_>,
        mut wanted: impl FnMut(&Pose, &mut RefineMemory<'_>) -> bool,
    ) -> bool {
        let Some(expected) = self.expected.get(self.at) else {
            return false;
        };
        self.at += 1;
        let reach_px = reach_px(subject, expected);
        // Behind the camera there is none.
        let near = near_poses(subject, image, expected, reach_px, self.step, memory);
        for place in near.unwrap_or_default() {
            if wanted(&place.1, memory) {
                keep(&mut self.places, place, |(score, _)| -score);
            }
        }
        true
    }
}

/// How far around a pose it is looked for, pixels.
fn reach_px(subject: &Subject<'_>, pose: &Pose) -> f64 {
    let depth = -pose.transform(&subject.model.bounds().centre)[2];
    let [fx, fy] = subject.camera.focal();
    REACH_MM * fx.max(fy) / depth.max(1.0)
}

/// What a step of metal is at least, by how much the frame changes over some pixels everywhere.
pub(super) fn usual_step(frame: &dyn Grey) -> f64 {
    let (width, height) = frame.size();
    let at = |k: usize, side: usize| (2 * k + 1) as f64 * side as f64 / (2 * ASKED) as f64;
    let (mut sum, mut count) = (0.0, 0usize);
    for [down, right] in (0..ASKED * ASKED).map(|k| [k / ASKED, k % ASKED]) {
        let (column, row) = (at(right, width), at(down, height));
        for (x, y) in [(HALF_PX, 0.0), (0.0, HALF_PX)] {
            let sides = (frame.at(column + x, row + y), frame.at(column - x, row - y));
            if let (Some(one), Some(other)) = sides {
                sum += (one - other).abs();
                count += 1;
            }
        }
    }
    // Of a frame without any nothing is a step.
    (STEPS * sum / count.max(1) as f64).max(f64::MIN_POSITIVE)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::frame::Frame;
    use proptest::prelude::*;
    use std::vec::Vec as Many;

    fn step_of(pixels: &[u8], width: usize, height: usize) -> f64 {
        usual_step(&Frame::new(pixels, width, height, width).expect("valid"))
    }

    properties! {
        #![proptest_config(ProptestConfig::with_cases(24))]
        /// Of a frame with as many pixels to a side as it is asked at, each is asked: the naive way compares all that are eight apart.
        #[test]
        fn a_usual_step_is_three_times_the_mean_change_over_eight_pixels(seed in 0u32..1000, dark in 0usize..64) {
            let mut random = seed;
            let pixels: Many<u8> = (0..ASKED * ASKED).map(|k| {
                random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                if k % ASKED < dark { 7 } else { (random >> 24) as u8 }
            }).collect();
            let at = |column: usize, row: usize| f64::from(pixels[row * ASKED + column]);
            let mut changes = Many::new();
            for (one, other) in (0..ASKED * ASKED).map(|k| (k % ASKED, k / ASKED)) {
                if one + 8 < ASKED {
                    changes.push((at(one + 8, other) - at(one, other)).abs());
                    changes.push((at(other, one + 8) - at(other, one)).abs());
                }
            }
            let wanted = 3.0 * changes.iter().sum::<f64>() / changes.len() as f64;
            let found = step_of(&pixels, ASKED, ASKED);
            prop_assert!((found - wanted).abs() < 1e-9 * wanted.max(1.0), "{found} {wanted}");
        }
    }

    /// Of any size; what rises by one a pixel, either way, changes by eight.
    #[test]
    fn an_even_slope_has_one_step_whatever_the_size_of_its_frame() {
        for (width, height) in [(64, 64), (150, 40), (23, 90)] {
            for (right, down) in [(1, 1), (-1, 1), (-1, -1)] {
                let grey = |k: usize| {
                    let (column, row) = ((k % width) as i32, (k / width) as i32);
                    let of = |sign: i32, at: i32, side: usize| {
                        if sign > 0 { at } else { side as i32 - 1 - at }
                    };
                    (of(right, column, width) + of(down, row, height)) as u8
                };
                let pixels: Many<u8> = (0..width * height).map(grey).collect();
                let found = step_of(&pixels, width, height);
                assert!((found - 24.0).abs() < 1e-9, "{width} {height}: {found}");
            }
        }
        let (blank, small) = (step_of(&[9; 400], 20, 20), step_of(&[9, 200], 2, 1));
        assert!(
            blank > 0.0 && blank < 1e-9 && small > 0.0,
            "what divides by it"
        );
    }
}
