//! Regions of a mask: the silhouette among the specks that a network or a threshold leaves.
//!
//! A region is what its borders enclose, its outer one and those of its holes. They are followed, and the words of
//! its own rectangle alone are looked at: a frame of a hundred thousand specks takes about as long as one of one region.

use core::ops::Range;

use crate::image::border::{Crack, Heading};
use crate::image::mask::{Mask, MaskError, MaskMut, WORD_BITS, next_bit};

/// Copies the largest region of `mask` (4-connected, holes as they are) to `out` and returns
/// the number of pixels left behind. `rest` is working memory of the same shape. An empty mask gives an empty `out`.
///
/// # Errors
/// [`MaskError::Sizes`] where the three differ in shape.
pub fn largest_region(
    mask: &Mask<'_>,
    rest: &mut MaskMut<'_>,
    out: &mut MaskMut<'_>,
) -> Result<u64, MaskError> {
    largest_counted(mask, rest, out, &mut |_| {})
}

/// [`largest_region`], which tells `look` how many words and sides of pixels it looks at.
fn largest_counted(
    mask: &Mask<'_>,
    rest: &mut MaskMut<'_>,
    out: &mut MaskMut<'_>,
    look: &mut impl FnMut(usize),
) -> Result<u64, MaskError> {
    let shape = (mask.width(), mask.height());
    if [&*rest, &*out].map(|memory| (memory.width(), memory.height())) != [shape; 2] {
        return Err(MaskError::Sizes);
    }
    rest.copy_from(mask);
    out.clear();
    let (mut best, mut most) = (None, 0);
    let mut from = (0, 0);
    while let Some(seed) = next_pixel(&rest.as_mask(), from, look) {
        let frame = enclose(&rest.as_mask(), seed, out, look);
        let area = frame.take(out, rest, look);
        if area > most {
            (best, most) = (Some(seed), area);
        }
        from = seed;
    }
    if let Some(seed) = best {
        enclose(mask, seed, out, look);
    }
    Ok(mask.area() - most)
}

/// The first set pixel in reading order, column and row, at or after `from`.
fn next_pixel(
    mask: &Mask<'_>,
    (column, row): (usize, usize),
    look: &mut impl FnMut(usize),
) -> Option<(usize, usize)> {
    let mut start = column;
    (row..mask.height()).find_map(|row| {
        let column = next_bit(mask.row(row), start, true);
        look((column - start) / WORD_BITS + 1);
        start = 0;
        (column < mask.width()).then_some((column, row))
    })
}

/// The words and rows that hold a region and the sides of its pixels.
struct Rectangle {
    words: Range<usize>,
    rows: Range<usize>,
}

impl Rectangle {
    fn at((column, row): (usize, usize)) -> Self {
        let word = column / WORD_BITS;
        Self {
            words: word..word + 1,
            rows: row..row + 1,
        }
    }

    /// Grows to hold a pixel.
    fn include(&mut self, column: usize, row: usize) {
        let word = column / WORD_BITS;
        self.words = self.words.start.min(word)..self.words.end.max(word + 1);
        self.rows = self.rows.start.min(row)..self.rows.end.max(row + 1);
    }

    /// Takes what `region` holds from `rest`, clears it, and returns its pixels.
    fn take(
        &self,
        region: &mut MaskMut<'_>,
        rest: &mut MaskMut<'_>,
        look: &mut impl FnMut(usize),
    ) -> u64 {
        let mut area = 0;
        for row in self.rows.clone() {
            let taken = region.row_mut(row).get_mut(self.words.clone());
            let left = rest.row_mut(row).get_mut(self.words.clone());
            let (taken, left) = (taken.unwrap_or_default(), left.unwrap_or_default());
            look(taken.len());
            for (taken, left) in taken.iter_mut().zip(left) {
                area += u64::from(taken.count_ones());
                *left &= !*taken;
                *taken = 0;
            }
        }
        area
    }
}

/// Draws the region of `mask` whose first pixel in reading order is `seed` into `out`, which is clear.
fn enclose(
    mask: &Mask<'_>,
    seed: (usize, usize),
    out: &mut MaskMut<'_>,
    look: &mut impl FnMut(usize),
) -> Rectangle {
    let mut rectangle = Rectangle::at(seed);
    let (column, row) = (seed.0 as i64, seed.1 as i64);
    let heading = Heading::Right;
    let outer = Crack {
        column,
        row,
        heading,
    };
    toggle_border(mask, outer, out, look, |column, row| {
        rectangle.include(column, row);
    });
    for row in rectangle.rows.clone() {
        let words = rectangle.words.clone();
        look(words.len());
        for run in mask.runs_within(row, words) {
            toggle_hole(mask, &run, row, out, look);
        }
    }
    for row in rectangle.rows.clone() {
        look(rectangle.words.len());
        out.fill_parity_within(row, rectangle.words.clone());
    }
    rectangle
}

/// Toggles the border of the hole to the right of a run of the region, where there is one that no run before it had.
///
/// A run is the region's where the side at its left is: that one is on the outer border, or on that of a hole that was
/// come across further up or further left.
fn toggle_hole(
    mask: &Mask<'_>,
    run: &Range<usize>,
    row: usize,
    out: &mut MaskMut<'_>,
    look: &mut impl FnMut(usize),
) {
    let toggled = |column| out.as_mask().get(column, row);
    if run.end < mask.width() && toggled(run.start) && !toggled(run.end) {
        let side = Crack {
            column: run.end as i64,
            row: row as i64,
            heading: Heading::Down,
        };
        toggle_border(mask, side, out, look, |_, _| {});
    }
}

/// Follows a border with the region on the right hand. Toggles the pixel to the right of each upright side: then the
/// parity along a row tells what is inside. `beside` is given that pixel, also where it is the frame's last and the
/// side is the frame's own.
fn toggle_border(
    mask: &Mask<'_>,
    start: Crack,
    out: &mut MaskMut<'_>,
    look: &mut impl FnMut(usize),
    mut beside: impl FnMut(usize, usize),
) {
    let last = mask.width().saturating_sub(1);
    let mut at = start;
    loop {
        look(1);
        if matches!(at.heading, Heading::Up | Heading::Down)
            && let Some((column, row)) = at.pixel_ahead(at.heading == Heading::Down)
        {
            out.toggle(column, row);
            beside(column.min(last), row);
        }
        at = at.step().turn(mask);
        if at == start {
            return;
        }
    }
}

#[cfg(test)]
mod tests;
