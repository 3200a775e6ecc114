//! Where a silhouette's outline crosses a normal.

use super::border::{BorderPixel, NormalReading};
use crate::image::mask::Mask;
use crate::image::silhouette::Silhouette;

/// Distance between readings along a normal, pixels.
const STEP: f64 = 0.5;

/// Where the outline of `silhouette` crosses the normal of a sample, within `range` pixels.
///
/// The mask is read by bilinear interpolation between pixel centres; the outline is where it is
/// one half. From inside the first crossing outwards is taken, from outside the first inwards.
pub(super) fn crossing(
    silhouette: &Silhouette<'_>,
    sample: &BorderPixel,
    range: f64,
) -> NormalReading {
    let normal = sample.normal.map(f64::from);
    let at = |t: f64| {
        let column = f64::from(sample.column) + t * normal[0];
        let row = f64::from(sample.row) + t * normal[1];
        coverage(silhouette, column, row)
    };
    let Some(mut value) = at_centre(silhouette, sample) else {
        return NormalReading::Unknown;
    };
    let direction = if value >= 0.5 { 1.0 } else { -1.0 };
    let steps = (range / STEP) as usize;
    for step in 1..=steps {
        let t = direction * STEP * step as f64;
        let Some(next) = at(t) else {
            return NormalReading::Unknown;
        };
        if (next >= 0.5) != (value >= 0.5) {
            let share = (value - 0.5) / (value - next);
            return NormalReading::At(t - direction * STEP * (1.0 - share));
        }
        value = next;
    }
    NormalReading::Nothing
}

/// [`coverage`] at the middle of a sample's pixel: that of the pixel alone.
fn at_centre(silhouette: &Silhouette<'_>, sample: &BorderPixel) -> Option<f64> {
    let (column, row) = (usize::from(sample.column), usize::from(sample.row));
    let mask = silhouette.mask();
    let unknown = |unknown: &Mask<'_>| unknown.square(column, row) != 0;
    let beyond = column + 1 >= mask.width() || row + 1 >= mask.height();
    let known = !beyond && !silhouette.unknown().is_some_and(unknown);
    known.then(|| f64::from(u8::from(mask.get(column, row))))
}

/// The mask between the centres of four pixels; coordinates are relative to the centre of the
/// first pixel. `None` beyond the outermost centres and where one of the four is unknown.
fn coverage(silhouette: &Silhouette<'_>, column: f64, row: f64) -> Option<f64> {
    let mask = silhouette.mask();
    let last = |side: usize| side as f64 - 1.0;
    if !(0.0..last(mask.width())).contains(&column) || !(0.0..last(mask.height())).contains(&row) {
        // Beside a part of a frame that is all of the silhouette there is nothing of it.
        return silhouette.is_clear_beyond(column, row).then_some(0.0);
    }
    let (left, above) = (column as usize, row as usize);
    if let Some(unknown) = silhouette.unknown()
        && unknown.square(left, above) != 0
    {
        return None;
    }
    let square = mask.square(left, above);
    // Most squares are all inside or all outside.
    if square == 0 || square == 0b1111 {
        return Some(f64::from(square & 1));
    }
    let (right, down) = (column - left as f64, row - above as f64);
    let [upper, lower] = [square, square >> 2].map(|pair| between(pair, right));
    Some(upper * (1.0 - down) + lower * down)
}

/// `a * (1 - share) + b * share` of two pixels, the lower bit first: products by 0 and 1 are dear where software makes them.
fn between(pair: u32, share: f64) -> f64 {
    match pair & 0b11 {
        0b00 => 0.0,
        0b01 => 1.0 - share,
        0b10 => share,
        // As it is rounded.
        _ => (1.0 - share) + share,
    }
}

/// How far the drawn model's own outline may be from the middle of a border pixel, pixels.
pub(super) const OWN_RANGE: f64 = 3.0;

#[cfg(test)]
mod tests {
    use super::between;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn between_two_pixels_is_what_products_give(share in 0.0..1.0f64, small in 0.0..1e-15f64) {
            for share in [share, small, 1.0 - small, 0.0, -0.0] {
                for pair in 0..4u32 {
                    let [a, b] = [pair & 1, pair >> 1].map(f64::from);
                    let products = a * (1.0 - share) + b * share;
                    prop_assert_eq!(between(pair, share), products);
                }
            }
        }
    }
}
