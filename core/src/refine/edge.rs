//! Where a grey frame has the edge that a model's outline predicts: the steepest rise along the outline's normal, read a
//! little along its tangent too.

use super::border::{BorderPixel, NormalReading};
use super::view::ImageTarget;
use crate::image::display::QuickCurve;
use crate::image::mask::Mask;
use crate::image::profile::{intensity_across, steepest_rise};

/// Weights of the readings along the tangent, one pixel apart: sixteenths.
pub(super) const TANGENT: [f64; 5] = [1.0 / 16.0, 4.0 / 16.0, 6.0 / 16.0, 4.0 / 16.0, 1.0 / 16.0];

/// The edge nearest to expectation on the normal of a sample: `expected` pixels from the middle
/// of its pixel, at most `range` from there. Grey values are read through `curve`.
pub(super) fn edge(
    image: &ImageTarget<'_>,
    curve: &QuickCurve,
    sample: &BorderPixel,
    expected: f64,
    range: f64,
) -> NormalReading {
    let normal = sample.normal.map(f64::from);
    steepest_rise(expected, range, |t| {
        reading(image, curve, sample.place(), normal, t)
    })
}

/// Intensity at a distance from a place along a normal, averaged along the tangent. `None` where
/// one of the pixels is unknown or beyond the frame.
fn reading(
    image: &ImageTarget<'_>,
    curve: &QuickCurve,
    place: [f64; 2],
    normal: [f64; 2],
    t: f64,
) -> Option<f64> {
    if !is_known(image, place, normal, t) {
        return None;
    }
    intensity_across(image.frame, curve, place, normal, &TANGENT, t)
}

/// Whether the pixel at a distance from a place along a normal says anything of the implant.
pub(super) fn is_known(image: &ImageTarget<'_>, place: [f64; 2], normal: [f64; 2], t: f64) -> bool {
    let [column, row] = [0, 1].map(|axis| place[axis] + t * normal[axis]);
    let hidden = |unknown: &Mask<'_>| {
        column >= 0.0 && row >= 0.0 && unknown.get(column as usize, row as usize)
    };
    !image.unknown.is_some_and(hidden)
}
