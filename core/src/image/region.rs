//! Regions of a mask: the silhouette among the specks that a network or a threshold leaves.

use crate::image::border::first_pixel;
use crate::image::mask::{Mask, MaskMut, Word};

/// Copies the largest region of `mask` (4-connected, holes as they are) to `out` and returns
/// the number of pixels left behind. `rest` and `current` are working memory of the same shape.
///
/// Never fails: an empty mask gives an empty `out`, and working memory of another shape cuts
/// what is copied to what both hold.
pub fn largest_region(
    mask: &Mask<'_>,
    rest: &mut MaskMut<'_>,
    current: &mut MaskMut<'_>,
    out: &mut MaskMut<'_>,
) -> u64 {
    copy(mask, rest);
    out.clear();
    let mut best = 0;
    while let Some((column, row)) = first_pixel(&rest.as_mask()) {
        current.clear();
        current.set(column, row, true);
        flood(&rest.as_mask(), current);
        let area = current.as_mask().area();
        if area > best {
            best = area;
            copy(&current.as_mask(), out);
        }
        for row in row..rest.height() {
            let region = current.as_mask();
            for (left, taken) in rest.row_mut(row).iter_mut().zip(region.row(row)) {
                *left &= !taken;
            }
        }
        // The seed goes even if `current` was too small to hold it: the loop must end.
        rest.set(column, row, false);
    }
    mask.area() - best
}

fn copy(from: &Mask<'_>, to: &mut MaskMut<'_>) {
    to.clear();
    for row in 0..to.height() {
        for (to, from) in to.row_mut(row).iter_mut().zip(from.row(row)) {
            *to = *from;
        }
    }
}

/// Grows `seeds` within `mask`, row by row downwards and upwards, until nothing changes.
fn flood(mask: &Mask<'_>, seeds: &mut MaskMut<'_>) {
    let height = mask.height().min(seeds.height());
    loop {
        let mut grown = false;
        for row in 0..height {
            grown |= grow_row(mask, seeds, row, row.checked_sub(1));
        }
        for row in (0..height).rev() {
            grown |= grow_row(mask, seeds, row, Some(row + 1));
        }
        if !grown {
            return;
        }
    }
}

/// Fills the runs of one row that hold a seed or touch one in the row `from`.
fn grow_row(mask: &Mask<'_>, seeds: &mut MaskMut<'_>, row: usize, from: Option<usize>) -> bool {
    let mut grown = false;
    for run in mask.runs(row) {
        let seen = seeds.as_mask();
        let own = count(seen.row(row), &run);
        let touched = from.map_or(0, |from| count(seen.row(from), &run));
        if own < run.len() && own + touched > 0 {
            seeds.fill_span(row, run.start as i64, run.end as i64);
            grown = true;
        }
    }
    grown
}

/// Number of bits set among the columns of a run.
fn count(row: &[Word], run: &core::ops::Range<usize>) -> usize {
    use crate::image::mask::WORD_BITS;
    let words = row.iter().enumerate().skip(run.start / WORD_BITS);
    words
        .take_while(|(index, _)| index * WORD_BITS < run.end)
        .map(|(index, word)| {
            let first = run.start.saturating_sub(index * WORD_BITS);
            let beyond = (index + 1) * WORD_BITS;
            let last = beyond.saturating_sub(run.end.min(beyond));
            (word >> first << first << last).count_ones() as usize
        })
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::mask::words_needed;

    const W: usize = 70;
    const H: usize = 12;

    fn mask_of(rows: &[&str], words: &mut [u32]) {
        let mut mask = MaskMut::new(words, W, H).expect("fits");
        for (r, row) in rows.iter().enumerate() {
            for (c, pixel) in row.bytes().enumerate() {
                mask.set(c, r, pixel == b'#');
            }
        }
    }

    #[test]
    fn the_largest_region_stays_and_specks_go() {
        let mut words = [0; words_needed(W, H)];
        // A spiral (needs several sweeps), a speck touching by a corner, a bar across words.
        mask_of(
            &[
                "#######.............................####",
                "#.....#",
                "#.###.#",
                "#.#.#.#",
                "#.#...#",
                "#.#####",
                "#......#",
                "#######.",
            ],
            &mut words,
        );
        let mask = Mask::new(&words, W, H).expect("valid");
        let (mut a, mut b, mut c) = ([0; 36], [0; 36], [0; 36]);
        let mut rest = MaskMut::new(&mut a, W, H).expect("fits");
        let mut current = MaskMut::new(&mut b, W, H).expect("fits");
        let mut out = MaskMut::new(&mut c, W, H).expect("fits");
        let dropped = largest_region(&mask, &mut rest, &mut current, &mut out);
        assert_eq!(dropped, 4 + 1);
        assert_eq!(out.as_mask().area(), mask.area() - dropped);
        assert!(out.as_mask().get(4, 3) && !out.as_mask().get(7, 6));
    }

    #[test]
    fn nothing_gives_nothing() {
        let words = [0; words_needed(W, H)];
        let mask = Mask::new(&words, W, H).expect("valid");
        let (mut a, mut b, mut c) = ([0; 36], [0; 36], [0; 36]);
        let mut rest = MaskMut::new(&mut a, W, H).expect("fits");
        let mut current = MaskMut::new(&mut b, W, H).expect("fits");
        let mut out = MaskMut::new(&mut c, W, H).expect("fits");
        assert_eq!(largest_region(&mask, &mut rest, &mut current, &mut out), 0);
        assert_eq!(out.as_mask().area(), 0);
    }
}
