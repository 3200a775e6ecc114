//! Grey films of the built-in implants: how far off their poses are, and whether that is told.

mod draw;
mod joint;
mod kinds;
mod outcome;
mod study;
mod table;
mod trial;

use std::path::Path;

use anyhow::{Result, ensure};
use fluoropose::camera::Camera;
use fluoropose::mesh::Model;
use fluoropose_phantom::implant::{self, Parameters, Triangles};
use rayon::prelude::*;

use crate::files::{owned, write_json};
use crate::finding::{ViewOptions, build_library};
use crate::options::at_least_1;
use crate::progress::progress;
use draw::{Film, Number, draw};
pub use joint::JointBands;
pub use kinds::FilmKind;
use outcome::Outcome;
use study::Study;
pub use table::FilmRow;
use table::{print, print_heading, print_legend};
pub use trial::FilmWay;
use trial::{Attempt, Bench};

/// Side of the square frames (pixels), focus to detector and pitch of its pixels (mm), distance of the libraries' views (mm).
const FRAME: usize = 1024;
const PRINCIPAL_DISTANCE: f64 = 1200.0;
const PITCH: f64 = 0.373;
const DISTANCE: f64 = 1080.0;
const PARTS: [&str; 2] = ["femur", "tibia"];

/// Options of `synthetic --films`.
#[derive(clap::Args)]
pub(super) struct FilmArgs {
    /// Grey films of the built-in implants, of several kinds: both components from one click, and refined from the truth
    #[arg(long, group = "filmed", conflicts_with_all = super::OF_THE_PROTOCOL, conflicts_with_all = super::OF_THE_LIBRARY)]
    pub(super) films: bool,
    /// With --films: films of each kind
    #[arg(long, default_value_t = 25, value_parser = at_least_1, requires = "filmed")]
    count: usize,
    /// With --films: only kinds whose name holds this
    #[arg(long, value_name = "WORDS", requires = "filmed")]
    only: Option<String>,
    /// With --films: how poses are come by [default: click, image, alone]
    #[arg(long, value_enum, value_name = "WAY", requires = "filmed")]
    way: Vec<FilmWay>,
}

/// What is measured.
#[derive(Clone, Copy, Debug)]
pub struct Films<'f> {
    /// The kinds of films.
    pub kinds: &'f [FilmKind],
    /// Films of each.
    pub count: usize,
    /// Seed of poses and noise: the same seed shows the same knees in every kind.
    pub seed: u64,
    /// How poses are come by.
    pub ways: &'f [FilmWay],
}

/// Measures and prints.
///
/// # Errors
/// Those of [`measure_films`].
pub(super) fn run(args: &FilmArgs, seed: u64, json: Option<&Path>) -> Result<()> {
    let mut kinds = FilmKind::all();
    if let Some(words) = &args.only {
        let names: Vec<String> = kinds.iter().map(|kind| kind.name.clone()).collect();
        kinds.retain(|kind| kind.name.contains(words));
        ensure!(
            !kinds.is_empty(),
            "no kind of film has a name that holds '{words}': {}",
            names.join(", ")
        );
    }
    let what = Films {
        kinds: &kinds,
        count: args.count,
        seed,
        ways: match &args.way[..] {
            [] => &FilmWay::USUAL,
            ways => ways,
        },
    };
    print_heading();
    let rows = measure_films(&what, print)?;
    print_legend();
    write_json(json, &rows)
}

/// Draws films of each kind and finds both components in them; `each` gets a row as soon as it is known.
///
/// # Errors
/// Where a film cannot be drawn.
pub fn measure_films(what: &Films<'_>, each: impl Fn(&FilmRow)) -> Result<Vec<FilmRow>> {
    let parameters = Parameters::default();
    let implants = [implant::femur(&parameters)?, implant::tibia(&parameters)?];
    let meshes = [owned(implants[0].clone())?, owned(implants[1].clone())?];
    let models = [meshes[0].as_model(), meshes[1].as_model()];
    let camera =
        Camera::from_principal_distance(FRAME, FRAME, PRINCIPAL_DISTANCE, PITCH, [0.0; 2])?;
    let library = |part: usize| {
        let built = build_library(models[part], camera, &ViewOptions::default(), DISTANCE);
        built.map(|built| built.bytes)
    };
    let libraries = match what.ways.iter().any(|way| way.is_found()) {
        true => Some([library(0)?, library(1)?]),
        false => None,
    };
    let mut rows = Vec::new();
    let mut all = vec![Vec::new(); what.ways.len()];
    for kind in what.kinds {
        let films = films_of(kind, &implants, camera, what)?;
        for (&way, all) in what.ways.iter().zip(&mut all) {
            let open = || Bench::open(libraries.as_ref(), models, camera);
            let study = Study {
                attempts: attempts_of(&films, way, &open)?,
                films: &films,
                models,
                camera,
            };
            let outcomes = study.outcomes(way)?;
            add_rows((&kind.name, way), &models, &outcomes, &each, &mut rows);
            all.extend(outcomes);
        }
    }
    if what.kinds.len() > 1 {
        for (way, outcomes) in what.ways.iter().zip(&all) {
            add_rows(("all of these", *way), &models, outcomes, &each, &mut rows);
        }
    }
    Ok(rows)
}

fn add_rows(
    (films, way): (&str, FilmWay),
    models: &[Model<'_>; 2],
    outcomes: &[[Outcome; 2]],
    each: &impl Fn(&FilmRow),
    rows: &mut Vec<FilmRow>,
) {
    for (part, name) in PARTS.into_iter().enumerate() {
        let column: Vec<Outcome> = outcomes.iter().map(|film| film[part]).collect();
        let mut row = FilmRow::of(films, [name, way.word()], &column);
        if part == 1 {
            row.joint = JointBands::of(models, outcomes);
        }
        each(&row);
        rows.push(row);
    }
}

/// The films of a kind: a study, as it were.
fn films_of(
    kind: &FilmKind,
    implants: &[Triangles; 2],
    camera: Camera,
    what: &Films<'_>,
) -> Result<Vec<Film>> {
    let bar = progress(what.count, "films");
    let film = |frame: usize| {
        let number = Number {
            seed: what.seed,
            frame: frame as u64,
        };
        let film = draw(implants, camera, &kind.physics, &number);
        bar.inc(1);
        film
    };
    let films = (0..what.count).into_par_iter().map(film).collect();
    bar.finish_and_clear();
    films
}

/// Poses in each film, by component, before anything is known of the film.
fn attempts_of<'b>(
    films: &[Film],
    way: FilmWay,
    open: &(impl Fn() -> Result<Bench<'b>> + Sync),
) -> Result<Vec<[Attempt; 2]>> {
    let bar = progress(films.len(), "found");
    let run = |bench: &mut Result<Bench<'b>>, film: &Film| match bench {
        Ok(bench) => {
            let attempt = bench.attempt(film, way);
            bar.inc(1);
            attempt
        }
        Err(error) => anyhow::bail!("{error:#}"),
    };
    let attempts = films.par_iter().map_init(open, run).collect();
    bar.finish_and_clear();
    attempts
}
