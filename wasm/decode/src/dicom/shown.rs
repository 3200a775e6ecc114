//! What a file says of how its greys are shown.

use super::attributes::Attributes;
use super::shutter::Stated;
use crate::frame::Window;
use crate::shutter::Shutter;

/// The stated window in units of the pixels handed out: rescale undone, sign offset, narrowing and inversion done. None
/// where a table stands between them.
pub(super) fn window(attributes: &Attributes) -> Option<Window> {
    let stated = attributes
        .window
        .filter(|_| attributes.falling_table.is_none())?;
    let (centre, width) = match stated.half_unit {
        true => (stated.centre - 0.5, stated.width - 1.0),
        false => (stated.centre, stated.width),
    };
    let mut centre = (centre - attributes.intercept) / attributes.slope;
    if attributes.signed {
        centre += f64::from(u32::MAX >> (32 - attributes.bits_stored) >> 1) + 1.0;
    }
    let step = f64::from(1u32 << attributes.narrowing.shift);
    centre = (centre - f64::from(attributes.narrowing.low)) / step;
    if attributes.is_inverted() {
        centre = f64::from(u16::MAX >> (16 - attributes.depth)) - centre;
    }
    let width = (width / attributes.slope.abs() / step).max(1.0);
    (centre.is_finite() && width.is_finite()).then_some(Window { centre, width })
}

/// The shutter that a frame of this size has, and what was done to the pixels or left undone.
pub(super) fn shutter_and_notes(
    attributes: &Attributes,
    size: (u32, u32),
) -> (Option<Shutter>, Vec<String>) {
    let mut notes = match attributes.is_grey() {
        true => notes(attributes),
        false => Vec::new(),
    };
    let Some(stated) = &attributes.shutter else {
        return (None, notes);
    };
    let (shutter, note) = shutter(stated, size);
    notes.extend(note);
    (shutter, notes)
}

/// A shutter of which something is known and that leaves something open and not all of it, and what is to be said of it.
fn shutter(stated: &Stated, (width, height): (u32, u32)) -> (Option<Shutter>, Option<String>) {
    let area = u64::from(width) * u64::from(height);
    let note = match stated {
        Stated::Unknown => "The file states a shutter and not where it is, or one of a kind that is not read; it is not used.".to_owned(),
        Stated::Known(shutter) => match shutter.open_area(width, height) {
            open if open == area => return (None, None),
            0 => "The file's shutter would cover all of the picture; it is not used.".to_owned(),
            open => {
                let percent = 100.0 * (1.0 - open as f64 / area as f64);
                let note = format!(
                    "The file's shutter covers {percent:.0} % of the picture; nothing is read there."
                );
                return (Some(shutter.clone()), Some(note));
            }
        },
    };
    (None, Some(note))
}

fn notes(attributes: &Attributes) -> Vec<String> {
    let mut notes = Vec::new();
    let mut note = |text: &str| notes.push(text.to_owned());
    if attributes.is_inverted() {
        note("Inverted so that bright is high (the file stores bright as low).");
    }
    if attributes.bits_stored > 16 {
        note("Of more than 16 bits the highest 16 that the file's values use were kept.");
    } else if attributes.signed {
        note("Signed pixels were moved up by half their range.");
    }
    if attributes.falling_table.is_some() {
        note(
            "Pixels are as stored; the file's table of meaningful values (modality LUT) is not applied, and no window.",
        );
    }
    let (slope, intercept) = (attributes.slope, attributes.intercept);
    if (slope, intercept) != (1.0, 0.0) {
        notes.push(format!(
            "Pixels are as stored; the file's rescale (slope {slope}, intercept {intercept}) is applied to the window alone."
        ));
    }
    notes
}
