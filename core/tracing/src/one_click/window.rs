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
    let (dark, bright) = (edge(low), edge(high + 1));
    (dark, bright.max(dark + 1))
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
mod tests {
    use super::super::background::BACKGROUND;
    use super::*;
    use fluoropose::image::frame::Frame;
    use fluoropose::image::mask::MaskMut;
    use fluoropose::image::shuttered::Shuttered;

    #[test]
    fn a_window_is_cut_to_the_frame_and_numbers_its_pixels() {
        let window = Window::cut([-5.0, 3.2, 6.9, 99.0], (20, 10));
        let whole = Window {
            left: 0,
            top: 3,
            width: 7,
            height: 7,
        };
        assert_eq!(window, whole);
        assert_eq!(window.place(window.index(6.5, 4.5)), (6, 1));
        assert_eq!(window.index(50.0, -3.0), 6);
        let mut seen = std::vec::Vec::new();
        window.neighbours(0, |index| seen.push(index));
        window.neighbours(8, |index| seen.push(index));
        assert_eq!(seen, [1, 7, 1, 7, 9, 15]);
        assert_eq!(Window::cut([30.0, 0.0, 40.0, 1.0], (20, 10)).width, 1);
    }

    /// A dark square on a ramp, and the same frame with its greys inverted.
    fn pixels(inverted: bool) -> std::vec::Vec<u16> {
        (0..64 * 64)
            .map(|k| {
                let (column, row) = (k % 64, k / 64);
                let inside = (20..40).contains(&column) && (20..40).contains(&row);
                let value = if inside { 900 } else { 3000 + 4 * column };
                if inverted { 4095 - value } else { value }
            })
            .collect()
    }

    #[test]
    fn what_is_not_of_the_picture_is_no_step() {
        let grey = [5, 900, BLOCKED];
        let steps =
            [[0, 1], [1, 0], [0, 2], [2, 1], [1, 9]].map(|[a, b]| step_between(&grey, a, b));
        assert_eq!(steps, [895, -895, 0, 0, 0]);
    }

    #[test]
    fn either_polarity_gives_the_same_picture() {
        let window = Window::cut([0.0, 0.0, 63.0, 63.0], (64, 64));
        let picture = |polarity: Polarity, inverted: bool| {
            let pixels = self::pixels(inverted);
            let frame = Frame::new(&pixels, 64, 64, 64).expect("fits");
            let mut grey = std::vec![0; window.pixels()];
            let mut histogram = [0; LEVELS];
            let how = Reading {
                polarity,
                smoothing: 2,
                against: None,
            };
            let step = levels(&frame, &window, how, None, &mut grey, &mut histogram);
            (grey, step)
        };
        let (dark, step) = picture(Polarity::DarkImplant, false);
        let (bright, other) = picture(Polarity::BrightImplant, true);
        assert_eq!(step, other);
        let differ = dark.iter().zip(&bright).map(|(a, b)| a.abs_diff(*b)).max();
        assert!(differ <= Some(1), "{differ:?}");
        assert_eq!(dark[30 * 64 + 30], 0);
        // A level stands for the range of greys divided by the number of levels.
        assert!((step - (3252.0 - 900.0) / 1023.0).abs() < 0.1, "{step}");
    }

    #[test]
    fn against_the_background_metal_is_alike_however_thick_the_limb_before_it() {
        const SIDE: usize = 96;
        // The limb grows thicker to the left, to a tenth of the light; metal takes three tenths of what is left.
        let inside = |k: usize| (20..76).contains(&(k % SIDE)) && (40..56).contains(&(k / SIDE));
        let pixels: std::vec::Vec<u16> = (0..SIDE * SIDE)
            .map(|k| {
                let limb = 40_000.0 * libm::pow(0.1, 1.0 - (k % SIDE) as f64 / SIDE as f64);
                (if inside(k) { 0.7 * limb } else { limb }) as u16
            })
            .collect();
        let frame = Frame::new(&pixels, SIDE, SIDE, SIDE).expect("fits");
        let window = Window::cut([0.0, 0.0, 95.0, 95.0], (SIDE, SIDE));
        let (mut grey, mut memory) = (std::vec![0; window.pixels()], [0; BACKGROUND]);
        let how = Reading {
            polarity: Polarity::DarkImplant,
            smoothing: 0,
            against: Some(40.0),
        };
        levels(&frame, &window, how, None, &mut grey, &mut memory);
        let step = |column: usize| {
            let at = |row: usize| f64::from(grey[row * SIDE + column]);
            at(20) - at(48)
        };
        let (thick, thin) = (step(28), step(68));
        assert!(thick > 0.5 * thin, "{thick} {thin}");
    }

