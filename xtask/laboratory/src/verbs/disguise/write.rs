//! A disguised copy of a study, with its truth.

use std::collections::HashSet;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result, ensure};
use fluoropose::camera::Camera;
use fluoropose::math::{Vector3, norm};
use fluoropose::pose::{EulerPose, Pose};
use fluoropose::render::{Projected, render, scratch_needed};
use fluoropose_decode::GreyFrame;
use fluoropose_phantom::implant::Side;
use fluoropose_phantom::own_folder::{check_files, check_source, check_study};
use fluoropose_phantom::picture::write_mask;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

use super::lens::Lens;
use super::mesh;
use super::picture::Picture;
use super::plan::{Frames, Plan};
use crate::files::{
    Component, Film, MaskBuffer, Study, grey, is_of_system, read_calibration, read_model,
    read_poses_of, write_poses, write_text,
};
use crate::measure::accuracy::in_front;

/// Streams of random numbers that no frame's noise has.
const MODELS: u64 = 1 << 63;
/// The file that states the disguise.
const STATED: &str = "disguise.toml";
/// Every so many pixels of a frame tell where a steep curve ends.
const SAMPLED: usize = 97;

/// Writes a study in disguise, and tells where its pixels went. Masks are drawn at its references' poses.
///
/// # Errors
/// For files that are missing, unreadable or do not belong together, and a plan that leaves no frame or component.
pub fn disguise(file: &Path, plan: &Plan, out: &Path) -> Result<Lens> {
    let study = Study::read_quietly(file)?;
    let folder = study.frames_folder()?;
    study.check_files(Some(folder))?;
    let film = Film::read(folder)?;
    let chosen = plan.frames.chosen(film.count());
    ensure!(!chosen.is_empty(), "no frame is left of {}", film.count());
    plan.check()?;
    let only = plan.models.only.as_deref();
    only.map(|name| study.component(name)).transpose()?;
    check_out(file, &study, plan, chosen.len(), out)?;
    let known: Vec<Known<'_>> = study
        .components
        .iter()
        .map(|component| Known::read(component, (folder, film.count()), &chosen))
        .collect::<Result<_>>()?;
    let calibration = read_calibration(&study.calibration)?;
    let camera = calibration.camera(film.size().0, film.size().1)?;
    let (middle, away) = middle(&known, &camera);
    let lens = Lens::new(&plan.view, camera, middle)?;
    fs::create_dir_all(out.join("frames")).with_context(|| out.display().to_string())?;
    let written = lens.calibration(
        &plan.view,
        calibration.principal_distance(),
        away.unwrap_or(1000.0),
    );
    write_text(&out.join("calibration.txt"), &written.to_string())?;
    write_frames(&film, plan, &lens, &chosen, &out.join("frames"))?;
    let mut text = heading(&study, plan);
    let mut random = ChaCha8Rng::seed_from_u64(plan.seed);
    random.set_stream(MODELS);
    for known in &known {
        let keys = known.write(plan, &lens, &mut random, out)?;
        let is_there = plan
            .models
            .only
            .as_ref()
            .is_none_or(|only| *only == known.component.name);
        text += if is_there { &keys } else { "" };
    }
    write_text(&out.join(STATED), &toml::to_string(plan)?)?;
    write_text(&out.join("study.toml"), &text)?;
    Ok(lens)
}

/// Refuses a folder in which something of others stands: a disguise is told by the file that states it.
fn check_out(file: &Path, study: &Study, plan: &Plan, count: usize, out: &Path) -> Result<()> {
    check_source(file, out)?;
    check_study(out, |_| out.join(STATED).is_file())?;
    let names = |ending: &str| -> HashSet<String> {
        let names = (0..count).map(|place| format!("{}.{ending}", plan.frames.name(place)));
        names.collect()
    };
    let only = |folder: &Path, own: &HashSet<String>| {
        check_files(folder, |name| own.contains(name) || is_of_system(name))
    };
    only(&out.join("frames"), &names(plan.frames.kind.ending()))?;
    let masks = names("png");
    let mut components = study.components.iter();
    components.try_for_each(|one| only(&out.join("masks").join(&one.name), &masks))
}

impl Frames {
    /// The frames that are taken of so many, from 0, in their new order.
    fn chosen(&self, of: usize) -> Vec<usize> {
        let most = if self.count == 0 { of } else { self.count };
        let taken = (self.first..of).step_by(self.every.max(1)).take(most);
        match self.backwards {
            true => taken.rev().collect(),
            false => taken.collect(),
        }
    }

    /// The name of a frame, from 0, without its ending.
    pub(super) fn name(&self, place: usize) -> String {
        format!(
            "{}{:0digits$}",
            self.prefix,
            place + 1,
            digits = self.digits
        )
    }
}

/// Text as the study file has it.
fn quoted(text: &str) -> String {
    toml::Value::from(text).to_string()
}

/// The keys of the study; side, where it is known, is that of the picture.
fn heading(study: &Study, plan: &Plan) -> String {
    let mut text = format!(
        "# {plan}\nname = {}\n",
        quoted(&format!("{} {}", study.name, plan.seed))
    );
    let side = study.side.map(|side| match (side, plan.view.mirrored) {
        (Side::Left, false) | (Side::Right, true) => "left",
        _ => "right",
    });
    let side = side.map(|side| format!("side = \"{side}\"\n"));
    text += side.as_deref().unwrap_or_default();
    text + "calibration = \"calibration.txt\"\nframes = \"frames\"\n"
}

