//! The relation that must hold for all models: whatever the file's axes and the direction of view, the part is found at
//! its place in the camera's frame.

use anyhow::Result;
use fluoropose::camera::Camera;
use fluoropose::finder::choice::ChoiceContext;
use fluoropose::finder::{Candidate, Verdict};
use fluoropose::math::{Matrix3, apply};
use fluoropose::mesh::{Model, OwnedModel};
use fluoropose::pose::Pose;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use serde::Serialize;

use super::random;
use crate::finding::{Finder, Method, ViewOptions, build_library};
use crate::measure::accuracy::Errors;
use crate::noise::{DisturbanceOptions, Scene};
use crate::progress::progress;

/// Views that are drawn for one choice of axes: as many as make a new library worth its while.
const VIEWS: usize = 20;

/// A pose is right within this of the truth: degrees, mm in the plane, mm of depth.
const RIGHT: (f64, f64, f64) = (1.0, 0.5, 3.0);

/// What is drawn.
#[derive(Clone, Copy, Debug)]
pub struct Anywhere {
    /// Whether the model's axes are turned at random.
    pub any_axes: bool,
    /// Distance of the library's views and middle of the range of z, mm.
    pub distance: f64,
    /// Number of poses.
    pub poses: usize,
    /// Seed of axes and poses.
    pub seed: u64,
}

/// How often the part was found at its place.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Places {
    /// Poses drawn.
    pub poses: usize,
    /// Found within 1 degree, 0.5 mm in the plane and 3 mm of depth.
    pub right: usize,
    /// Not right, but called doubtful with the right pose among the candidates.
    pub among_candidates: usize,
    /// Neither, and called doubtful or refused.
    pub doubted: usize,
    /// Neither, and called good.
    pub wrong: usize,
}

impl Places {
    /// Right ones and those that are told to be open, as a part of all.
    pub fn part(&self) -> f64 {
        (self.right + self.among_candidates) as f64 / self.poses as f64
    }

    fn plus(self, other: Self) -> Self {
        Self {
            poses: self.poses + other.poses,
            right: self.right + other.right,
            among_candidates: self.among_candidates + other.among_candidates,
            doubted: self.doubted + other.doubted,
            wrong: self.wrong + other.wrong,
        }
    }
}

/// Draws the model from everywhere and finds it again, from the silhouette alone.
///
/// # Errors
/// Where a view cannot be drawn.
pub fn measure_anywhere(model: &Model<'_>, camera: Camera, what: &Anywhere) -> Result<Places> {
    let bar = progress(what.poses, "poses");
    let rounds = what.poses.div_ceil(VIEWS);
    let round = |round: usize| {
        let count = VIEWS.min(what.poses - round * VIEWS);
        let places = one_round(model, camera, what, round as u64, count);
        bar.inc(count as u64);
        places
    };
    let sum = |a: Places, b: Places| Ok(a.plus(b));
    let places = (0..rounds).into_par_iter().map(round);
    let places = places.try_reduce(Places::default, sum)?;
    bar.finish_and_clear();
    Ok(places)
}

/// Views of the model with its axes turned once.
fn one_round(
    model: &Model<'_>,
    camera: Camera,
    what: &Anywhere,
    round: u64,
    count: usize,
) -> Result<Places> {
    let mut random = ChaCha8Rng::seed_from_u64(what.seed);
    random.set_stream(round);
    let turned = match what.any_axes {
        true => turned(model, &random::rotation(&mut random))?,
        false => turned(model, &Pose::IDENTITY.rotation)?,
    };
    let model = turned.as_model();
    let built = build_library(model, camera, &ViewOptions::default(), what.distance)?;
    let mut finder = Finder::open(&built.bytes, model, camera, Method::Refined)?;
    let mut scene = Scene::new(model, camera, DisturbanceOptions::default())?;
    let mut places = Places::default();
    for frame in 0..count {
        let truth = random::pose(&mut random, &model, what.distance);
        let (truth, seen) = scene.observe(&truth, frame as u64)?;
        let middle = model.bounds().centre;
        let found = seen.see(|silhouette| finder.all(&silhouette.into()));
        let right = |candidate: &Candidate| is_right(&candidate.pose, &truth, &middle);
        let decision = found
            .as_ref()
            .ok()
            .and_then(|found| found.decide(&ChoiceContext::default()));
        places.poses += 1;
        let (Ok(found), Some(decision)) = (found, decision) else {
            places.doubted += 1;
            continue;
        };
        let good = decision.verdict == Verdict::Good;
        *match () {
            () if right(&found.candidates[decision.choice.index]) => &mut places.right,
            () if !good && found.candidates.iter().any(right) => &mut places.among_candidates,
            () if !good => &mut places.doubted,
            () => &mut places.wrong,
        } += 1;
    }
    Ok(places)
}

/// A model whose file has other axes.
fn turned(model: &Model<'_>, axes: &Matrix3) -> Result<OwnedModel> {
    let mesh = model.mesh();
    let vertices = mesh.vertices().iter().flat_map(|vertex| {
        let turned = apply(axes, &vertex.map(f64::from));
        turned.map(|value| value as f32)
    });
    let triangles = mesh.triangles().as_flattened().to_vec();
    Ok(OwnedModel::new(vertices.collect(), triangles)?)
}

fn is_right(found: &Pose, truth: &Pose, middle: &[f64; 3]) -> bool {
    let (deg, aside, along) = RIGHT;
    let (there, here) = (found.transform(middle), truth.transform(middle));
    let [x, y, z] = std::array::from_fn(|k| there[k] - here[k]);
    let turn = Errors::of(found, truth).geodesic_deg;
    turn <= deg && x.hypot(y) <= aside && z.abs() <= along
}
