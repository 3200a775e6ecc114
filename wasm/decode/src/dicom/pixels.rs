//! Grey pixels from stored samples.

use super::attributes::{Attributes, Photometric};
use super::problem::damaged;
use crate::error::Problem;
use crate::frame::{GreyFrame, Pixels, Window};
use crate::luminance::luminance;

/// A frame of uncompressed, little endian samples.
pub(super) fn frame_from_stored(
    stored: &[u8],
    attributes: &Attributes,
) -> Result<GreyFrame, Problem> {
    let area = attributes.width as usize * attributes.height as usize;
    let pixels = match attributes.photometric {
        Photometric::Monochrome1 | Photometric::Monochrome2 => {
            return monochrome(stored, attributes);
        }
        Photometric::Rgb if attributes.planar => planar_rgb(stored, area),
        Photometric::Rgb | Photometric::InsideJpeg => crate::luminance::grey_from_u8(stored, 3),
        Photometric::YbrFull if attributes.planar => stored.iter().copied().take(area).collect(),
        Photometric::YbrFull => stored.iter().copied().step_by(3).collect(),
        Photometric::YbrFull422 => {
            let quads = stored.as_chunks::<4>().0.iter();
            quads
                .flat_map(|&[first, second, ..]| [first, second])
                .collect()
        }
    };
    finish(Pixels::U8(pixels), attributes)
}

/// Colour planes one after the other.
fn planar_rgb(stored: &[u8], area: usize) -> Vec<u8> {
    let (red, rest) = stored.split_at(area.min(stored.len()));
    let (green, blue) = rest.split_at(area.min(rest.len()));
    let channels = red.iter().zip(green).zip(blue);
    channels
        .map(|((&r, &g), &b)| luminance(r.into(), g.into(), b.into()) as u8)
        .collect()
}

fn monochrome(stored: &[u8], attributes: &Attributes) -> Result<GreyFrame, Problem> {
    let pixels = match attributes.bits_allocated {
        8 => stored_to_grey(stored.iter().map(|&v| v.into()), attributes),
        _ => {
            let words = stored.as_chunks::<2>().0.iter().copied();
            stored_to_grey(words.map(u16::from_le_bytes), attributes)
        }
    };
    finish(pixels, attributes)
}

/// Takes the stored bits out of each sample and makes them unsigned, and high where the file shows them bright.
fn stored_to_grey(samples: impl Iterator<Item = u16>, attributes: &Attributes) -> Pixels {
    let shift = attributes.high_bit + 1 - attributes.bits_stored;
    let most = u16::MAX >> (16 - attributes.bits_stored);
    // Two's complement to offset binary, and inversion, are both an exclusive or.
    let sign = if attributes.signed { most / 2 + 1 } else { 0 };
    let inversion = if is_inverted(attributes) { most } else { 0 };
    let grey = samples.map(|v| ((v >> shift) & most) ^ sign ^ inversion);
    match attributes.bits_stored {
        ..=8 => Pixels::U8(grey.map(|v| v as u8).collect()),
        _ => Pixels::U16(grey.collect()),
    }
}

/// Whether a high stored value is shown dark.
fn is_inverted(attributes: &Attributes) -> bool {
    (attributes.photometric == Photometric::Monochrome1) != (attributes.slope < 0.0)
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
    if attributes.photometric == Photometric::InsideJpeg {
        return finish(image.pixels, attributes);
    }
    let grey = match image.pixels {
        Pixels::U8(values) => stored_to_grey(values.iter().map(|&v| v.into()), attributes),
        Pixels::U16(values) => stored_to_grey(values.into_iter(), attributes),
    };
    finish(grey, attributes)
}

fn finish(pixels: Pixels, attributes: &Attributes) -> Result<GreyFrame, Problem> {
    if pixels.len() != attributes.width as usize * attributes.height as usize {
        return Err(damaged("its pixels do not fill its stated size"));
    }
    let mut frame = GreyFrame::plain(attributes.width, attributes.height, pixels);
    frame.geometry = attributes.geometry;
    if matches!(
        attributes.photometric,
        Photometric::Monochrome1 | Photometric::Monochrome2
    ) {
        frame.bits = attributes.bits_stored as u8;
        frame.window = window(attributes);
        frame.notes = notes(attributes);
    }
    Ok(frame)
}

/// The stated window in units of the pixels handed out: rescale undone, sign offset and inversion done.
fn window(attributes: &Attributes) -> Option<Window> {
    let stated = attributes.window?;
    let (centre, width) = match stated.half_unit {
        true => (stated.centre - 0.5, stated.width - 1.0),
        false => (stated.centre, stated.width),
    };
    let most = f64::from(u16::MAX >> (16 - attributes.bits_stored));
    let mut centre = (centre - attributes.intercept) / attributes.slope;
    if attributes.signed {
        centre += (most + 1.0) / 2.0;
    }
    if is_inverted(attributes) {
        centre = most - centre;
    }
    let width = (width / attributes.slope.abs()).max(1.0);
    (centre.is_finite() && width.is_finite()).then_some(Window { centre, width })
}

fn notes(attributes: &Attributes) -> Vec<String> {
    let mut notes = Vec::new();
    if is_inverted(attributes) {
        notes.push("Inverted so that bright is high (the file stores bright as low).".to_owned());
    }
    if attributes.signed {
        notes.push("Signed pixels were moved up by half their range.".to_owned());
    }
    if (attributes.slope, attributes.intercept) != (1.0, 0.0) {
        notes.push(format!(
            "Pixels are as stored; the file's rescale (slope {}, intercept {}) is applied to the window alone.",
            attributes.slope, attributes.intercept
        ));
    }
    notes
}
