//! The file of a library from its views.

use heapless::Vec;

use super::compact::stride;
use super::error::BuildError;
use super::info::{LibraryInfo, ViewRecord};
use super::open::{library_bytes, view_bytes};
use super::pack::Packed;
use super::runs::draw_runs;
use super::sketch::{MOST_BLOCKS, blocks};
use super::wire::{
    Body, HEADER_BYTES, PLAIN_VERSION, RECORD_BYTES, Reader, SHORT_RECORD_BYTES, VERSION, Writer,
    read_short_record, write_header, write_record,
};
use crate::checksum::checksum;
use crate::image::mask::{MaskMut, Word};
use crate::memory::{TooLittleMemory, first};

/// The packed views of a library, checked: a file to be written.
#[derive(Clone, Debug)]
pub struct Assembly<'p> {
    info: LibraryInfo,
    packed: &'p [&'p [u8]],
    common: CommonBlocks,
    /// Bytes of the runs of all views.
    runs_bytes: usize,
}

impl<'p> Assembly<'p> {
    pub(super) fn new(info: &LibraryInfo, packed: &'p [&'p [u8]]) -> Result<Self, BuildError> {
        let (needed, given) = (info.grid.views(), packed.len());
        if needed != given {
            return Err(BuildError::Views { needed, given });
        }
        let mut runs_bytes = 0;
        for (view, bytes) in packed.iter().enumerate() {
            let parts = Packed::split(bytes, &info.canonical).ok_or(BuildError::Packed(view))?;
            runs_bytes += parts.runs.len();
        }
        let views = views(packed, info);
        Ok(Self {
            info: *info,
            packed,
            common: CommonBlocks::of(views.map(|view| view.counts)),
            runs_bytes,
        })
    }

    fn views(&self) -> impl Iterator<Item = Packed<'p>> {
        views(self.packed, &self.info)
    }

    /// Bytes of the file: in the compact layout, or in the plain one where that is not larger.
    #[must_use]
    pub fn bytes_needed(&self) -> usize {
        self.compact_bytes().min(self.plain_bytes())
    }

    pub(super) fn compact_bytes(&self) -> usize {
        self.head_bytes() + self.runs_bytes
    }

    fn plain_bytes(&self) -> usize {
        library_bytes(&self.info.canonical, &self.info.grid).unwrap_or(usize::MAX)
    }

    /// Bytes before the runs.
    fn head_bytes(&self) -> usize {
        let varying = self.common.varying.len();
        let view = SHORT_RECORD_BYTES + 4 + stride(varying);
        HEADER_BYTES + self.packed.len() * view + blocks(&self.info.canonical) + 2 * varying
    }

    /// Writes the file. `words` is working memory for one view ([`crate::canonical::CanonicalSpec::words_needed`]).
    ///
    /// # Errors
    /// [`BuildError::Memory`] unless `out` has [`Self::bytes_needed`] bytes, [`BuildError::Mask`] where `words`
    /// has the wrong length.
    pub fn write(&self, words: &mut [Word], out: &mut [u8]) -> Result<(), BuildError> {
        if self.compact_bytes() < self.plain_bytes() {
            return self.write_compact(out);
        }
        let size = self.info.canonical.size();
        let mut views = self.views();
        write_plain(&self.info, out, |view, bits| {
            let packed = views.next().ok_or(BuildError::Packed(view))?;
            draw_runs(packed.runs, &mut MaskMut::new(words, size, size)?);
            write_bits(words, bits);
            let rotations = self.info.grid.rotations(view);
            Ok(read_short_record(
                &mut Reader::new(packed.record),
                rotations,
            ))
        })
    }

    pub(super) fn write_compact(&self, out: &mut [u8]) -> Result<(), BuildError> {
        let (header, rest) = header_and_body(out, self.compact_bytes())?;
        let (body, runs) = rest.split_at_mut(self.head_bytes() - HEADER_BYTES);
        self.write_head(body);
        let runs_of_all = &mut Writer::new(runs);
        self.views().for_each(|view| runs_of_all.bytes(view.runs));
        let body = Body {
            version: VERSION,
            blocks: self.common.varying.len(),
            bytes: (body.len() + runs.len()) as u64,
            crc: checksum([&*body, runs]),
        };
        write_header(header, &self.info, &body);
        Ok(())
    }

    /// Writes records, ends of runs, common blocks, places and sketches.
    fn write_head(&self, body: &mut [u8]) {
        let sketches_bytes = self.packed.len() * stride(self.common.varying.len());
        let (numbers, sketches) = body.split_at_mut(body.len() - sketches_bytes);
        let out = &mut Writer::new(numbers);
        self.views().for_each(|view| out.bytes(view.record));
        let mut end = 0;
        for view in self.views() {
            end += view.runs.len();
            out.u32(end);
        }
        out.bytes(&self.common.alike[..blocks(&self.info.canonical)]);
        let varying = &self.common.varying;
        varying.iter().for_each(|&block| out.u16(block.into()));
        sketches.fill(0);
        let places = sketches.chunks_exact_mut(stride(varying.len()).max(1));
        for (view, sketch) in self.views().zip(places) {
            for (to, &block) in sketch.iter_mut().zip(varying) {
                *to = view.counts[usize::from(block)];
            }
        }
    }
}

