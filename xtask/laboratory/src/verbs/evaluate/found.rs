//! Poses of a study's components in all of their sources.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use fluoropose::camera::Camera;
use fluoropose::camera::calibration::Calibration;
use fluoropose::film::FilmModel;
use fluoropose::finder::choice::Counterpart;
use fluoropose::joint::beside::Lying;
use fluoropose::library::ViewGrid;
use fluoropose::locate::Located;
use fluoropose::mesh::anatomy::field_axes;
use fluoropose::mesh::symmetry::symmetry_planes;
use fluoropose::pose::{EulerPose, Pose, geodesic_deg};
use fluoropose::refine::RefineBuffers;
use rayon::prelude::*;

use super::reference::Reference;
use super::request::Request;
use crate::choice::{Decision, Known, decide};
use crate::files::{Component, MaskBuffer, Role, Study};
use crate::finding::misfits::Misfits;
use crate::finding::{
    Built, Filmed, Finder, FrameFound, Method, Stated, ViewOptions, axes_of, bring_onto_frames,
    build_library, find_poses, first_poses, offset_words,
};
use crate::measure::accuracy::{in_front, median_absolute};
use crate::noise::DisturbanceOptions;
use crate::sequence::{Folders, Sequence, Source};
use fluoropose::mesh::OwnedModel;

/// Perspective changes views little where the distance changes by this part.
const ALIKE: f64 = 0.1;

/// A component and what was found in each of its sources.
pub(super) struct Part<'s> {
    pub(super) component: &'s Component,
    pub(super) model: OwnedModel,
    pub(super) reference: Option<Reference>,
    /// In the order of the sources' names.
    pub(super) found: Vec<Found>,
}

/// What was found in the masks of one source.
pub(super) struct Found {
    pub(super) source: String,
    pub(super) camera: Camera,
    pub(super) frames: Vec<FrameFound>,
    /// Which of the poses was chosen in each frame.
    pub(super) decisions: Vec<Option<Decision>>,
    /// Source of the femoral poses that were known when these were chosen.
    pub(super) femur: Option<String>,
    /// Of the method `image`: where refinement comes to from the reference pose.
    pub(super) from_reference: Option<Vec<Option<Pose>>>,
    /// Of the method `image`: what is known of the film, in words.
    pub(super) film: Option<String>,
    film_is_known: bool,
    /// Masks and frames.
    files: Source,
    /// Pixels of each mask that say nothing.
    pub(super) hidden: Vec<Option<MaskBuffer>>,
}

impl Found {
    /// The poses that were chosen.
    pub(super) fn poses(&self) -> Vec<Option<Pose>> {
        let pose = |decision: &Option<Decision>| decision.and_then(|decision| decision.pose());
        self.decisions.iter().map(pose).collect()
    }

    /// The same with how well their depths are known.
    pub(super) fn lying(&self) -> Vec<Option<Lying>> {
        let lying = |decision: &Option<Decision>| decision.as_ref().and_then(Decision::lying);
        self.decisions.iter().map(lying).collect()
    }

    /// Its masks as they are.
    pub(super) fn masks(&self) -> Result<Sequence<'_>> {
        self.files.disturbed(&DisturbanceOptions::default())
    }

    /// The same as rows of a pose file.
    pub(super) fn rows(&self) -> Vec<Option<EulerPose>> {
        let rows = self.poses().into_iter();
        rows.map(|pose| pose.map(EulerPose::from)).collect()
    }
}

