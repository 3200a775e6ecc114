//! Frames a second.

use super::structure::DataSet;
use super::tags::{CINE_RATE, FRAME_BEGUN, FRAME_TIME, FRAME_TIMES, RECOMMENDED_RATE};
use super::values::Values;

/// Times between frames that differ by more than this part of their mean are no rate.
const EVEN: f64 = 0.1;

/// From what says most: the times of all frames, the time of each, the rate at which they were taken, when each began to
/// be taken, the rate at which they are to be shown. A pulsed or variable rate is none.
pub(super) fn frames_per_s(bytes: &[u8], data_set: &DataSet) -> Option<f64> {
    let values = Values {
        bytes,
        found: &data_set.wanted,
    };
    let ms = match values.numbers(FRAME_TIMES) {
        Some(times) if times.len() > 1 => Some(even(times)?),
        _ => values.positive(FRAME_TIME),
    };
    let rate = ms.map(|ms| 1000.0 / ms);
    // Times are stated in decimals, rates mostly are multiples of a half.
    let whole = |rate: f64| {
        let half = (2.0 * rate).round() / 2.0;
        if (rate - half).abs() < 2e-4 * rate {
            half
        } else {
            rate
        }
    };
    rate.map(whole)
        .or_else(|| values.positive(CINE_RATE))
        .or_else(|| even(begun_ms(bytes, data_set)).map(|ms| whole(1000.0 / ms)))
        .or_else(|| values.positive(RECOMMENDED_RATE))
}

/// The mean of the times from frame to frame, if they are even. The first comes at no time after another.
fn even(times: Vec<f64>) -> Option<f64> {
    let steps = times.get(1..).filter(|steps| !steps.is_empty())?;
    let mean = steps.iter().sum::<f64>() / steps.len() as f64;
    let is_even = steps.iter().all(|step| (step - mean).abs() <= EVEN * mean);
    Some(mean).filter(|mean| is_even && mean.is_finite() && *mean > 0.0)
}

/// The time of each frame after the one before, ms, by when it began to be taken; none where one does not say it.
fn begun_ms(bytes: &[u8], data_set: &DataSet) -> Vec<f64> {
    let begun = data_set.per_frame.iter().map(|found| {
        let values = Values { bytes, found };
        seconds(values.text(FRAME_BEGUN)?)
    });
    let begun: Option<Vec<f64>> = begun.collect();
    let begun = begun.unwrap_or_default();
    let steps = begun.windows(2).map(|pair| 1000.0 * (pair[1] - pair[0]));
    std::iter::once(0.0).chain(steps).collect()
}

/// Seconds since the month began of a moment written as YYYYMMDDHHMMSS.FFFFFF.
fn seconds(moment: &str) -> Option<f64> {
    let part =
        |range: std::ops::Range<usize>| moment.get(range)?.parse::<u32>().ok().map(f64::from);
    let rest = moment.get(12..)?;
    let end = rest.find(['+', '-']).unwrap_or(rest.len());
    let seconds: f64 = rest.get(..end)?.parse().ok()?;
    Some(86_400.0 * part(6..8)? + 3600.0 * part(8..10)? + 60.0 * part(10..12)? + seconds)
}
