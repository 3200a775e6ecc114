//! The compact layout: runs instead of bits, and a sketch of each view.
//!
//! Body, in this order:
//!
//! - a record of 40 bytes a view, without the rotations: those are the grid's;
//! - where each view's runs end, bytes from the first view's (u32);
//! - the *ground*, a byte for each block of 16 x 16 pixels (row by row): its set pixels, at most
//!   255, where they are the same in all views, else 0;
//! - the numbers of the other blocks, rising (u16; how many there are stands in the header);
//! - the sketch of each view: a byte for each of those blocks, then zeros to a multiple of 32;
//! - the runs of each view (`runs.rs`).

use core::ops::Range;

use super::open::{Library, LibraryError, Views};
use super::runs::{are_runs, write_runs};
use super::sketch::{
    BLOCK, MOST_BLOCKS, STRIDE, at_most_255, block_row_of_bits, block_row_of_runs, blocks,
};
use super::wire::{
    Body, HEADER_BYTES, Reader, SHORT_RECORD_BYTES, VERSION, Writer, checksum, write_header,
    write_short_record,
};
use super::{BuildError, LibraryInfo};
use crate::mask::{Mask, Word};

/// Views in the compact layout.
#[derive(Clone, Copy, Debug)]
pub(super) struct Compact<'a> {
    pub(super) records: &'a [u8],
    ends: &'a [u8],
    sketches: Sketches<'a>,
    runs: &'a [u8],
}

/// The sketches of all views.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sketches<'a> {
    /// Set pixels of the blocks that are alike in all views; 0 in the others.
    pub(crate) ground: &'a [u8],
    places: &'a [u8],
    /// [`Self::stride`] bytes a view.
    pub(crate) all: &'a [u8],
}

/// Bytes of a sketch of `blocks` blocks.
pub(crate) const fn stride(blocks: usize) -> usize {
    blocks.next_multiple_of(STRIDE)
}

impl<'a> Sketches<'a> {
    /// Numbers of the blocks that a sketch has, rising.
    pub(crate) fn places(&self) -> impl ExactSizeIterator<Item = usize> + Clone + use<'a> {
        let two = self.places.as_chunks::<2>().0.iter();
        two.map(|&two| usize::from(u16::from_le_bytes(two)))
    }

    /// Bytes of one view's sketch.
    pub(crate) fn stride(&self) -> usize {
        stride(self.places.len() / 2)
    }

    /// The sketch of a view; empty beyond the last.
    pub(crate) fn of(&self, view: usize) -> &'a [u8] {
        self.of_row(&(view..view.saturating_add(1)))
    }

    /// The sketches of views that follow one another; nothing where some are beyond the last.
    pub(crate) fn of_row(&self, views: &Range<usize>) -> &'a [u8] {
        let [start, end] = [views.start, views.end].map(|view| view.saturating_mul(self.stride()));
        self.all.get(start..end).unwrap_or_default()
    }

    /// Whether they are those of a view with these runs.
    fn agree(&self, view: usize, runs: &[u8], info: &LibraryInfo) -> bool {
        let across = info.canonical.size() / BLOCK;
        let mut sketch = self.of(view).iter();
        let mut places = self.places().peekable();
        let blocks_agree = self
            .ground
            .chunks_exact(across)
            .enumerate()
            .all(|(row, ground)| {
                let counts = block_row_of_runs(runs, row);
                (row * across..)
                    .zip(ground)
                    .zip(counts)
                    .all(|((block, ground), count)| {
                        let kept = match places.next_if_eq(&block) {
                            Some(_) => sketch.next().copied().filter(|_| *ground == 0),
                            None => Some(*ground),
                        };
                        kept == Some(at_most_255(count))
                    })
            });
        blocks_agree && places.next().is_none() && sketch.all(|&padding| padding == 0)
    }
}

