//! What is called good, doubtful and no fit: true outlines, and outlines that are no view of the model.

use anyhow::Result;
use fluoropose::camera::Camera;
use fluoropose::finder::choice::ChoiceContext;
use fluoropose::finder::{Decision, Found};
use fluoropose::image::mask::Mask;
use fluoropose::mesh::{Model, OwnedModel};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use serde::Serialize;

use super::ranges::FAILURE_DEG;
use super::{random, strangers};
use crate::files::MaskBuffer;
use crate::finding::{Finder, Method, ViewOptions, build_library};
use crate::measure::accuracy::{Errors, rms};
use crate::noise::{DisturbanceOptions, Scene};
use crate::progress::progress;

/// What is drawn.
#[derive(Clone, Copy, Debug)]
pub struct Refusal<'r> {
    /// Models whose outlines are not the model's: the other component, other implants.
    pub others: &'r [OwnedModel],
    /// Distance of the library's views and middle of the range of z, mm.
    pub distance: f64,
    /// True outlines; of each kind of other ones, a quarter.
    pub poses: usize,
    /// Seed of poses, shapes and noise.
    pub seed: u64,
}

/// One kind of outlines.
#[derive(Clone, Debug, Serialize)]
pub struct Kind {
    /// What they are.
    pub kind: String,
    /// How many.
    pub count: usize,
    /// Verdicts.
    pub good: usize,
    /// See `good`.
    pub doubtful: usize,
    /// See `good`.
    pub none: usize,
    /// Of those called good, poses more than 4 degrees off, where there is a truth.
    pub good_but_wrong: usize,
    /// Root mean square error of depth of those called good, mm, where there is a truth.
    pub good_z_mm: Option<f64>,
    /// Of the fits of the best candidates: part met, misfit and mean distance (pixels) that nine in ten fall short of, in
    /// that order; and the same that one in ten falls short of.
    pub nine_in_ten: [f64; 3],
    /// See `nine_in_ten`.
    pub one_in_ten: [f64; 3],
}

/// What an outline is.
#[derive(Clone, Copy)]
enum Shape<'s> {
    /// The model's, by a hand, a part hidden.
    True(DisturbanceOptions),
    /// Another model's.
    Other(&'s OwnedModel),
    Ellipse,
    Blob,
    Hull,
    Cut,
}

const HAND: DisturbanceOptions = DisturbanceOptions {
    jitter: 1.0,
    correlation: 10.0,
    occlude: 0.0,
    unmarked: false,
    noise_seed: 1,
};

/// Draws every kind of outlines and judges what is found of them.
///
/// # Errors
/// Where one cannot be drawn.
pub fn measure_refusal(model: &Model<'_>, camera: Camera, what: &Refusal<'_>) -> Result<Vec<Kind>> {
    let hidden = |occlude: f64, unmarked: bool| {
        Shape::True(DisturbanceOptions {
            occlude,
            unmarked,
            ..HAND
        })
    };
    let scaled = |by: f32| scaled(model, [by; 3]);
    let sizes = [1.03, 1.05, 1.08].map(scaled);
    let mirrored = scaled_mirror(model)?;
    let mut kinds: Vec<(String, Shape<'_>, usize)> = vec![
        (
            "true, 1 px of jitter".into(),
            Shape::True(HAND),
            what.poses / 2,
        ),
        (
            "true, a fifth hidden, told".into(),
            hidden(0.2, false),
            what.poses / 4,
        ),
        (
            "true, a fifth hidden, not told".into(),
            hidden(0.2, true),
            what.poses / 4,
        ),
    ];
    let few = what.poses / 4;
    for (number, other) in what.others.iter().enumerate() {
        kinds.push((
            format!("other model {}", number + 1),
            Shape::Other(other),
            few,
        ));
    }
    for (name, shape) in [
        ("ellipse", Shape::Ellipse),
        ("blob", Shape::Blob),
        ("convex hull", Shape::Hull),
        ("cut straight", Shape::Cut),
        ("mirrored model", Shape::Other(&mirrored)),
    ] {
        kinds.push((name.into(), shape, few));
    }
    let sizes = sizes.into_iter().collect::<Result<Vec<_>>>()?;
    for (percent, size) in [3, 5, 8].into_iter().zip(&sizes) {
        kinds.push((format!("{percent} % larger"), Shape::Other(size), few));
    }
    let built = build_library(*model, camera, &ViewOptions::default(), what.distance)?;
    let finder = Finder::open(&built.bytes, *model, camera, Method::Refined)?;
    kinds
        .iter()
        .enumerate()
        .map(|(number, (name, shape, count))| {
            one_kind(model, &finder, camera, what, (number, name, *shape, *count))
        })
        .collect()
}

/// What one outline led to.
struct Judged {
    found: Option<(Found, Decision)>,
    /// Errors against the truth, where there is one.
    errors: Option<Errors>,
}

fn one_kind(
    model: &Model<'_>,
    finder: &Finder<'_>,
    camera: Camera,
    what: &Refusal<'_>,
    (number, name, shape, count): (usize, &str, Shape<'_>, usize),
) -> Result<Kind> {
    let bar = progress(count, name);
    let one = |finder: &mut Finder<'_>, index: usize| -> Result<Judged> {
        let mut random = ChaCha8Rng::seed_from_u64(what.seed);
        random.set_stream((number as u64) << 32 | index as u64);
        let judged = judge_one(model, finder, camera, what.distance, shape, &mut random);
        bar.inc(1);
        judged
    };
    let all = (0..count).into_par_iter();
    let all: Vec<Judged> = all
        .map_init(|| finder.clone(), one)
        .collect::<Result<_>>()?;
    bar.finish_and_clear();
    Ok(summary(name, &all))
}

