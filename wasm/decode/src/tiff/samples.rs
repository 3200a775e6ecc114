//! Greys from the samples of a page.

use tiff::decoder::DecodingResult;

use super::problem::FORMAT;
use crate::error::Problem;
use crate::frame::Pixels;
use crate::luminance::{grey_from_u8, grey_from_u16, luminance, weighted};
use crate::numbers::{Range, in_16_bits};

/// How the samples of a page are stored.
#[derive(Clone, Copy)]
pub(super) enum Layout {
    /// Grey of 1, 2 or 4 bits, packed, each row beginning at a byte.
    Packed(u8),
    /// This number of whole samples for each pixel. The first three are colours, or the first is grey.
    Channels(usize),
    /// So many planes one after the other, each of so many samples.
    Planes(usize, usize),
}

impl Layout {
    /// Where the samples of each pixel are: how many of colour or grey count, the distance between pixels, and between the
    /// samples of one.
    fn steps(self) -> (usize, usize, usize) {
        let counted = |channels: usize| if channels >= 3 { 3 } else { 1 };
        match self {
            Self::Packed(_) => (1, 1, 1),
            Self::Channels(channels) => (counted(channels), channels, 1),
            Self::Planes(planes, length) => (counted(planes), 1, length),
        }
    }

    /// Calls with the colours or the grey of each pixel.
    fn pixels<T: Copy, G>(
        self,
        samples: &[T],
        grey: impl Fn(T) -> G,
        colour: impl Fn([T; 3]) -> G,
    ) -> Vec<G> {
        let (counted, pixel, sample) = self.steps();
        let last = (counted - 1) * sample;
        let count = samples.len().saturating_sub(last).div_ceil(pixel);
        let count = if let Self::Planes(_, length) = self {
            count.min(length)
        } else {
            count
        };
        (0..count)
            .map(|i| i * pixel)
            .map(|at| match counted {
                3 => colour([samples[at], samples[at + sample], samples[at + 2 * sample]]),
                _ => grey(samples[at]),
            })
            .collect()
    }
}

/// Greys from what the library decoded; `notes` tell what was done to them.
pub(super) fn grey(
    samples: DecodingResult,
    layout: Layout,
    width: usize,
    notes: &mut Vec<String>,
) -> Result<Pixels, Problem> {
    let bytes = |s: &[u8]| match layout {
        Layout::Channels(channels) => grey_from_u8(s, channels),
        _ => layout.pixels(
            s,
            |v| v,
            |[r, g, b]| luminance(r.into(), g.into(), b.into()) as u8,
        ),
    };
    let words = |s: Vec<u16>| match layout {
        Layout::Channels(channels) => grey_from_u16(s.into_iter(), channels),
        _ => layout.pixels(&s, |v| v, |[r, g, b]| luminance(r, g, b)),
    };
    Ok(match (samples, layout) {
        (DecodingResult::U8(s), Layout::Packed(bits)) => {
            Pixels::U8(spread(unpack(&s, bits, width), bits))
        }
        (_, Layout::Packed(_)) => {
            return Err(Problem::damaged(
                FORMAT,
                "its bits are packed in an unknown way",
            ));
        }
        (DecodingResult::U8(s), _) => Pixels::U8(bytes(&s)),
        (DecodingResult::U16(s), _) => Pixels::U16(words(s)),
        (DecodingResult::I8(s), _) => {
            notes.push("Signed pixels were moved up by 128.".to_owned());
            let moved: Vec<u8> = s.iter().map(|v| v.cast_unsigned() ^ 0x80).collect();
            Pixels::U8(bytes(&moved))
        }
        (DecodingResult::I16(s), _) => {
            notes.push("Signed pixels were moved up by 32768.".to_owned());
            Pixels::U16(words(
                s.into_iter().map(|v| v.cast_unsigned() ^ 0x8000).collect(),
            ))
        }
        (DecodingResult::U32(s), _) => mixed(&s, layout, true, f64::from, notes),
        (DecodingResult::U64(s), _) => mixed(&s, layout, true, |v| v as f64, notes),
        (DecodingResult::I32(s), _) => mixed(&s, layout, true, f64::from, notes),
        (DecodingResult::I64(s), _) => mixed(&s, layout, true, |v| v as f64, notes),
        (DecodingResult::F16(s), _) => mixed(&s, layout, false, f64::from, notes),
        (DecodingResult::F32(s), _) => mixed(&s, layout, false, f64::from, notes),
        (DecodingResult::F64(s), _) => mixed(&s, layout, false, |v| v, notes),
    })
}

/// Greys, or the luminance of colours.
fn mixed<T: Copy>(
    samples: &[T],
    layout: Layout,
    are_whole: bool,
    number: impl Fn(T) -> f64,
    notes: &mut Vec<String>,
) -> Pixels {
    let values = layout.pixels(samples, &number, |colours| weighted(colours.map(&number)));
    let range = Range::of(values.iter().copied(), are_whole);
    in_16_bits(values.into_iter(), range, notes)
}

/// The numbers of a page of fewer than 8 bits.
pub(super) fn unpack(packed: &[u8], bits: u8, width: usize) -> Vec<u8> {
    let each = 8 / usize::from(bits);
    let most = (1u16 << bits) - 1;
    let row = |row: &[u8]| -> Vec<u8> {
        let value = |i: usize| {
            let shift = 8 - usize::from(bits) * (i % each + 1);
            u16::from(row[i / each] >> shift) & most
        };
        (0..width).map(|i| value(i) as u8).collect()
    };
    packed
        .chunks_exact(width.div_ceil(each))
        .flat_map(row)
        .collect()
}

/// Grey of fewer than 8 bits, spread over 0 to 255.
fn spread(values: Vec<u8>, bits: u8) -> Vec<u8> {
    let most = (1u16 << bits) - 1;
    let each = values
        .into_iter()
        .map(|value| u16::from(value) * 255 / most);
    each.map(|value| value as u8).collect()
}

/// The luminance of each colour whose number is stored; 8 bits where the palette has no more.
pub(super) fn colours(numbers: &Pixels, palette: &[u16]) -> Result<Pixels, Problem> {
    let (red, rest) = palette.split_at(palette.len() / 3);
    let (green, blue) = rest.split_at(red.len());
    // Some programs write entries of 8 bits as they are, others twice into 16.
    let few = palette.iter().all(|&entry| entry <= 255);
    let narrow = few || palette.iter().all(|&entry| entry % 257 == 0);
    let narrowed = |entry: u16| if narrow && !few { entry / 257 } else { entry };
    let entries: Vec<u16> = red
        .iter()
        .zip(green)
        .zip(blue)
        .map(|((&r, &g), &b)| luminance(narrowed(r), narrowed(g), narrowed(b)))
        .collect();
    let numbered = (0..numbers.len()).filter_map(|at| entries.get(usize::from(numbers.get(at)?)));
    let grey: Vec<u16> = numbered.copied().collect();
    if grey.len() < numbers.len() {
        return Err(Problem::damaged(
            FORMAT,
            "a pixel names a colour that is not in the palette",
        ));
    }
    Ok(match narrow {
        true => Pixels::U8(grey.into_iter().map(|value| value as u8).collect()),
        false => Pixels::U16(grey),
    })
}
