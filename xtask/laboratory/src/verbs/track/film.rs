//! All components of a film, from what is given to the files.

use std::collections::BTreeSet;
use std::fmt;
use std::fs;
use std::path::PathBuf;

use anyhow::{Context, Result};
use fluoropose::follow::{Anchor, Cell, Conclusion, State, frames_to_ask};
use fluoropose::mesh::OwnedModel;
use fluoropose::pose::EulerPose;
use fluoropose::refine::Polarity;
use fluoropose_report::counted;
use rayon::prelude::*;
use sha2::{Digest, Sha256};

use super::constants::{learn_again, learn_film};
use super::followed::followed;
use super::journal::Journal;
use super::judged::{against, good, judged};
use super::left_over::left_over;
use super::metal::begun;

use super::mirrored::beside;
use super::part::{Part, Shape, read_models};
use super::request::{Request, Told};
use super::run::Run;
use super::sides::Margins;
use super::squares::chosen_square;
use super::table::{HEADING, Row, TABLE, film_table, uncertain};
use crate::files::{
    Film, FoundWith, Study, camera_of_frames, check_outputs, doubt_beside, read, read_calibration,
    size_taken, write_covariances, write_poses, write_text,
};
use crate::finding::Stated;
use crate::options::of_body;

/// A component of a film that was followed.
pub struct Tracked {
    /// The component's name.
    pub component: String,
    /// A row for each frame.
    pub rows: Vec<Row>,
}

impl fmt::Display for Tracked {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{}: {}",
            self.component,
            counted(self.rows.len(), "frame")
        )?;
        for state in State::ALL {
            let count = self.rows.iter().filter(|row| row.state == state).count();
            if count > 0 {
                write!(f, ", {} {count}", state.word())?;
            }
        }
        Ok(())
    }
}

impl Tracked {
    /// Whether it has a pose in any frame.
    #[must_use]
    pub fn is_found(&self) -> bool {
        self.rows.iter().any(|row| row.pose.is_some())
    }

    /// Whether it is good in any frame.
    #[must_use]
    pub fn is_good(&self) -> bool {
        self.rows.iter().any(|row| row.verdict() == "good")
    }
}

/// Frames in which a component is not known well, from 0.
#[must_use]
pub fn doubtful_frames(tracked: &[Tracked]) -> BTreeSet<usize> {
    let good = |part: &Tracked, frame: usize| {
        let row = part.rows.get(frame);
        row.is_some_and(|row| row.verdict() == "good")
    };
    let frames = tracked.iter().map(|part| part.rows.len()).max();
    (0..frames.unwrap_or(0))
        .filter(|&frame| !tracked.iter().all(|part| good(part, frame)))
        .collect()
}

