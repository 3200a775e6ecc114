//! Other pictures of a frame: its edges, and its contrast equalised region by region. Display only: nothing is measured
//! in them.

use fluoropose::image::frame::Pixel;

/// Tiles to each side of the frame whose histograms are equalised.
const TILES: usize = 8;
/// A tile is at least this wide and high, pixels: a smaller one has no histogram worth the name.
const LEAST_TILE: usize = 16;
/// A grey value may be this many times as frequent as the mean before its share is cut: noise in even regions is not
/// blown up (Zuiderveld, Graphics Gems IV, 1994).
const CLIP: f64 = 3.0;
const BINS: usize = 256;
/// Share of the pixels that is left out at either end of the grey scale.
const OUTLIERS: f64 = 0.001;
/// Share of the edges that is shown in full white.
const STRONGEST: f64 = 0.005;
/// Slopes that are told apart for that; a screen shows 256.
const STEPS: usize = 1 << 14;

/// Contrast-limited adaptive histogram equalisation: 0 to 255.
pub(crate) fn equalised<P: Pixel>(pixels: &[P], width: usize, height: usize) -> Vec<u8> {
    let binned = binned(pixels);
    let tiles = Tiles::new(&binned, width, height);
    let rows = 0..height;
    rows.flat_map(|row| {
        let (tiles, binned) = (&tiles, &binned);
        (0..width).map(move |column| tiles.at(binned[row * width + column], column, row))
    })
    .collect()
}

/// Grey values in [`BINS`] steps between their least and greatest, outliers left out.
fn binned<P: Pixel>(pixels: &[P]) -> Vec<u8> {
    let (low, high) = (level(pixels, OUTLIERS), level(pixels, 1.0 - OUTLIERS));
    let span = f64::from(high.saturating_sub(low).max(1));
    let bin = |grey: u32| (f64::from(grey.saturating_sub(low)) * 255.0 / span).min(255.0) as u8;
    pixels.iter().map(|&grey| bin(grey.into())).collect()
}

/// The value that a share of all do not exceed.
fn level<P: Pixel>(pixels: &[P], share: f64) -> u32 {
    let most = pixels.iter().map(|&grey| grey.into()).max();
    let most = most.unwrap_or(0) as usize;
    let mut counts = vec![0usize; most + 1];
    for &grey in pixels {
        counts[grey.into() as usize] += 1;
    }
    let wanted = pixels.len() as f64 * share;
    let mut below = 0;
    let found = counts.iter().position(|count| {
        below += count;
        below as f64 >= wanted && below > 0
    });
    found.unwrap_or(most) as u32
}

/// The equalising map of each tile.
struct Tiles {
    maps: Vec<[u8; BINS]>,
    columns: Axis,
    rows: Axis,
}

/// Tiles along one side of the frame.
#[derive(Clone, Copy)]
struct Axis {
    count: usize,
    /// Pixels, not whole ones.
    size: f64,
}

impl Axis {
    fn new(length: usize) -> Self {
        let count = (length / LEAST_TILE).clamp(1, TILES);
        Self {
            count,
            size: length as f64 / count as f64,
        }
    }

    /// First and last pixel, the last excluded.
    fn span(&self, tile: usize) -> std::ops::Range<usize> {
        let edge = |tile: usize| (tile as f64 * self.size).round() as usize;
        edge(tile)..edge(tile + 1)
    }

    /// The tiles before and after a pixel's place, and how far it is from the first one's middle to the second's.
    fn between(&self, at: usize) -> (usize, usize, f64) {
        let place = ((at as f64 + 0.5) / self.size - 0.5).clamp(0.0, self.count as f64 - 1.0);
        let before = place as usize;
        (
            before,
            (before + 1).min(self.count - 1),
            place - before as f64,
        )
    }
}

impl Tiles {
    fn new(binned: &[u8], width: usize, height: usize) -> Self {
        let (columns, rows) = (Axis::new(width), Axis::new(height));
        let mut maps = Vec::with_capacity(columns.count * rows.count);
        for row in 0..rows.count {
            for column in 0..columns.count {
                let mut counts = [0usize; BINS];
                for y in rows.span(row) {
                    for x in columns.span(column) {
                        counts[usize::from(binned[y * width + x])] += 1;
                    }
                }
                maps.push(equalising(&counts));
            }
        }
        Self {
            maps,
            columns,
            rows,
        }
    }

    /// The shade of a bin at a place, between the maps of the four nearest tiles.
    fn at(&self, bin: u8, column: usize, row: usize) -> u8 {
        let (left, right, x) = self.columns.between(column);
        let (top, bottom, y) = self.rows.between(row);
        let map = |column: usize, row: usize| {
            f64::from(self.maps[row * self.columns.count + column][usize::from(bin)])
        };
        let upper = map(left, top) * (1.0 - x) + map(right, top) * x;
        let lower = map(left, bottom) * (1.0 - x) + map(right, bottom) * x;
        (upper * (1.0 - y) + lower * y).round() as u8
    }
}

/// The cumulative distribution of counts that are cut at [`CLIP`] times their mean, what is cut spread evenly.
fn equalising(counts: &[usize; BINS]) -> [u8; BINS] {
    let all: usize = counts.iter().sum();
    let limit = CLIP * all as f64 / BINS as f64;
    let cut: f64 = counts.iter().map(|&n| (n as f64 - limit).max(0.0)).sum();
    let spread = cut / BINS as f64;
    let mut sum = 0.0;
    counts.map(|count| {
        sum += (count as f64).min(limit) + spread;
        (sum * 255.0 / all.max(1) as f64).round().min(255.0) as u8
    })
}

