//! A walk over the directories of a TIFF file, before the library reads them.
//!
//! The library reserves what the count of a field says (up to 256 MiB for each field) and multiplies stated sizes. Here
//! every field must lie inside the file, and every size that the library multiplies must be possible for a page.

use super::problem::{FORMAT, damaged};
use crate::error::Problem;
use crate::frame::checked_area;
use crate::limits::{MAX_FRAMES, MAX_SIDE};

const SUBFILE_TYPE: u16 = 254;

const IMAGE_WIDTH: u16 = 256;
const IMAGE_LENGTH: u16 = 257;
const BITS_PER_SAMPLE: u16 = 258;
const PHOTOMETRIC: u16 = 262;
const SAMPLES_PER_PIXEL: u16 = 277;
const ROWS_PER_STRIP: u16 = 278;
const TILE_WIDTH: u16 = 322;
const TILE_LENGTH: u16 = 323;

/// Longest side of a tile: a whole page, rounded up to the blocks of 16 that tiles are made of.
const MAX_TILE: u64 = MAX_SIDE as u64;

/// Most samples of a pixel: colour, transparency and a few more that are left out.
const MAX_SAMPLES: u64 = 8;

/// Bit of the subfile type: a smaller copy of another page.
const REDUCED_COPY: u64 = 1;

/// Photometric interpretations.
const GREY: u16 = 1;
const PALETTE: u64 = 3;

/// A directory that holds a frame.
#[derive(Debug)]
pub(crate) struct Page {
    /// Its place in the file's order, counted from 0.
    pub number: usize,
    /// Width and height, pixels.
    pub size: (u32, u32),
    /// Where the file says which page is the first, and what it says where this one is.
    pub as_first: (usize, Vec<u8>),
    /// Where a page of numbers of colours says that it is one, and what it says where they are greys.
    pub palette_as_grey: Option<(usize, Vec<u8>)>,
}

/// What the fields of a directory say, as far as it is wanted here.
#[derive(Default)]
struct Said {
    subfile_type: u64,
    width: u64,
    height: u64,
    palette_as_grey: Option<(usize, Vec<u8>)>,
    /// Bytes of values that lie outside of the directory.
    elsewhere: u64,
}

/// Most times that the bytes of a file may be values of its directories: programs let pages share short texts.
const MOST_SHARED: u64 = 8;

/// Where numbers are and how wide.
struct Walker<'a> {
    bytes: &'a [u8],
    big_endian: bool,
    /// BigTIFF: counts and offsets of eight bytes.
    wide: bool,
}

/// One field of a directory.
struct Field {
    tag: u16,
    kind: u16,
    count: u64,
    /// Where the value or its offset is.
    at: usize,
}

impl Walker<'_> {
    fn take<const N: usize>(&self, at: usize) -> Result<[u8; N], Problem> {
        let found = self.bytes.get(at..).and_then(|rest| rest.first_chunk());
        let mut bytes: [u8; N] = *found.ok_or_else(|| {
            Problem::damaged(
                FORMAT,
                format!("it ends in the middle of a directory at byte {at}"),
            )
        })?;
        // Little endian from here on.
        if self.big_endian {
            bytes.reverse();
        }
        Ok(bytes)
    }

    fn u16(&self, at: usize) -> Result<u16, Problem> {
        self.take(at).map(u16::from_le_bytes)
    }

    /// A number of eight bytes, or of four in a classic file.
    fn offset(&self, at: usize) -> Result<u64, Problem> {
        match self.wide {
            true => self.take(at).map(u64::from_le_bytes),
            false => self.take(at).map(u32::from_le_bytes).map(u64::from),
        }
    }

    /// Bytes of an offset.
    fn offset_bytes(&self) -> usize {
        if self.wide { 8 } else { 4 }
    }

    fn field(&self, at: usize) -> Result<Field, Problem> {
        Ok(Field {
            tag: self.u16(at)?,
            kind: self.u16(at + 2)?,
            count: self.offset(at + 4)?,
            at: at + 4 + self.offset_bytes(),
        })
    }

    /// Checks that a field's values lie inside the file, and the sizes that it states.
    /// Gives how many bytes of values lie elsewhere.
    fn check(&self, field: &Field, page: usize) -> Result<u64, Problem> {
        let Some(size) = size_of(field.kind) else {
            return Ok(0);
        };
        let outside = || {
            damaged(
                page,
                format!("field {} reaches beyond the end of the file", field.tag),
            )
        };
        let length = field.count.checked_mul(size).ok_or_else(outside)?;
        if length > self.offset_bytes() as u64 {
            let end = self
                .offset(field.at)?
                .checked_add(length)
                .ok_or_else(outside)?;
            if end > self.bytes.len() as u64 {
                return Err(outside());
            }
        }
        let elsewhere = match length > self.offset_bytes() as u64 {
            true => length,
            false => 0,
        };
        let (Some(allowed), Some(value)) = (allowed(field.tag), self.single(field)?) else {
            return Ok(elsewhere);
        };
        match (allowed.0..=allowed.1).contains(&value) {
            true => Ok(elsewhere),
            false => Err(damaged(
                page,
                format!(
                    "field {} is {value} and {} to {} are possible",
                    field.tag, allowed.0, allowed.1
                ),
            )),
        }
    }

    /// The value of a field of one whole number.
    fn single(&self, field: &Field) -> Result<Option<u64>, Problem> {
        Ok(match (field.count, field.kind) {
            (1, 1) => Some(self.take::<1>(field.at)?[0].into()),
            (1, 3) => Some(self.u16(field.at)?.into()),
            (1, 4) => Some(u32::from_le_bytes(self.take(field.at)?).into()),
            (1, 16) => Some(self.offset(field.at)?),
            _ => None,
        })
    }

    /// Checks the directory at `at`; gives what it says, the offset of the next, 0 for none, and its own bytes.
    fn directory(&self, at: usize, page: usize) -> Result<(Said, u64, usize), Problem> {
        let start = at;
        let (count, mut at) = match self.wide {
            true => (self.offset(at)?, at + 8),
            false => (self.u16(at)?.into(), at + 2),
        };
        let mut said = Said::default();
        for _ in 0..count {
            let field = self.field(at)?;
            said.elsewhere += self.check(&field, page)?;
            let value = self.single(&field)?.unwrap_or(0);
            match field.tag {
                SUBFILE_TYPE => said.subfile_type = value,
                IMAGE_WIDTH => said.width = value,
                IMAGE_LENGTH => said.height = value,
                PHOTOMETRIC if (value, field.kind) == (PALETTE, 3) => {
                    let grey = match self.big_endian {
                        true => GREY.to_be_bytes(),
                        false => GREY.to_le_bytes(),
                    };
                    said.palette_as_grey = Some((field.at, grey.to_vec()));
                }
                _ => {}
            }
            at = field.at + self.offset_bytes();
        }
        Ok((said, self.offset(at)?, at - start))
    }

    /// What the file's beginning would say if the directory at `at` were its first.
    fn as_first(&self, at: u64) -> (usize, Vec<u8>) {
        let mut offset = at.to_le_bytes()[..self.offset_bytes()].to_vec();
        if self.big_endian {
            offset.reverse();
        }
        (self.offset_bytes(), offset)
    }
}

