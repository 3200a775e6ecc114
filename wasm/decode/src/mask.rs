//! Mask images: which pixels belong to the implant.

use crate::error::{DecodeError, Problem};
use crate::file::FrameFile;
use crate::frame::{GreyFrame, Pixels};
use crate::sniff::Kind;

/// A mask of one byte a pixel.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MaskImage {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// `width * height` pixels, row by row from the top: 1 inside, 0 outside.
    pub pixels: Vec<u8>,
}

impl MaskImage {
    /// Pixels inside.
    pub fn area(&self) -> usize {
        self.pixels.iter().filter(|&&inside| inside != 0).count()
    }
}

/// Which pixel values are inside a mask.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MaskRule {
    /// Every value but 0: masks are stored as 0 and 1, 0 and 255, or as labels.
    NonZero,
    /// Values of at least this.
    AtLeast(u16),
}

/// Decodes a mask image. Every pixel that is not 0 is inside; in a JPEG, whose coding leaves ripples around every edge,
/// every pixel of at least 128.
///
/// # Errors
/// [`DecodeError`] if the file is not an image, is damaged, too large, or holds more than one frame.
pub fn decode_mask(bytes: &[u8], name: &str) -> Result<MaskImage, DecodeError> {
    let rule = match crate::sniff::sniff(bytes, name) {
        Kind::Jpeg => MaskRule::AtLeast(128),
        _ => MaskRule::NonZero,
    };
    decode_mask_by(bytes, name, rule)
}

/// Decodes a mask image by a rule.
///
/// # Errors
/// Those of [`decode_mask`].
pub fn decode_mask_by(bytes: &[u8], name: &str, rule: MaskRule) -> Result<MaskImage, DecodeError> {
    let file = FrameFile::open(bytes, name)?;
    match file.count() {
        1 => Ok(mask_of(&file.frame(0)?, rule)),
        count => Err(Problem::SeveralMasks { count }.of(name)),
    }
}

/// The mask of a decoded frame.
pub fn mask_of(frame: &GreyFrame, rule: MaskRule) -> MaskImage {
    let least = match rule {
        MaskRule::NonZero => 1,
        MaskRule::AtLeast(least) => least,
    };
    let pixels = match &frame.pixels {
        Pixels::U8(p) => p.iter().map(|&v| u8::from(u16::from(v) >= least)).collect(),
        Pixels::U16(p) => p.iter().map(|&v| u8::from(v >= least)).collect(),
    };
    MaskImage {
        width: frame.width,
        height: frame.height,
        pixels,
    }
}
