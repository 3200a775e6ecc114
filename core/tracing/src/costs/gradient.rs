//! Gradients at two scales, and where they are greatest.

use fluoropose::math::sqrt;

/// Weights along one axis; they sum to 16.
const WEIGHTS: [u32; 5] = [1, 4, 6, 4, 1];
/// Distance between the pixels that are averaged for the coarse scale.
const SPREAD: usize = 2;

/// A row of values, as long as the frame is wide.
fn row_of(values: &[u16], width: usize, row: usize) -> &[u16] {
    values
        .get(row * width..(row + 1) * width)
        .unwrap_or_default()
}

/// The number `by` away from `at`, kept below `count`.
fn moved(at: usize, by: isize, count: usize) -> usize {
    at.saturating_add_signed(by).min(count - 1)
}

/// Smooths a row of the fine scale once more, with every second pixel: a Gaussian of about 2.2 pixels in all.
pub(super) fn coarse_row(fine: &[u16], width: usize, height: usize, row: usize, out: &mut [u16]) {
    let rows: [&[u16]; WEIGHTS.len()] = core::array::from_fn(|k| {
        let by = (SPREAD * k) as isize - (2 * SPREAD) as isize;
        row_of(fine, width, moved(row, by, height))
    });
    let Some(out) = out.get_mut(row * width..(row + 1) * width) else {
        return;
    };
    let down = |column: usize| -> u32 {
        let weighted = rows.iter().zip(WEIGHTS);
        weighted
            .map(|(row, weight)| weight * u32::from(row[column]))
            .sum()
    };
    let at = |column: usize| down(column.min(width - 1));
    // Column sums from four to the left to four to the right, so that each is computed once.
    let mut window = [0; 4 * SPREAD + 1];
    for (k, sum) in window.iter_mut().enumerate() {
        *sum = at(k.saturating_sub(2 * SPREAD));
    }
    for (column, value) in out.iter_mut().enumerate() {
        let weighted = window.iter().step_by(SPREAD).zip(WEIGHTS);
        let sum: u32 = weighted.map(|(sum, weight)| sum * weight).sum();
        *value = (sum >> 8) as u16;
        window.rotate_left(1);
        window[4 * SPREAD] = at(column + 2 * SPREAD + 1);
    }
}

/// Calls `emit` with the column, the magnitude and the direction (the sum of both gradients) of each pixel of a row.
pub(super) fn gradients_row(
    [fine, coarse]: [&[u16]; 2],
    width: usize,
    height: usize,
    row: usize,
    mut emit: impl FnMut(usize, u16, [i32; 2]),
) {
    let rows = |values, reach: isize| {
        [-reach, 0, reach].map(|by| row_of(values, width, moved(row, by, height)))
    };
    let fine = rows(fine, 1);
    let coarse = rows(coarse, SPREAD as isize);
    for column in 0..width {
        let [x1, y1] = difference(fine, column, 1);
        // Over twice the distance.
        let [x2, y2] = difference(coarse, column, SPREAD).map(|d| d / 2);
        let product = i64::from(x1) * i64::from(x2) + i64::from(y1) * i64::from(y2);
        let magnitude = if product > 0 {
            sqrt(product as f64)
        } else {
            0.0
        };
        emit(
            column,
            magnitude.min(f64::from(u16::MAX)) as u16,
            [x1 + x2, y1 + y2],
        );
    }
}

/// Differences to the right and downwards over `2 * reach` pixels.
fn difference([above, here, below]: [&[u16]; 3], column: usize, reach: usize) -> [i32; 2] {
    let (left, right) = (
        column.saturating_sub(reach),
        (column + reach).min(here.len() - 1),
    );
    [
        i32::from(here[right]) - i32::from(here[left]),
        i32::from(below[column]) - i32::from(above[column]),
    ]
}

/// The direction of a vector in 256ths of a turn, to about half of one. Of no vector, 0.
pub(super) fn angle_of(x: i32, y: i32) -> u8 {
    let (across, down) = (x.unsigned_abs(), y.unsigned_abs());
    let (small, large) = (across.min(down) as f32, across.max(down) as f32);
    if large == 0.0 {
        return 0;
    }
    let z = small / large;
    // atan(z) in 256ths of a turn (Rajan et al., *IEEE Signal Processing Magazine* 23, 2006): off by 0.16 at most.
    let octant = z * (32.0 + 11.12 * (1.0 - z));
    let quadrant = if down > across { 64.0 - octant } else { octant };
    let half = if x < 0 { 128.0 - quadrant } else { quadrant };
    let turn = if y < 0 { 256.0 - half } else { half };
    (turn + 0.5) as u32 as u8
}