impl<'a> Compact<'a> {
    /// The parts of a body; `None` where it is too short for them.
    pub(super) fn split(body: &'a [u8], info: &LibraryInfo, moving: usize) -> Option<Self> {
        let views = info.grid.views();
        let (records, rest) = body.split_at_checked(views.checked_mul(SHORT_RECORD_BYTES)?)?;
        let (ends, rest) = rest.split_at_checked(views.checked_mul(4)?)?;
        let (ground, rest) = rest.split_at_checked(blocks(&info.canonical))?;
        let (places, rest) = rest.split_at_checked(2 * moving)?;
        let (all, runs) = rest.split_at_checked(views.checked_mul(stride(moving))?)?;
        Some(Self {
            records,
            ends,
            sketches: Sketches {
                ground,
                places,
                all,
            },
            runs,
        })
    }

    /// Whether all runs stay in their frames and all sketches are those of their runs.
    pub(super) fn check(&self, info: &LibraryInfo) -> Result<(), LibraryError> {
        let views = info.grid.views();
        let mut end = 0;
        for view in 0..views {
            let next = self.end(view);
            let runs = self.runs.get(end..next);
            let Some(runs) = runs.filter(|runs| are_runs(runs, info.canonical.size())) else {
                return Err(LibraryError::Value("runs"));
            };
            if !self.sketches.agree(view, runs, info) {
                return Err(LibraryError::Value("sketch"));
            }
            end = next;
        }
        match end == self.runs.len() {
            true => Ok(()),
            false => Err(LibraryError::Value("runs")),
        }
    }

    fn end(&self, view: usize) -> usize {
        let four = self.ends.as_chunks::<4>().0.get(view);
        four.map_or(0, |&four| u32::from_le_bytes(four) as usize)
    }

    /// The runs of a view; none beyond the last.
    #[inline]
    pub(super) fn runs(&self, view: usize) -> &'a [u8] {
        let start = view.checked_sub(1).map_or(0, |before| self.end(before));
        self.runs.get(start..self.end(view)).unwrap_or_default()
    }

    pub(super) fn sketches(&self) -> Sketches<'a> {
        self.sketches
    }
}

/// The blocks of all views of a plain library: where they are alike, and which are not.
struct Ground {
    counts: [u8; MOST_BLOCKS],
    moves: [bool; MOST_BLOCKS],
}

impl Ground {
    fn of(library: &Library<'_>) -> Self {
        let mut ground = Self {
            counts: [0; MOST_BLOCKS],
            moves: [false; MOST_BLOCKS],
        };
        for view in 0..library.views() {
            for (block, count) in block_counts(library, view).enumerate() {
                if view == 0 {
                    ground.counts[block] = count;
                }
                ground.moves[block] |= ground.counts[block] != count;
            }
        }
        ground
    }

    fn moving(&self) -> impl Iterator<Item = usize> + '_ {
        let moves = self.moves.iter().enumerate();
        moves.filter(|(_, moves)| **moves).map(|(block, _)| block)
    }
}

/// Set pixels, at most 255, of each block of a view of a plain library.
fn block_counts<'l>(library: &'l Library<'_>, view: usize) -> impl Iterator<Item = u8> + 'l {
    let size = library.info().canonical.size();
    let across = size / BLOCK;
    let bits = library.bits(view);
    (0..across).flat_map(move |row| {
        let counts = block_row_of_bits(bits, size, row);
        counts.into_iter().take(across).map(at_most_255)
    })
}

