//! Elements of a DICOM file: their tags and lengths, read without reserving anything.

use std::ops::Range;

use super::problem::damaged;
use crate::error::Problem;

/// Deepest nesting of sequences.
const MAX_DEPTH: usize = 32;

/// A length that means "until the end mark".
pub(super) const UNDEFINED: u32 = u32::MAX;

pub(super) const ITEM: u32 = 0xFFFE_E000;
pub(super) const ITEM_END: u32 = 0xFFFE_E00D;
pub(super) const SEQUENCE_END: u32 = 0xFFFE_E0DD;

/// One element's tag and length.
pub(super) struct Element {
    pub tag: u32,
    pub representation: Option<[u8; 2]>,
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

    pub(super) fn u16(&self, at: usize) -> Result<u16, Problem> {
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
}

/// All representations (PS3.5 6.2); of the first ones the length takes two bytes.
pub(super) const REPRESENTATIONS: [&[u8; 2]; 34] = [
    b"AE", b"AS", b"AT", b"CS", b"DA", b"DS", b"DT", b"FD", b"FL", b"IS", b"LO", b"LT", b"PN",
    b"SH", b"SL", b"SS", b"ST", b"TM", b"UI", b"UL", b"US", b"OB", b"OD", b"OF", b"OL", b"OV",
    b"OW", b"SQ", b"SV", b"UC", b"UN", b"UR", b"UT", b"UV",
];
const SHORT: usize = 21;

/// Of all other representations, also those the standard may yet invent, the length takes four bytes after two reserved
/// ones (PS3.5 7.1.2).
fn has_short_length(representation: [u8; 2]) -> bool {
    REPRESENTATIONS[..SHORT].contains(&&representation)
}
