//! Reading a silhouette at the centres of canonical pixels, most of them a block at a time.

use super::CanonicalForm;
use crate::contour::Point;
use crate::mask::{Mask, WORD_BITS, Word};
use crate::math::ranking;

/// Binary places of a sampling position.
const PLACES: u32 = 16;

/// Side of the square blocks of canonical pixels of which most lie wholly inside or outside.
pub(super) const BLOCK: usize = 8;
/// And of the others many a quarter.
pub(super) const QUARTER: usize = BLOCK / 2;

/// More than rounding moves a position with the steps to it, up to 39 in each direction, in 1/65 536 pixel.
const MARGIN: i32 = 64;

/// Bits of a word whose value is known, and those of them that are set.
#[derive(Clone, Copy)]
pub(super) struct Uniform {
    known: Word,
    set: Word,
}

impl Uniform {
    /// Bits from a column on have one value.
    fn learn(&mut self, column: usize, count: usize, set: bool) {
        let bits = ((1 << count) - 1) << column;
        self.known |= bits;
        self.set |= if set { bits } else { 0 };
    }
}

/// The affine map from canonical pixels to frame pixels, and its steps.
pub(super) struct Sampler {
    /// Positions outside this rectangle (columns, rows; in 1/65 536 pixel) see no set pixel.
    columns: core::ops::Range<i32>,
    rows: core::ops::Range<i32>,
    centre: Point,
    right: [f64; 2],
    up: [f64; 2],
    /// To the right and to the row below.
    step: [i32; 2],
    down: [i32; 2],
}

impl Sampler {
    pub(super) fn new(form: &CanonicalForm, mask: &Mask<'_>) -> Self {
        // A position reads the pixels at its floor and one further.
        let reach = |pixels: core::ops::Range<usize>| {
            let fixed = |pixel: usize| (pixel as i32) << PLACES;
            fixed(pixels.start) - (1 << PLACES)..fixed(pixels.end)
        };
        let (columns, rows) = mask.bounds();
        let (sin, cos) = ranking::sin_cos(form.angle);
        let (x, y) = (1.0 / form.scale, 1.0 / (form.scale * form.aspect));
        let (right, up) = ([cos * x, -sin * y], [-sin * x, -cos * y]);
        Self {
            columns: reach(columns),
            rows: reach(rows),
            centre: form.centroid,
            right,
            up,
            step: right.map(to_fixed),
            down: up.map(|along| to_fixed(-along)),
        }
    }

    /// Which bits of [`BLOCK`] words below each other, the first of which begins at `right` and
    /// `up` of the canonical centre, are known from the frame's pixels round each block or each
    /// quarter of it: of the upper half of the words, and of the lower.
    pub(super) fn uniform(&self, mask: &Mask<'_>, right: f64, up: f64) -> [Uniform; 2] {
        let mut halves = [Uniform { known: 0, set: 0 }; 2];
        let first = self.start(right, up);
        for column in (0..WORD_BITS).step_by(BLOCK) {
            let corner = self.beside(&first, column, 0);
            if let Some(set) = self.one_value(mask, &corner, BLOCK) {
                halves
                    .iter_mut()
                    .for_each(|half| half.learn(column, BLOCK, set));
                continue;
            }
            for (down, half) in halves.iter_mut().enumerate() {
                for across in 0..2 {
                    let corner = self.beside(&corner, across * QUARTER, down * QUARTER);
                    if let Some(set) = self.one_value(mask, &corner, QUARTER) {
                        half.learn(column + across * QUARTER, QUARTER, set);
                    }
                }
            }
        }
        halves
    }

    /// The position of a canonical pixel so many to the right and below another.
    fn beside(&self, from: &Position, right: usize, down: usize) -> Position {
        let moved = |from: i32, axis: usize| {
            let (right, down) = (right as i32, down as i32);
            from.saturating_add(self.step[axis].saturating_mul(right))
                .saturating_add(self.down[axis].saturating_mul(down))
        };
        Position {
            column: moved(from.column, 0),
            row: moved(from.row, 1),
        }
    }

