//! Mask images: which pixels belong to the implant.

use std::collections::BTreeSet;

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

/// Parts of the largest value between 0 and it that are told apart.
const GRADES: usize = 64;
/// So many of them are probabilities or smoothed edges: labels of components are fewer.
const GRADED: usize = 8;

/// Decodes a mask image. Every pixel that is not 0 is inside; in a JPEG, whose coding leaves ripples around every edge,
/// every pixel of at least 128; where values are graded, as a network's probabilities and smoothed edges are, every pixel of at least half the largest:
/// the outline of what is merely not 0 lies some pixels outside.
///
/// # Errors
/// [`DecodeError`] if the file is not an image, is damaged, too large, or holds more than one frame.
pub fn decode_mask(bytes: &[u8], name: &str) -> Result<MaskImage, DecodeError> {
    let file = FrameFile::open(bytes, name)?;
    Ok(mask_alone(&only_frame(&file)?, file.kind()))
}

fn mask_alone(frame: &GreyFrame, kind: Kind) -> MaskImage {
    let mut values = Values::new();
    values.see(frame);
    mask_of(frame, values.rule_in(kind))
}

/// All masks of a file, which may hold those of a film. What is inside is decided over all of them: one that shows no implant has small values alone.
///
/// # Errors
/// Those of [`FrameFile::frame`].
pub fn decode_masks(file: &FrameFile<'_>) -> Result<Vec<MaskImage>, DecodeError> {
    if file.count() == 1 {
        return Ok(vec![mask_alone(&file.frame(0)?, file.kind())]);
    }
    let rule = mask_rule(file)?;
    let masks = (0..file.count()).map(|index| Ok(mask_of(&file.frame(index)?, rule)));
    masks.collect()
}

/// The values that occur in masks.
struct Values(Vec<bool>);

impl Values {
    fn new() -> Self {
        Self(vec![false; 1 << 16])
    }

    fn see(&mut self, frame: &GreyFrame) {
        match &frame.pixels {
            Pixels::U8(p) => p
                .iter()
                .for_each(|&value| self.0[usize::from(value)] = true),
            Pixels::U16(p) => p
                .iter()
                .for_each(|&value| self.0[usize::from(value)] = true),
        }
    }

    fn rule_in(&self, kind: Kind) -> MaskRule {
        match kind {
            Kind::Jpeg => MaskRule::AtLeast(128),
            _ => self.rule(),
        }
    }

    /// The rule for values that no coding has changed.
    fn rule(&self) -> MaskRule {
        let most = self.0.iter().rposition(|&seen| seen).unwrap_or(0);
        let between = (1..most).filter(|&value| self.0[value]);
        let grades: BTreeSet<usize> = between.map(|value| value * GRADES / most).collect();
        match grades.len() < GRADED {
            true => MaskRule::NonZero,
            // A value of a pixel.
            false => MaskRule::AtLeast(most.div_ceil(2) as u16),
        }
    }
}

/// The rule for all masks of a file, which are decoded one by one.
///
/// # Errors
/// Those of [`FrameFile::frame`].
pub fn mask_rule(file: &FrameFile<'_>) -> Result<MaskRule, DecodeError> {
    let mut values = Values::new();
    for index in 0..file.count() {
        values.see(&file.frame(index)?);
    }
    Ok(values.rule_in(file.kind()))
}

/// Nearer to 0 or to the largest value than this part of it a grade is as good as decided.
const DECIDED: f64 = 0.05;
/// At most this part of a graded mask's pixels is not: those along its border. Of a picture most are.
const MOST_UNDECIDED: f64 = 0.08;
/// At least this part is inside, and at least as much outside.
const LEAST_DECIDED: f64 = 0.001;

/// A picture read as the mask of graded values that it seems to be: nearly all of them lie near 0 or near the largest. `None` where it seems to be a
/// picture of something, or a mask of few values, which needs no such reading.
pub fn graded_mask(frame: &GreyFrame) -> Option<MaskImage> {
    let mut values = Values::new();
    values.see(frame);
    let rule = values.rule();
    let MaskRule::AtLeast(least) = rule else {
        return None;
    };
    let most = 2.0 * f64::from(least);
    let [low, high] = [DECIDED * most, (1.0 - DECIDED) * most];
    let part = |is: &dyn Fn(f64) -> bool| match &frame.pixels {
        Pixels::U8(p) => part_of(p, is),
        Pixels::U16(p) => part_of(p, is),
    };
    let (outside, inside) = (part(&|v| v < low), part(&|v| v > high));
    let is_mask = outside.min(inside) >= LEAST_DECIDED && outside + inside >= 1.0 - MOST_UNDECIDED;
    is_mask.then(|| mask_of(frame, rule))
}

fn part_of<T: Copy + Into<f64>>(pixels: &[T], is: &dyn Fn(f64) -> bool) -> f64 {
    let count = pixels.iter().filter(|&&value| is(value.into())).count();
    count as f64 / pixels.len().max(1) as f64
}

fn only_frame(file: &FrameFile<'_>) -> Result<GreyFrame, DecodeError> {
    match file.count() {
        1 => file.frame(0),
        count => Err(Problem::SeveralMasks { count }.of(file.name())),
    }
}

/// Decodes a mask image by a rule.
///
/// # Errors
/// Those of [`decode_mask`].
pub fn decode_mask_by(bytes: &[u8], name: &str, rule: MaskRule) -> Result<MaskImage, DecodeError> {
    let file = FrameFile::open(bytes, name)?;
    Ok(mask_of(&only_frame(&file)?, rule))
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
