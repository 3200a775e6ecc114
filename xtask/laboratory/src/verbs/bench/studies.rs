//! What people have: masks of real films and models as a CAD program left them, each frame by one thread.

use std::path::Path;

use anyhow::{Context, Result};
use fluoropose::camera::Camera;
use fluoropose::canonical::canonicalise;
use fluoropose::film::pool::profiles_of_each;
use fluoropose::film::{FilmPool, FilmProfile, GivenFilm};
use fluoropose::finder::onto_target;
use fluoropose::library::Library;
use fluoropose::mesh::Model;
use fluoropose::refine::{RefineBuffers, RefineOptions, film_profiles};

use super::native::SearchBuffers;
use super::row::{Row, median, timed};
use crate::files::{Study, owned, read_calibration};
use crate::finding::{Built, EdgeOptions, Finder, Method, ViewOptions, build_library, image};
use crate::progress::announce;
use crate::sequence::{Folders, Sequence, Source};
use fluoropose_phantom::implant::{self, Parameters};

/// Frames of a sequence that are timed, evenly spread.
const FRAMES: usize = 16;
/// Times that each is.
const ROUNDS: usize = 3;
/// Libraries built, of which the median counts.
const BUILDS: usize = 3;

/// Study, component and source of masks.
const CASES: [(&str, &str, &str); 4] = [
    ("left8", "femur", "cnn"),
    ("left8", "tibia", "cnn"),
    ("film70", "femur", "reference"),
    ("film70", "tibia", "reference"),
];

/// A row for each kind of work on the studies in a folder.
pub(super) fn measure(studies: &Path) -> Result<Vec<Row>> {
    let mut rows = Vec::new();
    for case in CASES {
        rows.extend(component(studies, case)?);
    }
    let camera = Camera::from_principal_distance(1024, 1024, 1200.0, 0.373, [0.0, 0.0])?;
    let surface = owned(implant::femur(&Parameters::default())?)?;
    let model = surface.as_model();
    let faces = model.triangles().len();
    rows.push(
        build(
            &format!("built-in femur ({faces} faces)"),
            model,
            camera,
            1080.0,
        )?
        .0,
    );
    Ok(rows)
}

fn component(studies: &Path, (study, name, masks): (&str, &str, &str)) -> Result<Vec<Row>> {
    announce(&format!("{study}, {name}"));
    let path = studies.join(study).join("study.toml");
    let study_file = Study::read(&path)?;
    let component = study_file.components.iter().find(|one| one.name == name);
    let component = component.with_context(|| format!("{} has no {name}", path.display()))?;
    let calibration = read_calibration(&study_file.calibration)?;
    let folders = Folders {
        masks: component.masks.get(masks).context("no such masks")?,
        unknown: None,
        frames: study_file.frames.as_deref(),
    };
    let source = Source::read(&folders, &calibration)?;
    let sequence = source.disturbed(&crate::noise::DisturbanceOptions::default())?;
    let owned = component.read_model()?;
    let model = owned.as_model();
    let distance = ViewOptions::default().distance_for(&calibration);
    let what = format!("{study} {name} ({} faces)", model.triangles().len());
    let (row, built) = build(&what, model, sequence.camera(), distance)?;
    let mut rows = vec![row];
    for method in [Method::Library, Method::Refined, Method::Image] {
        let finder = Finder::open(&built.bytes, model, sequence.camera(), method)?;
        let finder = finder.with_edges(EdgeOptions::default());
        let work = format!("{what}, {masks} mask: {}, verdict included", method.word());
        rows.push(Row::new(&work, frames(finder, &sequence)?, "none", None));
    }
    let finder = Finder::open(&built.bytes, model, sequence.camera(), Method::Refined)?;
    if let Some(ms) = on_known_film(finder, model, &sequence)? {
        let work = format!("{what}, {masks} mask: image where the film is known, verdict included");
        rows.push(Row::new(&work, ms, "none", None));
    }
    rows.push(exact(&what, &built, &sequence)?);
    Ok(rows)
}

