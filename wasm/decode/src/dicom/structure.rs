//! Where the elements of a DICOM file are: a walk over tags and lengths that reserves nothing.

use std::io::Read;
use std::ops::Range;

use flate2::read::DeflateDecoder;

use super::syntax::{Coding, Syntax};
use super::{FORMAT, damaged, functional};
use crate::error::Problem;
use crate::limits::MAX_INFLATED_BYTES;

/// Length of the preamble before `DICM`.
const PREAMBLE: usize = 128;

/// Elements longer than this are not copied for the library: nothing that is wanted comes near it.
const MAX_WANTED_BYTES: u32 = 4096;

/// Deepest nesting of sequences.
const MAX_DEPTH: usize = 32;

/// A length that means "until the end mark".
pub(super) const UNDEFINED: u32 = u32::MAX;

const PIXEL_DATA: u32 = 0x7FE0_0010;
pub(super) const ITEM: u32 = 0xFFFE_E000;
pub(super) const ITEM_END: u32 = 0xFFFE_E00D;
pub(super) const SEQUENCE_END: u32 = 0xFFFE_E0DD;

/// The part of the file before the data set.
pub(super) struct Meta {
    /// Identifier of the transfer syntax.
    pub transfer_syntax: String,
    /// Where the data set begins.
    pub end: usize,
}

/// What the walk found.
pub(super) struct DataSet {
    /// The bytes of the wanted small elements, one after the other, in the file's syntax.
    pub wanted: Vec<u8>,
    /// The same of what all frames share in their functional groups; empty where there are none.
    pub shared: Vec<u8>,
    /// The same of each frame's own functional groups; none where there are none.
    pub per_frame: Vec<Vec<u8>>,
    /// Where the pixels are.
    pub pixels: PixelData,
}

/// Where the pixels are.
pub(super) enum PixelData {
    /// One range; `words` if they are stored as 16-bit words.
    Native { range: Range<usize>, words: bool },
    /// The basic offset table and the fragments after it.
    Fragments {
        offsets: Vec<u32>,
        fragments: Vec<Range<usize>>,
    },
}

/// One element's tag and length.
pub(super) struct Element {
    pub tag: u32,
    pub representation: Option<[u8; 2]>,
    /// Where the tag begins.
    pub start: usize,
    /// Where the value begins.
    pub value: usize,
    pub length: u32,
}

impl Element {
    /// The value's range, if its length is stated.
    pub(super) fn range(&self, bytes: &[u8]) -> Result<Range<usize>, Problem> {
        let end = usize::try_from(self.length)
            .ok()
            .and_then(|length| self.value.checked_add(length))
            .filter(|&end| end <= bytes.len() && self.length != UNDEFINED);
        end.map(|end| self.value..end).ok_or_else(|| {
            damaged(format!(
                "element ({:04X},{:04X}) at byte {} reaches beyond the end of the file",
                self.tag >> 16,
                self.tag & 0xFFFF,
                self.value
            ))
        })
    }
}

/// Reads tags and lengths in one syntax.
#[derive(Clone, Copy)]
pub(super) struct Walker<'a> {
    pub bytes: &'a [u8],
    pub explicit: bool,
    pub big_endian: bool,
}

