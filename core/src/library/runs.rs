//! A view as runs of set pixels: what the compact form of a library holds instead of bits.
//!
//! Bands of consecutive rows with the same number of runs. A band is its first row, its number of rows
//! and its runs a row (three u16, little-endian), and then, row by row and from left to right, two
//! bytes a run: the pixels between it and the run before (or the border), and its own pixels. A
//! gap of more than 255 pixels is written with runs of length 0 between its parts; a longer run with gaps of length 0.

use crate::image::mask::{Mask, MaskMut};

/// Side of the widest canonical frame, pixels.
pub(super) const WIDEST_FRAME: usize = 1024;
/// Bytes before a band's runs.
const BAND_BYTES: usize = 6;
/// Most pixels that one byte can count.
const LONGEST: usize = 255;

/// Gap and pixels of each run of a row.
struct Pieces<R> {
    runs: R,
    current: Option<core::ops::Range<usize>>,
    at: usize,
}

impl<R: Iterator<Item = core::ops::Range<usize>>> Iterator for Pieces<R> {
    type Item = [u8; 2];

    fn next(&mut self) -> Option<[u8; 2]> {
        let run = self.current.take().or_else(|| self.runs.next())?;
        let gap = run.start - self.at;
        if gap > LONGEST {
            self.at += LONGEST;
            self.current = Some(run);
            return Some([LONGEST as u8, 0]);
        }
        self.at = run.end.min(run.start + LONGEST);
        if self.at < run.end {
            self.current = Some(self.at..run.end);
        }
        Some([gap as u8, (self.at - run.start) as u8])
    }
}

fn pieces(mask: &Mask<'_>, row: usize) -> impl Iterator<Item = [u8; 2]> {
    Pieces {
        runs: mask.runs(row),
        current: None,
        at: 0,
    }
}

/// A band that may still grow.
struct Open {
    at: usize,
    first_row: usize,
    rows: usize,
    per_row: usize,
}

impl Open {
    fn goes_on(&self, row: usize, per_row: usize) -> bool {
        self.per_row == per_row && self.first_row + self.rows == row
    }

    fn close(&self, out: &mut [u8]) {
        let numbers = [self.first_row, self.rows, self.per_row];
        let bytes = numbers.map(|number| (number as u16).to_le_bytes());
        put(out, self.at, bytes.as_flattened());
    }
}

/// Copies bytes where `out` has room for them.
fn put(out: &mut [u8], at: usize, bytes: &[u8]) {
    if let Some(place) = out.get_mut(at..at + bytes.len()) {
        place.copy_from_slice(bytes);
    }
}

/// Most pieces of a row of `size` pixels: each run a pixel and a gap, or as long as one piece can be.
const fn row_most(size: usize) -> usize {
    size / 2 + 2 * size.div_ceil(LONGEST)
}

/// Most pieces of a row of any view. Bands with more are none: their length need not be a number that 32 bits hold.
const LONGEST_ROW: usize = row_most(WIDEST_FRAME);

/// Bytes of the runs of a view of `size` x `size` pixels at most: each row a band of its own, each of its pieces a pixel
/// and a gap, or as long as one can be.
pub(super) const fn runs_most(size: usize) -> usize {
    size * (BAND_BYTES + 2 * row_most(size))
}

/// Writes the runs of a mask and returns how many bytes they take; where `out` has fewer, its contents are of no use.
pub(super) fn write_runs(mask: &Mask<'_>, out: &mut [u8]) -> usize {
    let mut length = 0;
    let mut band: Option<Open> = None;
    for row in mask.rows() {
        let start = length;
        for piece in pieces(mask, row) {
            put(out, length, &piece);
            length += piece.len();
        }
        let per_row = (length - start) / 2;
        if let Some(band) = band.as_mut().filter(|band| band.goes_on(row, per_row)) {
            band.rows += 1;
            continue;
        }
        if let Some(band) = band.take() {
            band.close(out);
        }
        if per_row > 0 {
            length += BAND_BYTES;
            if let Some(pieces) = out.get_mut(start..length) {
                pieces.copy_within(..2 * per_row, BAND_BYTES);
            }
            band = Some(Open {
                at: start,
                first_row: row,
                rows: 1,
                per_row,
            });
        }
    }
    if let Some(band) = band {
        band.close(out);
    }
    length
}

