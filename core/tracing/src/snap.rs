//! A rough line pulled onto the edges of a frame.
//!
//! The line is sampled, and along the normal of each sample the slope of the grey value is measured at places half a pixel
//! apart. Dynamic programming then chooses a place for all samples together: strong slopes attract, near ones more than
//! far ones, and neighbours stay close to each other (after Amini, Weymouth and Jain, *Using dynamic programming for
//! solving variational problems in vision*, IEEE PAMI 12, 1990). Therefore no single point jumps to a speck, and where
//! there is no edge the line stays.

mod profile;
mod sample;
mod track;

use profile::Reader;
use sample::STATES;
use track::track;

use crate::error::{TracingError, check_setting};
use crate::list::List;
use crate::noise::noise;
use crate::polyline::{check, distance, side, subdivide, subdivided_count, twice_area};
use crate::side::{Hand, Inside};
use crate::simplify::{Simplify, simplify};
use crate::vertex::{ShapeError, Vertex};
use fluoropose::image::contour::Point;
use fluoropose::image::frame::{Frame, Pixel};
use fluoropose::math::{floor, sqrt};
use fluoropose::memory::check_length;

#[cfg(feature = "alloc")]
use alloc::{vec, vec::Vec};

pub use sample::{MOST_REACH, Sample, Snap};

/// The greatest distance between samples along the line, pixels.
const SPACING: f64 = 2.0;
/// The direction of the line at a sample is that between its points at this distance behind and ahead of it, pixels.
const TANGENT: f64 = 3.0;
/// Points of the given line that did not move are never left out where a side next to them is longer than this, pixels.
/// Where points are closer together, the line is simplified like the parts that moved.
const LONG: f64 = 3.0;
/// A sample that moved by less than this has not moved, pixels.
const STILL: f64 = 1e-9;

/// Working memory of [`snap`]: each slice at least as long as [`snap_needed`] says.
#[derive(Debug)]
pub struct SnapMemory<'a> {
    /// Samples along the line.
    pub samples: &'a mut [Sample],
    /// The slope at each place of each sample, grey values a pixel.
    pub slopes: &'a mut [f32],
    /// For each place of each sample: the place of the sample before it on the best way there.
    pub ways: &'a mut [u8],
    /// The line before it is simplified.
    pub line: &'a mut [Vertex],
    /// One mark for each of its points.
    pub marks: &'a mut [bool],
}

/// Lengths of the slices of a [`SnapMemory`]: that of samples, line and marks, then that of slopes and ways.
#[must_use]
pub fn snap_needed(points: &[Point], closed: bool) -> (usize, usize) {
    let samples = subdivided_count(points, closed, SPACING);
    (samples, samples * STATES)
}

/// Pulls a line onto the edges of `frame` and writes it to `out`. The ends of an open line stay. Returns how far the
/// samples of the given line were moved.
///
/// An edge is a slope (filtered by the derivative of a Gaussian of 1 pixel) that noise alone does not make; the noise is
/// measured in the frame. Its place is that of the greatest slope, to a fraction of a pixel.
///
/// # Errors
/// [`TracingError::TooFewPoints`] and [`TracingError::NotAPlace`] about the line, [`TracingError::Setting`] about reach
/// and tolerance, [`TracingError::Memory`], and [`TracingError::TooLong`].
pub fn snap<P: Pixel>(
    frame: &Frame<'_, P>,
    points: &[Point],
    settings: &Snap,
    memory: SnapMemory<'_>,
    out: &mut List<'_, Vertex>,
) -> Result<ShapeError, TracingError> {
    check(points, if settings.closed { 3 } else { 2 })?;
    check_setting("the reach", settings.reach, 0.5, MOST_REACH)?;
    let (count, cells) = snap_needed(points, settings.closed);
    check_length("samples", count, memory.samples.len())?;
    check_length("slopes", cells, memory.slopes.len())?;
    check_length("ways", cells, memory.ways.len())?;
    check_length("line points", count, memory.line.len())?;
    let samples = memory.samples.get_mut(..count).unwrap_or_default();
    lay_out(points, settings, samples)?;
    let reader = Reader::new(frame, noise(frame), settings);
    for (sample, slopes) in samples.iter().zip(memory.slopes.chunks_exact_mut(STATES)) {
        reader.slopes(sample, slopes);
    }
    track(
        samples,
        memory.slopes,
        memory.ways,
        settings,
        reader.least(),
    );
    let error = moved(samples);
    let mut line = List::new(memory.line);
    place(samples, settings.closed, &mut line)?;
    let keep = |vertex: &Vertex| stays(points, settings.closed, vertex);
    let simple = Simplify {
        closed: settings.closed,
        tolerance: settings.tolerance,
        balanced: true,
    };
    let simplified = simplify(line.as_slice(), &simple, keep, memory.marks, out)?;
    Ok(ShapeError {
        max: error.max + simplified.max,
        rms: sqrt(error.rms * error.rms + simplified.rms * simplified.rms),
    })
}

