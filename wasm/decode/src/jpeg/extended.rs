//! Grey of 12 bits in cosines (processes 2 and 4, sequential), after ITU-T T.81 annexes A and F.
//!
//! X-ray angiography writes this coding, and the library that decodes the others knows 8 bits alone. The markers have been
//! walked before.

use super::huffman::{Bits, Table, Tables, intervals};
use super::markers::{
    END_OF_IMAGE, Process, QUANTISATION, RESTART_INTERVAL, START_OF_SCAN, TABLES, cut, end_of_scan,
    frame_header, restart_interval, segment, starts_frame,
};
use crate::error::Problem;

/// Pixels along a block's side, and of a block.
const SIDE: usize = 8;
const BLOCK: usize = SIDE * SIDE;

/// Where the coefficients of a block stand in it, in the order in which they are coded: along diagonals.
const DIAGONALS: [u8; BLOCK] = [
    0, 1, 8, 16, 9, 2, 3, 10, 17, 24, 32, 25, 18, 11, 4, 5, 12, 19, 26, 33, 40, 48, 41, 34, 27, 20,
    13, 6, 7, 14, 21, 28, 35, 42, 49, 56, 57, 50, 43, 36, 29, 22, 15, 23, 30, 37, 44, 51, 58, 59,
    52, 45, 38, 31, 39, 46, 53, 60, 61, 54, 47, 55, 62, 63,
];

/// cos(k pi / 16) / 2 for k from 0 to 8; the same digits on every machine.
const HALF_COSINES: [f32; 9] = [
    0.5,
    0.490_392_65,
    0.461_939_78,
    0.415_734_8,
    0.353_553_4,
    0.277_785_1,
    0.191_341_71,
    0.097_545_16,
    0.0,
];

type Factors = [u16; BLOCK];

/// Pixels row by row of the only component of an image whose markers are sound and whose area is allowed.
pub(super) fn decode(bytes: &[u8]) -> Result<Vec<u16>, Problem> {
    let early = || cut("it ends before the end-of-image mark");
    let mut factors = [const { None }; 4];
    let (mut tables, mut restart, mut frame) = (Tables::default(), 0, None);
    let mut at = 2;
    loop {
        let marker = *bytes.get(at + 1).ok_or_else(early)?;
        if marker == 0xFF {
            at += 1;
            continue;
        }
        if marker == END_OF_IMAGE {
            return Err(cut("it has no image between its marks"));
        }
        let body = segment(bytes, at + 2).ok_or_else(early)?;
        at += 4 + body.len();
        match marker {
            TABLES => tables.read(body)?,
            QUANTISATION => read_factors(body, &mut factors)?,
            RESTART_INTERVAL => restart = restart_interval(body)?,
            START_OF_SCAN => {
                let frame: Frame =
                    frame.ok_or_else(|| cut("a scan comes before the frame header"))?;
                let end = end_of_scan(bytes, at, Process::Sequential).ok_or_else(early)?;
                let missing = || cut("a scan names a table that is not there");
                let &[1, _, table, ..] = body else {
                    return Err(cut("a scan header is not one"));
                };
                let scan = Scan {
                    frame,
                    factors: factors[frame.factors].as_ref().ok_or_else(missing)?,
                    means: tables.lengths((table >> 4).into())?,
                    others: tables.coefficients((table & 0x0F).into())?,
                    restart,
                };
                return scan.pixels(&bytes[at..end]);
            }
            marker if starts_frame(marker) => frame = Some(Frame::read(marker, body)?),
            _ => {}
        }
    }
}

/// What the frame header says.
#[derive(Clone, Copy)]
struct Frame {
    width: usize,
    height: usize,
    precision: u8,
    /// Which table the coefficients are multiplied by.
    factors: usize,
}

impl Frame {
    fn read(marker: u8, body: &[u8]) -> Result<Self, Problem> {
        let short = || cut("its frame header is cut short");
        let header = frame_header(marker, body).ok_or_else(short)?;
        let factors = usize::from(*body.get(8).ok_or_else(short)?);
        match factors {
            0..4 => Ok(Self {
                width: header.width.into(),
                height: header.height.into(),
                precision: header.precision,
                factors,
            }),
            _ => Err(cut("it names a table that there cannot be")),
        }
    }
}

struct Scan<'a> {
    frame: Frame,
    factors: &'a Factors,
    means: Table,
    others: Table,
    restart: usize,
}