/// Consecutive rows with the same number of runs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Band<'a> {
    pub(crate) first_row: usize,
    /// At least 1.
    pub(crate) per_row: usize,
    /// Gap and pixels of each run.
    pub(crate) pieces: &'a [[u8; 2]],
}

impl<'a> Band<'a> {
    /// The rows above and from a row on; all of them above where there are no others.
    pub(super) fn split_at_row(self, row: usize) -> (Self, Option<Self>) {
        let above = self
            .per_row
            .saturating_mul(row.saturating_sub(self.first_row));
        match self.pieces.split_at_checked(above) {
            Some((above, below)) if !below.is_empty() => {
                let below = Self {
                    first_row: row,
                    pieces: below,
                    ..self
                };
                (
                    Self {
                        pieces: above,
                        ..self
                    },
                    Some(below),
                )
            }
            _ => (self, None),
        }
    }

    /// Each row's runs.
    pub(crate) fn rows_of_pieces(self) -> impl Iterator<Item = &'a [[u8; 2]]> {
        self.pieces.chunks_exact(self.per_row.max(1))
    }

    /// Each row's number and runs.
    #[inline(always)]
    pub(crate) fn rows(self) -> Rows<'a> {
        Rows {
            bands: bands(&[]),
            row: self.first_row,
            per_row: self.per_row,
            rest: self.pieces,
        }
    }
}

/// The bands of a view, from top to bottom.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bands<'a> {
    rest: &'a [u8],
}

pub(crate) fn bands(bytes: &[u8]) -> Bands<'_> {
    Bands { rest: bytes }
}

impl<'a> Iterator for Bands<'a> {
    type Item = Band<'a>;

    #[inline(always)]
    fn next(&mut self) -> Option<Band<'a>> {
        let (&[a, b, c, d, e, f], rest) = self.rest.split_first_chunk::<BAND_BYTES>()?;
        let number = |two| usize::from(u16::from_le_bytes(two));
        let (first_row, rows, per_row) = (number([a, b]), number([c, d]), number([e, f]));
        if per_row == 0 || per_row > LONGEST_ROW {
            return None;
        }
        let (band, rest) = rest.split_at_checked(2 * rows * per_row)?;
        self.rest = rest;
        Some(Band {
            first_row,
            per_row,
            pieces: band.as_chunks().0,
        })
    }
}

/// Number and runs of each row of a view, from top to bottom.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rows<'a> {
    bands: Bands<'a>,
    row: usize,
    per_row: usize,
    /// Of the band that is at hand.
    rest: &'a [[u8; 2]],
}

pub(crate) fn rows(bytes: &[u8]) -> Rows<'_> {
    Rows {
        bands: bands(bytes),
        row: 0,
        per_row: 1,
        rest: &[],
    }
}

