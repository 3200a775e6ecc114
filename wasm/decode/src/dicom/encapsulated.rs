//! Compressed pixels: which fragments make a frame, and their decoding.

use std::collections::HashSet;
use std::ops::Range;

use super::attributes::Attributes;
use super::pixels;
use super::problem::damaged;
use super::structure::PixelData;
use super::syntax::Coding;
use crate::error::Problem;
use crate::frame::GreyFrame;
use crate::{jpeg, jpeg2000};

/// Begins a JPEG image.
const JPEG: [u8; 3] = [0xFF, 0xD8, 0xFF];

/// How pixels are coded: as the file says, or where it does not as its first fragment begins.
pub(super) fn coding(bytes: &[u8], pixels: &PixelData, stated: Coding) -> Coding {
    match pixels {
        _ if stated != Coding::Unknown => stated,
        PixelData::Native { .. } => Coding::Native,
        PixelData::Fragments { fragments, .. } => {
            let first = fragments.first().and_then(|range| bytes.get(range.clone()));
            match first.unwrap_or_default() {
                image if image.starts_with(&JPEG) => Coding::Jpeg,
                image if image.starts_with(&jpeg2000::CODESTREAM) => Coding::Jpeg2000,
                _ => Coding::Rle,
            }
        }
    }
}

/// The fragments of each frame. These are, in this order:
/// - one for each frame, where there are as many fragments as frames;
/// - all of them for a single frame;
/// - those that the basic offset table gives;
/// - for JPEG and JPEG 2000 without a table, those from one that begins an image to the next one that does.
pub(super) fn frames(
    bytes: &[u8],
    offsets: &[u32],
    fragments: Vec<Range<usize>>,
    attributes: &Attributes,
    coding: Coding,
) -> Result<Vec<Vec<Range<usize>>>, Problem> {
    let count = attributes.frames;
    if fragments.len() < count {
        return Err(damaged(format!(
            "it states {count} frames and holds {} fragments of pixels",
            fragments.len()
        )));
    }
    if fragments.len() == count {
        return Ok(fragments
            .into_iter()
            .map(|fragment| vec![fragment])
            .collect());
    }
    if count == 1 {
        return Ok(vec![fragments]);
    }
    let first = fragments.first().map_or(0, |fragment| fragment.start);
    let stated: HashSet<u32> = offsets.iter().copied().collect();
    let begins = |fragment: &Range<usize>| {
        if offsets.len() == count {
            return u32::try_from(fragment.start - first).is_ok_and(|at| stated.contains(&at));
        }
        let content = &bytes[fragment.clone()];
        match coding {
            Coding::Jpeg => content.starts_with(&JPEG),
            Coding::Jpeg2000 => content.starts_with(&jpeg2000::CODESTREAM),
            _ => false,
        }
    };
    let mut frames: Vec<Vec<_>> = Vec::new();
    for fragment in fragments {
        match frames.last_mut() {
            Some(frame) if !begins(&fragment) => frame.push(fragment),
            _ => frames.push(vec![fragment]),
        }
    }
    match frames.len() == count {
        true => Ok(frames),
        false => Err(damaged(format!(
            "it states {count} frames and its fragments of pixels make {}",
            frames.len()
        ))),
    }
}

/// Decodes the joined fragments of one frame, an image of its own.
pub(super) fn decode(
    coded: &[u8],
    attributes: &Attributes,
    coding: Coding,
) -> Result<GreyFrame, Problem> {
    match coding {
        Coding::Jpeg => {
            let image = jpeg::decode_with(coded, Some(attributes.colour_inside))?;
            pixels::frame_from_jpeg(image, attributes)
        }
        Coding::Jpeg2000 => {
            let image = jpeg2000::decode_with(coded, attributes.colour_inside, attributes.signed)?;
            pixels::frame_from_jpeg(image, attributes)
        }
        _ => Err(damaged(
            "its pixels are in fragments though it says they are not compressed",
        )),
    }
}