impl Walker<'_> {
    fn take<const N: usize>(&self, at: usize) -> Result<[u8; N], Problem> {
        let found = self.bytes.get(at..).and_then(|rest| rest.first_chunk());
        found
            .copied()
            .ok_or_else(|| damaged(format!("it ends in the middle of an element at byte {at}")))
    }

    fn u16(&self, at: usize) -> Result<u16, Problem> {
        let bytes = self.take(at)?;
        Ok(match self.big_endian {
            true => u16::from_be_bytes(bytes),
            false => u16::from_le_bytes(bytes),
        })
    }

    fn u32(&self, at: usize) -> Result<u32, Problem> {
        let bytes = self.take(at)?;
        Ok(match self.big_endian {
            true => u32::from_be_bytes(bytes),
            false => u32::from_le_bytes(bytes),
        })
    }

    pub(super) fn element(&self, at: usize) -> Result<Element, Problem> {
        let tag = u32::from(self.u16(at)?) << 16 | u32::from(self.u16(at + 2)?);
        let delimiter = tag >> 16 == ITEM >> 16;
        let (representation, value, length) = if delimiter || !self.explicit {
            (None, at + 8, self.u32(at + 4)?)
        } else {
            let representation: [u8; 2] = self.take(at + 4)?;
            if !representation.iter().all(u8::is_ascii_uppercase) {
                return Err(damaged(format!(
                    "there is no value representation at byte {}",
                    at + 4
                )));
            }
            match has_short_length(representation) {
                true => (Some(representation), at + 8, self.u16(at + 6)?.into()),
                false => (Some(representation), at + 12, self.u32(at + 8)?),
            }
        };
        Ok(Element {
            tag,
            representation,
            start: at,
            value,
            length,
        })
    }

    /// The position after an element, whatever its length.
    pub(super) fn after(&self, element: &Element, depth: usize) -> Result<usize, Problem> {
        if element.length != UNDEFINED {
            return Ok(element.range(self.bytes)?.end);
        }
        if depth >= MAX_DEPTH {
            return Err(damaged(format!(
                "its sequences are nested deeper than {MAX_DEPTH}"
            )));
        }
        // An unknown element of undefined length is an implicit sequence whatever the file's syntax.
        let unknown = element.representation == Some(*b"UN");
        let inside = Walker {
            explicit: self.explicit && !unknown,
            ..*self
        };
        inside.after_sequence(element.value, depth)
    }

    /// The position after a sequence whose items begin at `at`.
    fn after_sequence(&self, mut at: usize, depth: usize) -> Result<usize, Problem> {
        loop {
            let item = self.element(at)?;
            at = match item.tag {
                SEQUENCE_END => return Ok(item.value),
                ITEM if item.length == UNDEFINED => self.after_item(item.value, depth)?,
                ITEM => item.range(self.bytes)?.end,
                _ => {
                    return Err(damaged(format!(
                        "there is no item of a sequence at byte {at}"
                    )));
                }
            };
        }
    }

    /// The position after an item, whatever its length.
    pub(super) fn after_any_item(&self, item: &Element) -> Result<usize, Problem> {
        match item.length {
            UNDEFINED => self.after_item(item.value, 1),
            _ => Ok(item.range(self.bytes)?.end),
        }
    }

    /// The position after an item of undefined length whose elements begin at `at`.
    fn after_item(&self, mut at: usize, depth: usize) -> Result<usize, Problem> {
        loop {
            let element = self.element(at)?;
            if element.tag == ITEM_END {
                return Ok(element.value);
            }
            at = self.after(&element, depth + 1)?;
        }
    }

    /// The fragments of encapsulated pixel data that begin at `at`.
    fn fragments(&self, mut at: usize) -> Result<PixelData, Problem> {
        let mut items = Vec::new();
        loop {
            let item = self.element(at)?;
            match item.tag {
                SEQUENCE_END => break,
                ITEM => items.push(item.range(self.bytes)?),
                _ => {
                    return Err(damaged(format!(
                        "there is no fragment of pixels at byte {at}"
                    )));
                }
            }
            at = items.last().map_or(at, |range| range.end);
        }
        let mut items = items.into_iter();
        let table = items
            .next()
            .and_then(|range| self.bytes.get(range))
            .unwrap_or_default();
        let offsets = table
            .as_chunks::<4>()
            .0
            .iter()
            .copied()
            .map(u32::from_le_bytes);
        Ok(PixelData::Fragments {
            offsets: offsets.collect(),
            fragments: items.collect(),
        })
    }
}

/// The representations whose length takes two bytes. All others, also those the standard may yet invent, take four
/// after two reserved ones (PS3.5 7.1.2).
fn has_short_length(representation: [u8; 2]) -> bool {
    const SHORT: [&[u8; 2]; 21] = [
        b"AE", b"AS", b"AT", b"CS", b"DA", b"DS", b"DT", b"FD", b"FL", b"IS", b"LO", b"LT", b"PN",
        b"SH", b"SL", b"SS", b"ST", b"TM", b"UI", b"UL", b"US",
    ];
    SHORT.contains(&&representation)
}