impl Scan<'_> {
    /// Blocks follow each other row by row; those at the right and lower border reach beyond the image.
    fn pixels(&self, coded: &[u8]) -> Result<Vec<u16>, Problem> {
        let Frame {
            width,
            height,
            precision,
            ..
        } = self.frame;
        let (across, down) = (width.div_ceil(SIDE), height.div_ceil(SIDE));
        let interval = if self.restart == 0 {
            across * down
        } else {
            self.restart
        };
        let most = f32::from(u16::MAX >> (16 - precision));
        let middle = (most + 1.0) / 2.0;
        let mut pixels = vec![0; width * height];
        let mut stretches = intervals(coded).into_iter();
        for first in (0..across * down).step_by(interval) {
            let stretch = stretches
                .next()
                .ok_or_else(|| cut("a restart mark is missing"))?;
            let (mut bits, mut mean) = (Bits::new(&coded[stretch]), 0);
            for block in first..(first + interval).min(across * down) {
                let values = cosines(&self.coefficients(&mut bits, &mut mean)?);
                let (left, top) = (block % across * SIDE, block / across * SIDE);
                for (row, values) in (top..height).zip(values.as_chunks::<SIDE>().0) {
                    let row = &mut pixels[row * width..][..width];
                    for (pixel, value) in row[left..].iter_mut().zip(values) {
                        *pixel = (value + middle).round().clamp(0.0, most) as u16;
                    }
                }
            }
        }
        Ok(pixels)
    }

    /// The coefficients of the next block, row by row, multiplied; `mean` is that of the block before.
    fn coefficients(&self, bits: &mut Bits<'_>, mean: &mut i32) -> Result<[f32; BLOCK], Problem> {
        let mut block = [0.0; BLOCK];
        *mean = i32::from((*mean as i16).wrapping_add(self.means.difference(bits)? as i16));
        block[0] = (*mean * i32::from(self.factors[0])) as f32;
        let mut at = 1;
        while at < BLOCK {
            let code = self.others.category(bits)?;
            let (zeros, length) = (usize::from(code >> 4), u32::from(code & 0x0F));
            match (zeros, length) {
                (15, 0) => at += 16,
                (_, 0) => break,
                _ => {
                    at += zeros;
                    let value = bits.signed(length)?;
                    let place = *DIAGONALS
                        .get(at)
                        .ok_or_else(|| cut("a block has too many coefficients"))?;
                    block[usize::from(place)] = (value * i32::from(self.factors[at])) as f32;
                    at += 1;
                }
            }
        }
        Ok(block)
    }
}

/// Values from coefficients: the inverse cosine transform, along rows and then along columns.
fn cosines(block: &[f32; BLOCK]) -> [f32; BLOCK] {
    let mut turned = *block;
    for _ in 0..2 {
        let source = turned;
        for (line, coefficients) in source.as_chunks::<SIDE>().0.iter().enumerate() {
            for place in 0..SIDE {
                let terms = coefficients.iter().enumerate();
                let value = terms.map(|(wave, coefficient)| coefficient * weight(wave, place));
                // Written in columns, so that the second time turns rows and columns back.
                turned[place * SIDE + line] = value.sum();
            }
        }
    }
    turned
}

/// What a wave of so many half periods in a block is at a place, halved; the mean is weighted down.
fn weight(wave: usize, place: usize) -> f32 {
    if wave == 0 {
        return HALF_COSINES[4];
    }
    match wave * (2 * place + 1) % 32 {
        turn @ 0..=8 => HALF_COSINES[turn],
        turn @ 9..=16 => -HALF_COSINES[16 - turn],
        turn @ 17..=24 => -HALF_COSINES[turn - 16],
        turn => HALF_COSINES[32 - turn],
    }
}

/// Reads a segment of factors, of 8 or 16 bits each.
fn read_factors(mut body: &[u8], factors: &mut [Option<Factors>; 4]) -> Result<(), Problem> {
    let odd = || cut("a table of factors is cut short");
    while let Some((&head, rest)) = body.split_first() {
        let (values, rest): (Vec<u16>, _) = match head >> 4 {
            0 => {
                let (values, rest) = rest.split_at_checked(BLOCK).ok_or_else(odd)?;
                (values.iter().map(|&value| value.into()).collect(), rest)
            }
            _ => {
                let (values, rest) = rest.split_at_checked(2 * BLOCK).ok_or_else(odd)?;
                let words = values.as_chunks::<2>().0.iter();
                (words.map(|&word| u16::from_be_bytes(word)).collect(), rest)
            }
        };
        let slot = factors.get_mut(usize::from(head & 0x0F)).ok_or_else(odd)?;
        *slot = values.try_into().ok();
        body = rest;
    }
    Ok(())
}
