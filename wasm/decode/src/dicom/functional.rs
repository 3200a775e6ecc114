//! Functional groups: where enhanced multi-frame objects keep what other objects have at their top level, once for all
//! frames and once for each.

use super::element::{Element, ITEM, ITEM_END, SEQUENCE_END, UNDEFINED, Walker};
use super::problem::damaged;
use super::values::Found;
use crate::error::Problem;
use crate::limits::MAX_FRAMES;

/// The sequence of what all frames share.
pub(super) const SHARED: u32 = 0x5200_9229;
/// The sequence with an item for each frame.
pub(super) const PER_FRAME: u32 = 0x5200_9230;

/// The groups that are looked into: window, rescaling, pixel spacing, spacing at the detector, X-ray geometry, times, shutters.
/// They are known by tag because implicit files do not say what is a sequence.
const GROUPS: [u32; 7] = [
    0x0028_9132,
    0x0028_9145,
    0x0028_9110,
    0x0028_9443,
    0x0018_9476,
    0x0020_9111,
    0x0018_9472,
];

/// The wanted elements of each item's groups.
pub(super) fn items(walker: &Walker<'_>, sequence: &Element) -> Result<Vec<Vec<Found>>, Problem> {
    let mut out = Vec::new();
    each_item(walker, sequence, |walker, item| {
        let mut wanted = Vec::new();
        each_element(walker, item, |walker, element| {
            match GROUPS.contains(&element.tag) {
                true => {
                    wanted.extend(elements(walker, element)?);
                    Ok(())
                }
                false => Ok(()),
            }
        })?;
        out.push(wanted);
        match out.len() > MAX_FRAMES {
            true => Err(damaged(format!(
                "its functional groups are for more than {MAX_FRAMES} frames"
            ))),
            false => Ok(()),
        }
    })?;
    Ok(out)
}

/// The wanted elements of all items of a sequence.
pub(super) fn elements(walker: &Walker<'_>, sequence: &Element) -> Result<Vec<Found>, Problem> {
    let mut wanted = Vec::new();
    each_item(walker, sequence, |walker, item| {
        each_element(walker, item, |walker, element| {
            wanted.extend(Found::of(walker, element));
            Ok(())
        })
    })?;
    Ok(wanted)
}

/// Calls `call` with each item of a sequence.
fn each_item(
    walker: &Walker<'_>,
    sequence: &Element,
    mut call: impl FnMut(&Walker<'_>, &Element) -> Result<(), Problem>,
) -> Result<(), Problem> {
    // An unknown element of undefined length is an implicit sequence whatever the file's syntax.
    let unknown = sequence.representation == Some(*b"UN") && sequence.length == UNDEFINED;
    let walker = Walker {
        explicit: walker.explicit && !unknown,
        ..*walker
    };
    let end = match sequence.length {
        UNDEFINED => None,
        _ => Some(sequence.range(walker.bytes)?.end),
    };
    let mut at = sequence.value;
    while end.is_none_or(|end| at < end) {
        let item = walker.element(at)?;
        match item.tag {
            SEQUENCE_END if end.is_none() => break,
            ITEM => call(&walker, &item)?,
            _ => {
                return Err(damaged(format!(
                    "there is no item of a functional group at byte {at}"
                )));
            }
        }
        at = walker.after_any_item(&item)?;
    }
    Ok(())
}

/// Calls `call` with each element of an item.
fn each_element(
    walker: &Walker<'_>,
    item: &Element,
    mut call: impl FnMut(&Walker<'_>, &Element) -> Result<(), Problem>,
) -> Result<(), Problem> {
    let end = match item.length {
        UNDEFINED => None,
        _ => Some(item.range(walker.bytes)?.end),
    };
    let mut at = item.value;
    while end.is_none_or(|end| at < end) {
        let element = walker.element(at)?;
        if element.tag == ITEM_END && end.is_none() {
            break;
        }
        at = walker.after(&element, 1)?;
        call(walker, &element)?;
    }
    Ok(())
}
