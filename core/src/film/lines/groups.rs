//! Lines by the tiles that they have places in, asked four at a time whether a triangle lies across them.

use super::course::{Course, ORIGIN, POINTS, STEP};
use super::cut::Seen;
use crate::image::contour::Point;
use crate::image::scan::{FixedPoint, ONE};
use crate::image::tiles::{TILES, Tiles};

/// Tiles have sides of eight pixels at least: a line has places in no more than [`SPANNED`] of them.
const LEAST_PLACES: u32 = 3;
pub(super) const SPANNED: usize = 8;
/// Places that are passed over where both ends lie in one tile.
const STRIDE: usize = 5;
/// In place of a group: a list ends.
pub(super) const NONE: u16 = u16::MAX;
/// Lines that are asked at once.
const LANES: usize = 4;
/// How far behind a line's origin it ends, in places.
const END: f32 = (POINTS - ORIGIN) as f32;

/// Some lines that have places in a tile, as numbers of 32 bits. What triangles ask of them comes first and lies together.
#[derive(Clone, Copy, Debug)]
pub struct LineGroup {
    /// Their origins, in units of 1/4096 pixel.
    columns: [f32; LANES],
    rows: [f32; LANES],
    /// Places to such a unit, to the right and down. Nothing lies across a line that has none.
    right: [f32; LANES],
    down: [f32; LANES],
    /// Their first places, seen from the origin.
    firsts: [f32; LANES],
    lines: [u16; LANES],
    count: u16,
    /// The next group of the same tile.
    next: u16,
}

impl Default for LineGroup {
    fn default() -> Self {
        Self::before(NONE)
    }
}

impl LineGroup {
    /// An empty one before another.
    const fn before(next: u16) -> Self {
        Self {
            columns: [0.0; LANES],
            rows: [0.0; LANES],
            right: [0.0; LANES],
            down: [0.0; LANES],
            firsts: [0.0; LANES],
            lines: [NONE; LANES],
            count: 0,
            next,
        }
    }

    fn push(&mut self, number: usize, line: &Course) {
        let lane = usize::from(self.count) % LANES;
        let [column, row] = line.origin;
        let origin = FixedPoint::rounded(Point { column, row }).0.units();
        let per_unit = line
            .direction
            .map(|part| (part / (STEP * ONE as f64)) as f32);
        [self.columns[lane], self.rows[lane]] = origin;
        [self.right[lane], self.down[lane]] = per_unit;
        self.firsts[lane] = line.first() as f32 - ORIGIN as f32;
        self.lines[lane] = number as u16;
        self.count += 1;
    }

    fn is_full(&self) -> bool {
        usize::from(self.count) == LANES
    }

    /// Which of the lines have corners of a triangle on both sides, and may have places between them: 1, else 0.
    // One pass over all lanes without a branch, and numbers as wide as they are: it becomes vectors.
    #[inline(always)]
    fn cut_by(&self, [a, b, c]: &[[f32; 2]; 3]) -> [u32; LANES] {
        let mut cut = [0; LANES];
        for (lane, cut) in cut.iter_mut().enumerate() {
            let (column, row) = (self.columns[lane], self.rows[lane]);
            let (right, down) = (self.right[lane], self.down[lane]);
            let across = |[x, y]: &[f32; 2]| (x - column) * down - (y - row) * right;
            let along = |[x, y]: &[f32; 2]| (x - column) * right + (y - row) * down;
            let [low, high] = range(across(a), across(b), across(c));
            let [begin, end] = range(along(a), along(b), along(c));
            let is_across = (low <= 0.0) & (high > 0.0);
            let is_along = (begin <= END) & (end >= self.firsts[lane]);
            *cut = u32::from(is_across & is_along);
        }
        cut
    }

    /// The corners of a triangle as one of the lines sees them: by the same numbers.
    #[inline(always)]
    fn seen(&self, lane: usize, corners: &[[f32; 2]; 3]) -> Seen {
        let (column, row) = (self.columns[lane], self.rows[lane]);
        let (right, down) = (self.right[lane], self.down[lane]);
        let off = corners.map(|[x, y]| [x - column, y - row]);
        Seen {
            across: off.map(|[x, y]| x * down - y * right),
            along: off.map(|[x, y]| x * right + y * down + ORIGIN as f32),
        }
    }
}