/// Finds and chooses the poses of all components. Femoral components are decided first, then
/// tibial ones with the femoral poses of the same source known, or of the first source that has
/// any. Others are decided by themselves.
pub(super) fn find_parts<'s>(
    study: &'s Study,
    calibration: &Calibration,
    request: &Request<'_>,
) -> Result<Vec<Part<'s>>> {
    let find = |component: &'s Component| {
        Part::find(component, study.frames.as_deref(), calibration, request)
            .with_context(|| format!("the component {}", component.name))
    };
    // On a core each.
    let components = study.components.par_iter();
    let mut parts: Vec<Part<'s>> = components.map(find).collect::<Result<_>>()?;
    if request.asks_frames() {
        by_film(&mut parts, study, request)?;
    }
    let is = |role: Role| move |part: &Part<'_>| part.component.role() == Some(role);
    let mut femurs: Vec<(String, Vec<Option<Known>>)> = Vec::new();
    for part in parts.iter_mut().filter(|part| !is(Role::Tibia)(part)) {
        for found in &mut part.found {
            found.decisions = decide(&found.frames, &[], &Pose::IDENTITY)?;
        }
    }
    for part in parts.iter().filter(|part| is(Role::Femur)(part)) {
        let Some(axes) = part.axes()? else {
            continue;
        };
        let poses = part.found.iter().map(|found| {
            let known = |decision: &Option<Decision>| {
                let decision = decision.as_ref()?;
                Some(Known {
                    counterpart: Counterpart::Femur(decision.pose()?.compose(&axes)),
                    is_doubtful: decision.is_doubtful(),
                })
            };
            let poses = found.decisions.iter().map(known);
            (found.source.clone(), poses.collect())
        });
        femurs.extend(poses);
    }
    for part in parts.iter_mut().filter(|part| is(Role::Tibia)(part)) {
        // Without axes of its own a tibia has no tilt.
        let (axes, known) = match part.axes()? {
            Some(axes) => (axes, &femurs[..]),
            None => (Pose::IDENTITY, &[][..]),
        };
        for found in &mut part.found {
            found.decide_with(known, &axes)?;
        }
    }
    if request.method == Method::Image {
        doubt_unusual(&mut parts);
    }
    Ok(parts)
}

