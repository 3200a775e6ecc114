//! The grid that the femoral component's two surfaces share.
//!
//! Rows run along `s` from the flange to the posterior condyles, columns from lateral to medial. Behind
//! the roof of the intercondylar notch the middle columns are missing, so the grid is a horseshoe.

use super::shape::{self, LAST_CUT, NOTCH_RADIUS};
use crate::table::{mix, smooth_step};
use libm::{cos, sin, sqrt};
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_4};

/// Rows of each of the five cuts at resolution 1.
const ROWS: [f64; 5] = [14.0, 10.0, 15.0, 7.0, 13.0];
/// Columns of each condyle and of the part between them at resolution 1.
const SIDE_COLUMNS: f64 = 15.0;
const MIDDLE_COLUMNS: f64 = 10.0;

/// Where the axis of the notch's round roof meets the distal cut, as a value of `s`.
const NOTCH_CENTRE: f64 = 2.82;

/// How far rounding lowers the flange's lateral and medial corner and the posterior condyles' corners, in `s`.
const FLANGE_FALL: [f64; 2] = [0.2, 0.3];
const CONDYLE_FALL: f64 = 0.4;

/// A node's row and column.
pub(super) type Node = (usize, usize);

/// Numbers of rows and columns, and which nodes exist.
pub(super) struct Grid {
    first_row: [usize; 6],
    side: usize,
    middle: usize,
    notch_row: usize,
}

impl Grid {
    /// Lays the grid out.
    pub(super) fn new(resolution: f64) -> Self {
        let count = |base: f64, least: usize| ((base * resolution + 0.5) as usize).max(least);
        let mut first_row = [0; 6];
        for (cut, &rows) in ROWS.iter().enumerate() {
            // A peg's block of nodes wants 12 rows of the distal cut.
            first_row[cut + 1] = first_row[cut] + count(rows, if cut == 2 { 12 } else { 3 });
        }
        let rows_distal = (first_row[3] - first_row[2]) as f64;
        let corner = NOTCH_CENTRE - 2.0 - FRAC_1_SQRT_2 * NOTCH_RADIUS / shape::DISTAL_CUT;
        Self {
            first_row,
            side: count(SIDE_COLUMNS, 12),
            middle: count(MIDDLE_COLUMNS, 4),
            notch_row: first_row[2] + (corner * rows_distal + 0.5) as usize,
        }
    }

    /// The index of the last row.
    pub(super) fn last_row(&self) -> usize {
        self.first_row[5]
    }

    /// The index of the last column.
    pub(super) fn last_column(&self) -> usize {
        2 * self.side + self.middle
    }

    /// Whether a node belongs to the horseshoe.
    pub(super) fn has(&self, (row, column): Node) -> bool {
        row <= self.notch_row || column <= self.side || column >= self.side + self.middle
    }