/// Follows the components of a study through its film.
///
/// # Errors
/// For files that are missing, unreadable or do not belong together.
pub fn track(request: &Request) -> Result<Vec<Tracked>> {
    let study = read_study(request)?;
    let frames = study.frames_folder()?;
    study.check_files(Some(frames))?;
    let calibration = read_calibration(&study.calibration)?;
    let film = Film::read(frames).context("frames")?;
    request.check(&film)?;
    for remark in [film.gaps(), film.repeats(), film.disorder()]
        .into_iter()
        .flatten()
    {
        (request.listener)(Told::Remark(remark));
    }
    let both = || format!("{} and {}", study.calibration.display(), frames.display());
    let (camera, doubts) = camera_of_frames(&calibration, film.size()).with_context(both)?;
    let beside = doubt_beside(&camera, &*film.frame(0)?);
    let left = left_over(&request.out, &study);
    for remark in doubts.into_iter().chain(beside).chain(left) {
        (request.listener)(Told::Remark(remark));
    }
    if let Some(taken) = size_taken(&calibration, film.size()) {
        (request.listener)(Told::Taken(taken));
    }
    let models = read_models(&study.components, &request.listener)?;
    fs::create_dir_all(&request.out)
        .with_context(|| format!("cannot make the folder {}", request.out.display()))?;
    check_written(request, &study)?;
    let attenuations: Vec<_> = study.components.iter().map(|one| one.attenuation).collect();
    let stated = Stated::of(study.film, &attenuations);
    let digest = digest(request, &study, &film, &models, &stated)?;
    let journal = request.out.join("journal.txt");
    let journal = Journal::open(&journal, &digest, request.anew, request.stop.clone())?;
    let run = Run {
        request,
        film: &film,
        journal: &journal,
        parts: models.len(),
        seen: std::sync::Mutex::default(),
    };
    let shapes = study.components.par_iter().zip(&models);
    let shape = |(component, model): (_, _)| {
        Shape::of(component, model).with_context(|| format!("the component {}", component.name))
    };
    let shapes: Vec<Shape<'_>> = shapes.map(shape).collect::<Result<_>>()?;
    if let Some(remark) = side_remark(&study, &shapes) {
        (request.listener)(Told::Remark(remark));
    }
    let parts_by = |seen, polarity| -> Vec<Part<'_>> {
        let part = |(number, shape)| Part::new(number, shape, &calibration, seen, polarity);
        shapes.iter().enumerate().map(part).collect()
    };
    let begun = begun(&run, |polarity| parts_by((camera, 1), polarity))?;
    let tracked = in_squares(&run, &stated, begun, |side, polarity| {
        Ok(parts_by((camera.reduced(side)?, side), polarity))
    })?;
    let names = study.components.iter().map(|one| one.name.as_str());
    let found_with = names.zip(models.iter().map(OwnedModel::as_model));
    FoundWith::of(&calibration, found_with).write(&request.out)?;
    Ok(tracked)
}

/// The study; what there is to say of its keys is told.
fn read_study(request: &Request) -> Result<Study> {
    let (study, remarks) = Study::with_remarks(&request.study)?;
    let file = request.study.display();
    for remark in remarks {
        (request.listener)(Told::Remark(format!("in {file}: {remark}")));
    }
    check_components(request, &study)?;
    Ok(study)
}

/// Follows all components from their anchors in the squares that the film is well read in; `parts` are the components as they are seen in those.
fn in_squares<'s>(
    run: &Run<'_>,
    stated: &Stated,
    (begun, anchors): (Vec<Part<'s>>, Vec<Vec<Anchor>>),
    parts: impl Fn(usize, Polarity) -> Result<Vec<Part<'s>>>,
) -> Result<Vec<Tracked>> {
    let polarity = begun.first().map(|part| part.polarity).unwrap_or_default();
    let parts = |side| parts(side, polarity);
    let side = chosen_square(run, stated, &anchors, parts)?;
    if side == 1 {
        return followed_through(run, stated, &begun, &anchors);
    }
    run.say(format!(
        "film: finer than its blur, read in squares of {side} pixels"
    ));
    let film = run.film.in_squares(side);
    let in_squares = |all: Vec<Anchor>| all.iter().map(|one| one.in_squares(side)).collect();
    let anchors: Vec<Vec<Anchor>> = anchors.into_iter().map(in_squares).collect();
    followed_through(&run.on(&film), stated, &parts(side)?, &anchors)
}

