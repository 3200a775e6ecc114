//! An outline without the shaking of the hand.

use crate::error::{TracingError, check_setting};
use crate::list::List;
use crate::polyline::{check, length, space_evenly, squared_distance};
use crate::simplify::{Simplify, simplify};
use crate::vertex::{ShapeError, Vertex};
use fluoropose::image::contour::Point;
use fluoropose::math::{exp, sqrt};
use fluoropose::memory::check_length;

/// The greatest width of smoothing, pixels.
pub const MOST_SIGMA: f64 = 64.0;
/// Distance between the samples that are averaged, as a fraction of the width of smoothing.
const SPACING: f64 = 0.25;
/// The Gaussian's reach in samples: three times its width.
const REACH: usize = (3.0 / SPACING) as usize;
/// The side nearest to a sample is searched among its own and this number of sides before and after it.
const BESIDE: usize = 1;

/// Working memory of [`soften`]: each slice is at least as long as [`soften_needed`] says.
#[derive(Debug)]
pub struct SoftenMemory<'a> {
    /// Points at equal distances along the outline.
    pub samples: &'a mut [Vertex],
    /// What smoothing takes away from each of them.
    pub rest: &'a mut [Point],
    /// The samples, smoothed.
    pub smooth: &'a mut [Vertex],
    /// One mark for each of them.
    pub marks: &'a mut [bool],
}

/// The length of each slice of a [`SoftenMemory`] for an outline smoothed by `sigma` pixels.
#[must_use]
pub fn soften_needed(points: &[Point], sigma: f64) -> usize {
    let samples = length(points, true) / (SPACING * sigma.clamp(0.1, MOST_SIGMA));
    (libm::ceil(samples) as usize).max(8)
}

/// Smooths a closed outline along its length by a Gaussian of `sigma` pixels (0.1 to [`MOST_SIGMA`]), then leaves out
/// points as [`simplify`] does with `tolerance` pixels. Returns how far the given outline lies from the new one.
///
/// The Gaussian is applied twice (`2 g - g * g`, "twicing": Tukey, *Exploratory Data Analysis*, 1977), which removes the
/// shaking but leaves gentle curves in their place: a circle of radius `r` shrinks by about `r (sigma / r)^4 / 4` instead
/// of `sigma^2 / 2 r`.
///
/// # Errors
/// [`TracingError::TooFewPoints`] and [`TracingError::NotAPlace`] about the outline, [`TracingError::Setting`] about
/// `sigma` and `tolerance`, [`TracingError::Memory`], and [`TracingError::TooLong`].
pub fn soften(
    points: &[Point],
    sigma: f64,
    tolerance: f64,
    memory: SoftenMemory<'_>,
    out: &mut List<'_, Vertex>,
) -> Result<ShapeError, TracingError> {
    check(points, 3)?;
    check_setting("the width of smoothing", sigma, 0.1, MOST_SIGMA)?;
    let count = soften_needed(points, sigma);
    check_length("samples", count, memory.samples.len())?;
    check_length("rests", count, memory.rest.len())?;
    check_length("smooth samples", count, memory.smooth.len())?;
    let mut samples = List::new(memory.samples);
    space_evenly(points, count, |vertex| samples.push(vertex))?;
    let samples = samples.into_slice();
    let smooth = memory.smooth.get_mut(..samples.len()).unwrap_or_default();
    let rest = memory.rest.get_mut(..samples.len()).unwrap_or_default();
    twice(samples, rest, smooth);
    let settings = Simplify {
        closed: true,
        tolerance,
        balanced: true,
    };
    simplify(smooth, &settings, |_| false, memory.marks, out)?;
    Ok(error(samples, out.as_slice()))
}

/// Writes `2 g - g * g` of closed samples.
fn twice(samples: &[Vertex], rest: &mut [Point], smooth: &mut [Vertex]) {
    let weights = weights();
    let count = samples.len();
    for (number, sample) in samples.iter().enumerate() {
        let mean = average(count, number, &weights, |k| samples[k].at);
        rest[number] = Point::new(sample.at.column - mean.column, sample.at.row - mean.row);
        smooth[number] = Vertex {
            at: mean,
            ..*sample
        };
    }
    for (number, smooth) in smooth.iter_mut().enumerate() {
        let back = average(count, number, &weights, |k| rest[k]);
        smooth.at.column += back.column;
        smooth.at.row += back.row;
    }
}

