//! Grey pixels from stored samples.

use std::borrow::Cow;

use super::attributes::{Attributes, Narrowing, Photometric};
use super::native::{bits, long_words, words};
use super::palette::Palette;
use super::problem::damaged;
use super::shown;
use crate::error::Problem;
use crate::frame::{GreyFrame, Pixels};
use crate::luminance::{grey_from_u8, grey_from_u16, luminance};

/// Little endian samples of a frame, and how many bits of the first byte are another frame's.
pub(super) struct Stored<'a> {
    pub bytes: Cow<'a, [u8]>,
    pub skipped: u32,
}

/// A frame of uncompressed samples.
pub(super) fn frame_from_stored(
    stored: &Stored<'_>,
    attributes: &Attributes,
) -> Result<GreyFrame, Problem> {
    let bytes = stored.bytes.as_ref();
    let area = attributes.width as usize * attributes.height as usize;
    let pixels = match (&attributes.photometric, attributes.bits_allocated) {
        (Photometric::Monochrome1 | Photometric::Monochrome2, 1) => {
            greys(bits(bytes, stored.skipped, area), attributes)
        }
        (Photometric::Monochrome1 | Photometric::Monochrome2, 8) => {
            greys(bytes.iter().map(|&byte| byte.into()), attributes)
        }
        (Photometric::Monochrome1 | Photometric::Monochrome2, 16) => {
            greys(words(bytes), attributes)
        }
        (Photometric::Monochrome1 | Photometric::Monochrome2, _) => {
            greys(long_words(bytes), attributes)
        }
        (Photometric::Palette(palette), 8) => {
            colours(bytes.iter().map(|&byte| byte.into()), palette, attributes)
        }
        (Photometric::Palette(palette), _) => colours(words(bytes), palette, attributes),
        (Photometric::YbrFull422, _) => {
            let quads = bytes.as_chunks::<4>().0.iter();
            Pixels::U8(
                quads
                    .flat_map(|&[first, second, ..]| [first, second])
                    .collect(),
            )
        }
        (_, 8) => Pixels::U8(luminances_of_8_bits(bytes, area, attributes)),
        _ => Pixels::U16(luminances_of_16_bits(bytes, area, attributes)),
    };
    finish(pixels, attributes)
}

fn luminances_of_8_bits(stored: &[u8], area: usize, attributes: &Attributes) -> Vec<u8> {
    match (&attributes.photometric, attributes.planar) {
        (Photometric::YbrFull, true) => stored.iter().copied().take(area).collect(),
        (Photometric::YbrFull, false) => stored.iter().copied().step_by(3).collect(),
        (_, true) => {
            let (red, rest) = stored.split_at(area.min(stored.len()));
            let (green, blue) = rest.split_at(area.min(rest.len()));
            let channels = red.iter().zip(green).zip(blue);
            channels
                .map(|((&r, &g), &b)| luminance(r.into(), g.into(), b.into()) as u8)
                .collect()
        }
        (_, false) => grey_from_u8(stored, 3),
    }
}

fn luminances_of_16_bits(stored: &[u8], area: usize, attributes: &Attributes) -> Vec<u16> {
    let samples = || words(stored).map(|word| word as u16);
    match (&attributes.photometric, attributes.planar) {
        (Photometric::YbrFull, true) => samples().take(area).collect(),
        (Photometric::YbrFull, false) => samples().step_by(3).collect(),
        (_, true) => {
            let channels = samples()
                .zip(samples().skip(area))
                .zip(samples().skip(2 * area));
            channels.map(|((r, g), b)| luminance(r, g, b)).collect()
        }
        (_, false) => grey_from_u16(samples(), 3),
    }
}

/// The stored bits of a sample; two's complement becomes offset binary.
fn stored_bits(sample: u32, attributes: &Attributes) -> u32 {
    let shift = attributes.high_bit + 1 - attributes.bits_stored;
    let most = u32::MAX >> (32 - attributes.bits_stored);
    let sign = if attributes.signed { most / 2 + 1 } else { 0 };
    ((sample >> shift) & most) ^ sign
}

/// Takes the stored bits out of each sample and makes them unsigned, and high where the file shows them bright.
fn greys(samples: impl Iterator<Item = u32>, attributes: &Attributes) -> Pixels {
    let most = u16::MAX >> (16 - attributes.depth);
    let inversion = if attributes.is_inverted() { most } else { 0 };
    let Narrowing { low, shift } = attributes.narrowing;
    let grey = samples.map(|sample| {
        let value = stored_bits(sample, attributes).saturating_sub(low) >> shift;
        value as u16 ^ inversion
    });
    match attributes.depth {
        ..=8 => Pixels::U8(grey.map(|v| v as u8).collect()),
        _ => Pixels::U16(grey.collect()),
    }
}

/// The luminance of each colour whose number is stored.
fn colours(
    samples: impl Iterator<Item = u32>,
    palette: &Palette,
    attributes: &Attributes,
) -> Pixels {
    let below = match attributes.signed {
        true => 1 << (attributes.bits_stored - 1),
        false => 0,
    };
    let numbers = samples.map(|sample| stored_bits(sample, attributes).cast_signed() - below);
    let grey = numbers.map(|number| palette.luminance(number));
    match palette.bits {
        8 => Pixels::U8(grey.map(|v| v as u8).collect()),
        _ => Pixels::U16(grey.collect()),
    }
}

/// Least and greatest stored value of a frame of more than 16 bits, as offset binary.
pub(super) fn extent(stored: &Stored<'_>, attributes: &Attributes) -> (u32, u32) {
    let values = long_words(&stored.bytes).map(|sample| stored_bits(sample, attributes));
    values.fold((u32::MAX, 0), |(low, high), v| (low.min(v), high.max(v)))
}

/// The frame of a decoded JPEG or JPEG 2000 image, whose pixels are stored values of one byte or of two.
pub(super) fn frame_from_jpeg(
    image: GreyFrame,
    attributes: &Attributes,
) -> Result<GreyFrame, Problem> {
    if (image.width, image.height) != (attributes.width, attributes.height) {
        return Err(damaged(format!(
            "it states {} x {} pixels and its compressed image has {} x {}",
            attributes.width, attributes.height, image.width, image.height
        )));
    }
    let from = |samples: &mut dyn Iterator<Item = u32>| match &attributes.photometric {
        Photometric::Palette(palette) => colours(samples, palette, attributes),
        _ => greys(samples, attributes),
    };
    let pixels = match image.pixels {
        pixels if attributes.photometric == Photometric::InsideJpeg => pixels,
        Pixels::U8(values) => from(&mut values.into_iter().map(u32::from)),
        Pixels::U16(values) => from(&mut values.into_iter().map(u32::from)),
    };
    finish(pixels, attributes)
}

fn finish(pixels: Pixels, attributes: &Attributes) -> Result<GreyFrame, Problem> {
    if pixels.len() != attributes.width as usize * attributes.height as usize {
        return Err(damaged("its pixels do not fill its stated size"));
    }
    let mut frame = GreyFrame::plain(attributes.width, attributes.height, pixels);
    frame.geometry = attributes.geometry;
    let size = (frame.width, frame.height);
    (frame.shutter, frame.notes) = shown::shutter_and_notes(attributes, size);
    if attributes.is_grey() {
        frame.bits = attributes.depth as u8;
        frame.window = shown::window(attributes);
    }
    Ok(frame)
}