/// Follows all components from their anchors, and once more where that tells of another film.
fn followed_through(
    run: &Run<'_>,
    stated: &Stated,
    parts: &[Part<'_>],
    anchors: &[Vec<Anchor>],
) -> Result<Vec<Tracked>> {
    learn_film(run, stated, parts, anchors)?;
    let (mut films, mut margins) = followed(run, parts, anchors)?;
    let to_ask = |number| frames_to_ask(&good(run, (number, parts), &films, &margins));
    let asked: Vec<_> = (0..parts.len()).map(to_ask).collect();
    if learn_again(run, stated, parts, &asked)? {
        (films, margins) = followed(run, parts, anchors)?;
    }
    finish(run, parts, &films, &margins)
}

/// What there is to say of the side of the body, without which there are no joint numbers, and of which no pose tells.
fn side_remark(study: &Study, shapes: &[Shape<'_>]) -> Option<String> {
    if let Some(stated) = study.side.map(of_body) {
        let other = shapes.iter().find_map(|shape| shape.other_side(stated))?;
        return Some(other.to_string());
    }
    let told = shapes.iter().find_map(Shape::made_for);
    let told = told.map_or_else(String::new, |side| {
        format!("; the femoral component is made for a {side} knee")
    });
    let lack = || format!("{}: joint numbers need it{told}", study.lacks("side"));
    study.is_knee().then(lack)
}

/// Refuses a folder in which poses would be written over those that the study names: of a person, perhaps, who has no others.
fn check_written(request: &Request, study: &Study) -> Result<()> {
    let components = study.components.iter();
    let poses = components.map(|one| request.out.join(format!("{}.jts", one.name)));
    let poses: Vec<PathBuf> = poses.collect();
    let outputs = poses.iter().map(|path| ("--out", Some(&**path)));
    let named = study
        .components
        .iter()
        .flat_map(|one| one.reference.iter().chain(one.peer.values()));
    check_outputs(
        &outputs.collect::<Vec<_>>(),
        named.map(|path| Some(&**path)),
    )
}

/// Whether the study has the components that are asked for.
fn check_components(request: &Request, study: &Study) -> Result<()> {
    for name in request.components() {
        study.component(name)?;
    }
    Ok(())
}

/// Tells what all steps of a run depend on from all else, hexadecimal.
fn digest(
    request: &Request,
    study: &Study,
    film: &Film,
    models: &[OwnedModel],
    stated: &Stated,
) -> Result<String> {
    let mut inputs = Sha256::new();
    inputs.update(film.digest());
    inputs.update(read(&study.calibration)?);
    for (model, component) in models.iter().zip(&study.components) {
        inputs.update(model.as_model().digest());
        inputs.update(format!(
            "{:?}{:?}{:?}{:?}",
            component.nominal,
            component.distance_mm,
            component.axes,
            component.role()
        ));
    }
    inputs.update(format!("{:?}", study.side));
    inputs.update([match request.polarity {
        Some(Polarity::DarkImplant) => 0,
        Some(Polarity::BrightImplant) => 1,
        None => 2,
    }]);
    if study.film.is_some() {
        inputs.update(format!("{stated:?}"));
    }
    let digest: [u8; 32] = inputs.finalize().into();
    Ok(digest.iter().map(|byte| format!("{byte:02x}")).collect())
}

/// Judges, and writes the files.
fn finish(
    run: &Run<'_>,
    parts: &[Part<'_>],
    films: &[Vec<Cell>],
    margins: &[Margins],
) -> Result<Vec<Tracked>> {
    let (out, side) = (&run.request.out, run.film.square_px());
    let mut tracked = Vec::new();
    let joint = beside(run, parts, films)?;
    for (number, part) in parts.iter().enumerate() {
        let (cells, middle) = (&films[number], part.middle());
        let against = against(run, (number, parts), films, margins, &joint);
        let judged = judged(run, (number, parts), films, margins, &against);
        let poses: Vec<Option<EulerPose>> = judged
            .iter()
            .map(|one: &Conclusion| one.pose.map(EulerPose::from))
            .collect();
        let file = out.join(format!("{}.jts", part.name()));
        write_poses(&file, &poses)?;
        write_covariances(&file, cells.iter().map(uncertain))?;
        let rows = cells.iter().zip(&judged).enumerate();
        let row = |(frame, (cell, judged)): (usize, (&Cell, &Conclusion))| {
            Row::of(frame, cell, &judged.in_pixels(side), (&middle, side))
        };
        tracked.push(Tracked {
            component: part.name().to_owned(),
            rows: rows.map(row).collect(),
        });
    }
    let mut text = String::from(HEADING);
    for frame in 0..run.film.count() {
        let (file, place) = run.film.place(frame);
        for part in &tracked {
            part.rows[frame].write(&part.component, (&file, place), &mut text);
        }
    }
    write_text(&out.join(TABLE), &text)?;
    let constants = parts.iter().map(|part| (part.name(), part.film()));
    write_text(&out.join("film.csv"), &film_table(constants))?;
    run.say_done();
    Ok(tracked)
}
