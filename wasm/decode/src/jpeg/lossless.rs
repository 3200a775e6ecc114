//! Lossless JPEG (process 14, all predictors, 2 to 16 bits), after ITU-T T.81 annex H.
//!
//! X-ray units write this coding. The library that decodes the other processes does not reset its prediction after a
//! restart mark and applies the point transform to predictions twice, so this coding is decoded here. The markers have been
//! walked before.

use std::ops::Range;

use super::markers::{
    END_OF_IMAGE, FORMAT, REMEDY, START_OF_IMAGE, START_OF_SCAN, cut, end_of_scan, frame_header,
    segment, starts_frame,
};
use crate::error::Problem;

const TABLES: u8 = 0xC4;
const RESTART_INTERVAL: u8 = 0xDD;

/// Samples of each component, one plane after the other.
pub(super) struct Planes {
    pub planes: Vec<Vec<u16>>,
}

/// What the markers before a scan have set.
struct Decoder {
    width: usize,
    height: usize,
    precision: u32,
    /// Identifiers of the components in the order of the frame header.
    components: Vec<u8>,
    tables: [Option<Table>; 4],
    restart: usize,
    planes: Vec<Vec<u16>>,
}

/// Decodes every scan. The image's markers are sound and its area allowed.
pub(super) fn decode(bytes: &[u8]) -> Result<Planes, Problem> {
    let early = || cut("it ends before the end-of-image mark");
    let mut decoder: Option<Decoder> = None;
    let mut tables = [const { None }; 4];
    let (mut at, mut restart) = (2, 0);
    debug_assert!(bytes.starts_with(&[0xFF, START_OF_IMAGE]));
    loop {
        let marker = *bytes.get(at + 1).ok_or_else(early)?;
        if marker == 0xFF {
            at += 1;
            continue;
        }
        if marker == END_OF_IMAGE {
            break;
        }
        let body = segment(bytes, at + 2).ok_or_else(early)?;
        at += 4 + body.len();
        match marker {
            TABLES => read_tables(body, &mut tables)?,
            RESTART_INTERVAL => {
                let &[high, low] = body else {
                    return Err(cut("its restart interval is not one"));
                };
                restart = usize::from(u16::from_be_bytes([high, low]));
            }
            START_OF_SCAN => {
                let end = end_of_scan(bytes, at).ok_or_else(early)?;
                let decoder = decoder
                    .as_mut()
                    .ok_or_else(|| cut("a scan comes before the frame header"))?;
                (decoder.tables, decoder.restart) = (tables.clone(), restart);
                decoder.scan(body, bytes.get(at..end).unwrap_or_default())?;
                at = end;
            }
            marker if starts_frame(marker) => decoder = Some(Decoder::new(marker, body)?),
            _ => {}
        }
    }
    let planes = decoder.map(|decoder| decoder.planes).unwrap_or_default();
    match planes.iter().any(Vec::is_empty) || planes.is_empty() {
        true => Err(cut("not all of its components have pixels")),
        false => Ok(Planes { planes }),
    }
}

impl Decoder {
    fn new(marker: u8, body: &[u8]) -> Result<Self, Problem> {
        let header =
            frame_header(marker, body).ok_or_else(|| cut("its frame header is cut short"))?;
        let specifications = body.get(6..6 + 3 * usize::from(header.components));
        let specifications = specifications
            .ok_or_else(|| cut("its frame header is cut short"))?
            .as_chunks::<3>()
            .0;
        if specifications
            .iter()
            .any(|[_, sampling, _]| *sampling != specifications[0][1])
        {
            let what = "lossless colours of different resolutions";
            return Err(Problem::unsupported(FORMAT, what, REMEDY));
        }
        if !(2..=16).contains(&header.precision) {
            return Err(cut(&format!("it states {} bits a pixel", header.precision)));
        }
        Ok(Self {
            width: header.width.into(),
            height: header.height.into(),
            precision: header.precision.into(),
            components: specifications.iter().map(|[id, ..]| *id).collect(),
            tables: [const { None }; 4],
            restart: 0,
            planes: vec![Vec::new(); specifications.len()],
        })
    }

    /// One scan: its header and its coded bytes.
    fn scan(&mut self, header: &[u8], coded: &[u8]) -> Result<(), Problem> {
        let scan = Scan::read(header, &self.components, self.precision)?;
        let count = scan.components.len();
        let rows = match self.restart {
            0 => self.height,
            interval if interval % self.width == 0 => interval / self.width,
            _ => return Err(cut("its restart interval is no number of whole rows")),
        };
        let tables: Vec<&Table> = scan
            .components
            .iter()
            .map(|&(_, table)| self.tables[table].as_ref())
            .collect::<Option<_>>()
            .ok_or_else(|| cut("a scan names a code table that is not there"))?;
        let mut planes = vec![vec![0u16; self.width * self.height]; count];
        let mut intervals = intervals(coded).into_iter();
        for first in (0..self.height).step_by(rows) {
            let range = intervals
                .next()
                .ok_or_else(|| cut("a restart mark is missing"))?;
            let mut bits = Bits::new(&coded[range]);
            for row in first..(first + rows).min(self.height) {
                for column in 0..self.width {
                    for (plane, table) in planes.iter_mut().zip(&tables) {
                        let difference = table.difference(&mut bits)?;
                        let place = Place {
                            row,
                            column,
                            first,
                            width: self.width,
                        };
                        let predicted = scan.predict(plane, place);
                        plane[row * self.width + column] = predicted.wrapping_add(difference);
                    }
                }
            }
        }
        let most = u16::MAX >> (16 - self.precision);
        for (plane, &(component, _)) in planes.into_iter().zip(&scan.components) {
            self.planes[component] = plane
                .into_iter()
                .map(|value| (value << scan.shift) & most)
                .collect();
        }
        Ok(())
    }
}

