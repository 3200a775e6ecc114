//! The known outline resampled at scale levels, and the windows of it that are slid along views.

use heapless::Vec;

use super::outline::{OutlinePoint, OutlinePoints, Piece};
use super::slide::Samples;
use super::trace::STRETCHES;

/// Most windows.
pub(super) const WINDOWS: usize = 24;
/// Most scales.
const LEVELS: usize = 24;
/// Most samples of all stretches at one scale.
const SAMPLES: usize = 512;
/// Between one scale and the next, at least.
const RATIO: f64 = 1.07;

/// Numbers that [`ScaleLevels`] borrows.
pub(super) const LEVEL_NUMBERS: usize = 2 * LEVELS * SAMPLES;

/// Length of a window, as a part of all that is known. Windows shorter than the whole are there
/// because arc length drifts: with noise, with the view, where a speck hides in the outline.
const PART: f64 = 0.4;
/// Stretches shorter than this part of all that is known are no windows.
const LEAST: f64 = 0.1;

/// A part of a stretch, in pixel widths from its beginning.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Window {
    stretch: usize,
    from: f64,
    length: f64,
}

/// Each stretch as a whole and, of long ones, parts that reach half way into the next.
fn windows(outline: &OutlinePoints<'_>) -> Vec<Window, WINDOWS> {
    let mut windows = Vec::new();
    let part = PART * outline.length;
    for (number, piece) in outline.pieces().enumerate() {
        let length = piece.length();
        if length < LEAST * outline.length {
            continue;
        }
        let window = |from, length| Window {
            stretch: number,
            from,
            length,
        };
        // Of more windows than there is room for, the first are taken.
        let _ = windows.push(window(0.0, length));
        if length < 1.4 * part {
            continue;
        }
        let steps = (2.0 * (length - part) / part + 0.5).max(1.0) as usize;
        for index in 0..=steps {
            let from = (length - part) * index as f64 / steps as f64;
            let _ = windows.push(window(from, part));
        }
    }
    windows
}

/// One scale.
struct Level {
    /// Pixel widths per canonical pixel.
    scale: f64,
    /// Pixel widths between samples.
    spacing: f64,
    /// Number of samples up to the end of each stretch.
    ends: [usize; STRETCHES],
}

/// The known outline in canonical pixels, for a range of scales.
pub(super) struct ScaleLevels<'a> {
    numbers: &'a [f32],
    windows: Vec<Window, WINDOWS>,
    levels: Vec<Level, LEVELS>,
    /// Between one scale and the next.
    ratio: f64,
}

/// The ratio at which all levels together reach from `low` to `high`.
fn ratio(low: f64, high: f64) -> f64 {
    let reach = |ratio: f64| (1..LEVELS).fold(1.0, |reach, _| reach * ratio);
    let mut ratio = RATIO;
    // Ends for any finite range: the step grows with the ratio.
    while reach(ratio) * low < high && ratio < f64::MAX / 2.0 {
        ratio *= 1.01;
    }
    ratio
}

impl<'a> ScaleLevels<'a> {
    /// Samples `spacing` canonical pixels apart, for scales (pixel widths per canonical pixel) from
    /// `scales.0` to `scales.1`. `numbers` holds [`LEVEL_NUMBERS`].
    pub(super) fn new(
        outline: &OutlinePoints<'_>,
        spacing: f64,
        scales: (f64, f64),
        numbers: &'a mut [f32],
    ) -> Self {
        let mut levels = Vec::new();
        let (mut scale, ratio) = (scales.0, ratio(scales.0, scales.1));
        let lists = numbers.chunks_exact_mut(2 * SAMPLES).take(LEVELS);
        for list in lists {
            let (x, y) = list.split_at_mut(SAMPLES);
            let mut level = Level {
                scale,
                spacing: spacing * scale,
                ends: [0; STRETCHES],
            };
            let mut used = 0;
            for (piece, end) in outline.pieces().zip(&mut level.ends) {
                let rest = [&mut *x, &mut *y].map(|list| list.get_mut(used..).unwrap_or_default());
                used += sample(&piece, scale, level.spacing, rest);
                *end = used;
            }
            // There is a list for each level.
            let _ = levels.push(level);
            if scale > scales.1 {
                break;
            }
            scale *= ratio;
        }
        Self {
            numbers,
            windows: windows(outline),
            levels,
            ratio,
        }
    }

    /// Numbers of the windows.
    pub(super) fn windows(&self) -> core::ops::Range<usize> {
        0..self.windows.len()
    }

    /// Numbers of the levels whose scales lie in a range, give or take half a level, and those scales.
    pub(super) fn levels(&self, low: f64, high: f64) -> impl Iterator<Item = (usize, f64)> {
        let scales = self.levels.iter().map(|level| level.scale).enumerate();
        let half = (1.0 + self.ratio) / 2.0;
        scales.filter(move |&(_, scale)| scale * half >= low && scale <= high * half)
    }