    /// The value of all frame pixels that the positions of a square of canonical pixels read, if it
    /// is one; `corner` is its first.
    fn one_value(&self, mask: &Mask<'_>, corner: &Position, side: usize) -> Option<bool> {
        let extent = |first: i32, axis: usize| {
            let sides = [self.step[axis], self.down[axis]];
            let sides = sides.map(|step| step.saturating_mul(side as i32 - 1));
            let [a, b] = sides.map(|side| (side.min(0), side.max(0)));
            let least = first.saturating_add(a.0).saturating_add(b.0);
            let most = first.saturating_add(a.1).saturating_add(b.1);
            (least.saturating_sub(MARGIN), most.saturating_add(MARGIN))
        };
        let (left, right) = extent(corner.column, 0);
        let (top, bottom) = extent(corner.row, 1);
        if beyond(left, right, &self.columns) || beyond(top, bottom, &self.rows) {
            return Some(false);
        }
        let pixel = |position: i32| usize::try_from(position >> PLACES);
        let (left, top) = (pixel(left).ok()?, pixel(top).ok()?);
        // A position reads the pixel after its own too.
        let (right, bottom) = (pixel(right).ok()? + 1, pixel(bottom).ok()? + 1);
        if right >= mask.width() || bottom >= mask.height() {
            return None;
        }
        mask.value_of(left..right + 1, top..bottom + 1)
    }

    /// One word of canonical pixels, from `right` and `up` of the canonical centre.
    pub(super) fn word(&self, mask: &Mask<'_>, uniform: &Uniform, right: f64, up: f64) -> Word {
        let (mut word, mut open) = (uniform.set, !uniform.known);
        if open == 0 {
            return word;
        }
        let start = self.start(right, up);
        while open != 0 {
            let bit = open.trailing_zeros();
            open &= open - 1;
            let at = Position {
                column: start.column.saturating_add(self.step[0] * bit as i32),
                row: start.row.saturating_add(self.step[1] * bit as i32),
            };
            word |= Word::from(at.covered(mask)) << bit;
        }
        word
    }

    /// The frame position `right` and `up` canonical pixels from the canonical centre.
    fn start(&self, right: f64, up: f64) -> Position {
        let column = self.centre.column + right * self.right[0] + up * self.up[0];
        let row = self.centre.row + right * self.right[1] + up * self.up[1];
        Position {
            column: to_fixed(column - 0.5),
            row: to_fixed(row - 0.5),
        }
    }
}

/// Whether everything between two positions lies on one side of a range.
fn beyond(a: i32, b: i32, range: &core::ops::Range<i32>) -> bool {
    a.max(b) < range.start || a.min(b) >= range.end
}

/// Rounds to 1/65 536; saturates beyond +-32 768, where no frame has pixels.
fn to_fixed(value: f64) -> i32 {
    let value = value * f64::from(1u32 << PLACES);
    // Cut off towards zero.
    (value + 0.5f64.copysign(value)) as i32
}

/// A frame position relative to pixel centres, in 1/65 536 pixel.
struct Position {
    column: i32,
    row: i32,
}

impl Position {
    /// Whether the silhouette, interpolated between the four nearest centres, covers half.
    fn covered(&self, mask: &Mask<'_>) -> bool {
        let (column, row) = (self.column >> PLACES, self.row >> PLACES);
        let square = match (usize::try_from(column), usize::try_from(row)) {
            (Ok(column), Ok(row)) => mask.square(column, row),
            _ => pair(mask, column, row) | pair(mask, column, row + 1) << 2,
        };
        if square == 0 || square == 0b1111 {
            return square != 0;
        }
        let weight = |position: i32| (position as u32 >> 8) & 0xff;
        let (right, down) = (weight(self.column), weight(self.row));
        let pixel = |bit: u32| square >> bit & 1;
        let upper = pixel(0) * (256 - right) + pixel(1) * right;
        let lower = pixel(2) * (256 - right) + pixel(3) * right;
        upper * (256 - down) + lower * down >= 1 << 15
    }
}

/// Two neighbouring pixels of a row as bits; outside the mask none is set.
fn pair(mask: &Mask<'_>, column: i32, row: i32) -> u32 {
    let pixel = |column: i32| match (usize::try_from(column), usize::try_from(row)) {
        (Ok(column), Ok(row)) => u32::from(mask.get(column, row)),
        _ => 0,
    };
    pixel(column) | pixel(column + 1) << 1
}
