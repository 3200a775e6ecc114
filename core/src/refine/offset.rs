//! How far a target's outline lies off the model's everywhere alike, at a pose that is known from elsewhere.

use super::error::RefineError;
use super::memory::RefineMemory;
use super::result::Refined;
use super::uncertainty::observe;
use super::view::CameraView;
use crate::mesh::Model;
use crate::pose::Pose;

/// Bins of distances: so many to a pixel, within so many pixels.
const TO_A_PIXEL: f64 = 64.0;
const REACH_PX: f64 = 5.0;
const BINS: usize = (2.0 * REACH_PX * TO_A_PIXEL) as usize;
/// Distances farther than this from the middle are other things', pixels.
const NEAR_PX: f64 = 1.5;
/// Rounds in which the middle settles.
const ROUNDS: usize = 8;

/// The mean distance of the target's outline beyond the model's at a pose (`camera_from_model`), pixels, by length; what lies
/// far off in places does not count. A mask is compared with the model as drawn, so that whole pixels cancel in the mean. `None`
/// where nothing is seen of it.
///
/// # Errors
/// [`RefineError`] as of [`super::refine`].
pub fn outline_offset(
    model: &Model<'_>,
    view: CameraView<'_>,
    pose: &Pose,
    memory: &mut RefineMemory<'_>,
) -> Result<Option<f64>, RefineError> {
    let mut lengths = [0.0; BINS];
    let at = Refined::at(*pose);
    observe(model, &[view], &at, memory, |seen| {
        for sample in seen.border {
            if let Some(px) = sample.residual_px() {
                lengths[bin_of(f64::from(px))] += f64::from(sample.weight);
            }
        }
    })?;
    Ok(middle(&lengths))
}

/// The mean of the distances near it, from the median on.
fn middle(lengths: &[f64; BINS]) -> Option<f64> {
    let half = lengths.iter().sum::<f64>() / 2.0;
    let mut below = 0.0;
    let median = lengths.iter().position(|&length| {
        below += length;
        below > half
    })?;
    let mut middle = px_of(median);
    for _ in 0..ROUNDS {
        let (mut sum, mut whole) = (0.0, 0.0);
        for (bin, &length) in lengths.iter().enumerate() {
            if (px_of(bin) - middle).abs() <= NEAR_PX {
                sum += length * px_of(bin);
                whole += length;
            }
        }
        if whole <= 0.0 {
            return None;
        }
        middle = sum / whole;
    }
    Some(middle)
}

fn bin_of(px: f64) -> usize {
    // A cast takes what is below zero to 0.
    (((px + REACH_PX) * TO_A_PIXEL + 0.5) as usize).min(BINS - 1)
}

/// The middle of a bin.
fn px_of(bin: usize) -> f64 {
    bin as f64 / TO_A_PIXEL - REACH_PX
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A mask 0.3 pixels larger differs from the model as drawn by a whole pixel in three places of ten, and by none elsewhere: a
    /// median is 0.
    #[test]
    fn whole_pixels_tell_parts_of_one() {
        let mut lengths = [0.0; BINS];
        for (px, length) in [(0.0, 7.0), (1.0, 3.0), (-4.5, 1.5)] {
            lengths[bin_of(px)] = length;
        }
        let found = middle(&lengths).expect("some");
        assert!((found - 0.3).abs() < 1e-9, "{found}");
        assert_eq!(middle(&[0.0; BINS]), None);
    }
}
