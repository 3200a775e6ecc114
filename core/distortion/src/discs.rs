//! Round marks in a frame: beads of a plate, dark or bright, with the centre of each to a small fraction of a pixel.
//!
//! A bead differs from the mean of a ring around it; means over squares come from a table of sums. Its centre is the
//! centroid of its difference from the plane that fits the ring, so that a slope of brightness does not move it.

use crate::error::DistortionError;
use fluoropose::image::frame::{Frame, Pixel};
use fluoropose::math::{Matrix3, floor, solve_spd, sqrt};
use fluoropose::memory::check_length;

/// Which marks are searched.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiscSearch {
    /// Approximate radius of the beads, px, 1 to 64; radii from 2/3 to 3/2 of it are found.
    pub radius_px: f64,
    /// Whether they are brighter than what surrounds them instead of darker.
    pub bright: bool,
}

/// A round mark.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Disc {
    /// Column of the centre, px.
    pub column: f64,
    /// Row of the centre, px.
    pub row: f64,
    /// Difference of its middle from the grey around it, grey values.
    pub depth: f64,
    /// Radius of a uniform disc of that depth with the same sum of differences, px.
    pub radius_px: f64,
}

/// Number of sums that [`find`] needs for a frame of `width` x `height` pixels.
#[must_use]
pub fn sums_needed(width: usize, height: usize) -> usize {
    (width + 1) * (height + 1)
}

/// Finds round marks, at most the number that `out` holds, the clearest first, and returns their number.
///
/// Marks nearer to the frame's border than about twice their radius are left out, because their ring is cut.
///
/// # Errors
/// [`DistortionError::Radius`] for a radius outside 1 to 64 px, and [`DistortionError::Memory`] where there are fewer sums
/// than [`sums_needed`] says.
pub fn find<P: Pixel>(
    frame: &Frame<'_, P>,
    search: DiscSearch,
    sums: &mut [u64],
    out: &mut [Disc],
) -> Result<usize, DistortionError> {
    if !(1.0..=64.0).contains(&search.radius_px) {
        return Err(DistortionError::Radius(search.radius_px));
    }
    let needed = sums_needed(frame.width(), frame.height());
    check_length("sums", needed, sums.len())?;
    fill(frame, sums);
    let contrast = Contrast::new(frame, sums, search);
    let candidates = peaks(&contrast, out);
    let found = out.get_mut(..candidates).unwrap_or_default();
    found.sort_unstable_by(|a, b| b.depth.total_cmp(&a.depth));
    let clear = found
        .get(RANK)
        .or(found.last())
        .map_or(0.0, |disc| LEAST_FRACTION * disc.depth);
    let mut kept = 0;
    for index in 0..candidates {
        let Some(&candidate) = out.get(index).filter(|disc| disc.depth >= clear) else {
            continue;
        };
        let Some(disc) = centred(frame, search, candidate) else {
            continue;
        };
        let before = out.get(..kept).unwrap_or_default();
        if before
            .iter()
            .any(|other| near(other, &disc, search.radius_px))
        {
            continue;
        }
        if let Some(slot) = out.get_mut(kept) {
            *slot = disc;
            kept += 1;
        }
    }
    Ok(kept)
}

/// The mark of this rank, counted from 0, is taken to be a bead: no plate has fewer.
const RANK: usize = 15;
/// Marks fainter than this fraction of it are dropped. Towards the border of a frame the exposure falls off by less.
const LEAST_FRACTION: f64 = 0.3;

fn near(a: &Disc, b: &Disc, reach: f64) -> bool {
    let (right, down) = (a.column - b.column, a.row - b.row);
    right * right + down * down < reach * reach
}

/// Writes for each corner of a pixel the sum of all pixels above and to the left of it.
fn fill<P: Pixel>(frame: &Frame<'_, P>, sums: &mut [u64]) {
    let stride = frame.width() + 1;
    sums[..stride].fill(0);
    for row in 0..frame.height() {
        let mut along = 0u64;
        sums[(row + 1) * stride] = 0;
        for (column, &pixel) in frame.row(row).iter().enumerate() {
            let grey: u32 = pixel.into();
            along += u64::from(grey);
            sums[(row + 1) * stride + column + 1] = sums[row * stride + column + 1] + along;
        }
    }
}

/// The difference between the middle of a square and a ring around it.
struct Contrast<'a> {
    sums: &'a [u64],
    width: usize,
    height: usize,
    /// Half sides of the middle and of the ring's inner and outer border.
    halves: [usize; 3],
    sign: f64,
    step: usize,
}