    #[test]
    fn what_is_behind_a_shutter_is_blocked_and_changes_nothing_before_it() {
        const SIDE: usize = 64;
        let window = Window::cut([0.0, 0.0, 63.0, 63.0], (SIDE, SIDE));
        let is_open = |k: usize| {
            let (right, down) = ((k % SIDE) as f64 - 30.0, (k / SIDE) as f64 - 33.0);
            libm::hypot(right, down) < 26.0
        };
        let mut words = [0; 2 * SIDE];
        let mut behind = MaskMut::new(&mut words, SIDE, SIDE).expect("fits");
        let covered = (0..SIDE * SIDE).filter(|&k| !is_open(k));
        covered.for_each(|k| behind.set(k % SIDE, k / SIDE, true));
        let how = Reading {
            polarity: Polarity::DarkImplant,
            smoothing: 2,
            against: Some(30.0),
        };
        let read = |beyond: u16, inverted: bool| {
            let mut pixels = self::pixels(inverted);
            let hidden = (0..SIDE * SIDE).filter(|&k| !is_open(k));
            hidden.for_each(|k| pixels[k] = beyond);
            let frame = Frame::new(&pixels, SIDE, SIDE, SIDE).expect("fits");
            let shuttered = Shuttered::new(frame, &words).expect("same size");
            let (mut grey, mut memory) = (std::vec![0; window.pixels()], [0; BACKGROUND]);
            let polarity = match inverted {
                true => Polarity::BrightImplant,
                false => Polarity::DarkImplant,
            };
            let how = Reading { polarity, ..how };
            levels(&shuttered, &window, how, None, &mut grey, &mut memory);
            grey
        };
        for inverted in [false, true] {
            let grey = read(0, inverted);
            assert_eq!(grey, read(4095, inverted));
            for (k, &level) in grey.iter().enumerate() {
                assert_eq!(level == BLOCKED, !is_open(k), "{k}");
                let (column, row) = (k % SIDE, k / SIDE);
                let near_metal = (14..46).contains(&column) && (14..46).contains(&row);
                // The ramp is as bright at the shutter as elsewhere.
                assert!(level > 900 || near_metal, "{column} {row}: {level}");
            }
        }
    }

    #[test]
    fn excluded_pixels_are_blocked_and_a_uniform_window_has_no_step() {
        let window = Window::cut([0.0, 0.0, 31.0, 3.0], (32, 4));
        let words = [0b10, 0, 0, 0];
        let excluded = Mask::new(&words, 32, 4).expect("valid");
        let pixels: [u8; 128] = core::array::from_fn(|k| k as u8);
        let frame = Frame::new(&pixels, 32, 4, 32).expect("fits");
        let (mut grey, mut histogram) = ([0; 128], [0; LEVELS]);
        let how = Reading {
            polarity: Polarity::DarkImplant,
            smoothing: 0,
            against: None,
        };
        assert!(
            levels(
                &frame,
                &window,
                how,
                Some(&excluded),
                &mut grey,
                &mut histogram
            ) > 0.0
        );
        assert_eq!(grey.iter().filter(|&&value| value == BLOCKED).count(), 1);
        assert_eq!(grey[1], BLOCKED);
        let flat = [7u8; 128];
        let frame = Frame::new(&flat, 32, 4, 32).expect("fits");
        assert_eq!(
            levels(&frame, &window, how, None, &mut grey, &mut histogram),
            0.0
        );
    }

    #[test]
    fn logarithms_keep_the_ends_of_the_scale_and_the_part_of_light_that_metal_takes() {
        let mut grey = [0, 4000, 8000, 30_000, 60_000, u16::MAX];
        let old = grey;
        let steepest = to_logarithms(&mut grey);
        assert_eq!((grey[0], grey[5]), (0, u16::MAX));
        // A sixteenth of the scale is light that nothing takes.
        let light = |grey: u16| f64::from(grey) + f64::from(u16::MAX) / 16.0;
        let scale = f64::from(u16::MAX) / f64::ln(17.0);
        for (new, old) in grey.windows(2).zip(old.windows(2)) {
            let expected = scale * f64::ln(light(old[1]) / light(old[0]));
            assert!(
                (f64::from(new[1] - new[0]) - expected).abs() < 1.5,
                "{old:?}"
            );
        }
        assert!((steepest - scale / light(0)).abs() < 1e-9);
    }

    /// Oracle: row by row, then column by column, the last pixel again at each border.
    #[test]
    fn a_pass_of_the_filter_is_a_binomial_in_both_directions() {
        let window = Window {
            left: 3,
            top: 4,
            width: 7,
            height: 5,
        };
        let grey: std::vec::Vec<u16> = (0..35).map(|k| (k * k * 499 % 60_000) as u16).collect();
        let pass = |grey: &[u16], step: usize, at: fn(usize) -> usize, length: usize| {
            let mean = |k: usize| {
                let here = at(k);
                let before = if here == 0 { k } else { k - step };
                let after = if here + 1 == length { k } else { k + step };
                let [a, b, c] = [before, k, after].map(|k| u32::from(grey[k]));
                ((a + 2 * b + c + 2) / 4) as u16
            };
            (0..grey.len()).map(mean).collect::<std::vec::Vec<u16>>()
        };
        let rows = pass(&grey, 1, |k| k % 7, 7);
        let expected = pass(&rows, 7, |k| k / 7, 5);
        let mut found = grey;
        smooth(&mut found, &window);
        assert_eq!(found, expected);
    }

    #[test]
    fn the_ends_of_the_scale_leave_out_a_few_pixels() {
        // Of 20 000 pixels ten at each end are few.
        let grey = |outside: usize| {
            let pixel = |k: usize| match k {
                k if k < outside => 0,
                k if k >= 20_000 - outside => 65_000,
                k => 10_000 + (k % 10_000) as u16,
            };
            (0..20_000).map(pixel).collect::<std::vec::Vec<u16>>()
        };
        let mut histogram = std::vec![7; 1024];
        let (dark, bright) = ends(&grey(5), &mut histogram);
        assert!((10_000 - 64..=10_000).contains(&dark), "{dark}");
        assert!((20_000 - 64..=20_000 + 64).contains(&bright), "{bright}");
        let (dark, bright) = ends(&grey(50), &mut histogram);
        assert_eq!(dark, 0);
        assert!(bright >= 65_000, "{bright}");
        // Of one value alone both ends are told.
        let (dark, bright) = ends(&[500; 100], &mut histogram);
        assert!(
            dark < bright && dark <= 500 && bright > 500,
            "{dark} {bright}"
        );
    }
}
