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
