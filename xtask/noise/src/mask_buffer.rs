//! Silhouettes with their own memory.

use anyhow::{Result, bail};
use fluoropose::image::mask::{Mask, MaskError, MaskMut, WORD_BITS, Word, words_needed};
use fluoropose::image::region::largest_region;

/// Specks are at most this part of the silhouette, percent.
const SPECK_SHARE: u64 = 10;

/// So many separate pieces are counted at most.
const MOST_PIECES: usize = 4;

/// A silhouette with its own memory.
#[derive(Clone, Debug)]
pub struct MaskBuffer {
    words: Vec<Word>,
    width: usize,
    height: usize,
}

impl MaskBuffer {
    /// An empty mask of `width` x `height` pixels.
    ///
    /// # Errors
    /// For a shape that no mask has.
    pub fn new(width: usize, height: usize) -> Result<Self> {
        let mut words = vec![0; words_needed(width, height)];
        MaskMut::new(&mut words, width, height)?;
        Ok(Self {
            words,
            width,
            height,
        })
    }

    /// The mask of an image, row by row: what is not 0 is set.
    ///
    /// # Errors
    /// For a shape that no mask has.
    pub fn of_pixels(pixels: &[u8], width: usize, height: usize) -> Result<Self> {
        let mut buffer = Self::new(width, height)?;
        let word = |pixels: &[u8]| {
            let bits = pixels.iter().enumerate();
            bits.fold(0, |word, (bit, &pixel)| {
                word | (Word::from(pixel != 0) << bit)
            })
        };
        let rows = pixels.chunks_exact(width);
        let words = rows.flat_map(|row| row.chunks(WORD_BITS).map(word));
        buffer
            .words
            .iter_mut()
            .zip(words)
            .for_each(|(own, word)| *own = word);
        Ok(buffer)
    }

    /// A copy of a mask.
    pub fn copy_of(mask: &Mask<'_>) -> Self {
        Self {
            words: mask.words().to_vec(),
            width: mask.width(),
            height: mask.height(),
        }
    }

    /// The mask of which each pixel is `rule` of the same pixels of two masks, bit by bit; `rule`
    /// must leave 0 where both are 0.
    ///
    /// # Errors
    /// Where the two differ in size.
    pub fn combined(&self, other: &Self, rule: impl Fn(Word, Word) -> Word) -> Result<Self> {
        if (self.width, self.height) != (other.width, other.height) {
            bail!(MaskError::Sizes);
        }
        let pairs = self.words.iter().zip(&other.words);
        Ok(Self {
            words: pairs.map(|(&a, &b)| rule(a, b)).collect(),
            ..*self
        })
    }

