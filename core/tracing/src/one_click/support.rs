//! How much of the model's outline at a pose lies on edges of the frame.

use super::observation::Observation;
use fluoropose::image::profile::grey_across;
use fluoropose::mesh::Model;
use fluoropose::pose::Pose;
use fluoropose::refine::{OutlineSample, Polarity, RefineError, RefineMemory, outline_samples};

/// Distance of the two readings of a slope from its middle, pixels. A slope here is the plain difference of two readings,
/// not that of the derivative of a Gaussian as in refinement and snapping, so that only the reading is shared with them.
const HALF: f64 = 1.0;
/// Distance between slopes along a normal, pixels.
const STEP: f64 = 0.5;
/// The greatest number of slopes to each side.
const MOST: usize = 16;
/// A slope counts as an edge from this fraction of the expected slope.
const FAINT: f64 = 0.25;

/// What a frame says about an outline.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Support {
    /// Strength of the edges along the outline: the greatest slope of the right sign near each piece, divided by the
    /// expected slope and at most 1, averaged over the known length. 0 where nothing lies on an edge, 1 where everything
    /// lies on a full one.
    pub strength: f64,
    /// Fraction of the known length where that slope is at least a quarter of the expected slope.
    pub fraction: f64,
    /// Known length of the outline, pixels.
    pub length: f64,
}

/// Measures the edges along the model's outline at `pose`, at most `reach` pixels to either side. `expected` is the slope
/// of an edge of metal, grey values a pixel.
///
/// # Errors
/// [`RefineError`] where the model cannot be drawn at the pose.
pub(super) fn support(
    observation: &Observation<'_>,
    model: &Model<'_>,
    pose: &Pose,
    (reach, expected): (f64, f64),
    memory: &mut RefineMemory<'_>,
) -> Result<Support, RefineError> {
    let mut sum = Support::default();
    outline_samples(model, observation.camera, pose, memory, |sample| {
        let Some(slope) = slope(observation, sample, reach) else {
            return;
        };
        let strength = (slope / expected.max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        sum.length += sample.length;
        sum.strength += sample.length * strength;
        if strength >= FAINT {
            sum.fraction += sample.length;
        }
    })?;
    let length = sum.length.max(f64::MIN_POSITIVE);
    Ok(Support {
        strength: sum.strength / length,
        fraction: sum.fraction / length,
        ..sum
    })
}

/// Weights of readings along an outline, for slopes of faint edges.
const FAINTLY: [f64; 5] = [0.2; 5];

/// The slope at a distance outwards from a sample, of readings averaged along the outline; positive from an implant to what
/// surrounds it, grey values a pixel. `None` where it is excluded or beyond the frame.
pub(super) fn second_slope(
    observation: &Observation<'_>,
    sample: &OutlineSample,
    t: f64,
) -> Option<f64> {
    let place = [sample.column, sample.row];
    let at = |t: f64| grey_across(observation.frame, place, sample.normal, &FAINTLY, t);
    let (column, row) = (
        (sample.column + t * sample.normal[0]).max(0.0) as usize,
        (sample.row + t * sample.normal[1]).max(0.0) as usize,
    );
    if observation
        .excluded
        .is_some_and(|mask| mask.get(column, row))
    {
        return None;
    }
    let outwards = (at(t + HALF)? - at(t - HALF)?) / (2.0 * HALF);
    Some(match observation.polarity {
        Polarity::DarkImplant => outwards,
        Polarity::BrightImplant => -outwards,
    })
}

/// The greatest slope of the right sign near a sample, grey values a pixel; `None` where the
/// sample is excluded or too near to the frame's border.
fn slope(observation: &Observation<'_>, sample: &OutlineSample, reach: f64) -> Option<f64> {
    let place = [sample.column, sample.row];
    let at = |t: f64| grey_across(observation.frame, place, sample.normal, &[1.0], t);
    let (column, row) = (
        sample.column.max(0.0) as usize,
        sample.row.max(0.0) as usize,
    );
    if observation
        .excluded
        .is_some_and(|mask| mask.get(column, row))
    {
        return None;
    }
    let steps = ((reach / STEP) as usize).min(MOST);
    let mut greatest: f64 = 0.0;
    for k in 0..=2 * steps {
        let t = STEP * (k as f64 - steps as f64);
        let outwards = (at(t + HALF)? - at(t - HALF)?) / (2.0 * HALF);
        greatest = greatest.max(match observation.polarity {
            Polarity::DarkImplant => outwards,
            Polarity::BrightImplant => -outwards,
        });
    }
    Some(greatest)
}

#[cfg(test)]
mod tests {
    use super::super::tests::{SIDE, camera, seen};
    use super::*;
    use fluoropose::image::frame::Frame;
    use fluoropose::math::sin_cos;
    use std::vec::Vec;

    /// Of a frame that grows brighter by so much a pixel in one direction, along any other.
    #[test]
    fn a_slope_is_what_a_frame_rises_by_a_pixel() {
        const RISE: f64 = 40.0;
        let (sin, cos) = sin_cos(0.5);
        let pixels: Vec<u16> = (0..SIDE * SIDE)
            .map(|k| {
                let (column, row) = ((k % SIDE) as f64 + 0.5, (k / SIDE) as f64 + 0.5);
                (20_000.0 + RISE * (column * cos + row * sin)) as u16
            })
            .collect();
        let (frame, camera) = (
            Frame::new(&pixels, SIDE, SIDE, SIDE).expect("fits"),
            camera(),
        );
        for turn in [0.0, 0.5, 1.3, 2.9] {
            let (down, right) = sin_cos(turn);
            let sample = OutlineSample {
                column: 100.0,
                row: 90.0,
                normal: [right, down],
                length: 1.0,
                jacobian: [0.0; 6],
            };
            let expected = RISE * (right * cos + down * sin);
            for (polarity, sign) in [
                (Polarity::DarkImplant, 1.0),
                (Polarity::BrightImplant, -1.0),
            ] {
                let seen = seen(&frame, &camera, polarity);
                let own = slope(&seen, &sample, 3.0).expect("in the frame");
                // Only slopes of the right sign are edges.
                assert!(
                    (own - (sign * expected).max(0.0)).abs() < 1.1,
                    "{turn}: {own}"
                );
                let second = second_slope(&seen, &sample, 4.0).expect("in the frame");
                assert!((second - sign * expected).abs() < 1.1, "{turn}: {second}");
            }
        }
    }

    /// An edge counts as far beside a sample as is asked, and the slope at its middle alone.
    #[test]
    fn an_edge_is_looked_for_within_a_reach() {
        let pixels: Vec<u16> = (0..SIDE * SIDE)
            .map(|k| if k % SIDE < 100 { 9000 } else { 9600 })
            .collect();
        let (frame, camera) = (
            Frame::new(&pixels, SIDE, SIDE, SIDE).expect("fits"),
            camera(),
        );
        let seen = seen(&frame, &camera, Polarity::DarkImplant);
        for (beside, reach, is_seen) in [
            (0.0, 0.0, true),
            (4.0, 2.0, false),
            (4.0, 4.0, true),
            (-4.0, 4.0, true),
            (8.5, 40.0, true),
            (10.5, 40.0, false),
        ] {
            let sample = OutlineSample {
                column: 100.0 + beside,
                row: 90.0,
                normal: [1.0, 0.0],
                length: 1.0,
                jacobian: [0.0; 6],
            };
            let found = slope(&seen, &sample, reach).expect("in the frame");
            assert_eq!(found > 0.0, is_seen, "{beside} {reach}");
        }
    }
}
