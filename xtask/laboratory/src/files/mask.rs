//! Silhouettes from files.

use std::path::Path;

use anyhow::{Result, bail};
use fluoropose_decode::{FrameFile, Pixels, decode_mask};
use fluoropose_noise::MaskBuffer;

use super::text::read;

/// Greys that are told apart where an image may be no mask.
const GREYS: usize = 128;
/// The part of the way from black to white that is still taken for either.
const NEAR_EITHER: f64 = 0.06;

/// Whether an image has many greys, and more of it than the border of a smooth mask is between black and white.
fn is_grey(pixels: &Pixels) -> bool {
    let value = |at| f64::from(pixels.get(at).unwrap_or(0));
    let most = (0..pixels.len()).map(value).fold(0.0, f64::max);
    let mut seen = [false; GREYS];
    let mut between = 0;
    for part in (0..pixels.len()).map(|at| value(at) / most.max(1.0)) {
        // Ripples around the edges of a coarse coding are near either.
        if (NEAR_EITHER..1.0 - NEAR_EITHER).contains(&part) {
            seen[(part * GREYS as f64) as usize] = true;
            between += 1;
        }
    }
    let greys = seen.iter().filter(|seen| **seen).count();
    greys > GREYS / 4 && between > pixels.len() / 4
}

/// Reads a mask image.
///
/// # Errors
/// Names the file and what is wrong with it; a grey picture is none.
pub fn read_mask(path: &Path) -> Result<MaskBuffer> {
    let (bytes, name) = (read(path)?, path.display().to_string());
    let file = FrameFile::open(bytes.as_slice(), &name)?;
    if file.count() == 1 && is_grey(&file.frame(0)?.pixels) {
        bail!(
            "{name}: this is a grey picture and no mask: a mask is 0 outside of the implant and another number inside; grey frames are named as frames"
        );
    }
    let image = decode_mask(&bytes, &name)?;
    let (width, height) = (image.width as usize, image.height as usize);
    MaskBuffer::of_pixels(&image.pixels, width, height)
}