impl<'a> Iterator for Rows<'a> {
    type Item = (usize, &'a [[u8; 2]]);

    #[inline(always)]
    fn next(&mut self) -> Option<Self::Item> {
        loop {
            if let Some((own, rest)) = self.rest.split_at_checked(self.per_row) {
                let row = self.row;
                (self.row, self.rest) = (row + 1, rest);
                return Some((row, own));
            }
            let band = self.bands.next()?;
            (self.row, self.per_row, self.rest) = (band.first_row, band.per_row, band.pieces);
        }
    }
}

/// Starts and ends of a row's runs, columns.
#[inline(always)]
pub(crate) fn spans(pieces: &[[u8; 2]]) -> impl Iterator<Item = (usize, usize)> {
    let mut at = 0;
    pieces.iter().map(move |&[gap, pixels]| {
        let start = at + usize::from(gap);
        at = start + usize::from(pixels);
        (start, at)
    })
}

/// Whether bytes are the runs of a view of `size` x `size` pixels: rows that rise, no more runs than a row has room for,
/// which end within it, and nothing behind.
#[cfg(test)]
pub(super) fn are_runs(bytes: &[u8], size: usize) -> bool {
    are_runs_with(bytes, size, |band| {
        let ends = band.rows().flat_map(|(_, pieces)| spans(pieces));
        ends.map(|(_, end)| end).max().unwrap_or(0)
    })
}

/// The same; `visit` gets each band up to the first that is none, and gives where the run ends that goes furthest.
pub(super) fn are_runs_with<'a>(
    bytes: &'a [u8],
    size: usize,
    mut visit: impl FnMut(Band<'a>) -> usize,
) -> bool {
    let mut bands = bands(bytes);
    let mut next_row = 0;
    for band in &mut bands {
        let rows = band.pieces.len() / band.per_row;
        let inside = band.first_row >= next_row && band.first_row + rows <= size;
        let few = band.per_row <= row_most(size);
        if rows == 0 || !few || !inside || visit(band) > size {
            return false;
        }
        next_row = band.first_row + rows;
    }
    bands.rest.is_empty()
}

/// Sets the pixels of the runs in a mask.
pub(super) fn draw_runs(bytes: &[u8], mask: &mut MaskMut<'_>) {
    for (row, pieces) in rows(bytes) {
        for (start, end) in spans(pieces) {
            mask.fill_span(row, start as i64, end as i64);
        }
    }
}

/// Number of pixels set in both of two views.
pub(super) fn overlap(a: &[u8], b: &[u8]) -> u32 {
    let (mut of_a, mut of_b) = (rows(a), rows(b));
    let (mut ours, mut theirs) = (of_a.next(), of_b.next());
    let mut sum = 0;
    while let (Some((row, one)), Some((other_row, other))) = (ours, theirs) {
        if row == other_row {
            sum += common(one, other);
        }
        if row <= other_row {
            ours = of_a.next();
        }
        if other_row <= row {
            theirs = of_b.next();
        }
    }
    sum
}

/// Pairs of runs of two rows that are quicker compared than merged: a processor that guesses branches guesses those of
/// merging wrong.
const FEW_PAIRS: usize = if cfg!(target_os = "none") { 0 } else { 64 };

/// Pixels in runs of both rows.
#[inline(always)]
fn common(a: &[[u8; 2]], b: &[[u8; 2]]) -> u32 {
    if a.len() * b.len() > FEW_PAIRS {
        return merged(a, b);
    }
    let mut common = 0;
    for (start, end) in spans(a) {
        for (first, last) in spans(b) {
            common += end.min(last).saturating_sub(start.max(first));
        }
    }
    common as u32
}

/// The same, run by run: of the two at hand that which ends first gives way to its next.
#[cfg_attr(target_os = "none", inline(never))]
fn merged(a: &[[u8; 2]], b: &[[u8; 2]]) -> u32 {
    let (mut ours, mut theirs) = (spans(a), spans(b));
    let (Some(mut one), Some(mut other)) = (ours.next(), theirs.next()) else {
        return 0;
    };
    let mut sum = 0;
    loop {
        let ((start, end), (first, last)) = (one, other);
        sum += end.min(last).saturating_sub(start.max(first)) as u32;
        if end < last {
            let Some(next) = ours.next() else {
                return sum;
            };
            one = next;
        } else {
            let Some(next) = theirs.next() else {
                return sum;
            };
            other = next;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::mask::{Word, words_needed};
    use crate::library::fake::spots;
    use proptest::prelude::*;

    fn packed(words: &[Word], size: usize) -> std::vec::Vec<u8> {
        let mask = Mask::new(words, size, size).expect("valid");
        let mut bytes = std::vec![0; write_runs(&mask, &mut [])];
        assert_eq!(write_runs(&mask, &mut bytes), bytes.len());
        bytes
    }

    fn drawn_again(words: &[Word], size: usize) -> std::vec::Vec<Word> {
        let bytes = packed(words, size);
        assert!(bytes.len() <= runs_most(size));
        assert!(are_runs(&bytes, size));
        let mut drawn = std::vec![0; words.len()];
        draw_runs(
            &bytes,
            &mut MaskMut::new(&mut drawn, size, size).expect("fits"),
        );
        drawn
    }

    fn noise() -> impl Strategy<Value = std::vec::Vec<u8>> {
        proptest::collection::vec(prop_oneof![0u8..4, any::<u8>()], 0..80)
    }

    /// Runs of which some bytes were changed by a little: noise alone passes in one of some thousand cases.
    fn damaged() -> impl Strategy<Value = std::vec::Vec<u8>> {
        let change = (any::<proptest::sample::Index>(), 0u8..9);
        let changes = proptest::collection::vec(change, 0..3);
        (spots(32), changes).prop_map(|(words, changes)| {
            let mut bytes = packed(&words, 32);
            let length = bytes.len();
            for (place, by) in changes.into_iter().filter(|_| length > 0) {
                let byte = &mut bytes[place.index(length)];
                *byte = byte.wrapping_add(by).wrapping_sub(4);
            }
            bytes
        })
    }

    properties! {
        #[test]
        fn what_is_packed_is_drawn_again(words in spots(96)) {
            prop_assert_eq!(drawn_again(&words, 96), words);
        }

        #[test]
        fn long_runs_and_long_gaps_are_packed_too(words in spots(608)) {
            prop_assert_eq!(drawn_again(&words, 608), words);
        }

        #[test]
        fn noise_is_packed_too(words in proptest::collection::vec(any::<Word>(), 64 * 2)) {
            prop_assert_eq!(drawn_again(&words, 64), words);
        }

        #[test]
        fn pixels_of_both_are_counted(a in spots(96), b in spots(96)) {
            let naive: u32 = a.iter().zip(&b).map(|(a, b)| (a & b).count_ones()).sum();
            prop_assert_eq!(overlap(&packed(&a, 96), &packed(&b, 96)), naive);
        }

        #[test]
        fn pixels_of_both_are_counted_in_noise(
            a in proptest::collection::vec(any::<Word>(), 64 * 2),
            b in proptest::collection::vec(any::<Word>(), 64 * 2),
        ) {
            let naive: u32 = a.iter().zip(&b).map(|(a, b)| (a & b).count_ones()).sum();
            prop_assert_eq!(overlap(&packed(&a, 64), &packed(&b, 64)), naive);
        }

        /// Whatever the bytes, they are read without a panic, and what passes stays in its frame.
        #[test]
        fn any_bytes_are_refused_or_drawn(bytes in prop_oneof![noise(), damaged(), damaged()]) {
            let mut drawn = [0; words_needed(32, 32)];
            draw_runs(&bytes, &mut MaskMut::new(&mut drawn, 32, 32).expect("fits"));
            let pixels: usize = rows(&bytes)
                .flat_map(|(_, pieces)| spans(pieces))
                .map(|(start, end)| end - start)
                .sum();
            let set: u32 = drawn.iter().map(|word| word.count_ones()).sum();
            if are_runs(&bytes, 32) {
                prop_assert_eq!(set as usize, pixels);
            }
        }
    }

    /// A band of empty runs that end in their row, as many as a header can name, makes each comparison slow; and with as
    /// many rows its length is no number of 32 bits.
    #[test]
    fn bands_of_more_runs_than_a_row_has_room_for_are_refused() {
        for (per_row, possible) in [(1, true), (row_most(64), true), (row_most(64) + 1, false)] {
            let mut bytes = std::vec![0, 0, 1, 0];
            bytes.extend((per_row as u16).to_le_bytes());
            bytes.resize(BAND_BYTES + 2 * per_row, 0);
            assert_eq!(are_runs(&bytes, 64), possible, "{per_row}");
        }
        let longest = 2 * usize::from(u16::MAX) * LONGEST_ROW;
        assert!(u32::try_from(longest).is_ok());
        let per_row = LONGEST_ROW + 1;
        let mut bytes = std::vec![0, 0, 1, 0];
        bytes.extend((per_row as u16).to_le_bytes());
        bytes.resize(BAND_BYTES + 2 * per_row, 0);
        assert!(bands(&bytes).next().is_none());
    }

    #[test]
    fn rows_that_follow_one_another_with_as_many_runs_are_one_band() {
        let mut words = [0; words_needed(64, 64)];
        let mut mask = MaskMut::new(&mut words, 64, 64).expect("fits");
        for (row, from, to) in [
            (2, 5, 9),
            (3, 4, 12),
            // Two runs.
            (4, 1, 2),
            (4, 60, 64),
            // One again, and after a row without any.
            (5, 0, 64),
            (7, 8, 10),
        ] {
            mask.fill_span(row, from, to);
        }
        let bands: [&[u8]; 4] = [
            &[2, 0, 2, 0, 1, 0, 5, 4, 4, 8],
            &[4, 0, 1, 0, 2, 0, 1, 1, 58, 4],
            &[5, 0, 1, 0, 1, 0, 0, 64],
            &[7, 0, 1, 0, 1, 0, 8, 2],
        ];
        assert_eq!(packed(&words, 64), bands.concat());
    }
}
