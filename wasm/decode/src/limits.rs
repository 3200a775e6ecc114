//! What a hostile or mistaken file may ask for, in one place.
//!
//! Every length that a file states is compared with these limits, or with the number of bytes that are there, before
//! memory of that size is reserved. The limits are far above what the field uses: a flat panel has 3072 pixels a side, a
//! scanned implant some 100 000 triangles.

/// Largest width and largest height of a frame, pixels.
pub const MAX_SIDE: u32 = 8192;

/// Most frames (pages) of one file.
pub const MAX_FRAMES: usize = 10_000;

/// Most bytes of pixels that [`decode_frames`](crate::decode_frames) holds at once. More frames are decoded one at a time,
/// with [`FrameFile`](crate::FrameFile).
pub const MAX_PIXEL_BYTES_AT_ONCE: usize = 1 << 30;

/// Most bytes that a deflated DICOM data set may grow to.
pub const MAX_INFLATED_BYTES: u64 = 1 << 29;

/// Most triangles of a model.
pub const MAX_TRIANGLES: usize = 5_000_000;

/// Most vertices of a model file, before equal ones are merged: three for each triangle.
pub const MAX_VERTICES: usize = 3 * MAX_TRIANGLES;

/// Most bytes that one byte of a file can stand for in any of the codings that are read: deflate reaches 1032 and
/// LZW 2560. A frame that states more is refused before memory is reserved for it.
pub(crate) const MAX_EXPANSION: u64 = 4096;
