//! Views on their way into a library, packed: a record of 40 bytes without the rotations, a byte for each block of
//! 16 x 16 pixels (row by row: its set pixels, at most 255), and the runs.

use super::ViewRecord;
use super::runs::{runs_most, write_runs};
use super::sketch::{blocks, count_blocks};
use super::wire::{SHORT_RECORD_BYTES, Writer, write_short_record};
use crate::canonical::CanonicalSpec;
use crate::image::mask::Mask;

/// A packed view taken apart.
pub(super) struct Packed<'p> {
    pub(super) record: &'p [u8],
    pub(super) counts: &'p [u8],
    pub(super) runs: &'p [u8],
}

impl<'p> Packed<'p> {
    /// `None` where `bytes` are too few for a record and its blocks.
    pub(super) fn split(bytes: &'p [u8], spec: &CanonicalSpec) -> Option<Self> {
        let (record, rest) = bytes.split_at_checked(SHORT_RECORD_BYTES)?;
        let (counts, runs) = rest.split_at_checked(blocks(spec))?;
        Some(Self {
            record,
            counts,
            runs,
        })
    }
}

/// Bytes of a packed view at most.
pub(super) fn packed_most(spec: &CanonicalSpec) -> usize {
    SHORT_RECORD_BYTES + blocks(spec) + runs_most(spec.size())
}

/// Packs a view and gives the bytes that it takes; `None` where `out` is too short.
pub(super) fn pack(record: &ViewRecord, canonical: &Mask<'_>, out: &mut [u8]) -> Option<usize> {
    let across = canonical.width() / super::sketch::BLOCK;
    let (place, rest) = out.split_at_mut_checked(SHORT_RECORD_BYTES)?;
    let (counts, runs) = rest.split_at_mut_checked(across * across)?;
    write_short_record(&mut Writer::new(place), record);
    count_blocks(canonical, counts);
    let length = write_runs(canonical, runs);
    (length <= runs.len()).then_some(place.len() + counts.len() + length)
}
