//! JPEG 2000: bare codestreams, as DICOM files hold them, and JP2 files; lossless and lossy, 1 to 16 bits.
//!
//! The tile-parts are walked before the library sees a byte: the library fills what is missing from a cut file, and a wrong
//! measurement is worse than none; and it reserves what headers state, so that they are held against the bytes there are.

mod problem;

mod codestream;

mod packets;

use hayro_jpeg2000::{DecodeSettings, DecoderContext, Image};

use crate::error::Problem;
use crate::frame::{GreyFrame, Pixels, can_hold, checked_area};
use crate::luminance::{ComponentColours, luminance};
pub(crate) use codestream::{CODESTREAM, JP2};
use codestream::{Size, codestream, size, walk};
use problem::{FORMAT, REMEDY, damaged};

/// Frames of so many bytes (1024 x 1024 of 16 bits) may be blank, of which an image tells in some hundred bytes.
const MOST_BLANK_BYTES: u64 = 2 << 20;

fn checked(bytes: &[u8]) -> Result<Size, Problem> {
    let stream = codestream(bytes)?;
    let size = size(stream)?;
    let area = checked_area(size.width.into(), size.height.into())?;
    if !matches!(size.components, 1 | 3) {
        return Err(Problem::unsupported(
            FORMAT,
            format!("{} colour channels", size.components),
            REMEDY,
        ));
    }
    if !(1..=16).contains(&size.bits) {
        return Err(Problem::unsupported(
            FORMAT,
            format!("{}-bit pixels", size.bits),
            REMEDY,
        ));
    }
    let bits = u64::from(size.bits) * u64::from(size.components);
    let blank = area as u64 * bits / 8 <= MOST_BLANK_BYTES;
    if !blank && !can_hold(bytes.len(), area, bits) {
        return Err(damaged("it is too short for its stated size"));
    }
    packets::check(stream.len(), &size, &walk(stream)?)?;
    Ok(size)
}

/// Checks the structure: whether this is one whole image of a kind and size that is read. Width and height.
pub(crate) fn check(bytes: &[u8]) -> Result<(u32, u32), Problem> {
    let size = checked(bytes)?;
    Ok((size.width, size.height))
}

/// Decodes an image file.
pub(crate) fn decode(bytes: &[u8]) -> Result<GreyFrame, Problem> {
    decode_as(bytes, ComponentColours::Rgb, false)
}

/// Decodes the image of a DICOM file. `colour` says what three components are. Signed samples are moved up by half their
/// range, or with `two_s_complement` returned as stored. Of a JP2 file, against the standard, the codestream alone counts.
pub(crate) fn decode_with(
    bytes: &[u8],
    colour: ComponentColours,
    two_s_complement: bool,
) -> Result<GreyFrame, Problem> {
    decode_as(codestream(bytes)?, colour, two_s_complement)
}

fn decode_as(
    bytes: &[u8],
    colour: ComponentColours,
    two_s_complement: bool,
) -> Result<GreyFrame, Problem> {
    let size = checked(bytes)?;
    let area = checked_area(size.width.into(), size.height.into())?;
    let failed = |e: hayro_jpeg2000::error::DecodeError| damaged(e.to_string());
    let settings = DecodeSettings {
        resolve_palette_indices: false,
        strict: true,
        target_resolution: None,
    };
    let image = Image::new(bytes, &settings).map_err(failed)?;
    let mut context = DecoderContext::default();
    let decoded = image.decode(&mut context).map_err(failed)?;
    let most = u16::MAX >> (16 - size.bits);
    let flipped = if size.signed && two_s_complement {
        most / 2 + 1
    } else {
        0
    };
    let whole = |sample: &f32| (sample.round().clamp(0.0, f32::from(most)) as u16) ^ flipped;
    let grey: Vec<u16> = match (decoded.components(), colour) {
        ([red, green, blue], ComponentColours::Rgb) => {
            let channels = red
                .samples()
                .iter()
                .zip(green.samples())
                .zip(blue.samples());
            channels
                .map(|((r, g), b)| luminance(whole(r), whole(g), whole(b)))
                .collect()
        }
        ([first, ..], _) => first.samples().iter().map(whole).collect(),
        ([], _) => Vec::new(),
    };
    if grey.len() != area {
        return Err(damaged("its pixels do not fill its stated size"));
    }
    let pixels = match size.bits {
        ..=8 => Pixels::U8(grey.into_iter().map(|value| value as u8).collect()),
        _ => Pixels::U16(grey),
    };
    let mut frame = GreyFrame::plain(size.width, size.height, pixels);
    frame.bits = size.bits;
    if size.signed && !two_s_complement {
        frame
            .notes
            .push("Signed pixels were moved up by half their range.".to_owned());
    }
    Ok(frame)
}