    /// The samples of a window at a level, cut to `most`; empty where it was too long for the memory.
    pub(super) fn samples(&self, window: usize, level: usize, most: usize) -> Samples<'a> {
        let none = Samples { x: &[], y: &[] };
        let (Some(window), Some(at)) = (self.windows.get(window), self.levels.get(level)) else {
            return none;
        };
        let end = |stretch: usize| at.ends.get(stretch).copied().unwrap_or(0);
        let before = window.stretch.checked_sub(1).map_or(0, end);
        let start = before.saturating_add((window.from / at.spacing + 0.5) as usize);
        let count = ((window.length / at.spacing) as usize).saturating_add(1);
        let end = end(window.stretch).min(start.saturating_add(count.min(most)));
        let list = self.numbers.chunks_exact(2 * SAMPLES).nth(level);
        let (x, y) = list
            .unwrap_or_default()
            .split_at_checked(SAMPLES)
            .unwrap_or_default();
        match (x.get(start..end), y.get(start..end)) {
            (Some(x), Some(y)) => Samples { x, y },
            _ => none,
        }
    }
}

/// Writes samples of a piece to `x` and `y`, in canonical pixels, and gives their number.
fn sample(piece: &Piece<'_>, scale: f64, spacing: f64, [x, y]: [&mut [f32]; 2]) -> usize {
    let points = piece.points;
    let count = ((piece.length() / spacing) as usize).saturating_add(1);
    let count = count.min(x.len()).min(y.len());
    for (index, (x, y)) in x.iter_mut().zip(y).take(count).enumerate() {
        let place = index as f64 * spacing / piece.step;
        let before = (place as usize).min(points.len().saturating_sub(1));
        let fraction = (place - before as f64) as f32;
        // The last point of an open stretch has none after it, and none is wanted.
        let ends = (
            points.get(before),
            points.get(before + 1).or(points.first()),
        );
        let (Some(OutlinePoint { at: a, .. }), Some(OutlinePoint { at: b, .. })) = ends else {
            continue;
        };
        *x = (a[0] + fraction * (b[0] - a[0])) / scale as f32;
        *y = (a[1] + fraction * (b[1] - a[1])) / scale as f32;
    }
    count
}

#[cfg(test)]
mod tests {
    use super::super::outline::{OutlinePoint, Sampling};
    use super::super::smooth::Plane;
    use super::super::trace::{PixelSide, trace};
    use super::*;
    use crate::image::mask::{Mask, MaskMut};
    use crate::image::silhouette::Silhouette;

    #[test]
    fn the_levels_reach_from_end_to_end() {
        assert_eq!(ratio(1.0, 2.0), RATIO);
        for high in [6.0, 100.0] {
            let ratio = ratio(1.0, high);
            let reach = libm::pow(ratio, (LEVELS - 1) as f64);
            assert!(reach >= high && reach < 1.3 * high, "{high}: {reach}");
        }
    }

    #[test]
    fn levels_that_reach_just_to_the_end_are_no_farther_apart() {
        let most = (1..LEVELS).fold(1.0, |scale, _| scale * RATIO);
        assert_eq!(ratio(1.0, most), RATIO);
        assert_eq!(ratio(1.0, most.next_up()), RATIO * 1.01);
        assert_eq!(ratio(3.0, 2.0), RATIO);
    }

    /// A rectangle of 96 by 40 pixels at the left border of its frame.
    fn outline(points: &mut [OutlinePoint]) -> OutlinePoints<'_> {
        let mut words = [0u32; 4 * 64];
        for row in words.chunks_exact_mut(4).skip(10).take(40) {
            row[..3].fill(u32::MAX);
        }
        let mask = Mask::new(&words, 128, 64).expect("valid");
        let mut memory = [0; 4 * 64];
        let mut visited = MaskMut::new(&mut memory, 128, 64).expect("fits");
        let mut sides = [PixelSide::default(); 400];
        let silhouette = Silhouette::from(&mask);
        let stretches = trace(&silhouette, &mut visited, &mut sides, 5).expect("fits");
        let sampling = Sampling {
            plane: Plane::new(128, 64, 1.0),
            reach: 1,
            spacing: 1.5,
        };
        OutlinePoints::new(&sides, &stretches, &sampling, points).expect("fits")
    }

    #[test]
    fn windows_lie_on_the_outline_at_every_scale() {
        let mut points = [OutlinePoint::default(); 200];
        let outline = outline(&mut points);
        // The two long sides and the right one, but for corners that are cut.
        assert!((outline.length - 232.0).abs() < 4.0, "{}", outline.length);
        let mut numbers = std::vec![0.0; LEVEL_NUMBERS];
        let levels = ScaleLevels::new(&outline, 6.0, (0.5, 1.4), &mut numbers);
        assert!(levels.windows().len() >= 4);
        for (level, scale) in levels.levels(0.5, 1.4) {
            for window in levels.windows() {
                let samples = levels.samples(window, level, usize::MAX);
                let wanted = levels.windows[window].length / (6.0 * scale);
                assert!((samples.len() as f64 - wanted).abs() <= 1.0);
                for (x, y) in samples.x.iter().zip(samples.y) {
                    let (x, y) = (f64::from(*x) * scale, f64::from(*y) * scale);
                    // Half a side of averaging and half a spacing of points cut the corners.
                    let across = [x - 32.0, y - 22.0, y + 18.0].map(f64::abs);
                    let nearest = across.into_iter().fold(f64::INFINITY, f64::min);
                    assert!(nearest < 0.8, "({x}, {y}) at scale {scale}");
                }
                assert!(levels.samples(window, level, 7).len() <= 7);
            }
        }
    }
}
