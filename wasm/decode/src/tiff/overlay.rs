//! A file as if it began with another page, and as if palettes were greys, without a copy of it.
//!
//! The library walks from a file's first page to the one that is wanted, page by page, so that a film would cost the square
//! of its length; and it does not read palettes, whose numbers are stored as greys are.

use std::io::{Cursor, Read, Result, Seek, SeekFrom};

use tiff::decoder::Decoder;

use super::directory::Page;

/// Reads one page.
pub(super) type Reader<'a> = Decoder<Overlaid<'a>>;

pub(super) struct Overlaid<'a> {
    bytes: Cursor<&'a [u8]>,
    /// What stands in place of the file's bytes, and where.
    patches: Vec<(usize, Vec<u8>)>,
}

impl<'a> Overlaid<'a> {
    /// The file with `page` as its first.
    pub(super) fn new(bytes: &'a [u8], page: &Page) -> Self {
        let mut patches = vec![page.as_first.clone()];
        patches.extend(page.palette_as_grey.clone());
        Self {
            bytes: Cursor::new(bytes),
            patches,
        }
    }
}

impl Read for Overlaid<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> Result<usize> {
        let start = self.bytes.position() as usize;
        let count = self.bytes.read(buffer)?;
        for (at, patch) in &self.patches {
            let places = (*at..).zip(patch);
            for (place, byte) in places.filter(|(place, _)| (start..start + count).contains(place))
            {
                buffer[place - start] = *byte;
            }
        }
        Ok(count)
    }
}

impl Seek for Overlaid<'_> {
    fn seek(&mut self, position: SeekFrom) -> Result<u64> {
        self.bytes.seek(position)
    }
}