/// Where the components lie on the film's frames on average, and how far away, mm; nothing without references.
fn middle(known: &[Known<'_>], camera: &Camera) -> (Option<[f64; 2]>, Option<f64>) {
    let all: Vec<Vector3> = known.iter().flat_map(Known::middles).collect();
    let count = all.len() as f64;
    let places = all.iter().filter_map(|at| camera.project(at));
    let sum = places.fold([0.0; 2], |[x, y], at| [x + at.column, y + at.row]);
    let away = all.iter().map(norm).sum::<f64>();
    let of = |value: f64| value / count;
    (
        (!all.is_empty()).then_some(sum.map(of)),
        (!all.is_empty()).then_some(of(away)),
    )
}

fn white(frame: &GreyFrame) -> f64 {
    f64::from((1u32 << frame.bits) - 1)
}

fn write_frames(
    film: &Film,
    plan: &Plan,
    lens: &Lens,
    chosen: &[usize],
    folder: &Path,
) -> Result<()> {
    let first = film.frame(chosen[0])?;
    let shown = grey(&first)?;
    let (width, height) = shown.size();
    let sampled = (0..width * height).step_by(SAMPLED);
    let value = |at: usize| shown.at((at % width) as f64 + 0.5, (at / width) as f64 + 0.5);
    let clip = plan.tone.clip(
        sampled
            .filter_map(value)
            .map(|value| value / white(&first))
            .collect(),
    );
    let kind = plan.frames.kind;
    chosen
        .par_iter()
        .enumerate()
        .try_for_each(|(place, &frame)| {
            let decoded = film.frame(frame)?;
            let name = format!("{}.{}", plan.frames.name(place), kind.ending());
            let picture = Picture::of(
                plan,
                lens,
                (&*grey(&decoded)?, white(&decoded)),
                clip,
                place as u64,
            );
            picture.write(&folder.join(name), kind)
        })
}

/// A component with its reference poses of the frames that are taken.
struct Known<'s> {
    component: &'s Component,
    middle: Vector3,
    poses: Option<Vec<Option<Pose>>>,
}

impl<'s> Known<'s> {
    /// Of a film of so many frames in a folder.
    fn read(
        component: &'s Component,
        (frames, count): (&Path, usize),
        chosen: &[usize],
    ) -> Result<Self> {
        let middle = component.read_model()?.as_model().bounds().centre;
        let poses = component.reference.as_ref().map(|path| {
            let all = read_poses_of(path, Some(frames))?;
            let rows = all.len();
            ensure!(
                rows == count,
                "{}: there are {rows} rows, but the film has {count} frames",
                path.display()
            );
            let pose = |&frame: &usize| Some(in_front(all.get(frame)?.as_ref()?, &middle));
            anyhow::Ok(chosen.iter().map(pose).collect())
        });
        Ok(Self {
            component,
            middle,
            poses: poses.transpose()?,
        })
    }

    /// The middles of its box, mm from the film's camera.
    fn middles(&self) -> impl Iterator<Item = Vector3> {
        let poses = self.poses.iter().flatten().flatten();
        poses.map(|pose| pose.transform(&self.middle))
    }

    /// Writes model, poses and masks, and returns the component's keys.
    fn write(
        &self,
        plan: &Plan,
        lens: &Lens,
        random: &mut ChaCha8Rng,
        out: &Path,
    ) -> Result<String> {
        let name = &self.component.name;
        let mirrored = plan.view.mirrored;
        let axes = mesh::axes(&plan.models, mirrored, random);
        let model = format!("{name}.{}", plan.models.mesh.ending());
        mesh::write(
            self.component,
            &out.join(&model),
            &plan.models,
            &axes,
            mirrored,
            random,
        )?;
        let mut text = format!(
            "[[component]]\nname = {}\nmodel = {}\n",
            quoted(name),
            quoted(&model)
        );
        if let Some(role) = self.component.role() {
            let _ = writeln!(text, "role = \"{}\"", format!("{role:?}").to_lowercase());
        }
        let Some(poses) = &self.poses else {
            return Ok(text);
        };
        let there = |pose: &Option<Pose>| pose.as_ref().map(|pose| lens.pose(pose, &axes));
        let there: Vec<Option<Pose>> = poses.iter().map(there).collect();
        let rows: Vec<Option<EulerPose>> =
            there.iter().map(|pose| pose.map(EulerPose::from)).collect();
        write_poses(&out.join(format!("{name}.jts")), &rows)?;
        write_masks(
            &out.join(&model),
            &lens.to,
            &there,
            &plan.frames,
            &out.join("masks").join(name),
        )?;
        let _ = writeln!(
            text,
            "reference = {}\nmasks.truth = {}",
            quoted(&format!("{name}.jts")),
            quoted(&format!("masks/{name}"))
        );
        Ok(text)
    }
}

/// Draws a model at poses; where there is none, nothing.
fn write_masks(
    model: &Path,
    camera: &Camera,
    poses: &[Option<Pose>],
    frames: &Frames,
    folder: &Path,
) -> Result<()> {
    let owned = read_model(model)?;
    let model = owned.as_model();
    fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    poses.par_iter().enumerate().try_for_each(|(place, pose)| {
        let mut drawn = MaskBuffer::new(camera.width(), camera.height())?;
        if let Some(pose) = pose {
            let mut scratch = vec![Projected::default(); scratch_needed(&model)];
            drawn.draw(|mask| render(&model, camera, pose, &mut scratch, mask))?;
        }
        write_mask(
            &folder.join(format!("{}.png", frames.name(place))),
            &drawn.mask(),
        )
    })
}
