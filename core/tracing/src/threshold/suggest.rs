//! A grey level to begin with.

use super::cut::Cut;
use super::region::{NEAR, nearest_where, outer_border};
use crate::side::Inside;
use crate::smoothed::Smoothed;
use fluoropose::image::border::Crack;
use fluoropose::image::contour::Point;

/// Levels that are tried.
const LEVELS: u32 = 48;
/// Smaller regions are specks, in square pixels.
const LEAST_AREA: f64 = 100.0;

/// The grey level at which the region under the cursor has the sharpest border, that is the greatest mean difference
/// between the pixels on both sides of it. `None` where no level gives a region of 100 pixels.
///
/// It follows 48 borders, which takes some milliseconds for a frame of 1024 x 1024 pixels.
#[must_use]
pub fn suggested_level(frame: &Smoothed<'_>, cursor: Point, inside: Inside) -> Option<f64> {
    let (first, last) = levels(frame, cursor, inside)?;
    let per_grey = frame.scale().per_grey();
    let mut best = (0.0, None);
    for number in 0..LEVELS {
        let fraction = (f64::from(number) + 0.5) / f64::from(LEVELS);
        let level = (first + fraction * (last - first)) / per_grey;
        let sharpness = sharpness(&Cut::new(frame, inside, level), cursor).unwrap_or_default();
        if sharpness > best.0 {
            best = (sharpness, Some(level));
        }
    }
    best.1
}

/// The smoothed values between which levels are tried: that under the cursor, and that of the frame farthest from it.
fn levels(frame: &Smoothed<'_>, cursor: Point, inside: Inside) -> Option<(f64, f64)> {
    let at_cursor = nearest_where((frame.width(), frame.height()), cursor, 0, |_, _| true)?;
    let value = frame.at(at_cursor.0, at_cursor.1);
    let rows = (0..frame.height()).flat_map(|row| frame.row(row));
    let farthest = match inside {
        Inside::Dark => rows.max(),
        Inside::Bright => rows.min(),
    };
    farthest.map(|&farthest| (f64::from(value), f64::from(farthest)))
}

/// Mean difference across the border of the region at the cursor; `None` for a speck, and for a region more than half of
/// whose border is the frame's own.
fn sharpness(cut: &Cut<'_>, cursor: Point) -> Option<f64> {
    let frame = cut.frame;
    let inside = |column: usize, row: usize| {
        let cell = frame.row(row).get(column);
        cell.is_some_and(|&cell| cut.holds(cell))
    };
    let seed = nearest_where((frame.width(), frame.height()), cursor, NEAR, inside)?;
    let start = outer_border(seed, inside);
    let (mut at, mut twice_area, mut sum, mut count, mut all) = (start, 0, 0.0, 0.0, 0.0);
    loop {
        let next = at.step();
        twice_area += at.column * next.row - at.row * next.column;
        if let Some(difference) = difference(frame, at) {
            sum += difference;
            count += 1.0;
        }
        all += 1.0;
        at = next.turn_where(inside);
        if at == start {
            break;
        }
    }
    let worth = twice_area as f64 >= 2.0 * LEAST_AREA && 2.0 * count > all;
    worth.then(|| sum / count)
}

/// The difference between the pixels on both hands; `None` at the frame's border.
fn difference(frame: &Smoothed<'_>, at: Crack) -> Option<f64> {
    let value = |left_hand| {
        let (column, row) = at.pixel_ahead(left_hand)?;
        frame.row(row).get(column).copied()
    };
    Some(f64::from(value(false)?.abs_diff(value(true)?)))
}
