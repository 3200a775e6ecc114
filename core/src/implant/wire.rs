//! The layout of an implant file: little-endian, every part begins at a multiple of four.
//!
//! The header has a CRC-32 (ISO-HDLC) of the body and, in its last four bytes, one of itself up to there.

/// First eight bytes of the file.
pub(super) const MAGIC: [u8; 8] = *b"FLUOROIM";
/// Version of the layout: triangles are those that the edges are of.
pub const VERSION: u16 = 1;
/// Version of the layout in which triangles stand beside the edges.
pub(super) const WITH_TRIANGLES: u16 = 0;
/// Bytes of the header.
pub const HEADER_BYTES: usize = 320;
/// Where the header's own checksum stands.
pub(super) const HEADER_CRC_AT: usize = HEADER_BYTES - 4;

/// Where the header says how many there are of each part.
pub(super) const COUNTS_AT: usize = 12;
/// Bytes of a vertex, a triangle, a box, an edge and a rim. Of triangles there are none since version 1.
pub(super) const SIZES: [usize; 5] = [12, 12, 40, 8, 6];
