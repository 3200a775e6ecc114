//! Which canonical pixels have to be read: those at the silhouette's border.

use core::ops::{ControlFlow, Range};

use super::cells::for_each_mixed;
use crate::image::contour::Point;
use crate::image::mask::{Mask, MaskMut, WORD_BITS};

/// Half the side of a cell, frame pixels, and more than rounding moves a sampling position.
const HALF_CELL: f64 = 0.5 + 1.0 / 256.0;

/// Binary places of a canonical position.
const PLACES: u32 = 32;

/// The affine map from frame pixels to canonical pixels.
pub(super) struct Inverse {
    /// Frame position that has the canonical centre for its image.
    pub(super) centre: Point,
    /// Canonical columns and rows of a frame column.
    pub(super) column: [f64; 2],
    /// Canonical columns and rows of a frame row.
    pub(super) row: [f64; 2],
}

/// The canonical pixels in the boxes around cells' images, which are parallelograms.
struct Boxes {
    size: i32,
    column: [i64; 2],
    row: [i64; 2],
    /// The first pixel after the box of cell (0, 0), and the one after its last.
    first: [i64; 2],
    end: [i64; 2],
}

impl Inverse {
    /// Sets the pixels of an empty canonical frame that lie in a cell of the border, and the one to the right of them.
    /// Breaks where the border is so long, or cells are so large, that reading every pixel costs no more.
    pub(super) fn mark(&self, mask: &Mask<'_>, canonical: &mut MaskMut<'_>) -> ControlFlow<()> {
        let size = canonical.width();
        let Some(boxes) = self.boxes(size) else {
            return ControlFlow::Break(());
        };
        let mut left = size * size / 4;
        for_each_mixed(mask, |column, row| {
            if let Some((columns, rows)) = boxes.of(column, row) {
                canonical.fill_box(&columns, rows);
            }
            left -= 1;
            if left > 0 {
                ControlFlow::Continue(())
            } else {
                ControlFlow::Break(())
            }
        })
    }

    /// `None` where a box is too wide for a word.
    fn boxes(&self, size: usize) -> Option<Boxes> {
        let [along, across] = [self.column, self.row];
        let half = |axis: usize| HALF_CELL * (along[axis].abs() + across[axis].abs());
        let half = [half(0), half(1)];
        // Two more pixels at most: one for the border between pixels, one to the right.
        let widest = (WORD_BITS / 2 - 1) as f64;
        if !(half[0] <= widest && half[1] <= size as f64) {
            return None;
        }
        let middle = |axis: usize| {
            let column = (1.0 - self.centre.column) * along[axis];
            let row = (1.0 - self.centre.row) * across[axis];
            (size as f64 - 1.0) / 2.0 + column + row
        };
        let middle = [middle(0), middle(1)];
        Some(Boxes {
            size: size as i32,
            column: self.column.map(fixed),
            row: self.row.map(fixed),
            first: [
                fixed(middle[0] - half[0] + 1.0),
                fixed(middle[1] - half[1] + 1.0),
            ],
            end: [
                fixed(middle[0] + half[0] + 2.0),
                fixed(middle[1] + half[1] + 1.0),
            ],
        })
    }
}

/// A canonical position or step as a whole number.
#[cfg_attr(target_os = "none", inline(never))]
fn fixed(canonical: f64) -> i64 {
    (canonical * (1u64 << PLACES) as f64) as i64
}

impl Boxes {
    /// Columns, one more to the right included, and rows; `None` where all are beyond the frame.
    #[inline(always)]
    fn of(&self, column: i32, row: i32) -> Option<(Range<usize>, Range<usize>)> {
        let (column, row) = (i64::from(column), i64::from(row));
        let reach = |axis: usize| {
            let moved = column * self.column[axis] + row * self.row[axis];
            let pixel = |at: i64| ((at + moved) >> PLACES) as i32;
            [pixel(self.first[axis]), pixel(self.end[axis])]
        };
        let ([left, right], [top, bottom]) = (reach(0), reach(1));
        let (left, top) = (left.max(0), top.max(0));
        let (right, bottom) = (right.min(self.size), bottom.min(self.size));
        let pixels = |from: i32, to: i32| from as usize..to as usize;
        (left < right && top < bottom).then_some((pixels(left, right), pixels(top, bottom)))
    }
}
