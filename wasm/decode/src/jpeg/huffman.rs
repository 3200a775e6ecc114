//! Huffman codes of JPEG images: bits, tables, and the stretches between restart marks.

use std::ops::Range;

use super::markers::cut;
use crate::error::Problem;

/// Bits of coded bytes, the zero after each 0xFF left out.
pub(super) struct Bits<'a> {
    coded: &'a [u8],
    at: usize,
    held: u64,
    count: u32,
}

impl<'a> Bits<'a> {
    pub(super) fn new(coded: &'a [u8]) -> Self {
        Self {
            coded,
            at: 0,
            held: 0,
            count: 0,
        }
    }

    fn fill(&mut self) {
        while self.count <= 48 {
            let Some(&byte) = self.coded.get(self.at) else {
                return;
            };
            self.at += if byte == 0xFF { 2 } else { 1 };
            self.held = self.held << 8 | u64::from(byte);
            self.count += 8;
        }
    }

    /// The next 16 bits without taking them; ones beyond the end.
    fn peek(&mut self) -> usize {
        if self.count < 16 {
            self.fill();
        }
        let bits = match self.count {
            0..16 => self.held << (16 - self.count) | ((1 << (16 - self.count)) - 1),
            more => self.held >> (more - 16),
        };
        (bits & 0xFFFF) as usize
    }

    /// The next bits.
    pub(super) fn take(&mut self, length: u32) -> Result<u32, Problem> {
        if self.count < length {
            self.fill();
        }
        if self.count < length {
            return Err(cut("its pixels end too early"));
        }
        self.count -= length;
        let value = self.held >> self.count & ((1 << length) - 1);
        Ok(value as u32)
    }

    /// The next `length` bits, 1 to 16, as a number whose lower half stands for the negative ones (T.81 table F.1).
    pub(super) fn signed(&mut self, length: u32) -> Result<i32, Problem> {
        let value = self.take(length)?;
        let below = match value >> (length - 1) {
            0 => (1 << length) - 1,
            _ => 0,
        };
        Ok(value.cast_signed() - below)
    }
}

/// A code table: for each 16 bits, the length of the code that they begin with and its category.
pub(super) struct Table(Vec<[u8; 2]>);

impl Table {
    /// From the number of codes of each length and the categories in order.
    fn new(counts: &[u8; 16], categories: &[u8]) -> Result<Self, Problem> {
        let mut lookup = Vec::with_capacity(1 << 16);
        let mut categories = categories.iter();
        for (length, &count) in (1u8..).zip(counts) {
            for category in categories.by_ref().take(count.into()) {
                lookup.resize(lookup.len() + (1 << (16 - length)), [length, *category]);
                if lookup.len() > 1 << 16 {
                    return Err(cut("a code table holds more codes than there can be"));
                }
            }
        }
        lookup.resize(1 << 16, [0, 0]);
        Ok(Self(lookup))
    }

    /// The category of the next code: for differences their number of bits, for coefficients with the zeros before them.
    pub(super) fn category(&self, bits: &mut Bits<'_>) -> Result<u8, Problem> {
        let [length, category] = self.0[bits.peek()];
        if length == 0 {
            return Err(cut("there are pixels in a code that is in no table"));
        }
        bits.take(length.into())?;
        Ok(category)
    }

    /// The next difference, modulo 2^16.
    pub(super) fn difference(&self, bits: &mut Bits<'_>) -> Result<u16, Problem> {
        match self.category(bits)? {
            0 => Ok(0),
            16 => Ok(1 << 15),
            category @ 1..16 => Ok(bits.signed(category.into())? as u16),
            _ => Err(cut("there are pixels in a code that is in no table")),
        }
    }
}

/// The number of codes of each length, and the categories in order.
type Codes = ([u8; 16], Vec<u8>);

/// The code tables that stand, by class and number. They are made when a scan wants them: a file may define many more.
#[derive(Clone, Default)]
pub(super) struct Tables([[Option<Codes>; 4]; 2]);

impl Tables {
    /// Reads a segment of code tables.
    pub(super) fn read(&mut self, mut body: &[u8]) -> Result<(), Problem> {
        let odd = || cut("a code table is cut short");
        while let Some((&head, rest)) = body.split_first() {
            let (counts, rest) = rest.split_first_chunk::<16>().ok_or_else(odd)?;
            let total = counts.iter().map(|&count| usize::from(count)).sum();
            let (categories, rest) = rest.split_at_checked(total).ok_or_else(odd)?;
            let class = self.0.get_mut(usize::from(head >> 4)).ok_or_else(odd)?;
            let slot = class.get_mut(usize::from(head & 0x0F)).ok_or_else(odd)?;
            *slot = Some((*counts, categories.to_vec()));
            body = rest;
        }
        Ok(())
    }

    /// The table of differences (of neighbours, or of the means of blocks) with this number.
    pub(super) fn lengths(&self, number: usize) -> Result<Table, Problem> {
        self.made(0, number)
    }

    /// The table of coefficients with this number.
    pub(super) fn coefficients(&self, number: usize) -> Result<Table, Problem> {
        self.made(1, number)
    }

    fn made(&self, class: usize, number: usize) -> Result<Table, Problem> {
        let codes = self.0[class].get(number).and_then(Option::as_ref);
        let (counts, categories) =
            codes.ok_or_else(|| cut("a scan names a code table that is not there"))?;
        Table::new(counts, categories)
    }
}

/// The stretches of a scan between restart marks.
pub(super) fn intervals(coded: &[u8]) -> Vec<Range<usize>> {
    let mut out = Vec::new();
    let (mut start, mut at) = (0, 0);
    while at < coded.len() {
        let restart = coded[at] == 0xFF
            && coded
                .get(at + 1)
                .is_some_and(|next| (0xD0..=0xD7).contains(next));
        if restart {
            out.push(start..at);
            start = at + 2;
        }
        at += if restart { 2 } else { 1 };
    }
    out.push(start..coded.len());
    out
}
