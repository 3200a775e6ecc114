//! Pages in fax codes of group 3 (ITU-T T.4, rows one by one or each by the row above) and in its run lengths alone (compression 2).
//! Group 4 is the library's.

use std::convert::Infallible;

use fax::maps::{Mode, black, mode, white};
use fax::{BitReader, ByteReader};
use tiff::tags::Tag;

use super::overlay::Reader;
use super::problem::{damaged, failed};
use crate::error::Problem;
use crate::frame::Pixels;

/// Values of the Compression field.
pub(super) const RUN_LENGTHS: u16 = 2;
pub(super) const GROUP_3: u16 = 3;

/// Field of what rows of group 3 may be: bit 0, by the row above.
const OPTIONS: Tag = Tag::Unknown(292);
/// Field of the order of bits; 2 where the lowest comes first.
const FILL_ORDER: Tag = Tag::Unknown(266);
/// Value of the field that says what numbers mean: 0 is white.
const WHITE_IS_ZERO: u16 = 0;

/// A run at least so long is followed by the rest of it.
const LONG: u16 = 64;

/// How rows are coded.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Rows {
    /// Each begins with a byte.
    Bytewise,
    /// Each begins behind a mark of eleven zeros or more and a one.
    Marked,
    /// The mark is followed by a bit: 0 where the row is told by the one above.
    MarkedByTheRowAbove,
}

/// Greys of a page of one bit of so many pixels; the places of its strips have been checked.
pub(super) fn grey(
    decoder: &mut Reader<'_>,
    bytes: &[u8],
    page: usize,
    (width, height): (usize, usize),
) -> Result<Pixels, Problem> {
    let mut list = |tag| {
        let values = decoder.find_tag_unsigned_vec::<u64>(tag);
        values
            .map(Option::unwrap_or_default)
            .map_err(|e| failed(page, e))
    };
    let (offsets, counts) = (list(Tag::StripOffsets)?, list(Tag::StripByteCounts)?);
    let mut number = |tag| {
        let value = decoder.find_tag_unsigned::<u32>(tag);
        value.map_err(|e| failed(page, e))
    };
    let rows = match number(Tag::Compression)? {
        Some(compression) if compression == u32::from(RUN_LENGTHS) => Rows::Bytewise,
        _ if number(OPTIONS)?.unwrap_or(0) & 1 == 1 => Rows::MarkedByTheRowAbove,
        _ => Rows::Marked,
    };
    let lowest_first = number(FILL_ORDER)? == Some(2);
    let photometric = number(Tag::PhotometricInterpretation)?;
    let of_white = match photometric == Some(WHITE_IS_ZERO.into()) {
        true => u8::MAX,
        false => 0,
    };
    let down = decoder.chunk_dimensions().1.max(1) as usize;
    if offsets.len() < height.div_ceil(down) {
        return Err(damaged(page, "not all of its strips are there"));
    }
    // Rows are made as they are found: a short file may state many.
    let mut pixels = Vec::new();
    for (index, (&offset, &count)) in offsets.iter().zip(&counts).enumerate() {
        let due = down.min(height.saturating_sub(index * down));
        let coded = bytes
            .get(offset as usize..(offset + count) as usize)
            .unwrap_or_default();
        strip(coded, lowest_first, rows, width as u32, due, |row| {
            let mut value = of_white;
            let mut from = 0;
            for &to in row.iter().chain([&(width as u32)]) {
                pixels.extend(std::iter::repeat_n(value, (to - from) as usize));
                (from, value) = (to, !value);
            }
        })
        .ok_or_else(|| damaged(page, "its fax codes end early or mean nothing"))?;
    }
    Ok(Pixels::U8(pixels))
}

/// Calls with the places of each of so many rows at which the colour changes, white first; none is beyond the width or before
/// another. `None` where the codes do not tell them.
fn strip(
    coded: &[u8],
    lowest_first: bool,
    rows: Rows,
    width: u32,
    count: usize,
    mut call: impl FnMut(&[u32]),
) -> Option<()> {
    let ordered = |&byte: &u8| match lowest_first {
        true => byte.reverse_bits(),
        false => byte,
    };
    // Tables are read by more bits than the last code may have.
    let padded = coded.iter().map(ordered).chain([0; 2]);
    let mut reader = ByteReader::new(padded.map(Ok::<u8, Infallible>)).ok()?;
    let mut above = Vec::new();
    for _ in 0..count {
        let is_alone = begin(&mut reader, rows)?;
        let row = match is_alone {
            true => alone(&mut reader, width)?,
            false => by_the_row_above(&mut reader, &above, width)?,
        };
        call(&row);
        above = row;
    }
    Some(())
}

/// Goes to the beginning of a row; whether it stands for itself.
fn begin(reader: &mut impl BitReader, rows: Rows) -> Option<bool> {
    if rows == Rows::Bytewise {
        let rest = reader.bits_to_byte_boundary();
        reader.consume(rest).ok()?;
        return Some(true);
    }
    // Some programs leave marks out where rows stand for themselves.
    if reader.peek(11)? == 0 {
        while reader.peek(1)? == 0 {
            reader.consume(1).ok()?;
        }
        reader.consume(1).ok()?;
    } else if rows == Rows::MarkedByTheRowAbove {
        return None;
    }
    if rows == Rows::Marked {
        return Some(true);
    }
    let bit = reader.peek(1)?;
    reader.consume(1).ok()?;
    Some(bit == 1)
}

/// A row of runs, white first.
fn alone(reader: &mut impl BitReader, width: u32) -> Option<Vec<u32>> {
    let (mut changes, mut at) = (Vec::new(), 0);
    while at < width {
        at += run(reader, changes.len() % 2 == 1)?;
        changes.push(at);
    }
    (at == width).then_some(changes)
}

/// A row told by where it differs from the one above.
fn by_the_row_above(reader: &mut impl BitReader, above: &[u32], width: u32) -> Option<Vec<u32>> {
    let mut changes: Vec<u32> = Vec::new();
    // The place before the row's first pixel is none yet.
    let (mut at, mut begun) = (0, false);
    while at < width {
        let is_black = changes.len() % 2 == 1;
        // The next change above to the other colour, and the one after it.
        let mut next = match begun {
            true => above.partition_point(|&change| change <= at),
            false => 0,
        };
        next += usize::from((next % 2 == 1) != is_black);
        let change = |number: usize| above.get(number).copied().unwrap_or(width);
        match mode::decode(reader)? {
            Mode::Pass => at = change(next + 1),
            Mode::Horizontal => {
                for is_black in [is_black, !is_black] {
                    at += run(reader, is_black)?;
                    changes.push(at);
                }
            }
            Mode::Vertical(aside) => {
                let to = change(next).checked_add_signed(aside.into())?;
                if to < at {
                    return None;
                }
                at = to;
                changes.push(at);
            }
            Mode::Extension | Mode::EOF => return None,
        }
        begun = true;
    }
    (at == width).then_some(changes)
}

/// The length of a run. There are no more codes of long ones than bits.
fn run(reader: &mut impl BitReader, is_black: bool) -> Option<u32> {
    let mut sum = 0u32;
    loop {
        let length = match is_black {
            true => black::decode(reader)?,
            false => white::decode(reader)?,
        };
        sum = sum.checked_add(length.into())?;
        if length < LONG {
            return Some(sum);
        }
    }
}
