//! Profiles of a frame across the outline of a model at a pose: what the constants of a film are estimated from.

use super::border::Residual;
use super::drawing::{Drawing, draw};
use super::edge::{TANGENT, is_known};
use super::error::RefineError;
use super::memory::{FILM_EVERY, RefineMemory, check_memory};
use super::outline::Sampling;
use super::probe::{self, OWN_STEPS};
use super::view::{ImageTarget, Polarity};
use crate::camera::Camera;
use crate::film::lines::measure;
use crate::film::{FilmProfile, PathLine};
use crate::memory::first;
use crate::mesh::Model;
use crate::pose::Pose;

/// Reads profiles across the outline of `model` at `pose` (`camera_from_model`), evenly spread along it, as many as there is
/// room for in `profiles`, and gives how many were read. The pose need only be near: how far each edge lies beside the outline
/// is left open. `component` and `frame` are any numbers that tell them apart.
///
/// # Errors
/// [`RefineError`] where the model cannot be drawn or memory is too short.
pub fn film_profiles(
    model: &Model<'_>,
    camera: &Camera,
    pose: &Pose,
    image: &ImageTarget<'_>,
    (component, frame): (u8, u16),
    memory: &mut RefineMemory<'_>,
    profiles: &mut [FilmProfile],
) -> Result<usize, RefineError> {
    check_memory(camera, memory)?;
    let sampling = Sampling {
        every: FILM_EVERY,
        ..Sampling::ALL
    };
    let Drawing {
        drawn,
        border,
        projected,
        film,
        ..
    } = draw(model, camera, pose, sampling, memory)?;
    let lines = first("lines across the outline", border.len(), film.lines)?;
    for (line, sample) in lines.iter_mut().zip(&*border) {
        *line = PathLine::at(sample.place(), sample.normal().map(f64::from));
    }
    measure(
        model,
        camera,
        pose,
        projected,
        lines,
        film.heads,
        film.groups,
    )?;
    let every = border.len().div_ceil(profiles.len().max(1)).max(1);
    let mut count = 0;
    for (line, sample) in lines.iter().zip(border).step_by(every) {
        let crossing = probe::crossing(&(&drawn).into(), sample, OWN_STEPS);
        let (Residual::Px(own), Some(paths)) = (crossing, line.paths()) else {
            continue;
        };
        let (place, normal) = (sample.place(), sample.normal().map(f64::from));
        let read = FilmProfile::read(paths, f64::from(own), |t| spread(image, place, normal, t));
        if let (Some(read), Some(out)) = (read, profiles.get_mut(count)) {
            *out = FilmProfile {
                component,
                frame,
                ..read
            };
            count += 1;
        }
    }
    Ok(count)
}