/// Magnitudes of a row and of its neighbours; beyond the frame those of its border.
pub(super) fn rows_around(
    magnitudes: &[u16],
    width: usize,
    height: usize,
    row: usize,
) -> [&[u16]; 3] {
    [-1, 0, 1].map(|by| row_of(magnitudes, width, moved(row, by, height)))
}

/// Neighbours by column and row, 0 to 2, clockwise on the screen from the right; the first again at the end.
const AROUND: [(usize, usize); 9] = [
    (2, 1),
    (2, 2),
    (1, 2),
    (0, 2),
    (0, 1),
    (0, 0),
    (1, 0),
    (2, 0),
    (2, 1),
];

/// Whether the magnitude at a column of the middle row is not less than beside it across the edge, linear between the
/// pixels there.
pub(super) fn is_ridge(rows: [&[u16]; 3], column: usize, outwards: u8) -> bool {
    let last = rows[1].len() - 1;
    let columns = [column.saturating_sub(1), column, (column + 1).min(last)];
    let at = |(right, down): (usize, usize)| u32::from(rows[down][columns[right]]);
    // The two neighbours that the direction passes between, and the weight of the second in 32nds. The opposite
    // direction has the same two sides, so the middle of an edge does not depend on the side of the implant.
    let (first, weight) = (usize::from(outwards / 32) % 4, u32::from(outwards % 32));
    let beside = |first: usize| at(AROUND[first]) * (32 - weight) + at(AROUND[first + 1]) * weight;
    let here = 32 * at((1, 1));
    // Strictly greater on one side, so that one of two equal pixels is the middle.
    here >= beside(first) && here > beside(first + 4)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_are_right_to_half_a_unit() {
        for k in 0..2000 {
            let turn = f64::from(k) / 2000.0;
            let (sin, cos) = (core::f64::consts::TAU * turn).sin_cos();
            let got = angle_of((30_000.0 * cos) as i32, (30_000.0 * sin) as i32);
            let off = (f64::from(got) - 256.0 * turn + 128.0).rem_euclid(256.0) - 128.0;
            assert!(off.abs() < 0.7, "{turn} {got}");
        }
        assert_eq!(angle_of(0, 0), 0);
    }

    /// Oracle: magnitudes around a pixel by the angle, linear between those at each eighth of a turn. Eighths of a turn, with those around,
    /// change nothing either.
    #[test]
    fn a_ridge_is_no_lower_than_what_lies_across_it() {
        let mut random = crate::synthetic::Random(7);
        for _ in 0..400 {
            let around: [u16; 8] = core::array::from_fn(|_| (9.0 * random.uniform()) as u16);
            let here = (9.0 * random.uniform()) as u16;
            let outwards = (256.0 * random.uniform()) as u8;
            let at = |angle: usize| {
                let (low, part) = (angle / 32, (angle % 32) as f64 / 32.0);
                f64::from(around[low % 8]) * (1.0 - part) + f64::from(around[(low + 1) % 8]) * part
            };
            // Of the two sides that in the lower half of the screen, or to the left, comes first.
            let first = usize::from(outwards) % 128;
            let expected = f64::from(here) >= at(first) && f64::from(here) > at(first + 128);
            let [e, se, s, sw, w, nw, n, ne] = around;
            let rows = [[nw, n, ne], [w, here, e], [sw, s, se]];
            let rows = rows.each_ref().map(|row| row.as_slice());
            assert_eq!(
                is_ridge(rows, 1, outwards),
                expected,
                "{around:?} {here} {outwards}"
            );
        }
    }

    /// Oracle: every second pixel up to four away, by the squares of a binomial, at the border the last pixel again.
    #[test]
    fn a_coarse_row_weighs_five_by_five_pixels_of_the_fine_one() {
        let (width, height) = (13, 11);
        let fine: std::vec::Vec<u16> = (0..width * height)
            .map(|k| (k * k * 977 % 65_521) as u16)
            .collect();
        let mut out = std::vec![0; width * height];
        for row in 0..height {
            coarse_row(&fine, width, height, row, &mut out);
        }
        let binomial = [1, 4, 6, 4, 1];
        let away =
            |at: usize, k: usize, count: usize| (at + 2 * k).saturating_sub(4).min(count - 1);
        for (at, &found) in out.iter().enumerate() {
            let (column, row) = (at % width, at / width);
            let mut sum = 0u32;
            for (down, by_row) in binomial.into_iter().enumerate() {
                for (right, by_column) in binomial.into_iter().enumerate() {
                    let pixel = away(row, down, height) * width + away(column, right, width);
                    sum += by_row * by_column * u32::from(fine[pixel]);
                }
            }
            assert_eq!(u32::from(found), sum / 256, "{column} {row}");
        }
    }
}