/// Strength of edges: the slope of the frame after a small Gaussian, the strongest white.
pub(crate) fn edges<P: Pixel>(pixels: &[P], width: usize, height: usize) -> Vec<u8> {
    let grey: Vec<f32> = pixels.iter().map(|&grey| grey.into() as f32).collect();
    let smooth = smoothed(&smoothed(&grey, width, height, 1), width, height, width);
    let slope = slopes(&smooth, width, height);
    let strongest = strongest(&slope);
    // A frame without any slope has no edge.
    let scale = if strongest > 0.0 {
        255.0 / strongest
    } else {
        0.0
    };
    slope
        .iter()
        .map(|&slope| (slope * scale).min(255.0) as u8)
        .collect()
}

/// The slope that only [`STRONGEST`] of all exceed, to a [`STEPS`]th of the greatest.
fn strongest(slope: &[f32]) -> f32 {
    let greatest = slope.iter().fold(0.0, |most: f32, &slope| most.max(slope));
    let mut counts = vec![0usize; STEPS + 1];
    for &slope in slope {
        counts[(slope / greatest * STEPS as f32) as usize] += 1;
    }
    let rank = slope.len() as f64 * (1.0 - STRONGEST);
    let mut below = 0;
    let found = counts.iter().position(|count| {
        below += count;
        below as f64 > rank
    });
    found.unwrap_or(STEPS) as f32 / STEPS as f32 * greatest
}

/// Weights 1 4 6 4 1 along a row (`step` of 1) or a column (`step` of a row's length).
fn smoothed(grey: &[f32], width: usize, height: usize, step: usize) -> Vec<f32> {
    let length = if step == 1 { width } else { height };
    let value = |index: usize, along: usize, by: isize| {
        let other = along.saturating_add_signed(by).min(length - 1);
        grey[index + other * step - along * step]
    };
    (0..width * height)
        .map(|index| {
            let along = if step == 1 {
                index % width
            } else {
                index / width
            };
            let at = |by| value(index, along, by);
            (at(-2) + at(2) + 4.0 * (at(-1) + at(1)) + 6.0 * at(0)) / 16.0
        })
        .collect()
}

/// Lengths of the gradient by central differences; zero at the frame's border.
fn slopes(grey: &[f32], width: usize, height: usize) -> Vec<f32> {
    let mut slopes = vec![0.0; grey.len()];
    for row in 1..height.saturating_sub(1) {
        for column in 1..width.saturating_sub(1) {
            let index = row * width + column;
            let across = grey[index + 1] - grey[index - 1];
            let down = grey[index + width] - grey[index - width];
            slopes[index] = across.hypot(down);
        }
    }
    slopes
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIDE: usize = 64;

    /// Dark on the left, bright on the right, each with a faint ramp in it.
    fn halves() -> Vec<u16> {
        let grey = |index: usize| {
            let (column, row) = (index % SIDE, index / SIDE);
            let base = if column < SIDE / 2 { 100 } else { 3000 };
            base + row as u16
        };
        (0..SIDE * SIDE).map(grey).collect()
    }

    #[test]
    fn edges_are_white_where_the_step_is_and_black_where_nothing_is() {
        let shown = edges(&halves(), SIDE, SIDE);
        let row = 30 * SIDE;
        assert_eq!(shown[row + SIDE / 2], 255);
        assert!(shown[row + 8] < 4 && shown[row + SIDE - 8] < 4);
    }

    #[test]
    fn faint_stripes_gain_contrast_on_both_sides_of_a_step_and_stay_bright_and_dark() {
        const FAINT: u16 = 40;
        let mut pixels = halves();
        for stripe in pixels.chunks_mut(SIDE).step_by(2) {
            stripe.iter_mut().for_each(|pixel| *pixel += FAINT);
        }
        let shown = equalised(&pixels, SIDE, SIDE);
        // The share of all grey values as they are on the film, in 255 shades.
        let plain = 255 * u32::from(FAINT) / 3003;
        for column in [8, SIDE - 8] {
            let shade = |row: usize| u32::from(shown[row * SIDE + column]);
            for bright in (0..SIDE - 1).step_by(2) {
                let (bright, dark) = (shade(bright), shade(bright + 1));
                assert!(bright > dark + plain, "column {column}: {bright}, {dark}");
            }
        }
    }

    #[test]
    fn an_even_frame_stays_even_and_an_empty_one_is_empty() {
        let shown = equalised(&[7u8; 24 * 16], 24, 16);
        assert!(shown.iter().all(|&shade| shade == shown[0]));
        assert!(
            edges(&[7u8; 24 * 16], 24, 16)
                .iter()
                .all(|&shade| shade == 0)
        );
        assert!(equalised::<u8>(&[], 0, 0).is_empty() && edges::<u8>(&[], 0, 0).is_empty());
    }

    #[test]
    fn frames_that_are_no_multiple_of_the_tiles_are_covered() {
        let pixels: Vec<u8> = (0..101 * 77).map(|i| (i * 31 % 251) as u8).collect();
        assert_eq!(equalised(&pixels, 101, 77).len(), 101 * 77);
        let axis = Axis::new(101);
        assert_eq!(
            (axis.span(0).start, axis.span(axis.count - 1).end),
            (0, 101)
        );
    }
}
