//! Numbers of a film against flexion, and over a cycle.
//!
//! A frame without a number has NaN. Between neighbouring frames that have one, numbers are taken to change linearly; nothing is
//! taken across a gap or beyond the ends.

use crate::math::{floor, sqrt};
use crate::memory::{TooLittleMemory, check_length};

/// Steps of flexion at which numbers are published, degrees.
pub const FLEXION_STEP_DEG: f64 = 10.0;
/// Flexion that goes back by less than this, degrees, has not turned: errors of flexion are a tenth of it.
pub const REVERSAL_DEG: f64 = 3.0;
/// Flexion that differs by more than this from frame to frame, degrees, has not been gone through: an angle that passed half a
/// turn, or a wrong pose.
pub const JUMP_DEG: f64 = 45.0;
/// Points of a cycle: 0 to 100 percent.
pub const CYCLE_POINTS: usize = 101;

/// Frames through which a knee only bends or only extends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Phase {
    /// First frame, from 0.
    pub first: usize,
    /// Last frame.
    pub last: usize,
    /// Whether flexion rises.
    pub rises: bool,
}

/// The monotonic phases of an activity, at most as many as there are frames. A phase ends where flexion goes back by more than `reversal_deg`, where it
/// jumps ([`JUMP_DEG`]), and at a frame without flexion; its last frame is the first of the next one.
///
/// # Errors
/// [`TooLittleMemory`] for room for fewer phases than frames.
pub fn phases<'p>(
    flexion_deg: &[f64],
    reversal_deg: f64,
    room: &'p mut [Phase],
) -> Result<&'p [Phase], TooLittleMemory> {
    check_length("phases", flexion_deg.len(), room.len())?;
    let mut count = 0;
    let mut first = 0;
    while first < flexion_deg.len() {
        let last = end_of_phase(flexion_deg, first, reversal_deg);
        if last > first {
            room[count] = Phase {
                first,
                last,
                rises: flexion_deg[last] > flexion_deg[first],
            };
            count += 1;
        }
        // What moves on nowhere is followed by a frame that may.
        first = if last > first && last + 1 < flexion_deg.len() && !flexion_deg[last + 1].is_nan() {
            last
        } else {
            last + 1
        };
    }
    Ok(&room[..count])
}

/// The last frame of the phase that begins at a frame; that frame where none does.
fn end_of_phase(flexion: &[f64], first: usize, reversal: f64) -> usize {
    let (mut lowest, mut highest, mut last) = (first, first, first);
    let mut rises = None;
    for (at, &value) in flexion.iter().enumerate().skip(first) {
        if value.is_nan() || (value - flexion[last]).abs() > JUMP_DEG {
            break;
        }
        last = at;
        if value > flexion[highest] {
            highest = at;
        }
        if value < flexion[lowest] {
            lowest = at;
        }
        let (up, down) = (value - flexion[lowest], flexion[highest] - value);
        match rises {
            None if up > reversal => rises = Some(true),
            None if down > reversal => rises = Some(false),
            Some(true) if down > reversal => return highest,
            Some(false) if up > reversal => return lowest,
            _ => {}
        }
    }
    last
}

/// A number at one flexion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bin {
    /// Flexion, degrees.
    pub flexion_deg: f64,
    /// Mean over the phases that reach it; NaN where none does.
    pub mean: f64,
    /// Standard deviation between these phases; NaN for fewer than two.
    pub deviation: f64,
    /// These phases.
    pub n: usize,
}

/// The multiples of `step_deg` that lie within the flexion of a film.
pub fn levels(flexion_deg: &[f64], step_deg: f64) -> impl Iterator<Item = f64> {
    let known = flexion_deg.iter().filter(|flexion| flexion.is_finite());
    let (low, high) = known.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &x| {
        (low.min(x), high.max(x))
    });
    let first = -floor(-low / step_deg);
    let count = if high >= low {
        (floor(high / step_deg) - first + 1.0).max(0.0) as usize
    } else {
        0
    };
    (0..count).map(move |k| (first + k as f64) * step_deg)
}

/// A number of a film at one flexion, from each phase that passes it.
#[must_use]
pub fn at_flexion(flexion_deg: &[f64], values: &[f64], phases: &[Phase], level_deg: f64) -> Bin {
    let (mut n, mut mean, mut squares) = (0, 0.0, 0.0);
    for phase in phases {
        let Some(value) = in_phase(flexion_deg, values, phase, level_deg) else {
            continue;
        };
        n += 1;
        let off: f64 = value - mean;
        mean += off / n as f64;
        squares += off * (value - mean);
    }
    Bin {
        flexion_deg: level_deg,
        mean: if n > 0 { mean } else { f64::NAN },
        deviation: if n > 1 {
            sqrt(squares / (n - 1) as f64)
        } else {
            f64::NAN
        },
        n,
    }
}

/// The number where a phase passes a flexion: the mean where errors make it pass several times.
fn in_phase(flexion: &[f64], values: &[f64], phase: &Phase, level: f64) -> Option<f64> {
    let (mut count, mut sum) = (0u32, 0.0);
    let mut met = |value: f64| {
        if value.is_finite() {
            count += 1;
            sum += value;
        }
    };
    for at in phase.first..=phase.last {
        let (Some(&here), Some(&value)) = (flexion.get(at), values.get(at)) else {
            break;
        };
        if here == level {
            met(value);
        }
        let next = flexion.get(at + 1).zip(values.get(at + 1));
        if let Some((&there, &after)) = next.filter(|_| at < phase.last)
            && (here < level) != (there < level)
            && here != level
            && there != level
        {
            met(value + (after - value) * (level - here) / (there - here));
        }
    }
    (count > 0).then(|| sum / f64::from(count))
}

/// A number over a cycle, at 0, 1, ... 100 percent between two positions. `positions` are those of the frames, rising: times or
/// numbers of frames. NaN where a frame beside the place has no number, and beyond the film.
#[must_use]
pub fn cycle(positions: &[f64], values: &[f64], from: f64, to: f64) -> [f64; CYCLE_POINTS] {
    core::array::from_fn(|point| {
        let part = point as f64 / (CYCLE_POINTS - 1) as f64;
        let position = from * (1.0 - part) + to * part;
        at_position(positions, values, position)
    })
}

fn at_position(positions: &[f64], values: &[f64], position: f64) -> f64 {
    let after = positions.partition_point(|&other| other < position);
    match (positions.get(after), values.get(after)) {
        (Some(&there), Some(&value)) if there == position => value,
        (Some(&there), Some(&value)) if after > 0 => {
            let (here, before) = (positions[after - 1], values[after - 1]);
            before + (value - before) * (position - here) / (there - here)
        }
        _ => f64::NAN,
    }
}

#[cfg(test)]
mod tests;
