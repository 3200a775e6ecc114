//! A level to begin with.

use super::region::{nearest_where, outer_border};
use super::{Cut, Inside, NEAR};
use crate::smoothed::Smoothed;
use fluoropose::image::border::Crack;
use fluoropose::image::contour::Point;

/// Levels that are tried.
const LEVELS: u32 = 48;
/// Smaller regions are specks, in square pixels.
const LEAST_AREA: f64 = 100.0;

/// The grey level at which the region under the cursor has the sharpest border: the greatest mean difference between
/// the pixels on both sides of it. `None` where no level gives a region of a hundred pixels.
///
/// Takes time with the length of 48 borders, some milliseconds for a frame of 1024 x 1024.
#[must_use]
pub fn suggested_level(film: &Smoothed<'_>, cursor: Point, inside: Inside) -> Option<f64> {
    let (first, last) = levels(film, cursor, inside)?;
    let per_grey = film.scale().per_grey();
    let mut best = (0.0, None);
    for number in 0..LEVELS {
        let share = (f64::from(number) + 0.5) / f64::from(LEVELS);
        let level = (first + share * (last - first)) / per_grey;
        let sharpness = sharpness(&Cut::new(film, inside, level), cursor).unwrap_or_default();
        if sharpness > best.0 {
            best = (sharpness, Some(level));
        }
    }
    best.1
}

/// From the value under the cursor to the farthest of the frame, smoothed values.
fn levels(film: &Smoothed<'_>, cursor: Point, inside: Inside) -> Option<(f64, f64)> {
    let at_cursor = nearest_where((film.width(), film.height()), cursor, 0, |_, _| true)?;
    let value = film.at(at_cursor.0, at_cursor.1);
    let rows = (0..film.height()).flat_map(|row| film.row(row));
    let farthest = match inside {
        Inside::Dark => rows.max(),
        Inside::Bright => rows.min(),
    };
    farthest.map(|&farthest| (f64::from(value), f64::from(farthest)))
}

/// Mean difference across the border of the region at the cursor; `None` for a speck, and for a region that the
/// frame's border cuts for more than half of its length.
fn sharpness(cut: &Cut<'_>, cursor: Point) -> Option<f64> {
    let film = cut.film;
    let inside = |column: usize, row: usize| {
        let cell = film.row(row).get(column);
        cell.is_some_and(|&cell| cut.holds(cell))
    };
    let seed = nearest_where((film.width(), film.height()), cursor, NEAR, inside)?;
    let start = outer_border(seed, inside);
    let (mut at, mut twice_area, mut sum, mut count, mut all) = (start, 0, 0.0, 0.0, 0.0);
    loop {
        let next = at.step();
        twice_area += at.column * next.row - at.row * next.column;
        if let Some(difference) = difference(film, at) {
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
fn difference(film: &Smoothed<'_>, at: Crack) -> Option<f64> {
    let value = |left_hand| {
        let (column, row) = at.pixel_ahead(left_hand)?;
        film.row(row).get(column).copied()
    };
    Some(f64::from(value(false)?.abs_diff(value(true)?)))
}