impl<'a> Contrast<'a> {
    fn new<P: Pixel>(frame: &Frame<'_, P>, sums: &'a [u64], search: DiscSearch) -> Self {
        let radius = search.radius_px;
        Self {
            sums,
            width: frame.width(),
            height: frame.height(),
            halves: [
                floor(0.6 * radius) as usize,
                floor(1.3 * radius) as usize + 1,
                floor(2.0 * radius) as usize + 2,
            ],
            sign: if search.bright { -1.0 } else { 1.0 },
            step: (floor(radius / 2.0) as usize).max(1),
        }
    }

    /// Sum over the square of this half side, and the number of its pixels.
    fn square(&self, column: usize, row: usize, half: usize) -> (u64, usize) {
        let stride = self.width + 1;
        let (left, top) = (column - half, row - half);
        let (right, bottom) = (column + half + 1, row + half + 1);
        let at =
            |row: usize, column: usize| self.sums.get(row * stride + column).copied().unwrap_or(0);
        let sum = at(bottom, right) + at(top, left) - at(top, right) - at(bottom, left);
        (sum, (right - left) * (bottom - top))
    }

    /// The contrast at a pixel: positive where the middle is darker than the ring, or brighter where bright marks are
    /// searched.
    fn at(&self, column: usize, row: usize) -> f64 {
        let [middle, inner, outer] = self.halves.map(|half| self.square(column, row, half));
        let ring = (outer.0 - inner.0) as f64 / (outer.1 - inner.1) as f64;
        self.sign * (ring - middle.0 as f64 / middle.1 as f64)
    }

    /// Coarsely spaced places (column, row) away from the border.
    fn places(&self) -> impl Iterator<Item = (usize, usize)> {
        let margin = self.halves[2] + self.step;
        let rows = (margin..self.height.saturating_sub(margin)).step_by(self.step);
        let (width, step) = (self.width, self.step);
        rows.flat_map(move |row| {
            (margin..width.saturating_sub(margin))
                .step_by(step)
                .map(move |column| (column, row))
        })
    }

    /// Whether no neighbour has a greater contrast; of equal ones the first counts.
    fn is_peak(&self, column: usize, row: usize, value: f64) -> bool {
        let s = self.step;
        let before = [
            (column - s, row - s),
            (column, row - s),
            (column + s, row - s),
            (column - s, row),
        ];
        let after = [
            (column + s, row),
            (column - s, row + s),
            (column, row + s),
            (column + s, row + s),
        ];
        before.iter().all(|&(c, r)| self.at(c, r) < value)
            && after.iter().all(|&(c, r)| self.at(c, r) <= value)
    }
}

/// Writes the greatest peaks of contrast as discs whose depth is that contrast, and returns their number.
fn peaks(contrast: &Contrast<'_>, out: &mut [Disc]) -> usize {
    let (squares, count) = contrast
        .places()
        .fold((0.0, 0usize), |(sum, count), (column, row)| {
            let value = contrast.at(column, row);
            (sum + value * value, count + 1)
        });
    // Most of the frame is no bead: peaks that are not above the usual unevenness are skipped.
    let floor = sqrt(squares / count.max(1) as f64);
    let mut kept = 0;
    let mut faintest = 0;
    for (column, row) in contrast.places() {
        let depth = contrast.at(column, row);
        if depth <= floor || !contrast.is_peak(column, row, depth) {
            continue;
        }
        let disc = Disc {
            column: column as f64 + 0.5,
            row: row as f64 + 0.5,
            depth,
            radius_px: 0.0,
        };
        if let Some(slot) = out.get_mut(kept) {
            *slot = disc;
            kept += 1;
        } else if out.get(faintest).is_some_and(|other| other.depth < depth) {
            out[faintest] = disc;
        } else {
            continue;
        }
        if kept == out.len() {
            let depths = out.iter().enumerate();
            faintest = depths
                .min_by(|a, b| a.1.depth.total_cmp(&b.1.depth))
                .map_or(0, |(index, _)| index);
        }
    }
    kept
}

/// The greatest number of times that the window is moved to the centroid.
const MOVES: usize = 8;
/// A shift below this ends them, px.
const SETTLED: f64 = 1e-3;
/// Differences below this fraction of the depth have no weight, so that noise far from the centre has none.
const CUT: f64 = 0.25;
/// The greatest ratio of the longest axis of a round mark to its shortest.
const ROUND: f64 = 1.5;

/// The mark near `start`, centred; `None` where there is no round mark of about the wanted size.
fn centred<P: Pixel>(frame: &Frame<'_, P>, search: DiscSearch, start: Disc) -> Option<Disc> {
    let mut disc = start;
    let mut found = None;
    for _ in 0..MOVES {
        let measured = Window::new(frame, search, &disc)?.measure()?;
        let shift = sqrt(
            (measured.column - disc.column) * (measured.column - disc.column)
                + (measured.row - disc.row) * (measured.row - disc.row),
        );
        let strayed = (measured.column - start.column).abs() + (measured.row - start.row).abs();
        if strayed > 3.0 * search.radius_px + 2.0 {
            return None;
        }
        disc = measured;
        found = Some(measured);
        if shift < SETTLED {
            break;
        }
    }
    let ratio = found?.radius_px / search.radius_px;
    found.filter(|_| (0.5..=1.8).contains(&ratio))
}