/// Writes a plain library in the compact layout and returns how many of the lent bytes that
/// took. As many bytes as the plain library has are always worth lending: where the compact
/// layout does not fit into them it is not smaller, and the plain one is to be kept.
///
/// `words` is working memory for one view ([`crate::canonical::CanonicalSpec::words_needed`]).
///
/// # Errors
/// [`BuildError::Memory`] where the lent bytes do not suffice, [`BuildError::Mask`] where `words` has the
/// wrong length, [`BuildError::Parameter`] where the library is compact already.
pub fn compact(
    library: &Library<'_>,
    words: &mut [Word],
    out: &mut [u8],
) -> Result<usize, BuildError> {
    if !matches!(library.views, Views::Plain { .. }) {
        return Err(BuildError::Parameter(LibraryError::Version(VERSION)));
    }
    let info = library.info();
    let ground = Ground::of(library);
    let moving = ground.moving().count();
    let views = library.views();
    let head = HEADER_BYTES
        + views * (SHORT_RECORD_BYTES + 4 + stride(moving))
        + blocks(&info.canonical)
        + 2 * moving;
    let given = out.len();
    let memory = move |needed| BuildError::Memory {
        what: "bytes for the compact form",
        needed,
        given,
    };
    let (front, runs) = out.split_at_mut_checked(head).ok_or(memory(head))?;
    let (header, body) = front.split_first_chunk_mut().ok_or(memory(head))?;
    let (records, rest) = body.split_at_mut(views * SHORT_RECORD_BYTES);
    let (ends, rest) = rest.split_at_mut(4 * views);
    write_records(library, records);
    write_sketches(library, &ground, moving, rest);
    let length = write_all_runs(library, words, ends, runs)?;
    let Some(runs) = runs.get(..length) else {
        return Err(memory(head + length));
    };
    let body = Body {
        version: VERSION,
        blocks: moving,
        bytes: (body.len() + length) as u64,
        crc: checksum([&*body, runs]),
    };
    write_header(header, info, &body);
    Ok(head + length)
}

fn write_records(library: &Library<'_>, records: &mut [u8]) {
    let out = &mut Writer::new(records);
    for view in 0..library.views() {
        write_short_record(out, &library.record(view));
    }
}

/// Ground, places and sketches.
fn write_sketches(library: &Library<'_>, ground: &Ground, moving: usize, out: &mut [u8]) {
    let all = blocks(&library.info().canonical);
    let (alike, rest) = out.split_at_mut(all);
    for ((to, &count), &moves) in alike.iter_mut().zip(&ground.counts).zip(&ground.moves) {
        *to = if moves { 0 } else { count };
    }
    let (places, sketches) = rest.split_at_mut(2 * moving);
    let places = &mut Writer::new(places);
    ground.moving().for_each(|block| places.u16(block));
    sketches.fill(0);
    for (view, sketch) in sketches.chunks_exact_mut(stride(moving).max(1)).enumerate() {
        let counts = block_counts(library, view).zip(&ground.moves);
        let kept = counts.filter(|(_, moves)| **moves);
        for (to, (count, _)) in sketch.iter_mut().zip(kept) {
            *to = count;
        }
    }
}

/// Ends and runs; returns how many bytes the runs take.
fn write_all_runs(
    library: &Library<'_>,
    words: &mut [Word],
    ends: &mut [u8],
    runs: &mut [u8],
) -> Result<usize, BuildError> {
    let size = library.info().canonical.size();
    let ends = &mut Writer::new(ends);
    let mut length = 0;
    for view in 0..library.views() {
        library.draw(view, words);
        let mask = Mask::new(words, size, size)?;
        length += write_runs(&mask, runs.get_mut(length..).unwrap_or_default());
        ends.u32(length);
    }
    Ok(length)
}

/// Rotations of a record, which the compact layout leaves to the grid.
pub(super) fn read_record(
    compact: &Compact<'_>,
    info: &LibraryInfo,
    view: usize,
) -> super::ViewRecord {
    let start = view.saturating_mul(SHORT_RECORD_BYTES);
    let bytes = compact.records.get(start..).unwrap_or_default();
    let (x, y) = info.grid.place(view);
    let rotations = match bytes.is_empty() {
        true => [0.0; 2],
        false => [info.grid.x.at(x as f64), info.grid.y.at(y as f64)],
    };
    super::wire::read_short_record(&mut Reader::new(bytes), rotations)
}
