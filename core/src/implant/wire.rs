//! The layout of an implant file: little-endian, every part begins at a multiple of four.
//!
//! The header has a CRC-32 (ISO-HDLC) of the body and, in its last four bytes, one of itself up to there.

/// First eight bytes of the file.
pub(super) const MAGIC: [u8; 8] = *b"FLUOROIM";
/// Version of the layout: edges and their boxes are a stream of bytes.
pub const VERSION: u16 = 2;
/// Version of the layout in which edges and boxes stand one after another, as numbers of 16 and 32 bits.
pub(super) const AS_NUMBERS: u16 = 1;
/// Version of the layout in which triangles stand beside the edges, instead of being those that the edges are of.
pub(super) const WITH_TRIANGLES: u16 = 0;
/// Bytes of the header.
pub const HEADER_BYTES: usize = 320;
/// Where the header's own checksum stands.
pub(super) const HEADER_CRC_AT: usize = HEADER_BYTES - 4;

/// Where the header says how many there are of each part, and how many bytes the library has.
pub(super) const COUNTS_AT: usize = 12;
pub(super) const LIBRARY_BYTES_AT: usize = 32;

/// Bytes of a vertex, a triangle (in version 2 each of the edges' bytes), a box, an edge and a rim; `None` of a version that
/// is not known.
pub(super) const fn sizes(version: u16) -> Option<[usize; 5]> {
    match version {
        WITH_TRIANGLES | AS_NUMBERS => Some([12, 12, 40, 8, 6]),
        VERSION => Some([12, 1, 0, 0, 6]),
        _ => None,
    }
}
