//! The structure of a DICOM file: its transfer syntax, the bytes of the wanted elements, and where its pixels are.

use std::io::Read;
use std::ops::Range;

use flate2::read::DeflateDecoder;

use super::element::{Element, ITEM, SEQUENCE_END, UNDEFINED, Walker, is_small_and_wanted};
use super::functional;
use super::problem::{FORMAT, damaged};
use super::syntax::{Coding, Syntax};
use crate::error::Problem;
use crate::limits::MAX_INFLATED_BYTES;

/// Length of the preamble before `DICM`.
const PREAMBLE: usize = 128;

const PIXEL_DATA: u32 = 0x7FE0_0010;

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
        _ => fragments(walker, element.value),
    }
}

/// The fragments of encapsulated pixel data that begin at `at`.
fn fragments(walker: &Walker<'_>, mut at: usize) -> Result<PixelData, Problem> {
    let mut items = Vec::new();
    loop {
        let item = walker.element(at)?;
        match item.tag {
            SEQUENCE_END => break,
            ITEM => items.push(item.range(walker.bytes)?),
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
        .and_then(|range| walker.bytes.get(range))
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
