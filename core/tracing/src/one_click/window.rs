//! The part of a frame that is searched: smoothed, with a dark implant, in integer grey levels.

use super::background::subtract_background;
use fluoropose::image::grey::Grey;
use fluoropose::image::mask::Mask;
use fluoropose::math::ln;
use fluoropose::refine::Polarity;

/// Number of grey levels.
pub(crate) const LEVELS: usize = 1024;
/// The level of an excluded pixel; no region enters it.
pub(crate) const BLOCKED: u16 = u16::MAX;

/// Fraction of the pixels at either end of the scale that get its first or its last level.
const CLIPPED: f64 = 0.0005;
/// A grey value is shifted right by this number of bits to find its bin in a histogram of [`LEVELS`] bins.
const BIN_SHIFT: u32 = 6;

/// Light that is as good as none, as a part of the window's range.
const NO_LIGHT: f64 = 1.0 / 16.0;

/// A rectangle of a frame's pixels, never empty.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Window {
    pub(crate) left: usize,
    pub(crate) top: usize,
    pub(crate) width: usize,
    pub(crate) height: usize,
}

impl Window {
    /// The pixels of a frame of `size` that touch the rectangle (left, top, right, bottom); at least one.
    pub(super) fn cut([left, top, right, bottom]: [f64; 4], size: (usize, usize)) -> Self {
        let span = |from: f64, to: f64, size: usize| {
            let first = (from.max(0.0) as usize).min(size.saturating_sub(1));
            let last = (fluoropose::math::floor(to).max(0.0) as usize)
                .clamp(first, size.saturating_sub(1));
            (first, last - first + 1)
        };
        let (left, width) = span(left, right, size.0);
        let (top, height) = span(top, bottom, size.1);
        Self {
            left,
            top,
            width,
            height,
        }
    }

    pub(crate) fn pixels(&self) -> usize {
        self.width * self.height
    }

    /// Index of the pixel of the frame that holds a place, moved into the window.
    pub(super) fn index(&self, column: f64, row: f64) -> usize {
        let cut = |at: f64, first: usize, length: usize| {
            (at.max(0.0) as usize).clamp(first, first + length - 1) - first
        };
        cut(row, self.top, self.height) * self.width + cut(column, self.left, self.width)
    }

    /// Column and row of a pixel in the window.
    pub(crate) fn place(&self, index: usize) -> (usize, usize) {
        // Shorter numbers divide sooner, and a window has no more pixels than they count.
        let (index, width) = (index as u32, self.width as u32);
        ((index % width) as usize, (index / width) as usize)
    }

    /// Calls `visit` with the pixels above, to the left, to the right and below.
    pub(crate) fn neighbours(&self, index: usize, mut visit: impl FnMut(usize)) {
        let (column, row) = self.place(index);
        if row > 0 {
            visit(index - self.width);
        }
        if column > 0 {
            visit(index - 1);
        }
        if column + 1 < self.width {
            visit(index + 1);
        }
        if row + 1 < self.height {
            visit(index + self.width);
        }
    }
}

/// How much brighter the second of two pixels is, levels. What is not of the picture, or excluded, is no border of anything, however bright the
/// other is: 0.
pub(super) fn step_between(grey: &[u16], one: usize, other: usize) -> i32 {
    let level = |pixel: usize| grey.get(pixel).copied().filter(|&level| level != BLOCKED);
    let steps = level(one).zip(level(other));
    steps.map_or(0, |(one, other)| i32::from(other) - i32::from(one))
}

/// How a window is read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Reading {
    pub(crate) polarity: Polarity,
    /// Passes of the binomial filter 1 2 1 in both directions: each adds a variance of 1/2 square pixel.
    pub(crate) smoothing: usize,
    /// Against the background, which is told from things smaller than a square of this side, pixels.
    pub(crate) against: Option<f64>,
}

/// Fills `grey` with the levels of the window's pixels, with dark metal whatever the polarity of the frame. Pixels of
/// `excluded` and those that are not of the picture become [`BLOCKED`]. `memory` are [`LEVELS`] numbers, and
/// [`super::background::BACKGROUND`] where the background is wanted. Returns the number of grey values of the frame for one level; 0
/// for a uniform window.
pub(super) fn levels(
    frame: &dyn Grey,
    window: &Window,
    how: Reading,
    excluded: Option<&Mask<'_>>,
    grey: &mut [u16],
    memory: &mut [u32],
) -> f64 {
    let at = |column: usize, row: usize| frame.at(column as f64 + 0.5, row as f64 + 0.5);
    let unit = levels_of(at, window, how, grey, memory);
    // Of a uniform window all is alike.
    if unit > 0.0 {
        block(grey, window, excluded);
    }
    unit
}