/// Mean and variance of the pixels that a reading is made of, grey values of a picture that is not inverted.
fn spread(image: &ImageTarget<'_>, place: [f64; 2], normal: [f64; 2], t: f64) -> Option<[f64; 2]> {
    let sign = match image.polarity {
        Polarity::DarkImplant => 1.0,
        Polarity::BrightImplant => -1.0,
    };
    if !is_known(image, place, normal, t) {
        return None;
    }
    let (mut mean, mut squares) = (0.0, 0.0);
    for (along, weight) in (-2..=2).zip(TANGENT) {
        let along = f64::from(along);
        let at = [
            place[0] + t * normal[0] - along * normal[1] - 0.5,
            place[1] + t * normal[1] + along * normal[0] - 0.5,
        ];
        if at[0] < 0.0 || at[1] < 0.0 {
            return None;
        }
        let low = at.map(|x| f64::from(x as u32));
        let part = [at[0] - low[0], at[1] - low[1]];
        for (right, down) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
            let near = |part: f64, beyond: f64| 1.0 - part + beyond * (2.0 * part - 1.0);
            let weight = weight * near(part[0], right) * near(part[1], down);
            let grey = sign * image.frame.at(low[0] + right + 0.5, low[1] + down + 0.5)?;
            mean += weight * grey;
            squares += weight * grey * grey;
        }
    }
    Some([mean, (squares - mean * mean).max(0.0)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::frame::Frame;
    use crate::image::mask::{MaskMut, words_needed};
    use proptest::prelude::*;
    use std::vec::Vec;

    const SIDE: usize = 24;

    /// Oracle: all pixels of a frame, each with what it weighs in five readings that are linear between the centres of pixels.
    fn moments(
        pixels: &[u16],
        sign: f64,
        [column, row]: [f64; 2],
        [right, down]: [f64; 2],
    ) -> [f64; 2] {
        let (mut sum, mut squares) = (0.0, 0.0);
        for (k, &grey) in pixels.iter().enumerate() {
            let centre = [(k % SIDE) as f64 + 0.5, (k / SIDE) as f64 + 0.5];
            let grey = sign * f64::from(grey);
            for (along, part) in [(-2.0, 1.0), (-1.0, 4.0), (0.0, 6.0), (1.0, 4.0), (2.0, 1.0)] {
                let at = [column - along * down, row + along * right];
                let near = |axis: usize| (1.0 - f64::abs(at[axis] - centre[axis])).max(0.0);
                let weight = part / 16.0 * near(0) * near(1);
                sum += weight * grey;
                squares += weight * grey * grey;
            }
        }
        [sum, squares - sum * sum]
    }

    properties! {
        #[test]
        fn a_reading_is_mean_and_variance_of_the_pixels_round_it(
            pixels in proptest::collection::vec(0u16..4000, SIDE * SIDE),
            place in (9.0..15.0f64, 9.0..15.0f64), angle in 0.0..7.0f64, t in -5.0..5.0f64, bright in any::<bool>(),
        ) {
            let frame = Frame::new(&pixels, SIDE, SIDE, SIDE).expect("fits");
            let polarity = Polarity::of(bright);
            let image = ImageTarget { frame: &frame, unknown: None, polarity, film: None };
            let (down, right) = libm::sincos(angle);
            let found = spread(&image, [place.0, place.1], [right, down], t).expect("within");
            let there = [place.0 + t * right, place.1 + t * down];
            let sign = if bright { -1.0 } else { 1.0 };
            let wanted = moments(&pixels, sign, there, [right, down]);
            prop_assert!((found[0] - wanted[0]).abs() < 1e-6, "{found:?} {wanted:?}");
            prop_assert!((found[1] - wanted[1]).abs() < 1e-3, "{found:?} {wanted:?}");
        }
    }

    #[test]
    fn nothing_is_read_beyond_the_frame_or_where_nothing_is_known() {
        let pixels: Vec<u16> = (0..(SIDE * SIDE) as u16).collect();
        let frame = Frame::new(&pixels, SIDE, SIDE, SIDE).expect("fits");
        let mut words = std::vec![0; words_needed(SIDE, SIDE)];
        let mut unknown = MaskMut::new(&mut words, SIDE, SIDE).expect("fits");
        unknown.set(14, 12, true);
        let unknown = unknown.into_mask();
        let image = |unknown| ImageTarget {
            frame: &frame,
            unknown,
            polarity: Polarity::DarkImplant,
            film: None,
        };
        let read = |unknown, place, t| spread(&image(unknown), place, [1.0, 0.0], t);
        assert!(read(None, [12.5, 12.5], 2.0).is_some());
        assert!(read(Some(&unknown), [12.5, 12.5], 2.0).is_none());
        assert!(read(Some(&unknown), [12.5, 12.5], 3.0).is_some());
        // Readings along the tangent are two pixels above and below.
        for (place, is_read) in [
            ([12.5, 2.5], true),
            ([12.5, 2.4], false),
            ([12.5, 21.4], true),
            ([12.5, 21.6], false),
        ] {
            assert_eq!(read(None, place, 0.0).is_some(), is_read, "{place:?}");
        }
        assert!(read(None, [2.5, 12.5], -2.0).is_some());
        assert!(read(None, [2.5, 12.5], -2.1).is_none());
    }
}