/// The pixels around a place, and the plane of grey that fits the ring there.
struct Window<'f, 'p, P> {
    frame: &'f Frame<'p, P>,
    sign: f64,
    /// Radii, px: of the middle that gives the depth, of the window, of the inner and the outer border of the ring.
    radii: [f64; 4],
    centre: [f64; 2],
    plane: [f64; 3],
}

impl<'f, 'p, P: Pixel> Window<'f, 'p, P> {
    fn new(frame: &'f Frame<'p, P>, search: DiscSearch, at: &Disc) -> Option<Self> {
        let radius = search.radius_px;
        let mut window = Self {
            frame,
            sign: if search.bright { -1.0 } else { 1.0 },
            radii: [
                (0.5 * radius).max(0.8),
                1.6 * radius + 1.0,
                1.7 * radius + 1.0,
                2.2 * radius + 2.0,
            ],
            centre: [at.column, at.row],
            plane: [0.0; 3],
        };
        let reach = window.radii[3] + 1.0;
        let inside = |at: f64, side: usize| at > reach && at < side as f64 - reach;
        if !inside(at.column, frame.width()) || !inside(at.row, frame.height()) {
            return None;
        }
        let (mut normal, mut side): (Matrix3, [f64; 3]) = ([[0.0; 3]; 3], [0.0; 3]);
        window.each(window.radii[2], window.radii[3], |right, down, grey| {
            let terms = [1.0, right, down];
            for (row, a) in terms.iter().enumerate() {
                side[row] += a * grey;
                for (column, b) in terms.iter().enumerate() {
                    normal[row][column] += a * b;
                }
            }
        });
        window.plane = solve_spd(normal, side)?;
        Some(window)
    }

    /// Calls `call` with the offsets to the right and down and the grey of each pixel whose centre lies between two radii.
    fn each(&self, from: f64, to: f64, mut call: impl FnMut(f64, f64, f64)) {
        let [column, row] = self.centre;
        for r in floor(row - to) as isize..=floor(row + to) as isize {
            for c in floor(column - to) as isize..=floor(column + to) as isize {
                let (right, down) = (c as f64 + 0.5 - column, r as f64 + 0.5 - row);
                let away = right * right + down * down;
                if away >= from * from && away < to * to {
                    let grey: u32 = self.frame.nearest(c, r).into();
                    call(right, down, f64::from(grey));
                }
            }
        }
    }

    /// Difference of a pixel from the plane, positive inside of a mark.
    fn depth(&self, right: f64, down: f64, grey: f64) -> f64 {
        let [level, across, along] = self.plane;
        self.sign * (level + across * right + along * down - grey)
    }

    fn measure(&self) -> Option<Disc> {
        let [middle, window, ..] = self.radii;
        let (mut sum, mut count) = (0.0, 0.0);
        self.each(0.0, middle, |right, down, grey| {
            sum += self.depth(right, down, grey);
            count += 1.0;
        });
        let depth = sum / count;
        if depth.is_nan() || depth <= 0.0 {
            return None;
        }
        let mut moments = [0.0; 6];
        let mut taken = 0.0;
        self.each(0.0, window, |right, down, grey| {
            let whole = self.depth(right, down, grey);
            let weight = (whole - CUT * depth).max(0.0);
            taken += whole.max(0.0);
            for (moment, power) in
                moments
                    .iter_mut()
                    .zip([1.0, right, down, right * right, right * down, down * down])
            {
                *moment += weight * power;
            }
        });
        let [mass, right, down, xx, xy, yy] = moments;
        let (right, down) = (right / mass, down / mass);
        if !is_round(
            xx / mass - right * right,
            xy / mass - right * down,
            yy / mass - down * down,
        ) {
            return None;
        }
        Some(Disc {
            column: self.centre[0] + right,
            row: self.centre[1] + down,
            depth,
            radius_px: sqrt(taken / depth / core::f64::consts::PI),
        })
    }
}

/// Whether second moments about the centroid are those of a round mark. NaN is not round.
fn is_round(xx: f64, xy: f64, yy: f64) -> bool {
    let (mean, half) = ((xx + yy) / 2.0, (xx - yy) / 2.0);
    let spread = sqrt(half * half + xy * xy);
    mean - spread > 0.0 && mean + spread < ROUND * ROUND * (mean - spread)
}

#[cfg(test)]
mod tests;
