//! How much darker a frame is inside of a model's outline than outside: whether there is metal at all.
//!
//! Residuals do not tell: noise and texture have an edge near every line. But noise is not darker on the same side all
//! along an outline.

use heapless::Vec;

use super::subject::Subject;
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
    let mut steps: Vec<f64, SAMPLES> = Vec::new();
    let (mut every, mut number) = (1, 0usize);
    let (mut known, mut all) = (0usize, 0usize);
    let (model, camera) = (subject.model, subject.camera);
    outline_samples(model, camera, pose, memory, |sample| {
        number += 1;
        if !number.is_multiple_of(every) {
            return;
        }
        all += 1;
        let Some(step) = step_at(image, sample) else {
            return;
        };
        known += 1;
        if steps.push(step).is_err() {
            halve(&mut steps);
            every *= 2;
        }
    })?;
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

/// Keeps every second.
fn halve(steps: &mut Vec<f64, SAMPLES>) {
    for at in 0..SAMPLES / 2 {
        steps[at] = steps[2 * at];
    }
    steps.truncate(SAMPLES / 2);
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
