//! The constants of a film from the frames at hand, and poses corrected by them.

use anyhow::Result;
use fluoropose::film::estimate::MOST_COMPONENTS;
use fluoropose::film::{FilmConstants, FilmEstimate, FilmModel, FilmProfile, estimate};
use fluoropose::finder::rivals::{RefinedRival, refine_rivals};
use fluoropose::finder::{correct_candidates, onto_image};
use fluoropose::mesh::Model;
use fluoropose::pose::Pose;
use fluoropose::refine::{CameraView, RefineBuffers, RefineOptions, film_profiles};
use rayon::prelude::*;

use super::film::FrameFound;
use super::finder::{EdgeOptions, image};
use crate::files::StatedFilm;
use crate::sequence::{Seen, Sequence};

/// Profiles of each frame and component; fewer of a long film.
const PROFILES: usize = 96;
/// Profiles of all frames together, at most.
const ALL: usize = 6000;

/// One component in the frames of a sequence.
#[derive(Clone, Copy)]
pub struct Filmed<'f> {
    /// Its model.
    pub model: Model<'f>,
    /// The frames.
    pub sequence: &'f Sequence<'f>,
    /// How edges are looked for.
    pub edges: EdgeOptions,
}

/// What a film that a person stated makes of a component of this attenuation, per mm.
pub fn stated_model(film: StatedFilm, attenuation: f64) -> FilmModel {
    let constants = FilmConstants {
        curvature: film.curvature,
        blur_px: film.blur_px,
    };
    FilmModel::certain(constants, attenuation)
}

/// Estimates the constants of a film from the best poses of its components; `None` where they do not tell.
pub fn estimate_film(parts: &[(Filmed<'_>, &[FrameFound])]) -> Option<FilmEstimate> {
    let parts = &parts[..parts.len().min(MOST_COMPONENTS)];
    let frames: usize = parts.iter().map(|(_, found)| found.len()).sum();
    let each = (ALL / frames.max(1)).clamp(12, PROFILES);
    let mut profiles = Vec::new();
    for (component, (part, found)) in parts.iter().enumerate() {
        let read = |buffers: &mut RefineBuffers, (frame, found): (usize, &FrameFound)| {
            let Some(best) = found.candidates.first() else {
                return Vec::new();
            };
            let names = (component as u8, frame as u16);
            let look = |seen: &Seen<'_>| part.profiles(seen, &best.pose, names, each, buffers);
            part.sequence.look(frame, look).unwrap_or_default()
        };
        let frames = found.par_iter().enumerate();
        let read: Vec<Vec<FilmProfile>> = frames.map_init(RefineBuffers::default, read).collect();
        profiles.extend(read.into_iter().flatten());
    }
    estimate(&mut profiles, parts.len())
}

impl Filmed<'_> {
    fn profiles(
        &self,
        seen: &Seen<'_>,
        pose: &Pose,
        names: (u8, u16),
        count: usize,
        buffers: &mut RefineBuffers,
    ) -> Result<Vec<FilmProfile>> {
        let camera = self.sequence.camera();
        let image = image(seen, self.edges, None)?;
        let mut memory = buffers.borrow(&self.model, &camera);
        let mut profiles = vec![FilmProfile::default(); count];
        let read = film_profiles(
            &self.model,
            &camera,
            pose,
            &image,
            names,
            &mut memory,
            &mut profiles,
        )?;
        profiles.truncate(read);
        Ok(profiles)
    }

    fn options(&self) -> RefineOptions {
        RefineOptions {
            edge_offset: self.edges.edge_offset,
            ..RefineOptions::default()
        }
    }
}

/// Brings the poses that outlines led to onto the edges of the frames, by the film's model of the component where there is one.
/// A frame that leads nowhere has no candidates, and says why.
pub fn bring_onto_frames(
    part: &Filmed<'_>,
    outlines: &[FrameFound],
    film: Option<FilmModel>,
) -> Vec<FrameFound> {
    let camera = part.sequence.camera();
    let bring = |buffers: &mut RefineBuffers, (frame, outline): (usize, &FrameFound)| {
        let mut found = outline.clone();
        if outline.candidates.is_empty() {
            return found;
        }
        let brought = part.sequence.look(frame, |seen| {
            let image = image(seen, part.edges, film)?;
            let mut memory = buffers.borrow(&part.model, &camera);
            let (model, options) = (&part.model, part.options());
            let outline = &outline.candidates;
            Ok(onto_image(
                model,
                &camera,
                image,
                outline,
                options,
                &mut memory,
            )?)
        });
        match brought {
            Ok(candidates) => found.candidates = candidates.to_vec(),
            Err(error) => {
                found.candidates.clear();
                found.failure = Some(format!("{error:#}"));
            }
        }
        found
    };
    let frames = outlines.par_iter().enumerate();
    frames.map_init(RefineBuffers::default, bring).collect()
}

/// Corrects all poses of all frames by the film's model of the component, which has become better known. A frame that cannot
/// be corrected stays as it is, and says so on standard error.
pub fn correct_poses(part: &Filmed<'_>, found: &mut [FrameFound], film: FilmModel) {
    let camera = part.sequence.camera();
    let correct = |buffers: &mut RefineBuffers, (frame, found): (usize, &mut FrameFound)| {
        if found.candidates.is_empty() {
            return;
        }
        let corrected = part.sequence.look(frame, |seen| {
            let image = image(seen, part.edges, Some(film))?;
            let mut memory = buffers.borrow(&part.model, &camera);
            let candidates = &found.candidates;
            Ok(correct_candidates(
                &part.model,
                &camera,
                image,
                candidates,
                part.options(),
                &mut memory,
            )?)
        });
        match corrected {
            Ok(corrected) => found.candidates = corrected.to_vec(),
            Err(error) => eprintln!("frame {} is not corrected: {error:#}", frame + 1),
        }
    };
    let frames = found.par_iter_mut().enumerate();
    frames.for_each_init(RefineBuffers::default, correct);
}

/// Brings a pose onto the edges of a frame, by the film's model where there is one; best first.
///
/// # Errors
/// Where there is no frame, and where the pose cannot be refined.
pub fn refine_on_frame(
    part: &Filmed<'_>,
    seen: &Seen<'_>,
    start: &Pose,
    film: Option<FilmModel>,
    buffers: &mut RefineBuffers,
) -> Result<Vec<RefinedRival>> {
    let camera = part.sequence.camera();
    let view = CameraView::only(&camera, image(seen, part.edges, film)?);
    let mut memory = buffers.borrow(&part.model, &camera);
    let (model, options) = (&part.model, part.options());
    Ok(refine_rivals(model, &[view], &[*start], &[], options, &mut memory)?.to_vec())
}