/// Doubts poses that leave more than is usual on their film.
fn doubt_unusual(parts: &mut [Part<'_>]) {
    for name in sources_of(parts) {
        let of = parts.iter_mut().flat_map(|part| &mut part.found);
        let mut found: Vec<&mut Found> = of.filter(|found| found.source == name).collect();
        if !found.iter().all(|found| found.film_is_known) {
            continue;
        }
        let misfit = |decision: &Option<Decision>| Some(decision.as_ref()?.chosen.misfit());
        let misfits = |found: &&mut Found| found.decisions.iter().map(misfit).collect();
        let misfits = Misfits(found.iter().map(misfits).collect());
        for (number, found) in found.iter_mut().enumerate() {
            for (frame, decision) in found.decisions.iter_mut().enumerate() {
                if let Some(decision) = decision {
                    let beside = misfits.beside(number, frame);
                    let doubt = beside.doubt(decision.chosen.misfit());
                    decision.verdict = decision.verdict.or_doubt(doubt);
                }
            }
        }
    }
}

fn sources_of(parts: &[Part<'_>]) -> BTreeSet<String> {
    let sources = parts.iter().flat_map(|part| &part.found);
    sources.map(|found| found.source.clone()).collect()
}

impl Found {
    /// Chooses tibial poses with the femoral ones of a source known.
    fn decide_with(&mut self, femurs: &[(String, Vec<Option<Known>>)], axes: &Pose) -> Result<()> {
        let fitting = || {
            femurs
                .iter()
                .filter(|(_, poses)| poses.len() == self.frames.len())
        };
        let same = fitting().find(|(source, _)| *source == self.source);
        let femur = same.or_else(|| fitting().next());
        let counterparts = femur.map_or(Vec::new(), |(_, known)| known.clone());
        self.femur = femur.map(|(source, _)| source.clone());
        self.decisions = decide(&self.frames, &counterparts, axes)?;
        Ok(())
    }
}

impl<'s> Part<'s> {
    fn find(
        component: &'s Component,
        frames: Option<&Path>,
        calibration: &Calibration,
        request: &Request<'_>,
    ) -> Result<Self> {
        let mut part = Self {
            component,
            model: component.read_model()?,
            reference: Reference::of(component, frames)?,
            found: Vec::new(),
        };
        let wanted = |name: &String| request.source.is_none_or(|source| source == name);
        for (name, masks) in component.masks.iter().filter(|(name, _)| wanted(name)) {
            let folders = Folders {
                masks,
                unknown: component.unknown.get(name).map(PathBuf::as_path),
                frames: frames.filter(|_| request.asks_frames()),
            };
            let source = Source::read(&folders, calibration)?;
            let found = part.find_source(name, source, calibration, request)?;
            part.found.push(found);
        }
        Ok(part)
    }

    /// The rotation from the field's axes to the model's, as the study states it or the shape tells it. Where that does not
    /// tell which way is up, the directions alone, which the tilt asks for.
    pub(super) fn axes(&self) -> Result<Option<Pose>> {
        let Some(role) = self.component.role() else {
            return Ok(None);
        };
        let model = self.model.as_model();
        let axes = axes_of(&model, role, self.component.axes.as_deref())?;
        let unsigned = || {
            let planes = symmetry_planes(model.mesh());
            field_axes(model.mesh(), &planes, role.component())
        };
        Ok(axes.map(|axes| axes.model_from_field).or_else(unsigned))
    }

    /// The library: with the views that the study asks for, else with those that the masks show. Perspective depends on the
    /// distance: where nobody told it, the masks do.
    fn prepare(
        &self,
        calibration: &Calibration,
        sequence: &Sequence<'_>,
        request: &Request<'_>,
    ) -> Result<Built> {
        let nominal = self.component.nominal;
        let asked = ViewOptions {
            distance: self.component.distance_mm,
            ..nominal
                .map(|[x, y]| ViewOptions::window([x, y]))
                .unwrap_or_default()
        };
        let guess = asked.distance_for(calibration);
        let built = self.library(sequence, &asked, guess)?;
        if nominal.is_some() && asked.distance.is_some() {
            return Ok(built);
        }
        let finder = self.finder(&built, sequence, Method::Library, request)?;
        let first = first_poses(&finder, sequence);
        let middle = self.model.as_model().bounds().centre;
        let depths: Vec<f64> = first
            .iter()
            .map(|one| one.pose.transform(&middle)[2])
            .collect();
        let seen = match depths.is_empty() || asked.distance.is_some() {
            true => guess,
            false => median_absolute(&depths),
        };
        if nominal.is_none() && is_within_the_window(&first) {
            return self.library(sequence, &ViewOptions::window([0.0; 2]), seen);
        }
        match (seen / guess - 1.0).abs() <= ALIKE {
            true => Ok(built),
            false => self.library(sequence, &asked, seen),
        }
    }

    fn library(
        &self,
        sequence: &Sequence<'_>,
        views: &ViewOptions,
        distance: f64,
    ) -> Result<Built> {
        build_library(self.model.as_model(), sequence.camera(), views, distance)
            .with_context(|| self.component.words())
    }

    fn finder<'l>(
        &'l self,
        built: &'l Built,
        sequence: &Sequence<'_>,
        method: Method,
        request: &Request<'_>,
    ) -> Result<Finder<'l>> {
        let mesh = self.model.as_model();
        let finder = Finder::open(&built.bytes, mesh, sequence.camera(), method)?;
        Ok(finder.with_edges(request.edges))
    }

    fn find_source(
        &self,
        name: &str,
        files: Source,
        calibration: &Calibration,
        request: &Request<'_>,
    ) -> Result<Found> {
        let sequence = files.disturbed(&request.disturbance)?;
        let built = self.prepare(calibration, &sequence, request)?;
        let count = sequence.masks().len();
        if let Some(reference) = &self.reference
            && reference.poses.len() != count
        {
            bail!(
                "{name}: {count} masks but {} reference poses; both must be of the same frames",
                reference.poses.len()
            );
        }
        // Outlines first: they tell the film, and with it poses are brought onto the frames.
        let method = match request.method {
            Method::Image => Method::Refined,
            method => method,
        };
        let finder = self.finder(&built, &sequence, method, request)?;
        let frames = find_poses(&finder, &sequence);
        let masks = sequence.masks();
        let hidden = masks.map(|(_, mask)| mask.hidden.clone()).collect();
        drop(sequence);
        Ok(Found {
            source: name.to_owned(),
            camera: files.camera,
            frames,
            decisions: Vec::new(),
            femur: None,
            from_reference: None,
            film: None,
            film_is_known: false,
            files,
            hidden,
        })
    }
}

