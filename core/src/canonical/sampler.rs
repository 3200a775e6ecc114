//! Reading a silhouette at the centres of canonical pixels, most of them a block at a time.

use core::ops::Range;

use super::CanonicalForm;
use crate::contour::Point;
use crate::mask::{Mask, WORD_BITS, Word};
use crate::math::ranking;

/// Binary places of a sampling position.
const PLACES: u32 = 16;

/// Side of the square blocks of canonical pixels of which most lie wholly inside or outside.
pub(super) const BLOCK: usize = 8;
/// And of the others many a quarter.
const QUARTER: usize = BLOCK / 2;

/// More than rounding moves a position with the steps to it, up to 39 in each direction, in 1/65 536 pixel.
const MARGIN: i32 = 64;

/// The affine map from canonical pixels to frame pixels, and its steps.
pub(super) struct Sampler {
    /// Positions outside this rectangle (columns, rows; in 1/65 536 pixel) see no set pixel.
    columns: Range<i32>,
    rows: Range<i32>,
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
        let reach = |pixels: Range<usize>| {
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

    /// [`BLOCK`] words of canonical pixels below each other, the first of which begins at `right` and `up` of the
    /// canonical centre.
    pub(super) fn words(&self, mask: &Mask<'_>, right: f64, up: f64) -> [Word; BLOCK] {
        let starts = core::array::from_fn(|row| self.start(right, up - row as f64));
        let mut words = [0; BLOCK];
        for column in (0..WORD_BITS).step_by(BLOCK) {
            let corner = self.along(&starts[0], column);
            let value = match self.reads(mask, &corner, BLOCK) {
                Reads::Nothing => Some(false),
                Reads::Pixels(columns, rows) => mask.value_of(columns, rows),
                Reads::Beyond => None,
            };
            match value {
                Some(false) => {}
                Some(true) => words.iter_mut().for_each(|word| *word |= 0xff << column),
                None => self.quarters(mask, &starts, column, &mut words),
            }
        }
        words
    }

    /// One block of them, a quarter at a time.
    fn quarters(
        &self,
        mask: &Mask<'_>,
        starts: &[Position; BLOCK],
        column: usize,
        words: &mut [Word; BLOCK],
    ) {
        let starts = starts.chunks_exact(QUARTER);
        for (starts, words) in starts.zip(words.chunks_exact_mut(QUARTER)) {
            self.quarter(mask, starts, column, words);
            self.quarter(mask, starts, column + QUARTER, words);
        }
    }

    fn quarter(&self, mask: &Mask<'_>, starts: &[Position], column: usize, words: &mut [Word]) {
        let window = match self.reads(mask, &self.along(&starts[0], column), QUARTER) {
            Reads::Nothing => return,
            Reads::Pixels(columns, rows) => Window::new(mask, &columns, &rows),
            Reads::Beyond => None,
        };
        if let Some(set) = window.as_ref().and_then(|window| window.value) {
            let four = if set { 0xf << column } else { 0 };
            words.iter_mut().for_each(|word| *word |= four);
            return;
        }
        for (word, start) in words.iter_mut().zip(starts) {
            let mut at = self.along(start, column);
            for column in column..column + QUARTER {
                let square = match &window {
                    Some(window) => window.square(&at),
                    None => at.square(mask),
                };
                *word |= Word::from(at.is_covered(square)) << column;
                at.step(self.step);
            }
        }
    }

    /// The position of a canonical pixel so many to the right of another.
    fn along(&self, from: &Position, right: usize) -> Position {
        let moved = |from: i32, step: i32| from.saturating_add(step.saturating_mul(right as i32));
        Position {
            column: moved(from.column, self.step[0]),
            row: moved(from.row, self.step[1]),
        }
    }

    /// What the positions of a square of canonical pixels read; `corner` is its first.
    fn reads(&self, mask: &Mask<'_>, corner: &Position, side: usize) -> Reads {
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
            return Reads::Nothing;
        }
        // A position reads the pixel after its own too.
        let pixels = |first: i32, last: i32, all: usize| {
            let first = usize::try_from(first >> PLACES).ok()?;
            let end = usize::try_from(last >> PLACES).ok()? + 2;
            (end <= all).then_some(first..end)
        };
        let columns = pixels(left, right, mask.width());
        let both = columns.zip(pixels(top, bottom, mask.height()));
        both.map_or(Reads::Beyond, |(columns, rows)| {
            Reads::Pixels(columns, rows)
        })
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

/// What some positions read of a frame.
enum Reads {
    /// No set pixel.
    Nothing,
    /// Of these columns and rows.
    Pixels(Range<usize>, Range<usize>),
    /// Beyond the frame too.
    Beyond,
}

/// Rows of a window at most: those that a quarter block reads where a canonical pixel is up to seven of the frame.
const ROWS: usize = 32;

/// A few frame pixels, a word a row.
struct Window {
    left: i32,
    top: i32,
    rows: [Word; ROWS],
    /// Of all its pixels, if it is one.
    value: Option<bool>,
}

impl Window {
    /// `None` for more pixels than it holds.
    fn new(mask: &Mask<'_>, columns: &Range<usize>, rows: &Range<usize>) -> Option<Self> {
        if columns.len() > WORD_BITS || rows.len() > ROWS {
            return None;
        }
        let within = Word::MAX >> (WORD_BITS - columns.len());
        let (mut any, mut all) = (0, Word::MAX);
        let mut window = [0; ROWS];
        for (bits, row) in window.iter_mut().zip(rows.clone()) {
            *bits = mask.bits_from(columns.start, row);
            (any, all) = (any | *bits, all & *bits);
        }
        Some(Self {
            left: columns.start as i32,
            top: rows.start as i32,
            rows: window,
            value: match (any & within, all & within) {
                (0, _) => Some(false),
                (_, all) if all == within => Some(true),
                _ => None,
            },
        })
    }

    /// See [`Mask::square`]; the position must be one of those that the window was made for.
    fn square(&self, at: &Position) -> u32 {
        let column = ((at.column >> PLACES) - self.left) as u32;
        let row = ((at.row >> PLACES) - self.top) as usize;
        let pair = |row: usize| self.rows[row % ROWS] >> (column % Word::BITS) & 3;
        pair(row) | pair(row + 1) << 2
    }
}

/// Whether everything between two positions lies on one side of a range.
fn beyond(a: i32, b: i32, range: &Range<i32>) -> bool {
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
    /// Where it would leave the numbers it is far beyond any frame, on whichever side.
    fn step(&mut self, [right, down]: [i32; 2]) {
        self.column = self.column.wrapping_add(right);
        self.row = self.row.wrapping_add(down);
    }

    /// The four pixels round it, as [`Mask::square`] gives them.
    fn square(&self, mask: &Mask<'_>) -> u32 {
        let (column, row) = (self.column >> PLACES, self.row >> PLACES);
        match (usize::try_from(column), usize::try_from(row)) {
            (Ok(column), Ok(row)) => mask.square(column, row),
            _ => pair(mask, column, row) | pair(mask, column, row + 1) << 2,
        }
    }

    /// Whether the silhouette, interpolated between these four, covers half.
    fn is_covered(&self, square: u32) -> bool {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mask::{MaskMut, words_needed};
    use proptest::prelude::*;

    const WIDTH: usize = 150;
    const HEIGHT: usize = 90;

    /// Oracle: each canonical pixel by itself, from four pixels that are read one by one.
    fn one_by_one(sampler: &Sampler, mask: &Mask<'_>, right: f64, up: f64) -> [Word; BLOCK] {
        core::array::from_fn(|row| {
            let start = sampler.start(right, up - row as f64);
            (0..WORD_BITS).fold(0, |word, bit| {
                let column = i64::from(start.column) + i64::from(sampler.step[0]) * bit as i64;
                let row = i64::from(start.row) + i64::from(sampler.step[1]) * bit as i64;
                let weight = |position: i64, next: i64| {
                    let share = (position >> 8) & 0xff;
                    if next == 1 { share } else { 256 - share }
                };
                let mut covered = 0;
                for (across, down) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                    let (x, y) = ((column >> PLACES) + across, (row >> PLACES) + down);
                    let set = x >= 0 && y >= 0 && mask.get(x as usize, y as usize);
                    covered += i64::from(set) * weight(column, across) * weight(row, down);
                }
                word | Word::from(covered >= 1 << 15) << bit
            })
        })
    }

    proptest! {
        #[test]
        fn blocks_hold_what_single_pixels_are(
            solid in (0..WIDTH, 0..WIDTH, 0..HEIGHT, 0..HEIGHT),
            speckles in proptest::collection::vec((0..WIDTH, 0..HEIGHT, any::<bool>()), 0..60),
            centroid in (-20.0..170.0f64, -20.0..110.0f64),
            angle in -4.0..4.0f64,
            log_scale in -3.0..1.5f64,
            aspect in 0.5..2.0f64,
            at in (-6..6i32, -12..12i32),
        ) {
            let mut words = std::vec![0; words_needed(WIDTH, HEIGHT)];
            let mut mask = MaskMut::new(&mut words, WIDTH, HEIGHT).expect("fits");
            let (left, right, top, bottom) = solid;
            for row in top.min(bottom)..top.max(bottom) {
                mask.fill_span(row, left as i64, right as i64);
            }
            for (column, row, set) in speckles {
                mask.set(column, row, set);
            }
            let mask = mask.into_mask();
            let form = CanonicalForm {
                area_px: 0,
                centroid: Point { column: centroid.0, row: centroid.1 },
                angle,
                scale: libm::exp(log_scale),
                aspect,
                elongation: 0.0,
                clipped: false,
            };
            let sampler = Sampler::new(&form, &mask);
            let (right, up) = (f64::from(32 * at.0) + 0.5, f64::from(8 * at.1) - 0.5);
            let naive = one_by_one(&sampler, &mask, right, up);
            prop_assert_eq!(sampler.words(&mask, right, up), naive);
        }
    }
}
