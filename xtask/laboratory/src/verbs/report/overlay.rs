//! The frames of a study with what was found in them laid on, and the curves beside.

use std::path::Path;

use anyhow::{Result, ensure};
use fluoropose::camera::Camera;
use fluoropose::image::border::follow_border;
use fluoropose::image::contour::Contour;
use fluoropose::image::region::largest_region;
use fluoropose::pose::Pose;
use fluoropose::render::{Projected, render, scratch_needed};
use fluoropose_decode::{GreyFrame, Pixels, Window};
use fluoropose_report::JointFilm;
use fluoropose_report::overlay::{Overlay, Shown};
use fluoropose_report::webm::webm;
use rayon::prelude::*;

use super::out::make_folder;
use super::sources::{Body, Sources};
use crate::files::{Film, MaskBuffer, Study, camera_of_frames, read_calibration, write_bytes};

/// Corners of a silhouette's border that are drawn.
const CORNERS: usize = 16_384;
/// Pictures a second where nobody said how fast the film was taken.
const USUAL_RATE: f64 = 10.0;
/// The share of pixels that a frame's window leaves out at either end, where its file states none.
const CLIPPED: f64 = 0.005;

/// Writes a picture of each frame, and the film of them.
pub(super) fn write(out: &Path, study: &Study, film: &JointFilm, sources: &Sources) -> Result<()> {
    let frames = Film::read(study.frames_folder()?)?;
    ensure!(
        frames.count() == film.rows.len(),
        "there are {} frames and {} poses: both must be of the same film",
        frames.count(),
        film.rows.len()
    );
    let (camera, _) = camera_of_frames(&read_calibration(&study.calibration)?, frames.size())?;
    let folder = out.join("overlay");
    make_folder(&folder)?;
    let (columns, rows) = frames.size();
    let overlay = Overlay::new(film, [columns, rows]);
    let picture = |index: usize| -> Result<_> {
        let grey = shades(&*frames.frame(index)?);
        let mut outlines = Vec::new();
        for body in [&sources.femur, &sources.tibia] {
            outlines.push(outline(body, &camera, body.poses[index].as_ref())?);
        }
        let shown = Shown {
            grey: &grey,
            outlines: [outlines[0].as_deref(), outlines[1].as_deref()],
        };
        let name = format!("frame_{:04}.png", index + 1);
        let picture = overlay.picture(index, &shown);
        write_bytes(&folder.join(name), &picture.png())?;
        Ok((picture.size(), picture.coded()?))
    };
    let pictures = (0..frames.count()).into_par_iter().map(picture);
    let (sizes, coded): (Vec<_>, Vec<_>) =
        pictures.collect::<Result<Vec<_>>>()?.into_iter().unzip();
    println!("{}: {} pictures", folder.display(), frames.count());
    let rate = film.frames_per_s.unwrap_or(USUAL_RATE);
    let size = sizes.first().copied().unwrap_or_default();
    let name = out.join("overlay.webm");
    write_bytes(&name, &webm(coded, size, rate))?;
    println!("{}: {rate} pictures a second", name.display());
    Ok(())
}

/// Grey from black to white, by the window that the file states, or by one that leaves out little at either end.
fn shades(frame: &GreyFrame) -> Vec<u8> {
    match &frame.pixels {
        Pixels::U8(pixels) => shaded(pixels, frame.window),
        Pixels::U16(pixels) => shaded(pixels, frame.window),
    }
}

fn shaded<P: Copy + Ord + Into<f64>>(pixels: &[P], stated: Option<Window>) -> Vec<u8> {
    let (black, width) = match stated {
        Some(Window { centre, width }) => (centre - width / 2.0, width),
        None => {
            let mut sorted = pixels.to_vec();
            let last = sorted.len().saturating_sub(1);
            let mut at = |part: f64| -> f64 {
                let place = (part * last as f64) as usize;
                let (_, value, _) = sorted.select_nth_unstable(place);
                (*value).into()
            };
            let black = at(CLIPPED);
            (black, at(1.0 - CLIPPED) - black)
        }
    };
    let shade = |&pixel: &P| (255.0 * (pixel.into() - black) / width.max(1.0)).round() as u8;
    pixels.iter().map(shade).collect()
}

/// The border of a silhouette's largest region; none without a pose, and where nothing of it is in the frame.
fn outline(body: &Body, camera: &Camera, pose: Option<&Pose>) -> Result<Option<Vec<[f64; 2]>>> {
    let Some(pose) = pose else { return Ok(None) };
    let empty = MaskBuffer::new(camera.width(), camera.height())?;
    let (mut drawn, mut rest, mut largest) = (empty.clone(), empty.clone(), empty);
    let model = body.model.as_model();
    let mut scratch = vec![Projected::default(); scratch_needed(&model)];
    drawn.draw(|mask| render(&model, camera, pose, &mut scratch, mask))?;
    let drawn = drawn.mask();
    if drawn.area() == 0 {
        return Ok(None);
    }
    largest.draw(|largest| rest.draw(|rest| largest_region(&drawn, rest, largest)))?;
    let mut border = Box::new(Contour::<CORNERS>::new());
    follow_border(&largest.mask(), border.as_mut())?;
    let corners = border.iter().map(|point| [point.column, point.row]);
    Ok(Some(corners.collect()))
}