/// The same of any grey values by column and row; `None` of what is not of the picture.
pub(crate) fn levels_of(
    value: impl Fn(usize, usize) -> Option<f64>,
    window: &Window,
    how: Reading,
    grey: &mut [u16],
    memory: &mut [u32],
) -> f64 {
    let at = |index: usize| {
        let (column, row) = window.place(index);
        value(window.left + column, window.top + row)
    };
    let read = |visit: &mut dyn FnMut(usize, f64)| {
        let values = (0..window.pixels()).map(|index| (index, at(index)));
        let seen = values.filter_map(|(index, value)| Some((index, value?)));
        seen.for_each(|(index, value)| visit(index, value));
    };
    let (mut low, mut high, mut seen) = (f64::INFINITY, f64::NEG_INFINITY, 0);
    read(&mut |_, value| (low, high, seen) = (low.min(value), high.max(value), seen + 1));
    if high <= low || seen == 0 {
        grey.fill(0);
        return 0.0;
    }
    let unit = f64::from(u16::MAX) / (high - low);
    read(&mut |index, value| {
        let value = match how.polarity {
            Polarity::DarkImplant => value - low,
            Polarity::BrightImplant => high - value,
        };
        if let Some(pixel) = grey.get_mut(index) {
            *pixel = (value * unit) as u16;
        }
    });
    let is_shuttered = seen < window.pixels();
    if is_shuttered {
        repeat_borders(grey, window, |index| at(index).is_some());
    }
    for _ in 0..how.smoothing {
        smooth(grey, window);
    }
    let mut unit = unit;
    if let Some(side) = how.against {
        unit *= to_logarithms(grey);
        subtract_background(grey, window.width, side, memory);
    }
    let (dark, bright) = ends(grey, memory.get_mut(..LEVELS).unwrap_or_default());
    let scale = (LEVELS - 1) as f64 / f64::from(bright - dark);
    for pixel in &mut *grey {
        let value = pixel.saturating_sub(dark).min(bright - dark);
        *pixel = (f64::from(value) * scale) as u16;
    }
    if is_shuttered {
        let pixels = grey.iter_mut().enumerate().take(window.pixels());
        let hidden = pixels.filter(|(index, _)| at(*index).is_none());
        hidden.for_each(|(_, pixel)| *pixel = BLOCKED);
    }
    1.0 / (unit * scale)
}

/// Gives pixels that are not of the picture the value of the nearest in their row that is, and rows without one that of the nearest
/// row: no edge is there, whatever looks at neighbours.
fn repeat_borders(grey: &mut [u16], window: &Window, is_seen: impl Fn(usize) -> bool) {
    let width = window.width;
    if grey.len() < window.pixels() {
        return;
    }
    let seen_in = |row: usize| (row * width..(row + 1) * width).filter(|&index| is_seen(index));
    let mut last_row = None;
    for row in 0..window.height {
        let mut before: Option<usize> = None;
        for seen in seen_in(row) {
            let from = before.map_or(row * width, |before| before + 1);
            for index in from..seen {
                let is_nearer = before.is_some_and(|before| index - before < seen - index);
                grey[index] = grey[before.filter(|_| is_nearer).unwrap_or(seen)];
            }
            before = Some(seen);
        }
        if let Some(last) = before {
            let value = grey[last];
            grey[last + 1..(row + 1) * width].fill(value);
            let first = last_row.map_or(0, |last: usize| last + 1);
            for unseen in first..row {
                let nearest = last_row.filter(|last| unseen - last < row - unseen);
                let nearest = nearest.unwrap_or(row) * width;
                grey.copy_within(nearest..nearest + width, unseen * width);
            }
            last_row = Some(row);
        }
    }
    if let Some(last) = last_row {
        for unseen in last + 1..window.height {
            grey.copy_within(last * width..(last + 1) * width, unseen * width);
        }
    }
}

/// Replaces 16-bit grey values by their logarithms on the same scale: metal takes the same part of the light whatever lies in front
/// of it. Returns the number of new values for an old one where it is darkest, which is the most.
fn to_logarithms(grey: &mut [u16]) -> f64 {
    let most = f64::from(u16::MAX);
    let scale = most / ln(1.0 + 1.0 / NO_LIGHT);
    for value in &mut *grey {
        *value = (scale * ln(1.0 + f64::from(*value) / (NO_LIGHT * most))) as u16;
    }
    scale / (NO_LIGHT * most)
}

/// One pass of the binomial filter in both directions; at the border the last pixel counts twice.
fn smooth(grey: &mut [u16], window: &Window) {
    let mut line = |first: usize, step: usize, length: usize| {
        let at = |k: usize| first + k * step;
        let mut before = grey.get(first).copied().map_or(0, u32::from);
        let mut here = before;
        for k in 0..length {
            let after = if k + 1 < length {
                grey.get(at(k + 1)).copied().map_or(here, u32::from)
            } else {
                here
            };
            if let Some(pixel) = grey.get_mut(at(k)) {
                *pixel = ((before + 2 * here + after + 2) / 4) as u16;
            }
            (before, here) = (here, after);
        }
    };
    for row in 0..window.height {
        line(row * window.width, 1, window.width);
    }
    for column in 0..window.width {
        line(column, window.width, window.height);
    }
}

/// The ends of the scale, the greater last: all but a few pixels lie between them.
fn ends(grey: &[u16], histogram: &mut [u32]) -> (u16, u16) {
    histogram.fill(0);
    for &value in grey {
        if let Some(count) = histogram.get_mut((value >> BIN_SHIFT) as usize) {
            *count += 1;
        }
    }
    let few = CLIPPED * grey.len() as f64;
    let low = rank(histogram.iter(), few);
    let high = histogram
        .len()
        .saturating_sub(1 + rank(histogram.iter().rev(), few));
    let edge = |bin: usize| (bin << BIN_SHIFT).min(usize::from(u16::MAX) - 1) as u16;
    // The last bin is no lower than the first, for hardly any pixels lie beyond either.
    (edge(low), edge(high + 1))
}

/// Number of the count at which the sum of counts exceeds `few`.
fn rank<'c>(mut counts: impl Iterator<Item = &'c u32>, few: f64) -> usize {
    let mut sum = 0.0;
    let place = counts.position(|&count| {
        sum += f64::from(count);
        sum > few
    });
    place.unwrap_or(0)
}

fn block(grey: &mut [u16], window: &Window, excluded: Option<&Mask<'_>>) {
    let Some(excluded) = excluded else { return };
    for (index, pixel) in grey.iter_mut().enumerate() {
        let (column, row) = window.place(index);
        if excluded.get(window.left + column, window.top + row) {
            *pixel = BLOCKED;
        }
    }
}

#[cfg(test)]
mod tests;