/// Milliseconds that a frame takes.
fn frames(mut finder: Finder<'_>, sequence: &Sequence<'_>) -> Result<f64> {
    let count = sequence.masks().len();
    let mut times = Vec::new();
    for at in (0..ROUNDS).flat_map(|_| 0..FRAMES.min(count)) {
        let frame = at * count / FRAMES.min(count);
        times.push(sequence.look(frame, |seen| Ok(timed(|| finder.all(seen)).0))?);
    }
    Ok(median(times))
}

/// Milliseconds that a frame takes from its mask to poses where the film of the sequence puts edges: what `evaluate` does of each frame once
/// it has the film's constants. `None` where the frames do not tell these.
fn on_known_film(
    mut finder: Finder<'_>,
    model: Model<'_>,
    sequence: &Sequence<'_>,
) -> Result<Option<f64>> {
    let (camera, count) = (sequence.camera(), sequence.masks().len());
    let frames = FRAMES.min(count);
    let mut buffers = RefineBuffers::default();
    let mut pool = FilmPool::default();
    let frame_of = |at: usize| at * count / frames;
    for frame in (0..frames).map(frame_of) {
        let read = sequence.look(frame, |seen| {
            let mut read = vec![FilmProfile::default(); profiles_of_each(frames)];
            let found = finder.all(seen)?;
            let pose = found.candidates.first().context("no pose")?.pose;
            let (target, names) = (
                image(seen, EdgeOptions::default(), None)?,
                (0, frame as u16),
            );
            let memory = &mut buffers.borrow(&model, &camera);
            let count = film_profiles(&model, &camera, &pose, &target, names, memory, &mut read)?;
            read.truncate(count);
            Ok(read)
        })?;
        pool.take(0, frame as u16, read);
    }
    let Some(film) = pool
        .estimate(GivenFilm::default())
        .map(|film| film.model(0))
    else {
        return Ok(None);
    };
    let mut times = Vec::new();
    for at in (0..ROUNDS).flat_map(|_| 0..frames) {
        times.push(sequence.look(frame_of(at), |seen| {
            let target = image(seen, EdgeOptions::default(), Some(film))?;
            let memory = &mut buffers.borrow(&model, &camera);
            let options = RefineOptions::default();
            let (ms, found) = timed(|| -> Result<_> {
                let found = finder.all(seen)?.candidates;
                Ok(onto_target(
                    &model, &camera, target, &found, options, memory,
                )?)
            });
            found.map(|_| ms)
        })?);
    }
    Ok(Some(median(times)))
}

/// A library of all directions, on all cores.
fn build(what: &str, model: Model<'_>, camera: Camera, distance: f64) -> Result<(Row, Built)> {
    let views = ViewOptions::default();
    let mut builds = (0..BUILDS)
        .map(|_| build_library(model, camera, &views, distance))
        .collect::<Result<Vec<_>>>()?;
    let times = builds.iter().map(|built| 1000.0 * built.took.as_secs_f64());
    let work = format!(
        "{what}: library of all directions, {} views, {} threads",
        views.grid().views(),
        rayon::current_num_threads()
    );
    let row = Row::new(&work, median(times.collect()), "none", None);
    Ok((row, builds.pop().context("some are built")?))
}

/// The exact best of all views for each mask.
fn exact(what: &str, built: &Built, sequence: &Sequence<'_>) -> Result<Row> {
    let library = Library::open(&built.bytes)?;
    let spec = library.info().canonical;
    let mut memory = SearchBuffers::new(&library);
    let mut times = Vec::new();
    for (_, seen) in sequence.masks() {
        let mut words = vec![0; spec.words_needed()];
        let aspect = sequence.camera().aspect();
        canonicalise(&seen.mask.mask(), &spec, aspect, &mut words)?;
        for _ in 0..ROUNDS {
            let (ms, found) = timed(|| memory.best(&library, &words));
            found?;
            times.push(ms);
        }
    }
    let work = format!("{what}: exact best of all directions");
    Ok(Row::new(&work, median(times), "none", None))
}