fn judge_one(
    model: &Model<'_>,
    finder: &mut Finder<'_>,
    camera: Camera,
    distance: f64,
    shape: Shape<'_>,
    random: &mut ChaCha8Rng,
) -> Result<Judged> {
    let frame = random.random_range(0..1 << 40);
    let other = match shape {
        Shape::Other(other) => other.as_model(),
        _ => *model,
    };
    let options = match shape {
        Shape::True(options) => DisturbanceOptions {
            occlude: options.occlude * random.random_range(0.0..=1.0f64),
            ..options
        },
        _ => HAND,
    };
    let pose = random::pose(random, &other, distance);
    let mut scene = Scene::new(other, camera, options)?;
    let (truth, mut seen) = scene.observe(&pose, frame)?;
    let change: Option<MaskBuffer> = {
        let mask: Mask<'_> = seen.mask.mask();
        match shape {
            Shape::True(_) | Shape::Other(_) => None,
            Shape::Ellipse => Some(strangers::ellipse(&mask, random)?),
            Shape::Blob => Some(strangers::blob(&mask, random)?),
            Shape::Hull => Some(strangers::hull(&mask)?),
            Shape::Cut => Some(strangers::cut(&mask, random)?),
        }
    };
    if let Some(mask) = change {
        seen.mask = mask;
    }
    let found = seen.see(|silhouette| finder.all(&silhouette.into())).ok();
    let found = found.and_then(|found| {
        let decision = found.decide(&ChoiceContext::default())?;
        Some((found, decision))
    });
    let errors = match shape {
        Shape::True(_) => found.as_ref().map(|(found, decision)| {
            Errors::of(&found.candidates[decision.choice.index].pose, &truth)
        }),
        _ => None,
    };
    Ok(Judged { found, errors })
}

fn summary(name: &str, all: &[Judged]) -> Kind {
    let word = |judged: &Judged| {
        let decision = judged.found.as_ref().map(|(_, decision)| decision);
        decision.map_or("none", |decision| decision.verdict.word())
    };
    let count = |wanted: &str| all.iter().filter(|judged| word(judged) == wanted).count();
    let good = || all.iter().filter(|judged| word(judged) == "good");
    let errors: Vec<Errors> = good().filter_map(|judged| judged.errors).collect();
    let fits = all.iter().filter_map(|judged| {
        let (found, decision) = judged.found.as_ref()?;
        let fit = found.candidates.get(decision.choice.index)?.fit;
        Some([fit.met, fit.misfit_px, fit.apart_px.unwrap_or(f64::NAN)])
    });
    let fits: Vec<[f64; 3]> = fits.collect();
    let at = |part: f64| {
        std::array::from_fn(|column| {
            let mut values: Vec<f64> = fits.iter().map(|fit| fit[column]).collect();
            values.sort_by(f64::total_cmp);
            let place = (part * values.len() as f64) as usize;
            values
                .get(place.min(values.len().saturating_sub(1)))
                .copied()
                .unwrap_or(f64::NAN)
        })
    };
    let depths: Vec<f64> = errors.iter().map(|errors| errors.z_mm).collect();
    Kind {
        kind: name.to_owned(),
        count: all.len(),
        good: count("good"),
        doubtful: count("doubtful"),
        none: count("none"),
        good_but_wrong: errors
            .iter()
            .filter(|e| e.geodesic_deg > FAILURE_DEG)
            .count(),
        good_z_mm: (!depths.is_empty()).then(|| rms(&depths)),
        nine_in_ten: at(0.9),
        one_in_ten: at(0.1),
    }
}

/// A model of another size, or mirrored.
fn scaled(model: &Model<'_>, by: [f32; 3]) -> Result<OwnedModel> {
    let mesh = model.mesh();
    let vertices = mesh.vertices().iter();
    let vertices =
        vertices.flat_map(|vertex| std::array::from_fn::<f32, 3, _>(|k| vertex[k] * by[k]));
    let triangles = mesh.triangles().as_flattened().to_vec();
    Ok(OwnedModel::new(vertices.collect(), triangles)?)
}

/// Mirrored in the file's z: the same implant for the other knee.
fn scaled_mirror(model: &Model<'_>) -> Result<OwnedModel> {
    scaled(model, [1.0, 1.0, -1.0])
}

/// Prints the table.
pub(super) fn print(kinds: &[Kind]) {
    println!(
        "{:<32} {:>6} {:>6} {:>9} {:>6} {:>11} {:>9}   met, misfit px, apart px: 1 in 10; 9 in 10 below",
        "outlines", "count", "good", "doubtful", "none", "good, wrong", "z RMS mm"
    );
    for kind in kinds {
        let numbers = |[met, misfit, apart]: [f64; 3]| format!("{met:.2} {misfit:5.2} {apart:5.2}");
        println!(
            "{:<32} {:>6} {:>6} {:>9} {:>6} {:>11} {:>9}   {}; {}",
            kind.kind,
            kind.count,
            kind.good,
            kind.doubtful,
            kind.none,
            kind.good_but_wrong,
            kind.good_z_mm.map_or(String::new(), |z| format!("{z:.2}")),
            numbers(kind.one_in_ten),
            numbers(kind.nine_in_ten)
        );
    }
}
