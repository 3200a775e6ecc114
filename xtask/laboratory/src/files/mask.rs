//! Silhouettes from files.

use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use fluoropose_decode::{FrameFile, Pixels, decode_masks};
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

/// So many values are labels at most, and so much of what is not 0 has each of two that are of two things: where edges are smoothed few pixels lie between.
const LABELS: usize = 16;
const OF_EACH: f64 = 0.1;

/// Two values that are labels of two things, by how many pixels have them.
fn labels(pixels: &Pixels) -> Option<[u16; 2]> {
    let mut counts: Vec<(u16, usize)> = Vec::new();
    let values = (0..pixels.len()).filter_map(|at| pixels.get(at));
    for value in values.filter(|&value| value != 0) {
        match counts.iter().position(|&(known, _)| known == value) {
            Some(at) => counts[at].1 += 1,
            None if counts.len() < LABELS => counts.push((value, 1)),
            None => return None,
        }
    }
    let inside: usize = counts.iter().map(|(_, count)| count).sum();
    let least = OF_EACH * inside as f64;
    counts.retain(|&(_, count)| count as f64 >= least);
    counts.sort_unstable();
    match counts[..] {
        [(one, _), (other, _), ..] => Some([one, other]),
        _ => None,
    }
}

/// Reads a mask image.
///
/// # Errors
/// Names the file and what is wrong with it; a grey picture is none, nor are labels of several things, nor several masks.
pub fn read_mask(path: &Path) -> Result<MaskBuffer> {
    let mut masks = read_masks(path)?;
    match (masks.pop(), masks.len()) {
        (Some((_, mask)), 0) => Ok(mask),
        (_, others) => bail!(
            "{} holds {} masks, and one is wanted here",
            path.display(),
            others + 1
        ),
    }
}

/// Reads all masks of a file, which may hold those of a film, each with its name.
///
/// # Errors
/// Those of [`read_mask`], of any of them.
pub fn read_masks(path: &Path) -> Result<Vec<(PathBuf, MaskBuffer)>> {
    let (bytes, file) = (read(path)?, path.display().to_string());
    let frames = FrameFile::open(bytes.as_slice(), &file)?;
    let count = frames.count();
    let name = |index: usize| match count {
        1 => file.clone(),
        _ => format!("{file} #{}", index + 1),
    };
    for index in 0..count {
        check_is_mask(&frames.frame(index)?.pixels, &name(index))?;
    }
    let images = decode_masks(&frames)?.into_iter().enumerate();
    let masks = images.map(|(index, image)| {
        let (width, height) = (image.width as usize, image.height as usize);
        let mask = MaskBuffer::of_pixels(&image.pixels, width, height)?;
        Ok((name(index).into(), mask))
    });
    masks.collect()
}

fn check_is_mask(pixels: &Pixels, name: &str) -> Result<()> {
    if is_grey(pixels) {
        bail!(
            "{name}: this is a grey picture and no mask: a mask is 0 outside of the implant and another number inside; grey frames are named as frames"
        );
    }
    if let Some([one, other]) = labels(pixels) {
        bail!(
            "{name}: it holds labels of several things ({one} and {other}), and a mask is of one component: write each label as a mask of its own, 0 elsewhere"
        );
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_values_are_labels_where_neither_is_a_border() {
        let found = |values: &[(u8, usize)]| {
            let pixels = values.iter().flat_map(|&(value, count)| vec![value; count]);
            labels(&Pixels::U8(pixels.collect()))
        };
        assert_eq!(found(&[(0, 500), (2, 90), (1, 60)]), Some([1, 2]));
        assert_eq!(found(&[(0, 500), (255, 100)]), None);
        // A border between, as resizing leaves it, and no component at all.
        assert_eq!(found(&[(0, 500), (255, 95), (128, 5), (64, 5)]), None);
        assert_eq!(found(&[(0, 500)]), None);
        let ramp: Vec<(u8, usize)> = (0..200).map(|value| (value, 3)).collect();
        assert_eq!(found(&ramp), None);
    }
}
