//! The compact layout: runs instead of bits, and a sketch of each view.
//!
//! Body, in this order:
//!
//! - a record of 40 bytes a view, without the rotations: those are the grid's;
//! - where each view's runs end, bytes from the first view's (u32);
//! - the *common blocks*, a byte for each block of 16 x 16 pixels (row by row): its set pixels, at most
//!   255, where they are the same in all views, else 0;
//! - the numbers of the other blocks, rising (u16; how many there are stands in the header);
//! - the sketch of each view: a byte for each of those blocks, then zeros to a multiple of 32;
//! - the runs of each view (`runs.rs`).

use core::iter::Peekable;
use core::ops::Range;
use core::slice;

use super::LibraryInfo;
use super::error::LibraryError;
use super::runs::are_runs_with;
use super::sketch::{BLOCK, BlockRow, STRIDE, at_most_255, blocks};
use super::wire::{Reader, SHORT_RECORD_BYTES};

/// The parts of a body in the compact layout.
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
    pub(crate) common: &'a [u8],
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

    /// The sketch of a view, to be compared with its runs.
    fn beside(
        &self,
        view: usize,
        info: &LibraryInfo,
    ) -> Comparison<'a, impl Iterator<Item = usize> + use<'a>> {
        let across = (info.canonical.size() / BLOCK).max(1);
        Comparison {
            common: self.common.chunks_exact(across),
            places: self.places().peekable(),
            sketch: self.of(view).iter(),
            across,
            row: 0,
            block: 0,
            counts: BlockRow::EMPTY,
            is_same: true,
        }
    }
}

/// The sketch of a view beside its runs, block row by block row.
struct Comparison<'a, P: Iterator<Item = usize>> {
    common: slice::ChunksExact<'a, u8>,
    places: Peekable<P>,
    sketch: slice::Iter<'a, u8>,
    across: usize,
    /// The block row that runs are gathered for, and the first block of it.
    row: usize,
    block: usize,
    counts: BlockRow,
    is_same: bool,
}

impl<'a, P: Iterator<Item = usize>> Comparison<'a, P> {
    /// Adds a run; block rows above its own are whole by then.
    #[inline(always)]
    fn add(&mut self, row: usize, start: usize, end: usize) {
        while self.row < row / BLOCK && self.is_same {
            self.compare();
        }
        self.counts.add(start, end);
    }

    fn compare(&mut self) {
        let common = self.common.next();
        let Some(common) = common else {
            self.is_same = false;
            return;
        };
        let counts = self.counts.take(self.across);
        for ((block, &common), count) in (self.block..).zip(common).zip(counts) {
            let kept = match self.places.next_if_eq(&block) {
                Some(_) => self.sketch.next().copied().filter(|_| common == 0),
                None => Some(common),
            };
            self.is_same &= kept == Some(at_most_255(count));
        }
        self.row += 1;
        self.block += self.across;
    }

    /// Whether all of it is the same.
    fn finish(mut self) -> bool {
        while self.is_same && self.common.len() > 0 {
            self.compare();
        }
        self.is_same && self.places.next().is_none() && self.sketch.all(|&padding| padding == 0)
    }
}

impl<'a> Compact<'a> {
    /// The parts of a body; `None` where it is too short for them.
    pub(super) fn split(body: &'a [u8], info: &LibraryInfo, varying: usize) -> Option<Self> {
        let views = info.grid.views();
        let (records, rest) = body.split_at_checked(views.checked_mul(SHORT_RECORD_BYTES)?)?;
        let (ends, rest) = rest.split_at_checked(views.checked_mul(4)?)?;
        let (common, rest) = rest.split_at_checked(blocks(&info.canonical))?;
        let (places, rest) = rest.split_at_checked(2 * varying)?;
        let (all, runs) = rest.split_at_checked(views.checked_mul(stride(varying))?)?;
        Some(Self {
            records,
            ends,
            sketches: Sketches {
                common,
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
            let mut comparison = self.sketches.beside(view, info);
            let runs = self.runs.get(end..next);
            let are_runs = runs.is_some_and(|runs| {
                are_runs_with(runs, info.canonical.size(), |row, start, end| {
                    comparison.add(row, start, end);
                })
            });
            if !are_runs {
                return Err(LibraryError::Value("runs"));
            }
            if !comparison.finish() {
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

/// Rotations of a record, which the compact layout leaves to the grid.
pub(super) fn read_record(
    compact: &Compact<'_>,
    info: &LibraryInfo,
    view: usize,
) -> super::ViewRecord {
    let start = view.saturating_mul(SHORT_RECORD_BYTES);
    let bytes = compact.records.get(start..).unwrap_or_default();
    let rotations = match bytes.is_empty() {
        true => [0.0; 2],
        false => info.grid.rotations(view),
    };
    super::wire::read_short_record(&mut Reader::new(bytes), rotations)
}