    /// Draws into the cleared mask.
    pub fn draw<T>(&mut self, draw: impl FnOnce(&mut MaskMut<'_>) -> T) -> T {
        let mut mask = MaskMut::new(&mut self.words, self.width, self.height)
            .expect("the shape was checked when the buffer was made");
        draw(&mut mask)
    }

    /// The same, but what was drawn before stays.
    pub fn draw_onto<T>(&mut self, draw: impl FnOnce(&mut MaskMut<'_>) -> T) -> T {
        let mut mask = MaskMut::onto(&mut self.words, self.width, self.height)
            .expect("the shape was checked when the buffer was made");
        draw(&mut mask)
    }

    /// The mask without specks: its largest region alone where all else is at most a tenth of
    /// it, as a network or a threshold leaves it; otherwise unchanged, because a silhouette in
    /// two halves is no matter of specks. Returns the number of pixels dropped.
    ///
    /// # Errors
    /// For a shape that no mask has.
    pub fn drop_specks(&mut self) -> Result<u64> {
        let blank = || Self::new(self.width, self.height);
        let (mut rest, mut largest) = (blank()?, blank()?);
        let dropped =
            rest.draw(|rest| largest.draw(|out| largest_region(&self.mask(), rest, out)))?;
        if dropped > SPECK_SHARE * (self.mask().area() - dropped) / 100 {
            return Ok(0);
        }
        *self = largest;
        Ok(dropped)
    }

    /// Pixels of its separate pieces, the largest first, until what is left would be specks; no more than [`MOST_PIECES`].
    ///
    /// # Errors
    /// For a shape that no mask has.
    pub fn pieces(&self) -> Result<Vec<u64>> {
        let blank = || Self::new(self.width, self.height);
        let (mut left, mut pieces) = (self.clone(), Vec::new());
        while pieces.len() < MOST_PIECES {
            let (mut rest, mut largest) = (blank()?, blank()?);
            let behind =
                rest.draw(|rest| largest.draw(|out| largest_region(&left.mask(), rest, out)))?;
            pieces.push(largest.mask().area());
            if behind <= SPECK_SHARE * pieces[0] / 100 {
                break;
            }
            left = left.combined(&largest, |all, taken| all & !taken)?;
        }
        Ok(pieces)
    }

    /// That it is in pieces, a sentence without its full stop; `None` where it is in one.
    ///
    /// # Errors
    /// For a shape that no mask has.
    pub fn in_pieces(&self) -> Result<Option<String>> {
        let areas: Vec<String> = self.pieces()?.iter().map(u64::to_string).collect();
        let number = match areas.len() {
            0 | 1 => return Ok(None),
            MOST_PIECES => format!("at least {MOST_PIECES}"),
            few => few.to_string(),
        };
        let (last, first) = areas.split_last().expect("two or more");
        Ok(Some(format!(
            "the mask has {number} separate pieces, of {} and {last} pixels, and an implant is one: leave out what is not its own, and mark what hides a part \
             of it as unknown",
            first.join(", ")
        )))
    }

    /// What has been drawn.
    pub fn mask(&self) -> Mask<'_> {
        Mask::new(&self.words, self.width, self.height)
            .expect("drawing keeps the bits beyond a row's end clear")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn squares(sides: &[usize]) -> MaskBuffer {
        let mut buffer = MaskBuffer::new(200, 100).unwrap();
        buffer.draw(|mask| {
            for (index, &side) in sides.iter().enumerate() {
                for pixel in 0..side * side {
                    mask.set(70 * index + pixel % side, 5 + pixel / side, true);
                }
            }
        });
        buffer
    }

    #[test]
    fn pixels_become_bits_one_for_one() {
        for width in [1, 31, 32, 33, 70] {
            let pixels: Vec<u8> = (0..width * 5).map(|k| ((k * 7) % 3) as u8 * 100).collect();
            let buffer = MaskBuffer::of_pixels(&pixels, width, 5).unwrap();
            for (k, &pixel) in pixels.iter().enumerate() {
                assert_eq!(buffer.mask().get(k % width, k / width), pixel != 0);
            }
        }
        assert!(MaskBuffer::of_pixels(&[], 0, 5).is_err());
    }

    #[test]
    fn specks_go_and_halves_stay() {
        let mut specked = squares(&[50, 3]);
        assert_eq!(specked.drop_specks().unwrap(), 9);
        assert_eq!(specked.mask().area(), 2500);
        let mut halves = squares(&[50, 40]);
        assert_eq!(halves.drop_specks().unwrap(), 0);
        assert_eq!(halves.mask().area(), 4100);
        let mut empty = squares(&[]);
        assert_eq!(empty.drop_specks().unwrap(), 0);
    }

    #[test]
    fn pieces_are_counted_until_specks_are_left() {
        for (sides, areas) in [
            (&[50, 3][..], &[2500][..]),
            (&[40, 50], &[2500, 1600]),
            (&[16, 50, 3], &[2500, 256]),
            (&[], &[0]),
        ] {
            assert_eq!(squares(sides).pieces().unwrap(), areas, "{sides:?}");
            let told = squares(sides).in_pieces().unwrap();
            assert_eq!(told.is_some(), areas.len() > 1, "{told:?}");
        }
        // A chessboard of single pixels.
        let board: Vec<u8> = (0..101 * 7).map(|at| (at % 2) as u8).collect();
        let board = MaskBuffer::of_pixels(&board, 101, 7).unwrap();
        assert_eq!(board.pieces().unwrap(), [1; MOST_PIECES]);
        let told = board.in_pieces().unwrap().unwrap();
        assert!(
            told.starts_with("the mask has at least 4 separate pieces, of 1, 1, 1 and 1 pixels")
        );
    }
}