/// Bytes of one value of each type; `None` for types that are passed over.
fn size_of(kind: u16) -> Option<u64> {
    match kind {
        1 | 2 | 6 | 7 => Some(1),
        3 | 8 => Some(2),
        4 | 9 | 11 | 13 => Some(4),
        5 | 10 | 12 | 16 | 17 | 18 => Some(8),
        _ => None,
    }
}

/// The smallest and largest value of a field whose value the library multiplies.
fn allowed(tag: u16) -> Option<(u64, u64)> {
    match tag {
        IMAGE_WIDTH | IMAGE_LENGTH => Some((1, MAX_SIDE.into())),
        TILE_WIDTH | TILE_LENGTH => Some((1, MAX_TILE)),
        SAMPLES_PER_PIXEL => Some((1, MAX_SAMPLES)),
        BITS_PER_SAMPLE => Some((1, 64)),
        // All ones is common: the whole page is one strip.
        ROWS_PER_STRIP => Some((1, u32::MAX.into())),
        _ => None,
    }
}

/// Checks every directory of a file; gives those that hold frames, in the file's order.
pub(super) fn pages(bytes: &[u8]) -> Result<Vec<Page>, Problem> {
    let short = || Problem::damaged(FORMAT, "it is shorter than its header");
    let header: &[u8; 4] = bytes.first_chunk().ok_or_else(short)?;
    let walker = Walker {
        bytes,
        big_endian: header[0] == b'M',
        wide: header.contains(&b'+'),
    };
    let mut next = walker.offset(walker.offset_bytes())?;
    let (mut pages, mut walked, mut elsewhere) = (Vec::new(), 0, 0);
    for number in 0..MAX_FRAMES {
        let at = usize::try_from(next).map_err(|_| short())?;
        let (said, after, length) = walker.directory(at, number)?;
        walked += length;
        elsewhere += said.elsewhere;
        // Directories that share bytes could hold the square of a file's length.
        if walked > bytes.len() || elsewhere > MOST_SHARED * bytes.len() as u64 {
            break;
        }
        if said.subfile_type & REDUCED_COPY == 0 {
            checked_area(said.width, said.height)?;
            pages.push(Page {
                number,
                size: (said.width as u32, said.height as u32),
                as_first: walker.as_first(next),
                palette_as_grey: said.palette_as_grey,
            });
        }
        next = after;
        if next == 0 {
            return match pages.is_empty() {
                true => Err(Problem::damaged(FORMAT, "it has no full-size page")),
                false => Ok(pages),
            };
        }
    }
    let detail = format!(
        "it has more than {MAX_FRAMES} pages, or they are linked in a circle or share what they hold"
    );
    Err(Problem::damaged(FORMAT, detail))
}