/// Whether most frames are seen from within the window of Walker et al. 1996 about the file's own axes, by the best of
/// all views: its library is finer.
fn is_within_the_window(first: &[Located]) -> bool {
    let (grid, window) = (ViewOptions::default().grid(), ViewGrid::default());
    let is_within = |best: &&Located| {
        let [x, y] = grid.rotations(best.view);
        x.abs() <= -window.x.first && y.abs() <= -window.y.first
    };
    5 * first.iter().filter(is_within).count() >= 4 * first.len().max(1)
}

/// Where refinement on the grey frame comes to from the reference poses; of several answers, as a
/// mirrored one, the nearest to the reference.
fn from_reference(
    part: &Filmed<'_>,
    reference: &Reference,
    film: Option<FilmModel>,
) -> Vec<Option<Pose>> {
    let refine = |buffers: &mut RefineBuffers, (frame, pose): (usize, &Option<Pose>)| {
        let start = in_front(&(*pose)?, &part.model.bounds().centre);
        let found = part.refine(frame, &start, film, buffers);
        let turn = |pose: &Pose| geodesic_deg(&pose.rotation, &start.rotation);
        let poses = found.map(|found| {
            let poses = found.iter().map(|rival| rival.refined.pose);
            poses.min_by(|a, b| turn(a).total_cmp(&turn(b)))
        });
        poses.unwrap_or_else(|error| {
            eprintln!("frame {} from the reference pose: {error:#}", frame + 1);
            None
        })
    };
    let known = reference.poses.par_iter().enumerate();
    known.map_init(RefineBuffers::default, refine).collect()
}

/// Brings the poses of each source onto the grey frames, by what these tell of the film.
fn by_film(parts: &mut [Part<'_>], study: &Study, request: &Request<'_>) -> Result<()> {
    for name in sources_of(parts) {
        let mut filmed = Vec::new();
        let mut rest = Vec::new();
        for part in &mut *parts {
            let Part {
                component,
                model,
                reference,
                found,
            } = part;
            let Some(found) = found.iter_mut().find(|found| found.source == name) else {
                continue;
            };
            filmed.push(Filmed {
                name: &component.name,
                model: model.as_model(),
                sequence: found.files.disturbed(&request.disturbance)?,
                edges: request.edges,
                found: &mut found.frames,
                square_px: 1,
            });
            rest.push((
                component.attenuation,
                reference,
                (&mut found.film, &mut found.film_is_known),
                &mut found.from_reference,
            ));
        }
        let attenuations: Vec<_> = rest.iter().map(|(attenuation, ..)| *attenuation).collect();
        let stated = Stated::of(study.film, &attenuations);
        let outlines: Vec<_> = filmed.iter().map(|part| part.found.clone()).collect();
        let known = bring_onto_frames(&mut filmed, &stated);
        let offsets: Vec<_> = filmed.iter().map(Filmed::mask_offset).collect();
        for ((part, offset), outlines) in filmed.iter_mut().zip(&offsets).zip(&outlines) {
            if let (true, Some(common)) = (request.is_centred(), offset) {
                *part.found = part.without_offset(outlines, *common);
            }
        }
        for (((part, (_, reference, (film, is_known), starts)), model), offset) in
            filmed.iter().zip(rest).zip(&known.models).zip(offsets)
        {
            let lying = offset.map_or(String::new(), |common| {
                format!("; {}", offset_words(common))
            });
            *film = Some(known.words.clone() + &lying);
            *is_known = model.is_some();
            if request.is_centred() {
                continue;
            }
            *starts = reference
                .as_ref()
                .map(|reference| from_reference(part, reference, *model));
        }
    }
    Ok(())
}
