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

use core::ops::Range;

use super::error::LibraryError;
use super::runs::{Band, are_runs_with};
use super::sketch::{BLOCK, BlockRow, STRIDE, Sketch, blocks};
use super::wire::{Reader, SHORT_RECORD_BYTES, read_short_record};
use super::{LibraryInfo, ViewRecord};

/// The parts of a body in the compact layout.
#[derive(Clone, Copy, Debug)]
pub(super) struct Compact<'a> {
    records: &'a [u8],
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

    /// How many bytes of a sketch are compared: with wide instructions its padding takes no time, without them as much as
    /// its blocks.
    pub(crate) fn compared(&self) -> usize {
        if cfg!(target_os = "none") {
            self.places.len() / 2
        } else {
            self.stride()
        }
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

    /// The sketch of a view, to be compared with its runs; `counts` is empty before and after.
    fn beside<'c>(
        &self,
        view: usize,
        info: &LibraryInfo,
        counts: &'c mut BlockRow,
    ) -> Comparison<'a, 'c> {
        let places = self.places.as_chunks().0;
        let (sketch, padding) = self
            .of(view)
            .split_at_checked(places.len())
            .unwrap_or_default();
        Comparison {
            common: self.common,
            sketch: Sketch::of(places, sketch),
            across: (info.canonical.size() / BLOCK).max(1),
            row: 0,
            counts,
            is_same: padding.iter().all(|&padding| padding == 0),
        }
    }
}

/// The sketch of a view beside its runs, block row by block row.
struct Comparison<'a, 'c> {
    /// What is left of the common blocks.
    common: &'a [u8],
    sketch: Sketch<'a>,
    across: usize,
    /// The block row that runs are gathered for.
    row: usize,
    counts: &'c mut BlockRow,
    is_same: bool,
}

impl Comparison<'_, '_> {
    /// Adds a band; block rows above it are whole by then. Gives where the run ends that goes furthest.
    fn add(&mut self, band: Band<'_>) -> usize {
        let (mut rest, mut furthest) = (Some(band), 0);
        while let Some(band) = rest {
            let row = band.first_row / BLOCK;
            while self.row < row && self.is_same {
                self.compare();
            }
            let (own, below) = band.split_at_row((row + 1) * BLOCK);
            furthest = furthest.max(self.counts.add(&own));
            rest = below;
        }
        furthest
    }

    fn compare(&mut self) {
        let Some((common, rest)) = self.common.split_at_checked(self.across) else {
            self.is_same = false;
            return;
        };
        self.common = rest;
        self.is_same &= self.counts.is(common, &mut self.sketch);
        self.row += 1;
    }

    /// Whether all of it is the same.
    fn finish(&mut self) -> bool {
        while self.is_same && !self.common.is_empty() {
            self.compare();
        }
        self.is_same && self.sketch.is_over()
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
        let (mut end, mut counts) = (0, BlockRow::EMPTY);
        for view in 0..views {
            let next = self.end(view);
            let mut comparison = self.sketches.beside(view, info, &mut counts);
            let runs = self.runs.get(end..next);
            let size = info.canonical.size();
            let are_runs =
                runs.is_some_and(|runs| are_runs_with(runs, size, |band| comparison.add(band)));
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

    /// The record of a view, whose rotations the compact layout leaves to the grid; zeros beyond the last.
    pub(super) fn record(&self, view: usize, rotations: [f64; 2]) -> ViewRecord {
        let start = view.saturating_mul(SHORT_RECORD_BYTES);
        let bytes = self.records.get(start..).unwrap_or_default();
        read_short_record(&mut Reader::new(bytes), rotations)
    }
}
