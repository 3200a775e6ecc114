//! Every byte of a library file, and nothing else.
//!
//! Little-endian throughout. Header (256 bytes), then the body. Two CRC-32 (ISO-HDLC): of the
//! header up to its own, and of the body.
//!
//! Version 0, plain: a record of 64 bytes a view, then the canonical bits of each view
//! (`size * size / 8` bytes, row by row, least significant bit leftmost). Version 1, compact: see
//! `compact.rs`.

use super::{LibraryInfo, ViewAxis, ViewGrid, ViewRecord};
use crate::checksum::checksum;

/// First eight bytes of the file.
pub(crate) const MAGIC: [u8; 8] = *b"FLUOROPL";
/// Version of the plain layout, bits: what views are drawn into.
pub(crate) const PLAIN_VERSION: u16 = 0;
/// Version of the compact layout, runs: what is kept.
pub const VERSION: u16 = 1;
/// Bytes of the header.
pub const HEADER_BYTES: usize = 256;
/// Bytes of a view's record in the plain layout.
pub const RECORD_BYTES: usize = 64;
/// Bytes of a view's record in the compact layout: without the rotations, which are the grid's.
pub(super) const SHORT_RECORD_BYTES: usize = 40;

/// Where the model's digest stands.
const DIGEST_AT: usize = 136;
/// Where the header's own checksum stands.
pub(super) const HEADER_CRC_AT: usize = HEADER_BYTES - 4;

/// The model's digest in the bytes of a library, where they are as long as a header.
pub(crate) fn digest_in(bytes: &[u8]) -> Option<&[u8; 32]> {
    bytes.get(DIGEST_AT..HEADER_BYTES)?.first_chunk()
}

/// Reads numbers one after another; zero beyond the end, so no index can be wrong.
pub(super) struct Reader<'a> {
    rest: &'a [u8],
}

impl<'a> Reader<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self { rest: bytes }
    }

    fn next<const N: usize>(&mut self) -> Option<&'a [u8; N]> {
        let (head, rest) = self.rest.split_first_chunk()?;
        self.rest = rest;
        Some(head)
    }

    pub(super) fn bytes<const N: usize>(&mut self) -> [u8; N] {
        self.next().copied().unwrap_or([0; N])
    }

    pub(super) fn u16(&mut self) -> u16 {
        self.next().map_or(0, |&two| u16::from_le_bytes(two))
    }

    pub(super) fn u32(&mut self) -> u32 {
        self.next().map_or(0, |&four| u32::from_le_bytes(four))
    }

    /// Two words: eight bytes at once would be copied first.
    pub(super) fn u64(&mut self) -> u64 {
        u64::from(self.u32()) | u64::from(self.u32()) << 32
    }

    pub(super) fn f32(&mut self) -> f32 {
        f32::from_bits(self.u32())
    }

    pub(super) fn f64(&mut self) -> f64 {
        f64::from_bits(self.u64())
    }
}

/// Writes numbers one after another; stops at the end of its bytes.
pub(super) struct Writer<'a> {
    rest: &'a mut [u8],
}

impl<'a> Writer<'a> {
    pub(super) fn new(bytes: &'a mut [u8]) -> Self {
        Self { rest: bytes }
    }

    pub(super) fn bytes(&mut self, bytes: &[u8]) {
        let rest = core::mem::take(&mut self.rest);
        if let Some((head, rest)) = rest.split_at_mut_checked(bytes.len()) {
            head.copy_from_slice(bytes);
            self.rest = rest;
        }
    }

    pub(super) fn f64(&mut self, value: f64) {
        self.bytes(&value.to_le_bytes());
    }

    pub(super) fn u32(&mut self, value: usize) {
        self.bytes(&(value as u32).to_le_bytes());
    }

    pub(super) fn u16(&mut self, value: usize) {
        self.bytes(&(value as u16).to_le_bytes());
    }
}

fn write_axis(out: &mut Writer<'_>, axis: &ViewAxis) {
    out.f64(axis.first);
    out.f64(axis.step);
}

/// What the header says of the body.
#[derive(Clone, Copy, Debug)]
pub(super) struct Body {
    pub(super) version: u16,
    /// Blocks of a sketch; 0 in the plain layout.
    pub(super) blocks: usize,
    pub(super) bytes: u64,
    pub(super) crc: u32,
}

/// Writes the header.
pub(super) fn write_header(header: &mut [u8; HEADER_BYTES], info: &LibraryInfo, body: &Body) {
    header.fill(0);
    let out = &mut Writer::new(header);
    out.bytes(&MAGIC);
    out.bytes(&body.version.to_le_bytes());
    out.u16(HEADER_BYTES);
    out.u32(info.canonical.area() as usize);
    out.u16(info.canonical.size());
    out.u16(info.grid.x.count);
    out.u16(info.grid.y.count);
    out.u16(0);
    write_axis(out, &info.grid.x);
    write_axis(out, &info.grid.y);
    out.f64(info.distance);
    info.reference.iter().for_each(|&value| out.f64(value));
    out.f64(info.focal);
    out.u32(info.camera.width());
    out.u32(info.camera.height());
    info.camera.focal().iter().for_each(|&value| out.f64(value));
    let centre = info.camera.principal_point();
    centre.iter().for_each(|&value| out.f64(value));
    out.bytes(&info.model);
    out.bytes(&body.bytes.to_le_bytes());
    out.bytes(&body.crc.to_le_bytes());
    out.u16(body.blocks);
    let crc = checksum([&header[..HEADER_CRC_AT]]).to_le_bytes();
    header[HEADER_CRC_AT..].copy_from_slice(&crc);
}

pub(super) fn read_grid(reader: &mut Reader<'_>, x_count: usize, y_count: usize) -> ViewGrid {
    let mut axis = |count| ViewAxis {
        first: reader.f64(),
        step: reader.f64(),
        count,
    };
    ViewGrid {
        x: axis(x_count),
        y: axis(y_count),
    }
}

pub(super) fn write_record(bytes: &mut [u8], record: &ViewRecord) {
    bytes.fill(0);
    let out = &mut Writer::new(bytes);
    out.f64(record.x_deg);
    out.f64(record.y_deg);
    write_short_record(out, record);
}

/// A record without the rotations.
pub(super) fn write_short_record(out: &mut Writer<'_>, record: &ViewRecord) {
    out.f64(record.scale);
    out.f64(record.angle);
    record.offset.iter().for_each(|&value| out.f64(value));
    out.bytes(&record.area.to_le_bytes());
    out.bytes(&record.elongation.to_le_bytes());
}

pub(super) fn read_record(bytes: &[u8]) -> ViewRecord {
    let reader = &mut Reader::new(bytes);
    let rotations = [reader.f64(), reader.f64()];
    read_short_record(reader, rotations)
}

/// A record of which the rotations are known.
pub(super) fn read_short_record(reader: &mut Reader<'_>, [x_deg, y_deg]: [f64; 2]) -> ViewRecord {
    ViewRecord {
        x_deg,
        y_deg,
        scale: reader.f64(),
        angle: reader.f64(),
        offset: [reader.f64(), reader.f64()],
        area: reader.u32(),
        elongation: reader.f32(),
    }
}
