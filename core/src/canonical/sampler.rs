//! Reading a silhouette at the centres of canonical pixels.

use super::cells::ones;
use super::form::CanonicalForm;
use super::marks::Inverse;
use crate::image::contour::Point;
use crate::image::mask::{Mask, MaskMut, WORD_BITS, Word};
use crate::math::ranking;

/// Binary places of a position.
const PLACES: u32 = 16;

/// Binary places of what a position is reckoned from: products of a canonical frame's pixels lose none of a position's.
const FINE_PLACES: u32 = 34;

/// The affine map from canonical pixels to frame pixels.
pub(super) struct Sampler {
    /// Column and row of the canonical centre relative to pixel centres, of [`FINE_PLACES`].
    centre: [i64; 2],
    /// Columns and rows of half a canonical pixel to the right, and of half a one up, of [`FINE_PLACES`].
    right: [i64; 2],
    up: [i64; 2],
    /// Columns and rows of a canonical pixel to the right, of [`PLACES`].
    step: [i64; 2],
    inverse: Inverse,
}

impl Sampler {
    pub(super) fn new(form: &CanonicalForm) -> Self {
        let (sin, cos) = ranking::sin_cos(form.angle);
        let (x, y) = (1.0 / form.scale, 1.0 / (form.scale * form.aspect));
        let (right, up) = ([cos * x, -sin * y], [-sin * x, -cos * y]);
        let fine = |value: f64| to_fixed(value, FINE_PLACES);
        let Point { column, row } = form.centroid;
        Self {
            centre: [column - 0.5, row - 0.5].map(fine),
            right: right.map(|along| fine(0.5 * along)),
            up: up.map(|along| fine(0.5 * along)),
            step: right.map(|along| to_fixed(along, PLACES)),
            inverse: Inverse {
                centre: form.centroid,
                column: [cos, sin].map(|along| along * form.scale),
                row: [-sin, cos].map(|along| along * form.scale * form.aspect),
            },
        }
    }

    /// Draws the canonical silhouette into an empty mask. From one pixel of a row to the next the silhouette changes only
    /// where its border lies: the pixels there are read, and each holds for those up to the next that is.
    pub(super) fn draw(&self, mask: &Mask<'_>, canonical: &mut MaskMut<'_>) {
        let size = canonical.width();
        if self.inverse.mark(mask, canonical).is_break() {
            (0..size).for_each(|row| canonical.fill_span(row, 0, size as i64));
        }
        for row in 0..size {
            let start = self.left_of(size, row);
            self.read(mask, canonical.row_mut(row), start);
        }
    }

    /// Where the first pixel of a row lies, of [`FINE_PLACES`].
    fn left_of(&self, size: usize, row: usize) -> [i64; 2] {
        // Halves of pixels from the canonical centre, to the right and up.
        let (right, up) = (1 - size as i64, size as i64 - 1 - 2 * row as i64);
        core::array::from_fn(|axis| {
            self.centre[axis] + right * self.right[axis] + up * self.up[axis]
        })
    }

    /// Replaces the marks of a row by its pixels, the first of which is read in any case and lies at `start`.
    fn read(&self, mask: &Mask<'_>, words: &mut [Word], start: [i64; 2]) {
        let mut value = 0;
        for (index, word) in words.iter_mut().enumerate() {
            let marks = *word | Word::from(index == 0);
            *word = value;
            if marks == 0 {
                continue;
            }
            let start = self.word(start, index);
            let mut pixels = value;
            for bit in ones(u64::from(marks)) {
                let covered = start.moved(self.step, bit).is_covered(mask);
                value = if covered { Word::MAX } else { 0 };
                let after = Word::MAX << bit;
                pixels = pixels & !after | value & after;
            }
            *word = pixels;
        }
    }

    /// Where the first pixel of a word lies.
    fn word(&self, start: [i64; 2], index: usize) -> Position {
        let halves = 2 * (index * WORD_BITS) as i64;
        let at = |axis: usize| round(start[axis] + halves * self.right[axis]);
        Position {
            column: at(0),
            row: at(1),
        }
    }
}

/// From [`FINE_PLACES`] to [`PLACES`].
fn round(fine: i64) -> i64 {
    const CUT: u32 = FINE_PLACES - PLACES;
    (fine + (1 << (CUT - 1))) >> CUT
}

/// Rounds to so many binary places; saturates far beyond any frame.
fn to_fixed(value: f64, places: u32) -> i64 {
    let value = value * (1u64 << places) as f64;
    // Cut off towards zero.
    let fixed = (value + 0.5f64.copysign(value)) as i64;
    fixed.clamp(-FARTHEST, FARTHEST)
}