/// What a scan header says.
struct Scan {
    /// Index of the component and of its code table.
    components: Vec<(usize, usize)>,
    predictor: u8,
    shift: u32,
    /// What the first sample is predicted as.
    middle: u16,
}

/// Where a sample stands; `first` is the row that a restart interval begins with.
#[derive(Clone, Copy)]
struct Place {
    row: usize,
    column: usize,
    first: usize,
    width: usize,
}

impl Scan {
    fn read(header: &[u8], components: &[u8], precision: u32) -> Result<Self, Problem> {
        let odd = || cut("a scan header is not one");
        let (&count, rest) = header.split_first().ok_or_else(odd)?;
        let (selectors, rest) = rest
            .split_at_checked(2 * usize::from(count))
            .ok_or_else(odd)?;
        let &[predictor, _, shift] = rest else {
            return Err(odd());
        };
        let shift = u32::from(shift & 0x0F);
        if !(1..=7).contains(&predictor) || shift >= precision || count == 0 {
            return Err(cut(&format!(
                "predictor {predictor} with a shift of {shift} bits is not possible"
            )));
        }
        let pairs = selectors.as_chunks::<2>().0.iter().map(|[id, tables]| {
            let component = components.iter().position(|known| known == id)?;
            Some((component, usize::from(tables >> 4)))
        });
        let pairs: Vec<_> = pairs.collect::<Option<_>>().ok_or_else(odd)?;
        if pairs.iter().any(|&(_, table)| table > 3) {
            return Err(odd());
        }
        Ok(Self {
            components: pairs,
            predictor,
            shift,
            middle: 1 << (precision - shift - 1),
        })
    }

    /// Table H.1, and what stands for it at the left and upper border.
    fn predict(
        &self,
        plane: &[u16],
        Place {
            row,
            column,
            first,
            width,
        }: Place,
    ) -> u16 {
        let at = row * width + column;
        if row == first {
            return if column == 0 {
                self.middle
            } else {
                plane[at - 1]
            };
        }
        let above = plane[at - width];
        if column == 0 {
            return above;
        }
        let (a, b, c) = (
            i32::from(plane[at - 1]),
            i32::from(above),
            i32::from(plane[at - width - 1]),
        );
        let value = match self.predictor {
            1 => a,
            2 => b,
            3 => c,
            4 => a + b - c,
            5 => a + ((b - c) >> 1),
            6 => b + ((a - c) >> 1),
            _ => (a + b) >> 1,
        };
        // Modulo 2^16, as the standard has it.
        value as u16
    }
}

/// The stretches of a scan between restart marks.
fn intervals(coded: &[u8]) -> Vec<Range<usize>> {
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

/// Bits of coded bytes, the zero after each 0xFF left out.
struct Bits<'a> {
    coded: &'a [u8],
    at: usize,
    held: u64,
    count: u32,
}

impl<'a> Bits<'a> {
    fn new(coded: &'a [u8]) -> Self {
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

    fn take(&mut self, length: u32) -> Result<u32, Problem> {
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
}

/// A code table: for each 16 bits, the length of the code that they begin with and its category.
#[derive(Clone)]
struct Table(Vec<[u8; 2]>);

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

    /// The next difference, modulo 2^16.
    fn difference(&self, bits: &mut Bits<'_>) -> Result<u16, Problem> {
        let [length, category] = self.0[bits.peek()];
        if length == 0 || category > 16 {
            return Err(cut("there are pixels in a code that is in no table"));
        }
        bits.take(length.into())?;
        let category = u32::from(category);
        match category {
            0 => Ok(0),
            16 => Ok(1 << 15),
            _ => {
                let value = bits.take(category)?;
                // The lower half stands for the negative differences.
                let below = if value >> (category - 1) == 0 {
                    (1 << category) - 1
                } else {
                    0
                };
                Ok(value.wrapping_sub(below) as u16)
            }
        }
    }
}

/// Reads a segment of code tables.
fn read_tables(mut body: &[u8], tables: &mut [Option<Table>; 4]) -> Result<(), Problem> {
    let odd = || cut("a code table is cut short");
    while let Some((&head, rest)) = body.split_first() {
        let (counts, rest) = rest.split_first_chunk::<16>().ok_or_else(odd)?;
        let total = counts.iter().map(|&count| usize::from(count)).sum();
        let (categories, rest) = rest.split_at_checked(total).ok_or_else(odd)?;
        // Tables of the other class are for other processes.
        if head >> 4 == 0 {
            let slot = tables.get_mut(usize::from(head & 0x0F)).ok_or_else(odd)?;
            *slot = Some(Table::new(counts, categories)?);
        }
        body = rest;
    }
    Ok(())
}
