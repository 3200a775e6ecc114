//! How much of the model's outline at a pose lies on edges of the frame.

use super::Scene;
use fluoropose::mesh::Model;
use fluoropose::pose::Pose;
use fluoropose::refine::{OutlineSample, Polarity, RefineError, RefineMemory, outline_samples};

/// Distance of the two readings of a slope from its middle, pixels.
const HALF: f64 = 1.0;
/// Distance between slopes along a normal, pixels.
const STEP: f64 = 0.5;
/// Slopes to each side at most.
const MOST: usize = 16;
/// An edge counts as one from this part of the expected slope.
const FAINT: f64 = 0.25;

/// What a frame says of an outline.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Support {
    /// Mean over the outline's known length of the slope of the right sign nearest by, divided by
    /// the expected slope and cut at 1: 0 where nothing of it lies on an edge, 1 where all of it
    /// lies on a full one.
    pub strength: f64,
    /// Part of the outline's known length where that slope is at least a quarter of what is
    /// expected.
    pub share: f64,
    /// Known length, pixels.
    pub length: f64,
}

/// Reads the frame along the model's outline at `pose`, at most `reach` pixels to either side;
/// `expected` is the slope of an edge of metal, grey values a pixel.
///
/// # Errors
/// Where the model cannot be drawn at the pose.
pub(super) fn support(
    scene: &Scene<'_>,
    model: &Model<'_>,
    pose: &Pose,
    (reach, expected): (f64, f64),
    memory: &mut RefineMemory<'_>,
) -> Result<Support, RefineError> {
    let mut sum = Support::default();
    outline_samples(model, scene.camera, pose, memory, |sample| {
        let Some(slope) = slope(scene, sample, reach) else {
            return;
        };
        let part = (slope / expected.max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        sum.length += sample.length;
        sum.strength += sample.length * part;
        if part >= FAINT {
            sum.share += sample.length;
        }
    })?;
    let length = sum.length.max(f64::MIN_POSITIVE);
    Ok(Support {
        strength: sum.strength / length,
        share: sum.share / length,
        ..sum
    })
}

/// The greatest slope of the right sign near a sample, grey values a pixel; `None` where the
/// sample is excluded or too near to the frame's border.
fn slope(scene: &Scene<'_>, sample: &OutlineSample, reach: f64) -> Option<f64> {
    let at = |t: f64| {
        let column = sample.column + t * sample.normal[0];
        let row = sample.row + t * sample.normal[1];
        scene.frame.at(column, row)
    };
    let (column, row) = (
        sample.column.max(0.0) as usize,
        sample.row.max(0.0) as usize,
    );
    if scene.excluded.is_some_and(|mask| mask.get(column, row)) {
        return None;
    }
    let steps = ((reach / STEP) as usize).min(MOST);
    let mut greatest: f64 = 0.0;
    for k in 0..=2 * steps {
        let t = STEP * (k as f64 - steps as f64);
        let outwards = (at(t + HALF)? - at(t - HALF)?) / (2.0 * HALF);
        greatest = greatest.max(match scene.polarity {
            Polarity::DarkImplant => outwards,
            Polarity::BrightImplant => -outwards,
        });
    }
    Some(greatest)
}
