//! What a file says of how its greys are shown.

use super::attributes::Attributes;
use crate::frame::Window;

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

/// What was done to the pixels or left undone.
pub(super) fn notes(attributes: &Attributes) -> Vec<String> {
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
    if attributes.has_shutter {
        note("Pixels outside of the file's shutter are as stored, not black.");
    }
    let (slope, intercept) = (attributes.slope, attributes.intercept);
    if (slope, intercept) != (1.0, 0.0) {
        notes.push(format!(
            "Pixels are as stored; the file's rescale (slope {slope}, intercept {intercept}) is applied to the window alone."
        ));
    }
    notes
}