fn views<'p>(
    packed: &'p [&'p [u8]],
    info: &LibraryInfo,
) -> impl Iterator<Item = Packed<'p>> + use<'p> {
    let spec = info.canonical;
    // They were checked.
    let parts = packed.iter();
    parts.filter_map(move |bytes| Packed::split(bytes, &spec))
}

/// What the blocks of all views have in common.
#[derive(Clone, Debug)]
struct CommonBlocks {
    /// Set pixels of the blocks that are the same in all views; 0 elsewhere.
    alike: [u8; MOST_BLOCKS],
    /// Numbers of the other blocks, rising.
    varying: Vec<u16, MOST_BLOCKS>,
}

impl CommonBlocks {
    fn of<'c>(mut views: impl Iterator<Item = &'c [u8]>) -> Self {
        let (mut alike, mut moves) = ([0; MOST_BLOCKS], [false; MOST_BLOCKS]);
        let first = views.next().unwrap_or_default();
        alike[..first.len()].copy_from_slice(first);
        for view in views {
            for ((moves, first), count) in moves.iter_mut().zip(&alike).zip(view) {
                *moves |= first != count;
            }
        }
        let varying: Vec<u16, MOST_BLOCKS> = (0..)
            .zip(moves)
            .filter_map(|(block, moves)| moves.then_some(block))
            .collect();
        for &block in &varying {
            alike[usize::from(block)] = 0;
        }
        Self { alike, varying }
    }
}

/// Writes a plain library: `view` gives the record of each view and draws its bits.
///
/// # Errors
/// [`BuildError::Memory`] unless `out` has the bytes of such a library, and those of `view`.
pub(super) fn write_plain(
    info: &LibraryInfo,
    out: &mut [u8],
    mut view: impl FnMut(usize, &mut [u8]) -> Result<ViewRecord, BuildError>,
) -> Result<(), BuildError> {
    let needed = library_bytes(&info.canonical, &info.grid).unwrap_or(usize::MAX);
    let (header, body) = header_and_body(out, needed)?;
    let (records, bits) = body.split_at_mut(info.grid.views() * RECORD_BYTES);
    let bits = bits.chunks_exact_mut(view_bytes(&info.canonical));
    let places = records.chunks_exact_mut(RECORD_BYTES).zip(bits);
    for (number, (record, bits)) in places.enumerate() {
        write_record(record, &view(number, bits)?);
    }
    let body = Body {
        version: PLAIN_VERSION,
        blocks: 0,
        bytes: body.len() as u64,
        crc: checksum([&*body]),
    };
    write_header(header, info, &body);
    Ok(())
}

/// Writes the canonical bits of a view as a plain library has them.
pub(super) fn write_bits(canonical: &[Word], out: &mut [u8]) {
    for (four, word) in out.chunks_exact_mut(4).zip(canonical) {
        four.copy_from_slice(&word.to_le_bytes());
    }
}

/// The parts of a file of `needed` bytes.
fn header_and_body(
    out: &mut [u8],
    needed: usize,
) -> Result<(&mut [u8; HEADER_BYTES], &mut [u8]), BuildError> {
    let short = TooLittleMemory {
        what: "bytes",
        needed: needed.max(HEADER_BYTES),
        given: out.len(),
    };
    let parts = first("bytes", needed, out)?.split_first_chunk_mut();
    parts.ok_or(BuildError::Memory(short))
}