/// The same with memory of its own, for callers that have an allocator: the line, and how far its samples were moved.
///
/// # Errors
/// As [`snap`].
#[cfg(feature = "alloc")]
pub fn snapped<P: Pixel>(
    frame: &Frame<'_, P>,
    points: &[Point],
    settings: &Snap,
) -> Result<(Vec<Vertex>, ShapeError), TracingError> {
    let (samples, slopes) = snap_needed(points, settings.closed);
    let mut places = vec![Vertex::default(); samples];
    let mut out = List::new(&mut places);
    let memory = SnapMemory {
        samples: &mut vec![Sample::default(); samples],
        slopes: &mut vec![0.0; slopes],
        ways: &mut vec![0; slopes],
        line: &mut vec![Vertex::default(); samples],
        marks: &mut vec![false; samples],
    };
    let moved = snap(frame, points, settings, memory, &mut out)?;
    let kept = out.as_slice().len();
    places.truncate(kept);
    Ok((places, moved))
}

/// Whether an untouched point must not be left out.
fn stays(points: &[Point], closed: bool, vertex: &Vertex) -> bool {
    let Some(number) = vertex.kept_number() else {
        return false;
    };
    let count = points.len();
    if !closed && (number == 0 || number + 1 == count) {
        return true;
    }
    let before = side(points, (number + count - 1) % count);
    let after = side(points, number);
    [before, after]
        .iter()
        .any(|ends| distance(ends.0, ends.1) > LONG)
}

/// Samples along the line with their normals.
fn lay_out(points: &[Point], settings: &Snap, samples: &mut [Sample]) -> Result<(), TracingError> {
    let mut at = 0;
    subdivide(points, settings.closed, SPACING, |vertex| {
        let most = samples.len();
        let sample = samples.get_mut(at).ok_or(TracingError::TooLong(most))?;
        *sample = Sample {
            vertex,
            ..Sample::default()
        };
        at += 1;
        Ok(())
    })?;
    let count = samples.len();
    for number in 0..count {
        let before = samples[(number + count - 1) % count].vertex.at;
        samples[number].step = distance(before, samples[number].vertex.at);
    }
    let brighter_left = brighter_left(points, settings);
    for number in 0..count {
        let [right, down] = direction(samples, number, settings.closed);
        // The left hand of (right, down) is (down, -right).
        samples[number].normal = [brighter_left * down, -brighter_left * right];
    }
    Ok(())
}

/// 1 where it gets brighter towards the left hand of the line, -1 where towards the right.
fn brighter_left(points: &[Point], settings: &Snap) -> f64 {
    let implant_right = if settings.closed {
        twice_area(points) > 0.0
    } else {
        settings.hand != Hand::Left
    };
    if implant_right == (settings.inside == Inside::Dark) {
        1.0
    } else {
        -1.0
    }
}

/// The direction of the line at a sample.
fn direction(samples: &[Sample], number: usize, closed: bool) -> [f64; 2] {
    let behind = walk(samples, number, closed, false);
    let ahead = walk(samples, number, closed, true);
    let (right, down) = (ahead.column - behind.column, ahead.row - behind.row);
    let long = sqrt(right * right + down * down);
    // Where a line turns back on itself it has no direction and is not moved.
    if long > 1e-6 {
        [right / long, down / long]
    } else {
        [0.0, 0.0]
    }
}

/// The first sample that lies at least [`TANGENT`] ahead of or behind another; the end of an open line where that is nearer.
fn walk(samples: &[Sample], number: usize, closed: bool, ahead: bool) -> Point {
    let count = samples.len();
    let (mut at, mut passed) = (number, 0.0);
    for _ in 0..count {
        let end = if ahead { count - 1 } else { 0 };
        if passed >= TANGENT || (!closed && at == end) {
            break;
        }
        if ahead {
            at = (at + 1) % count;
            passed += samples[at].step;
        } else {
            passed += samples[at].step;
            at = (at + count - 1) % count;
        }
    }
    samples[at].vertex.at
}

/// How far samples were moved.
fn moved(samples: &[Sample]) -> ShapeError {
    let squares = samples.iter().map(|sample| sample.offset * sample.offset);
    let greatest = squares.clone().fold(0.0, f64::max);
    ShapeError {
        max: sqrt(greatest),
        rms: sqrt(squares.sum::<f64>() / samples.len().max(1) as f64),
    }
}

/// Writes the samples at their new places. Samples that would run against the direction of the line are left out: on the
/// inner side of a sharp bend normals cross.
fn place(
    samples: &[Sample],
    closed: bool,
    line: &mut List<'_, Vertex>,
) -> Result<(), TracingError> {
    let count = samples.len();
    let mut last: Option<(Point, Point)> = None;
    for (number, sample) in samples.iter().enumerate() {
        let Sample {
            vertex,
            normal,
            offset,
            ..
        } = *sample;
        let still = offset.abs() < STILL;
        let at = Point::new(
            vertex.at.column + offset * normal[0],
            vertex.at.row + offset * normal[1],
        );
        if let Some((given, made)) = last {
            let along = (vertex.at.column - given.column) * (at.column - made.column)
                + (vertex.at.row - given.row) * (at.row - made.row);
            let end = !closed && number + 1 == count;
            if along <= 0.0 && !end && !still {
                continue;
            }
        }
        last = Some((vertex.at, at));
        line.push(if still {
            vertex
        } else {
            vertex_moved(&vertex, at)
        })?;
    }
    Ok(())
}

fn vertex_moved(vertex: &Vertex, at: Point) -> Vertex {
    let number = floor(vertex.from);
    Vertex::from_side(number as usize, vertex.from - number, at)
}

#[cfg(test)]
mod tests;
