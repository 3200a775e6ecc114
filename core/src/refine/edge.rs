//! Where a grey frame has the edge that a model's outline predicts: the steepest rise along the outline's normal, read a
//! little along its tangent too.

use super::border::{BorderPixel, NormalReading};
use super::view::ImageTarget;
use crate::image::display::QuickCurve;
use crate::image::grey::StraightLine;
use crate::image::mask::Mask;
use crate::image::profile::{READING_STEP, steepest_rise};

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
    steepest_rise(expected, range, |middle, profile| {
        read(image, curve, sample, (expected, middle), profile)
    })
}

/// Intensities along the normal of a sample, averaged along its tangent, of which the one with the number `middle` is `expected`
/// pixels from the middle of its pixel. `None` where one of the pixels is unknown or beyond the frame.
fn read(
    image: &ImageTarget<'_>,
    curve: &QuickCurve,
    sample: &BorderPixel,
    (expected, middle): (f64, usize),
    profile: &mut [f64],
) -> Option<()> {
    let (origin, direction) = (sample.place(), sample.normal().map(f64::from));
    let normal = StraightLine {
        origin,
        direction,
        aside: [0.0; 2],
        expected,
        middle,
        step: READING_STEP,
    };
    if let Some(unknown) = image.unknown {
        let mut places = (0..profile.len()).map(|number| normal.place(number));
        if places.any(|place| is_hidden(unknown, place)) {
            return None;
        }
    }
    profile.fill(0.0);
    let [right, down] = direction;
    for (along, weight) in (-2..=2).map(f64::from).zip(TANGENT) {
        let beside = StraightLine {
            aside: [-along * down, along * right],
            ..normal
        };
        image.frame.add_along(&beside, curve, weight, profile)?;
    }
    Some(())
}

/// Whether the pixel at a distance from a place along a normal says anything of the implant.
pub(crate) fn is_known(image: &ImageTarget<'_>, place: [f64; 2], normal: [f64; 2], t: f64) -> bool {
    let place = [0, 1].map(|axis| place[axis] + t * normal[axis]);
    !image
        .unknown
        .is_some_and(|unknown| is_hidden(unknown, place))
}

fn is_hidden(unknown: &Mask<'_>, [column, row]: [f64; 2]) -> bool {
    column >= 0.0 && row >= 0.0 && unknown.get(column as usize, row as usize)
}
