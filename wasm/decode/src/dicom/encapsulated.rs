//! Compressed pixels: which fragments make a frame, and their decoding.

use std::ops::Range;

use super::attributes::Attributes;
use super::problem::damaged;
use super::syntax::Coding;
use super::{pixels, rle};
use crate::error::Problem;
use crate::frame::GreyFrame;
use crate::{jpeg, jpeg2000};

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
    let begins = |fragment: &Range<usize>| {
        if offsets.len() == count {
            return u32::try_from(fragment.start - first).is_ok_and(|at| offsets.contains(&at));
        }
        let content = &bytes[fragment.clone()];
        match coding {
            Coding::Jpeg => content.starts_with(&[0xFF, 0xD8]),
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

/// Decodes the joined fragments of one frame.
pub(super) fn decode(
    coded: &[u8],
    attributes: &Attributes,
    coding: Coding,
) -> Result<GreyFrame, Problem> {
    match coding {
        Coding::Jpeg => {
            let image = jpeg::decode_with(coded, attributes.colour_inside)?;
            pixels::frame_from_jpeg(image, attributes)
        }
        Coding::Jpeg2000 => {
            let image = jpeg2000::decode_with(coded, attributes.colour_inside, attributes.signed)?;
            pixels::frame_from_jpeg(image, attributes)
        }
        Coding::Rle => {
            let area = attributes.width as usize * attributes.height as usize;
            let bytes_per_sample = usize::from(attributes.bits_allocated / 8);
            let samples = usize::from(attributes.samples);
            let stored = rle::decode(coded, area, samples, bytes_per_sample)?;
            // Run lengths give interleaved samples whatever the file says of its planes.
            let interleaved = Attributes {
                planar: false,
                ..attributes.clone()
            };
            pixels::frame_from_stored(&stored, &interleaved)
        }
        Coding::Native => Err(damaged(
            "its pixels are in fragments though it says they are not compressed",
        )),
    }
}
