//! A disguised frame as a file.

use std::io::Cursor;
use std::path::Path;

use anyhow::{Context, Result};
use fluoropose_phantom::picture::{write_grey, write_grey_16};
use jpeg_encoder::{ColorType, Encoder};
use tiff::encoder::TiffEncoder;
use tiff::encoder::colortype::{Gray8, Gray16};

use super::picture::Picture;
use super::plan::Kind;
use crate::files::write_bytes;

impl Kind {
    /// The ending of its files' names.
    pub(super) fn ending(self) -> &'static str {
        match self {
            Self::Png8 | Self::Png16 => "png",
            Self::Tiff8 | Self::Tiff12 => "tif",
            Self::Jpeg85 => "jpg",
            _ => "dcm",
        }
    }

    fn bits(self) -> u16 {
        match self {
            Self::Png8 | Self::Tiff8 | Self::Jpeg85 | Self::Dicom8 => 8,
            Self::Tiff12 | Self::Dicom12 | Self::Dicom12Inverse => 12,
            Self::Png16 | Self::Dicom16 => 16,
        }
    }
}

impl Picture {
    /// Writes it.
    ///
    /// # Errors
    /// Names the file.
    pub(super) fn write(&self, path: &Path, kind: Kind) -> Result<()> {
        let white = f64::from((1u32 << kind.bits()) - 1);
        let stored = |value: &f64| (value * white).round().clamp(0.0, white) as u16;
        let words: Vec<u16> = self.pixels.iter().map(stored).collect();
        let bytes = || words.iter().map(|&word| word as u8).collect::<Vec<u8>>();
        let (size, [width, height]) = (
            (self.width, self.height),
            [self.width, self.height].map(|side| side as u16),
        );
        let mut file = Vec::new();
        match kind {
            Kind::Png8 => return write_grey(path, size, &bytes()),
            Kind::Png16 => return write_grey_16(path, size, &words),
            Kind::Jpeg85 => {
                Encoder::new(&mut file, 85).encode(&bytes(), width, height, ColorType::Luma)?
            }
            Kind::Tiff8 | Kind::Tiff12 => {
                let mut out = TiffEncoder::new(Cursor::new(&mut file))?;
                let (width, height) = (u32::from(width), u32::from(height));
                match kind {
                    Kind::Tiff8 => out.write_image::<Gray8>(width, height, &bytes()),
                    _ => out.write_image::<Gray16>(width, height, &words),
                }
                .with_context(|| path.display().to_string())?;
            }
            Kind::Dicom8 | Kind::Dicom12 | Kind::Dicom16 | Kind::Dicom12Inverse => {
                let last = white as u16;
                let inverse = kind == Kind::Dicom12Inverse;
                let word = |word: u16| if inverse { last - word } else { word };
                file = dicom(
                    [width, height],
                    kind.bits(),
                    inverse,
                    words.into_iter().map(word),
                );
            }
        }
        write_bytes(path, &file)
    }
}

/// A DICOM file of one frame, explicit little endian, with what an image needs and no more (PS3.5, PS3.10).
fn dicom(
    [columns, rows]: [u16; 2],
    bits: u16,
    inverse: bool,
    words: impl Iterator<Item = u16>,
) -> Vec<u8> {
    let allocated = if bits == 8 { 8 } else { 16 };
    let mut pixels: Vec<u8> = match allocated {
        8 => words.map(|word| word as u8).collect(),
        _ => words.flat_map(u16::to_le_bytes).collect(),
    };
    if pixels.len() % 2 == 1 {
        pixels.push(0);
    }
    let mut syntax = Vec::new();
    element(&mut syntax, 0x0002_0010, *b"UI", b"1.2.840.10008.1.2.1\0");
    let mut file = vec![0; 128];
    file.extend(b"DICM");
    element(
        &mut file,
        0x0002_0000,
        *b"UL",
        &(syntax.len() as u32).to_le_bytes(),
    );
    file.extend(syntax);
    element(&mut file, 0x0028_0002, *b"US", &1u16.to_le_bytes());
    let shown: &[u8] = if inverse {
        b"MONOCHROME1 "
    } else {
        b"MONOCHROME2 "
    };
    element(&mut file, 0x0028_0004, *b"CS", shown);
    for (tag, value) in [
        (0x10, rows),
        (0x11, columns),
        (0x100, allocated),
        (0x101, bits),
        (0x102, bits - 1),
        (0x103, 0),
    ] {
        element(&mut file, 0x0028_0000 | tag, *b"US", &value.to_le_bytes());
    }
    element(&mut file, 0x7FE0_0010, *b"OW", &pixels);
    file
}

/// A tag, its representation, length and value.
fn element(out: &mut Vec<u8>, tag: u32, representation: [u8; 2], value: &[u8]) {
    out.extend(((tag >> 16) as u16).to_le_bytes());
    out.extend((tag as u16).to_le_bytes());
    out.extend(representation);
    match &representation {
        b"OW" => {
            out.extend([0, 0]);
            out.extend((value.len() as u32).to_le_bytes());
        }
        _ => out.extend((value.len() as u16).to_le_bytes()),
    }
    out.extend(value);
}
