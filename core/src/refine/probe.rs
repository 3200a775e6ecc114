//! Where a mask's outline crosses a normal.

use super::outline::BorderPixel;
use crate::mask::Mask;

/// Distance between readings along a normal, pixels.
const STEP: f64 = 0.5;

/// Distance in pixels along a sample's outward normal, from the middle of its pixel, at which the
/// outline of `mask` crosses; negative inwards. `None` where it does not cross within `range`, or
/// only beyond the frame.
///
/// The mask is read by bilinear interpolation between pixel centres; the outline is where it is
/// one half. From inside the first crossing outwards is taken, from outside the first inwards.
pub(super) fn crossing(mask: &Mask<'_>, sample: &BorderPixel, range: f64) -> Option<f64> {
    let normal = sample.normal.map(f64::from);
    let at = |t: f64| {
        let column = f64::from(sample.column) + t * normal[0];
        let row = f64::from(sample.row) + t * normal[1];
        coverage(mask, column, row)
    };
    let mut value = at(0.0)?;
    let direction = if value >= 0.5 { 1.0 } else { -1.0 };
    let steps = (range / STEP) as usize;
    for step in 1..=steps {
        let t = direction * STEP * step as f64;
        let next = at(t)?;
        if (next >= 0.5) != (value >= 0.5) {
            let share = (value - 0.5) / (value - next);
            return Some(t - direction * STEP * (1.0 - share));
        }
        value = next;
    }
    None
}

/// The mask between the centres of four pixels; coordinates are relative to the centre of the
/// first pixel. `None` beyond the outermost centres.
fn coverage(mask: &Mask<'_>, column: f64, row: f64) -> Option<f64> {
    let last = |side: usize| side as f64 - 1.0;
    if !(0.0..last(mask.width())).contains(&column) || !(0.0..last(mask.height())).contains(&row) {
        return None;
    }
    let (left, above) = (column as usize, row as usize);
    let (right, down) = (column - left as f64, row - above as f64);
    let pixel = |column: usize, row: usize| f64::from(u8::from(mask.get(column, row)));
    let upper = pixel(left, above) * (1.0 - right) + pixel(left + 1, above) * right;
    let lower = pixel(left, above + 1) * (1.0 - right) + pixel(left + 1, above + 1) * right;
    Some(upper * (1.0 - down) + lower * down)
}
