//! The structure of a data set: where the values of the wanted elements and the pixels are.

use std::io::Read;
use std::ops::Range;

use flate2::read::DeflateDecoder;

use super::element::{Element, ITEM, SEQUENCE_END, UNDEFINED, Walker};
use super::functional;
use super::problem::{FORMAT, damaged};
use super::syntax::{Coding, Syntax};
use super::tags::MODALITY_TABLE;
use super::values::Found;
use crate::error::Problem;
use crate::limits::MAX_INFLATED_BYTES;

const PIXEL_DATA: u32 = 0x7FE0_0010;

/// What the walk found.
pub(super) struct DataSet {
    /// The wanted elements.
    pub wanted: Vec<Found>,
    /// Those of what all frames share in their functional groups; empty where there are none.
    pub shared: Vec<Found>,
    /// Those of each frame's own functional groups; none where there are none.
    pub per_frame: Vec<Vec<Found>>,
    /// Those of the table that turns stored values into meaningful ones; empty where there is none.
    pub modality_table: Vec<Found>,
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
    let walker = syntax.walker(bytes);
    let (mut at, mut wanted) = (start, Vec::new());
    let (mut shared, mut per_frame, mut modality_table) = (Vec::new(), Vec::new(), Vec::new());
    while at < bytes.len() {
        let element = walker.element(at)?;
        match element.tag {
            PIXEL_DATA => {
                let pixels = pixel_data(&walker, &element, syntax.coding)?;
                return Ok(DataSet {
                    wanted,
                    shared,
                    per_frame,
                    modality_table,
                    pixels,
                });
            }
            functional::SHARED => shared = functional::items(&walker, &element)?.concat(),
            functional::PER_FRAME => per_frame = functional::items(&walker, &element)?,
            MODALITY_TABLE => modality_table = functional::elements(&walker, &element)?,
            _ => wanted.extend(Found::of(&walker, &element)),
        }
        at = walker.after(&element, 0)?;
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