/// Reads the group of elements (always explicit little endian) that names the transfer syntax.
pub(super) fn read_meta(bytes: &[u8]) -> Result<Meta, Problem> {
    if bytes.get(PREAMBLE..PREAMBLE + 4) != Some(b"DICM") {
        return Err(damaged("the mark DICM is missing at byte 128"));
    }
    let walker = Walker {
        bytes,
        explicit: true,
        big_endian: false,
    };
    let (mut at, mut transfer_syntax) = (PREAMBLE + 4, None);
    while at < bytes.len() && walker.u16(at)? == 0x0002 {
        let element = walker.element(at)?;
        let value = element.range(bytes)?;
        at = value.end;
        if element.tag == 0x0002_0010 {
            let text = String::from_utf8_lossy(&bytes[value]);
            let padding = |c: char| c == '\0' || c.is_whitespace();
            transfer_syntax = Some(text.trim_matches(padding).to_owned());
        }
    }
    Ok(Meta {
        transfer_syntax: transfer_syntax.ok_or_else(|| damaged("it names no transfer syntax"))?,
        end: at,
    })
}

/// Inflates a deflated data set, up to [`MAX_INFLATED_BYTES`].
pub(super) fn inflate(bytes: &[u8]) -> Result<Vec<u8>, Problem> {
    let mut inflated = Vec::new();
    DeflateDecoder::new(bytes)
        .take(MAX_INFLATED_BYTES + 1)
        .read_to_end(&mut inflated)
        .map_err(|e| damaged(format!("its deflated data set cannot be read ({e})")))?;
    match inflated.len() as u64 > MAX_INFLATED_BYTES {
        true => Err(damaged("its deflated data set grows beyond all bounds")),
        false => Ok(inflated),
    }
}

/// Walks the data set that begins at `start` up to its pixels.
pub(super) fn walk(bytes: &[u8], start: usize, syntax: &Syntax) -> Result<DataSet, Problem> {
    let walker = Walker {
        bytes,
        explicit: syntax.explicit,
        big_endian: syntax.big_endian,
    };
    let (mut at, mut wanted) = (start, Vec::new());
    let (mut shared, mut per_frame) = (Vec::new(), Vec::new());
    while at < bytes.len() {
        let element = walker.element(at)?;
        if element.tag == PIXEL_DATA {
            let pixels = pixel_data(&walker, &element, syntax.coding)?;
            return Ok(DataSet {
                wanted,
                shared,
                per_frame,
                pixels,
            });
        }
        match element.tag {
            functional::SHARED => shared = functional::items(&walker, &element)?.concat(),
            functional::PER_FRAME => per_frame = functional::items(&walker, &element)?,
            _ => {}
        }
        let end = walker.after(&element, 0)?;
        if is_small_and_wanted(&element) {
            wanted.extend_from_slice(&bytes[at..end]);
        }
        at = end;
    }
    Err(Problem::unsupported(
        FORMAT,
        "no pixels (a report, a directory or floating point data)",
        "Choose the file with the X-ray frames",
    ))
}

/// Whether an element goes to the library: one of the attributes, with a representation whose values are small.
pub(super) fn is_small_and_wanted(element: &Element) -> bool {
    super::attributes::is_wanted(element.tag)
        && element.length <= MAX_WANTED_BYTES
        && element.representation.is_none_or(has_short_length)
}

fn pixel_data(
    walker: &Walker<'_>,
    element: &Element,
    coding: Coding,
) -> Result<PixelData, Problem> {
    if element.length != UNDEFINED {
        return Ok(PixelData::Native {
            range: element.range(walker.bytes)?,
            words: element.representation != Some(*b"OB"),
        });
    }
    match coding {
        Coding::Native => Err(damaged(
            "its pixels are in fragments though it says they are not compressed",
        )),
        _ => walker.fragments(element.value),
    }
}