/// The least and the greatest. By comparisons that are one instruction for four of them.
#[inline(always)]
fn range(a: f32, b: f32, c: f32) -> [f32; 2] {
    let [low, high] = if a < b { [a, b] } else { [b, a] };
    [
        if low < c { low } else { c },
        if high > c { high } else { c },
    ]
}

/// Tiles with the lists of lines that have places in them.
pub(super) struct Grid<'g> {
    tiles: Tiles,
    heads: &'g [u16],
    groups: &'g [LineGroup],
}

impl<'g> Grid<'g> {
    /// Enters each line in the lists of the tiles that it has places in.
    pub(super) fn of(
        lines: impl Iterator<Item = Course> + Clone,
        heads: &'g mut [u16],
        groups: &'g mut [LineGroup],
    ) -> Self {
        // All places of a line lie between its ends.
        let ends = lines
            .clone()
            .flat_map(|line| [line.first(), POINTS - 1].map(|point| line.pixel(point)));
        let tiles = Tiles::around(ends, LEAST_PLACES);
        heads.fill(NONE);
        let mut used = 0;
        for (number, line) in lines.enumerate() {
            for_each_tile(&tiles, &line, |[column, row]| {
                let head = &mut heads[row * TILES + column];
                if groups
                    .get(usize::from(*head))
                    .is_none_or(LineGroup::is_full)
                {
                    groups[used] = LineGroup::before(*head);
                    *head = used as u16;
                    used += 1;
                }
                groups[usize::from(*head)].push(number, &line);
            });
        }
        Self {
            tiles,
            heads,
            groups,
        }
    }

    /// Calls `each` with the number of every line that a triangle lies across, and its corners as that sees them; with some more than once.
    #[inline(always)]
    pub(super) fn for_each_cut(
        &self,
        corners: &[FixedPoint; 3],
        mut each: impl FnMut(usize, Seen),
    ) {
        let Some([[left, right], [top, bottom]]) = self.tiles.met(corners) else {
            return;
        };
        let corners = corners.map(FixedPoint::units);
        for row in top..bottom {
            let heads = self.heads.get(row * TILES + left..row * TILES + right);
            for &head in heads.unwrap_or_default() {
                let mut at = head;
                while let Some(group) = self.groups.get(usize::from(at)) {
                    at = group.next;
                    let cut = group.cut_by(&corners);
                    if cut == [0; LANES] {
                        continue;
                    }
                    for lane in (0..LANES).filter(|&lane| cut[lane] != 0) {
                        each(usize::from(group.lines[lane]), group.seen(lane, &corners));
                    }
                }
            }
        }
    }
}

/// Calls `each` with the column and row of every tile that a line has places in.
fn for_each_tile(tiles: &Tiles, line: &Course, mut each: impl FnMut([usize; 2])) {
    let (mut entered, mut before) = (0, None);
    let mut points = line.first()..POINTS;
    while let Some(point) = points.next() {
        let tile = tiles.tile(line.pixel(point));
        // A tile that has both ends of a piece has all of it.
        if tiles.tile(line.pixel((point + STRIDE).min(POINTS - 1))) == tile {
            points.start += STRIDE - 1;
        }
        if before != Some(tile) && entered < SPANNED {
            before = Some(tile);
            entered += 1;
            each(tile);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::vec::Vec;

    properties! {
        #[test]
        fn a_line_is_entered_in_every_tile_that_it_has_places_in_once(
            places in proptest::collection::vec((-20.0..300.0f64, -20.0..300.0f64, 0.0..7.0f64), 1..12), first in 0u16..40,
        ) {
            let line = |&(column, row, angle): &(f64, f64, f64)| {
                let (down, right) = libm::sincos(angle);
                Course { origin: [column, row], direction: [right, down], first }
            };
            let lines: Vec<Course> = places.iter().map(line).collect();
            let all = |line: &Course| (line.first()..POINTS).map(|point| line.pixel(point)).collect::<Vec<_>>();
            let tiles = Tiles::around(lines.iter().flat_map(all), LEAST_PLACES);
            for line in &lines {
                let mut wanted: Vec<[usize; 2]> = all(line).into_iter().map(|pixel| tiles.tile(pixel)).collect();
                wanted.dedup();
                let mut found = Vec::new();
                for_each_tile(&tiles, line, |tile| found.push(tile));
                prop_assert!(found.len() <= SPANNED);
                prop_assert_eq!(found, wanted);
            }
        }
    }
}