    /// Cells by their node of lowest row and column.
    pub(super) fn cells(&self) -> impl Iterator<Item = Node> + '_ {
        let columns = self.last_column();
        (0..self.last_row()).flat_map(move |row| {
            let behind = row >= self.notch_row;
            (0..columns)
                .filter(move |&column| {
                    !behind || column < self.side || column >= self.side + self.middle
                })
                .map(move |column| (row, column))
        })
    }

    /// The border, once round: along the flange's tip towards medial, then the medial edge.
    pub(super) fn border(&self) -> Vec<Node> {
        let (rows, columns) = (self.last_row(), self.last_column());
        let (left, right) = (self.side, self.side + self.middle);
        let mut border: Vec<Node> = (0..columns).map(|column| (0, column)).collect();
        border.extend((0..rows).map(|row| (row, columns)));
        border.extend((right + 1..=columns).rev().map(|column| (rows, column)));
        border.extend((self.notch_row + 1..=rows).rev().map(|row| (row, right)));
        border.extend(
            (left + 1..=right)
                .rev()
                .map(|column| (self.notch_row, column)),
        );
        border.extend((self.notch_row..rows).map(|row| (row, left)));
        border.extend((1..=left).rev().map(|column| (rows, column)));
        border.extend((1..=rows).rev().map(|row| (row, 0)));
        border
    }

    /// The node in the middle of a condyle's distal cut that lies nearest to `s`, where a peg stands.
    pub(super) fn peg_node(&self, medial: bool, s: f64) -> Node {
        let (from, to) = (self.first_row[2], self.first_row[3]);
        let wanted = from + ((s - 2.0) * (to - from) as f64 + 0.5) as usize;
        let half = self.side / 2;
        (
            wanted,
            if medial {
                self.last_column() - half
            } else {
                half
            },
        )
    }

    /// The place `(s, z)` of a node.
    pub(super) fn place(&self, (row, column): Node) -> (f64, f64) {
        let s = self.row_place(row);
        let (s, z) = if column <= self.side {
            let part = column as f64 / self.side as f64;
            (s, mix(row_edges(s)[0], self.notch_line(row, 0), part))
        } else if column >= self.side + self.middle {
            let part = (self.last_column() - column) as f64 / self.side as f64;
            (s, mix(row_edges(s)[1], self.notch_line(row, 1), part))
        } else {
            self.middle_place(row, column - self.side)
        };
        (self.round_tips(s, z), z)
    }

    fn row_place(&self, row: usize) -> f64 {
        let cut = (0..4)
            .find(|&cut| row < self.first_row[cut + 1])
            .unwrap_or(4);
        let rows = self.first_row[cut + 1] - self.first_row[cut];
        cut as f64 + (row - self.first_row[cut]) as f64 / rows as f64
    }

    /// The column line that becomes a wall of the notch: 0 lateral, 1 medial.
    fn notch_line(&self, row: usize, side: usize) -> f64 {
        let s = self.row_place(row);
        let sign = if side == 0 { -1.0 } else { 1.0 };
        if row <= self.notch_row {
            let corner = self.row_place(self.notch_row);
            let width = row_edges(s)[side] / row_edges(corner)[side];
            return sign * self.arc_half_width(corner) * width;
        }
        sign * self.arc_half_width(s)
    }

    /// Half the width of the notch: a circular roof, then walls.
    fn arc_half_width(&self, s: f64) -> f64 {
        if s >= NOTCH_CENTRE {
            return shape::notch_half_width(s);
        }
        let above = (NOTCH_CENTRE - s) * shape::DISTAL_CUT;
        sqrt(NOTCH_RADIUS * NOTCH_RADIUS - above * above)
    }

    /// Nodes between the condyles: the rows bend into the notch's roof.
    fn middle_place(&self, row: usize, step: usize) -> (f64, f64) {
        let part = step as f64 / self.middle as f64;
        let s = self.row_place(row);
        let corner = self.row_place(self.notch_row);
        let straight = mix(self.notch_line(row, 0), self.notch_line(row, 1), part);
        let angle = (2.0 * part - 1.0) * FRAC_PI_4;
        let bend = smooth_bend((s - 2.0) / (corner - 2.0));
        let rise = (cos(angle) - FRAC_1_SQRT_2) * NOTCH_RADIUS / shape::DISTAL_CUT;
        (
            s - rise * bend,
            mix(straight, NOTCH_RADIUS * sin(angle), bend),
        )
    }

    /// Rounds the tip of the flange, highest on the lateral side, and those of the posterior condyles.
    fn round_tips(&self, s: f64, z: f64) -> f64 {
        let edge = row_edges(s)[usize::from(z > 0.0)].abs();
        if s < 1.0 {
            return s + flange_fall(z / edge) * (1.0 - s) * (1.0 - s);
        }
        if s > LAST_CUT - 1.0 {
            let wall = shape::notch_half_width(s);
            let u = (2.0 * z.abs() - edge - wall) / (edge - wall);
            let past = s - LAST_CUT + 1.0;
            return s - CONDYLE_FALL * u * u * u * u * past * past;
        }
        s
    }
}

/// How far the flange's tip falls towards its lateral (-1) and medial (1) corner, in `s`.
fn flange_fall(across: f64) -> f64 {
    let from_peak = across + 0.4;
    let (reach, fall) = if from_peak < 0.0 {
        (0.6, FLANGE_FALL[0])
    } else {
        (1.4, FLANGE_FALL[1])
    };
    let u = from_peak / reach;
    fall * u * u * (0.4 + 0.6 * u * u * u * u)
}

/// The edges of a row, at the height to which rounding the tips brings its two ends.
fn row_edges(s: f64) -> [f64; 2] {
    let (before, past) = ((1.0 - s).max(0.0), (s - LAST_CUT + 1.0).max(0.0));
    let end = |side: usize| {
        let rounded = s + FLANGE_FALL[side] * before * before - CONDYLE_FALL * past * past;
        shape::edges(rounded)[side]
    };
    [end(0), end(1)]
}

/// How much a row between the anterior edge of the distal cut (0) and the notch (1) follows the roof.
fn smooth_bend(x: f64) -> f64 {
    let t = x.clamp(0.0, 1.0);
    t * (0.5 * t + 0.5 * smooth_step(t))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn border_visits_every_border_node_once() {
        for resolution in [0.5, 1.0, 1.7] {
            let grid = Grid::new(resolution);
            let border = grid.border();
            let once: HashSet<Node> = border.iter().copied().collect();
            assert_eq!(once.len(), border.len());
            for pair in border.windows(2) {
                let apart = pair[0].0.abs_diff(pair[1].0) + pair[0].1.abs_diff(pair[1].1);
                assert_eq!(
                    apart, 1,
                    "{:?} and {:?} are not neighbours",
                    pair[0], pair[1]
                );
            }
            assert!(border.iter().all(|&node| grid.has(node)));
        }
    }

    #[test]
    fn columns_and_rows_keep_their_order() {
        let grid = Grid::new(1.0);
        for row in 0..=grid.last_row() {
            for column in 0..grid.last_column() {
                if grid.has((row, column)) && grid.has((row, column + 1)) {
                    assert!(grid.place((row, column)).1 < grid.place((row, column + 1)).1);
                }
                if row < grid.last_row() && grid.has((row, column)) && grid.has((row + 1, column)) {
                    assert!(grid.place((row, column)).0 < grid.place((row + 1, column)).0);
                }
            }
        }
    }
}
