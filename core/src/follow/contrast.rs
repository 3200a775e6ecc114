//! How much darker a frame is inside of a model's outline than outside: whether there is metal at all.
//!
//! Residuals do not tell: noise and texture have an edge near every line. But noise is not darker on the same side all
//! along an outline.

use super::subject::Subject;
use super::thinned::Thinned;
use crate::image::grey::Grey;
use crate::image::profile::grey_across;
use crate::pose::Pose;
use crate::refine::{
    ImageTarget, OutlineSample, Polarity, RefineError, RefineMemory, outline_samples,
};

/// Places of the readings on each side of the outline, pixels from it.
const READINGS: [f64; 3] = [2.0, 3.0, 4.0];
/// Samples that are kept of an outline; of a longer one every second, every fourth and so on.
const SAMPLES: usize = 512;
/// A full step is exceeded along this part of the outline: where another leg passes, all steps are smaller.
const FULL: f64 = 0.25;
/// Places at which a frame is asked how much it changes, to a side.
const ASKED: usize = 64;
/// Across which it is asked, pixels to either side, and how many times the mean change a step of metal is.
const HALF_PX: f64 = 4.0;
const STEPS: f64 = 3.0;

/// The step of grey values along an outline.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Contrast {
    /// Step that is exceeded along a quarter of the outline, grey values, positive where metal is inside.
    pub step: f64,
    /// Mean of the steps, each divided by that one and cut to 0..1: 0 where nothing lies on an edge of metal, 1 where
    /// everything lies on a full one.
    pub strength: f64,
    /// Part of the outline of which the frame says anything.
    pub known: f64,
}

/// Measures the step along the outline of the model at a pose.
///
/// # Errors
/// [`RefineError`] where the model cannot be drawn at the pose.
pub fn contrast(
    subject: &Subject<'_>,
    image: &ImageTarget<'_>,
    pose: &Pose,
    memory: &mut RefineMemory<'_>,
) -> Result<Contrast, RefineError> {
    let mut thinned = Thinned::<f64, SAMPLES>::new();
    let (mut known, mut all) = (0usize, 0usize);
    let (model, camera) = (subject.model, subject.camera);
    outline_samples(model, camera, pose, memory, |sample| {
        if !thinned.counts_next() {
            return;
        }
        all += 1;
        if let Some(step) = step_at(image, sample) {
            known += 1;
            thinned.keep(step);
        }
    })?;
    let mut steps = thinned.into_kept();
    steps.sort_unstable_by(f64::total_cmp);
    let at = ((1.0 - FULL) * steps.len() as f64) as usize;
    let step = steps.get(at).copied().unwrap_or(0.0);
    let full = step.max(f64::MIN_POSITIVE);
    let sum: f64 = steps.iter().map(|step| (step / full).clamp(0.0, 1.0)).sum();
    Ok(Contrast {
        step,
        strength: sum / steps.len().max(1) as f64,
        known: known as f64 / all.max(1) as f64,
    })
}

/// How much brighter it is outside than inside, or darker of a bright implant; `None` where that is not known.
fn step_at(image: &ImageTarget<'_>, sample: &OutlineSample) -> Option<f64> {
    let place = [sample.column, sample.row];
    let unknown = image.unknown.is_some_and(|unknown| {
        let [column, row] = place.map(|at| at.max(0.0) as usize);
        unknown.get(column, row)
    });
    if unknown {
        return None;
    }
    let mut sum = 0.0;
    for t in READINGS {
        let grey = |t: f64| grey_across(image.frame, place, sample.normal, &[1.0], t);
        sum += grey(t)? - grey(-t)?;
    }
    let step = sum / READINGS.len() as f64;
    Some(match image.polarity {
        Polarity::DarkImplant => step,
        Polarity::BrightImplant => -step,
    })
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

#[cfg(all(test, feature = "alloc"))]
mod tests {
    use super::*;
    use crate::finder::fake::{BESIDE, METAL, SIDE, camera, crank, drawn, grey, placed};
    use crate::image::frame::Frame;
    use crate::image::mask::Mask;
    use crate::refine::RefineBuffers;

    /// What a frame of the crank at one pose says of another; unknown where the mask of a third covers it.
    fn contrast_at(
        [seen, asked]: [&Pose; 2],
        hidden: Option<&Pose>,
        polarity: Polarity,
    ) -> (Contrast, f64) {
        let (model, camera) = (crank(), camera());
        let pixels = grey(&model, &camera, seen);
        let frame = Frame::new(&pixels, SIDE, SIDE, SIDE).expect("valid");
        let words = hidden.map(|pose| drawn(&model, &camera, pose));
        let unknown = words
            .as_ref()
            .map(|words| Mask::new(words, SIDE, SIDE).expect("valid"));
        let image = ImageTarget {
            frame: &frame,
            unknown: unknown.as_ref(),
            polarity,
            film: None,
        };
        let (mut buffers, model) = (RefineBuffers::default(), model.as_model());
        let mut memory = buffers.borrow(&model, &camera);
        let subject = Subject::new(&model, &[], &camera);
        let found = contrast(&subject, &image, asked, &mut memory).expect("in front");
        let (mut known, mut all) = (0, 0);
        outline_samples(&model, &camera, asked, &mut memory, |sample| {
            let [column, row] = [sample.column, sample.row].map(|at| at as usize);
            all += 1;
            known += u32::from(unknown.is_none_or(|unknown| !unknown.get(column, row)));
        })
        .expect("in front");
        (found, f64::from(known) / f64::from(all))
    }

    #[test]
    fn all_along_its_outline_a_part_has_a_full_step_and_elsewhere_hardly_any() {
        let at = placed([20.0, 30.0, 5.0], [0.0; 3]);
        let full = f64::from(BESIDE - METAL);
        let (here, _) = contrast_at([&at; 2], None, Polarity::DarkImplant);
        assert!(
            (here.step - full).abs() < 1e-9 && here.strength > 0.9,
            "{here:?}"
        );
        assert_eq!(here.known, 1.0);
        let (bright, _) = contrast_at([&at; 2], None, Polarity::BrightImplant);
        assert!(bright.step < 0.0 && bright.strength < 0.1, "{bright:?}");
        // Turned by a quarter, most of it lies beside any edge.
        let turned = placed([20.0, 30.0, 95.0], [0.0; 3]);
        let (elsewhere, _) = contrast_at([&at, &turned], None, Polarity::DarkImplant);
        assert!(
            elsewhere.strength < 0.5 * here.strength || elsewhere.step < 0.5 * full,
            "{elsewhere:?}"
        );
    }

    /// The outline is short enough that each of its samples counts.
    #[test]
    fn what_is_known_of_an_outline_is_the_part_that_nothing_hides() {
        let at = placed([20.0, 30.0, 5.0], [0.0; 3]);
        for shift in [[30.0, 10.0, 0.0], [-45.0, 5.0, 40.0]] {
            let other = placed([0.0, 0.0, 40.0], shift);
            let (found, known) = contrast_at([&at; 2], Some(&other), Polarity::DarkImplant);
            assert!(known > 0.2 && known < 0.9, "{known}");
            assert_eq!(found.known, known);
        }
    }
}

#[cfg(test)]
mod step_tests {
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