/// The Gaussian from its middle on, scaled so that both halves together sum to 1.
fn weights() -> [f64; REACH + 1] {
    let mut weights = core::array::from_fn(|k| {
        let t = SPACING * k as f64;
        exp(-t * t / 2.0)
    });
    let sum = weights[0] + 2.0 * weights[1..].iter().sum::<f64>();
    weights.iter_mut().for_each(|weight| *weight /= sum);
    weights
}

/// The weighted mean of the points around one of `count` in a ring.
fn average(count: usize, at: usize, weights: &[f64], point: impl Fn(usize) -> Point) -> Point {
    let here = point(at);
    let mut sum = Point::new(weights[0] * here.column, weights[0] * here.row);
    for (k, weight) in weights.iter().enumerate().skip(1) {
        let away = k % count;
        for other in [(at + away) % count, (at + count - away) % count] {
            let other = point(other);
            sum.column += weight * other.column;
            sum.row += weight * other.row;
        }
    }
    sum
}

/// How far the samples lie from the outline that some of them, smoothed, make. Each is compared with the side of its own
/// stretch and the sides next to it, so the result may be too large where an outline comes near itself, never too small.
fn error(samples: &[Vertex], outline: &[Vertex]) -> ShapeError {
    let count = outline.len();
    if count == 0 || samples.is_empty() {
        return ShapeError::default();
    }
    let (mut sum, mut greatest) = (0.0, 0.0f64);
    let mut side = count - 1;
    for sample in samples {
        while outline[(side + 1) % count].from <= sample.from && (side + 1) % count > side % count
            || side == count - 1 && (outline[0].from..outline[side].from).contains(&sample.from)
        {
            side = (side + 1) % count;
        }
        let near = (0..=2 * BESIDE).map(|k| (side + count + k - BESIDE) % count);
        let ends = near.map(|k| (outline[k].at, outline[(k + 1) % count].at));
        let away = ends.map(|ends| squared_distance(sample.at, ends));
        let away = away.fold(f64::INFINITY, f64::min);
        sum += away;
        greatest = greatest.max(away);
    }
    ShapeError {
        max: sqrt(greatest),
        rms: sqrt(sum / samples.len() as f64),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polyline::{between, distance, side, twice_area};
    use crate::synthetic::{Random, circle};
    use std::vec::Vec;

    fn softened(points: &[Point], sigma: f64, tolerance: f64) -> (Vec<Vertex>, ShapeError) {
        let needed = soften_needed(points, sigma);
        let mut samples = std::vec![Vertex::default(); needed];
        let mut rest = std::vec![Point::default(); needed];
        let mut smooth = samples.clone();
        let mut places = samples.clone();
        let mut marks = std::vec![false; needed];
        let memory = SoftenMemory {
            samples: &mut samples,
            rest: &mut rest,
            smooth: &mut smooth,
            marks: &mut marks,
        };
        let mut out = List::new(&mut places);
        let error = soften(points, sigma, tolerance, memory, &mut out).expect("valid");
        (out.as_slice().to_vec(), error)
    }

    fn shaken(radius: f64, shake: f64) -> Vec<Point> {
        let mut random = Random(9);
        let points = circle([100.0, 100.0], radius, 240).into_iter();
        let shaken = points.map(|p| {
            let by = shake * (2.0 * random.uniform() - 1.0) / radius;
            let grown = |v: f64| 100.0 + (v - 100.0) * (1.0 + by);
            Point::new(grown(p.column), grown(p.row))
        });
        shaken.collect()
    }

    fn off_circle(line: &[Vertex], radius: f64) -> f64 {
        let off = |vertex: &Vertex| {
            let away = distance(vertex.at, Point::new(100.0, 100.0)) - radius;
            away * away
        };
        sqrt(line.iter().map(off).sum::<f64>() / line.len() as f64)
    }

    #[test]
    fn weights_are_those_of_a_gaussian_and_of_a_mean() {
        let weights = weights();
        let sum = |of: fn(f64) -> f64| {
            let terms = (1..=REACH).map(|k| 2.0 * weights[k] * of(SPACING * k as f64));
            weights[0] * of(0.0) + terms.sum::<f64>()
        };
        assert!((sum(|_| 1.0) - 1.0).abs() < 1e-12);
        // Of the width 1, of which three widths at least are kept.
        assert!((sum(|t| t * t) - 1.0).abs() < 0.03);
        for k in 1..REACH {
            let ratio = weights[k] * weights[k] / (weights[k - 1] * weights[k + 1]);
            assert!((ratio - exp(SPACING * SPACING)).abs() < 1e-9);
        }
        // What is the same everywhere is its own mean, in rings shorter than the reach too, and a step is drawn out evenly.
        for count in [1, 2, 3, 50] {
            let mean = average(count, 0, &weights, |_| Point::new(7.0, -3.0));
            assert!((mean.column - 7.0).abs() < 1e-9 && (mean.row + 3.0).abs() < 1e-9);
        }
        let step = |k: usize| Point::new(if k < 40 { 0.0 } else { 1.0 }, 0.0);
        for k in 0..20 {
            let [before, after] = [39 - k, 40 + k].map(|at| average(80, at, &weights, step).column);
            assert!((before + after - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn shaking_goes_and_the_circle_stays() {
        let points = shaken(40.0, 1.0);
        let given: Vec<Vertex> = points.iter().map(|&p| Vertex::new(p)).collect();
        let (line, error) = softened(&points, 4.0, 0.05);
        assert!(off_circle(&given, 40.0) > 0.5);
        assert!(off_circle(&line, 40.0) < 0.2, "{}", off_circle(&line, 40.0));
        assert!(error.rms > 0.4 && error.max < 1.3, "{error:?}");
        // Nothing shrinks: 0.2 pixels a side would be 1 % of the area.
        let smooth: Vec<Point> = line.iter().map(|vertex| vertex.at).collect();
        let ratio = twice_area(&smooth) / twice_area(&points);
        assert!((ratio - 1.0).abs() < 0.004, "{ratio}");
    }

    #[test]
    fn the_error_is_the_distance_from_the_given_outline() {
        for points in [shaken(40.0, 2.0), circle([100.0, 100.0], 50.0, 5)] {
            let (line, error) = softened(&points, 3.0, 0.3);
            let made: Vec<Point> = line.iter().map(|vertex| vertex.at).collect();
            let (mut sum, mut greatest, mut count) = (0.0, 0.0f64, 0.0);
            for number in 0..points.len() {
                let ends = side(&points, number);
                let parts = (distance(ends.0, ends.1) / 0.1) as usize + 1;
                for part in 0..parts {
                    let at = between(ends, part as f64 / parts as f64);
                    let sides = (0..made.len()).map(|k| squared_distance(at, side(&made, k)));
                    let away = sides.fold(f64::INFINITY, f64::min);
                    sum += away;
                    greatest = greatest.max(away);
                    count += 1.0;
                }
            }
            let rms = sqrt(sum / count);
            assert!((error.rms / rms - 1.0).abs() < 0.05, "{error:?} {rms}");
            assert!(
                (error.max / sqrt(greatest) - 1.0).abs() < 0.1,
                "{error:?} {greatest}"
            );
        }
    }

    #[test]
    fn points_know_the_side_that_they_come_from() {
        let points = circle([100.0, 100.0], 50.0, 12);
        let (line, _) = softened(&points, 2.0, 0.2);
        for vertex in &line {
            assert_eq!(vertex.kept_number(), None);
            let from = side(&points, vertex.from as usize);
            assert!(squared_distance(vertex.at, from) < 4.0);
        }
        assert!(line.windows(2).all(|pair| pair[0].from < pair[1].from));
    }
}