/// Beyond any frame in either number of places, and as many steps of that length as a canonical frame is wide and high are still a number.
const FARTHEST: i64 = 1 << 51;

/// A frame position relative to pixel centres, in 1/65 536 pixel.
struct Position {
    column: i64,
    row: i64,
}

impl Position {
    #[inline(always)]
    fn moved(&self, [right, down]: [i64; 2], times: u32) -> Self {
        Self {
            column: self.column + right * i64::from(times),
            row: self.row + down * i64::from(times),
        }
    }

    /// The four pixels around it, as [`Mask::square`] gives them.
    #[inline(always)]
    fn square(&self, mask: &Mask<'_>) -> u32 {
        let (column, row) = (self.column >> PLACES, self.row >> PLACES);
        if (column | row) >= 0 {
            return mask.square(column as usize, row as usize);
        }
        pair(mask, column, row) | pair(mask, column, row + 1) << 2
    }

    /// Whether the silhouette, interpolated between the four pixels around it, covers half.
    #[inline(always)]
    fn is_covered(&self, mask: &Mask<'_>) -> bool {
        let square = self.square(mask);
        if square == 0 || square == 0b1111 {
            return square != 0;
        }
        let weight = |position: i64| (position as u32 >> 8) & 0xff;
        let (right, down) = (weight(self.column), weight(self.row));
        let pixel = |bit: u32| square >> bit & 1;
        let upper = pixel(0) * (256 - right) + pixel(1) * right;
        let lower = pixel(2) * (256 - right) + pixel(3) * right;
        upper * (256 - down) + lower * down >= 1 << 15
    }
}

/// Two neighbouring pixels of a row as bits; outside the mask none is set.
#[cold]
fn pair(mask: &Mask<'_>, column: i64, row: i64) -> u32 {
    let pixel = |column: i64| match (usize::try_from(column), usize::try_from(row)) {
        (Ok(column), Ok(row)) => u32::from(mask.get(column, row)),
        _ => 0,
    };
    pixel(column) | pixel(column + 1) << 1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::mask::words_needed;
    use proptest::prelude::*;

    const WIDTH: usize = 150;
    const HEIGHT: usize = 90;
    const SIDE: usize = 128;

    /// Oracle: a canonical pixel by itself, from four pixels that are read one by one.
    fn is_set(sampler: &Sampler, mask: &Mask<'_>, canonical: (usize, usize)) -> bool {
        let (word, bit) = (canonical.0 / WORD_BITS, canonical.0 % WORD_BITS);
        let start = sampler.word(sampler.left_of(SIDE, canonical.1), word);
        let column = start.column + sampler.step[0] * bit as i64;
        let row = start.row + sampler.step[1] * bit as i64;
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
        covered >= 1 << 15
    }

    fn check(mask: &Mask<'_>, form: &CanonicalForm) -> Result<(), TestCaseError> {
        let sampler = Sampler::new(form);
        let mut words = std::vec![0; words_needed(SIDE, SIDE)];
        let mut drawn = MaskMut::new(&mut words, SIDE, SIDE).expect("fits");
        sampler.draw(mask, &mut drawn);
        for (row, column) in (0..SIDE).flat_map(|row| (0..SIDE).map(move |column| (row, column))) {
            let naive = is_set(&sampler, mask, (column, row));
            prop_assert_eq!(
                drawn.as_mask().get(column, row),
                naive,
                "{}, {}",
                column,
                row
            );
        }
        Ok(())
    }

    properties! {
        #[test]
        fn a_silhouette_holds_what_its_pixels_are_one_by_one(
            solid in (0..WIDTH, 0..WIDTH, 0..HEIGHT, 0..HEIGHT),
            speckles in proptest::collection::vec((0..WIDTH, 0..HEIGHT, any::<bool>()), 0..60),
            chequered in proptest::bool::weighted(0.1),
            centroid in (-20.0..170.0f64, -20.0..110.0f64),
            angle in -4.0..4.0f64,
            log_scale in -3.0..1.5f64,
            aspect in 0.5..2.0f64,
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
            // So many cells that every pixel is read.
            for at in (0..WIDTH * HEIGHT).filter(|_| chequered) {
                mask.set(at % WIDTH, at / WIDTH, (at % WIDTH + at / WIDTH).is_multiple_of(2));
            }
            let form = CanonicalForm {
                area_px: 0,
                centroid: Point { column: centroid.0, row: centroid.1 },
                angle,
                scale: libm::exp(log_scale),
                aspect,
                elongation: 0.0,
                clipped: false,
            };
            check(&mask.into_mask(), &form)?;
        }
    }
}
