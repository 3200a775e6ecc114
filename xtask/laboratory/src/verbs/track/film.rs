//! All components of a film, from what is given to the files.

use std::fmt;
use std::fs;

use anyhow::{Context, Result, ensure};
use fluoropose::follow::{
    Anchor, Cell, Conclusion, KnownBeside, KnownFemur, Settling, State, conclude, trusted_depths,
};
use fluoropose::joint::beside::Beside;
use fluoropose::mesh::OwnedModel;
use fluoropose::pose::{EulerPose, Pose};
use fluoropose::refine::Polarity;
use fluoropose_report::counted;
use rayon::prelude::*;
use sha2::{Digest, Sha256};

use super::anchors::{again, fill, fill_in_joint};
use super::constants::{learn_again, learn_film};
use super::follow::follow;
use super::journal::Journal;
use super::metal::begun;
use super::mirrored::beside;
use super::part::{Part, Shape, read_models};
use super::request::{Request, Told};
use super::run::Run;
use super::sides::{Margins, settle, up_to_a_choice};
use super::table::{HEADING, Row, TABLE, covariance_table, film_table};
use crate::files::{
    Film, Role, Study, camera_of_frames, read, read_calibration, write_poses, write_text,
};
use crate::finding::Stated;

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

/// Frames in which a component is not known well.
#[must_use]
pub fn doubtful_frames(tracked: &[Tracked]) -> usize {
    let good = |part: &Tracked, frame: usize| {
        let row = part.rows.get(frame);
        row.is_some_and(|row| row.verdict() == "good")
    };
    let frames = tracked.iter().map(|part| part.rows.len()).max();
    (0..frames.unwrap_or(0))
        .filter(|&frame| !tracked.iter().all(|part| good(part, frame)))
        .count()
}

/// Follows the components of a study through its film.
///
/// # Errors
/// For files that are missing, unreadable or do not belong together.
pub fn track(request: &Request) -> Result<Vec<Tracked>> {
    let study = Study::read(&request.study)?;
    for name in request.components() {
        let names = study.components.iter().map(|one| one.name.as_str());
        let known: Vec<&str> = names.collect();
        let others = known.join(", ");
        ensure!(
            known.contains(&name),
            "the study has no component {name}: it has {others}"
        );
    }
    let frames = study.frames_folder()?;
    study.check_files(Some(frames))?;
    if study.is_knee() && study.side.is_none() {
        let lack = study.lacks("side");
        (request.listener)(Told::Remark(format!("{lack}: joint numbers need it")));
    }
    let calibration = read_calibration(&study.calibration)?;
    let film = Film::read(frames).context("frames")?;
    request.check(&film)?;
    for remark in [film.gaps(), film.repeats()].into_iter().flatten() {
        (request.listener)(Told::Remark(remark));
    }
    let both = || format!("{} and {}", study.calibration.display(), frames.display());
    let (camera, doubts) = camera_of_frames(&calibration, film.size()).with_context(both)?;
    for doubt in doubts {
        (request.listener)(Told::Remark(doubt));
    }
    let models = read_models(&study.components, &request.listener)?;
    fs::create_dir_all(&request.out)
        .with_context(|| format!("cannot make the folder {}", request.out.display()))?;
    let attenuations: Vec<_> = study.components.iter().map(|one| one.attenuation).collect();
    let stated = Stated::of(study.film, &attenuations);
    let digest = digest(request, &study, &film, &models, &stated)?;
    let journal = request.out.join("journal.txt");
    let run = Run {
        request,
        film: &film,
        journal: Journal::open(&journal, &digest, request.anew, request.stop.clone())?,
        parts: models.len(),
        seen: std::sync::Mutex::default(),
    };
    let shapes = study.components.par_iter().zip(&models);
    let shape = |(component, model): (_, _)| {
        Shape::of(component, model).with_context(|| format!("the component {}", component.name))
    };
    let shapes: Vec<Shape<'_>> = shapes.map(shape).collect::<Result<_>>()?;
    let parts = |polarity| -> Vec<Part<'_>> {
        let part = |(number, shape)| Part::new(number, shape, &calibration, camera, polarity);
        shapes.iter().enumerate().map(part).collect()
    };
    let (parts, anchors) = begun(&run, parts)?;
    learn_film(&run, &stated, &parts, &anchors)?;
    let (mut films, mut margins) = followed(&run, &parts, &anchors)?;
    let good = good(&run, &parts, &films, &margins);
    if learn_again(&run, &stated, &parts, &good)? {
        (films, margins) = followed(&run, &parts, &anchors)?;
    }
    finish(&run, &parts, &films, &margins)
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
            "{:?}{:?}",
            component.nominal, component.distance_mm
        ));
    }
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

/// All components, side by side as far as they need no other: a tibia waits for its femur where its sides are chosen. A component that is lost after
/// all is looked for beside the other one of its joint.
fn followed(
    run: &Run<'_>,
    parts: &[Part<'_>],
    anchors: &[Vec<Anchor>],
) -> Result<(Vec<Vec<Cell>>, Vec<Margins>)> {
    let alone = |(part, anchors): (&Part<'_>, &Vec<Anchor>)| -> Result<(Vec<Cell>, Settling)> {
        let mut cells = of_part(run, part, anchors)?;
        let mut settling = Settling::new(part.middle(), 0..cells.len());
        if up_to_a_choice(run, part, &mut settling, &mut cells)? && !is_tibia(part) {
            settle(run, part, None, &mut settling, &mut cells)?;
        }
        Ok((cells, settling))
    };
    let each = parts.par_iter().zip(anchors).map(alone);
    let each = each.collect::<Result<Vec<_>>>()?;
    let (mut films, mut settlings): (Vec<_>, Vec<_>) = each.into_iter().unzip();
    for (number, part) in parts.iter().enumerate().filter(|(_, part)| is_tibia(part)) {
        let femur = femur_of(part, parts, &films);
        let settling = &mut settlings[number];
        settle(run, part, femur.as_ref(), settling, &mut films[number])?;
    }
    for (number, part) in parts.iter().enumerate() {
        let Some(other) = other_of(number, parts) else {
            continue;
        };
        let known = trusted(run, (other, parts), &films, &margins_of(&settlings, &films));
        let cells = &mut films[number];
        if fill_in_joint(run, (part, cells), (&parts[other], &known))? {
            let mut settling = Settling::new(part.middle(), 0..cells.len());
            let femur = femur_of(part, parts, &films);
            let cells = &mut films[number];
            if up_to_a_choice(run, part, &mut settling, cells)? {
                settle(run, part, femur.as_ref(), &mut settling, cells)?;
            }
            settlings[number] = settling;
        }
    }
    let margins = margins_of(&settlings, &films);
    Ok((films, margins))
}

fn margins_of(settlings: &[Settling], films: &[Vec<Cell>]) -> Vec<Margins> {
    let each = settlings.iter().zip(films);
    each.map(|(settling, cells)| settling.margins(cells))
        .collect()
}

/// A component in those frames alone in which it is good.
fn trusted(
    run: &Run<'_>,
    (number, parts): (usize, &[Part<'_>]),
    films: &[Vec<Cell>],
    margins: &[Margins],
) -> Vec<Cell> {
    let judged = judged(run, (number, parts), films, margins, &[]);
    let each = judged.iter().zip(&films[number]);
    let trusted = |(one, cell): (&Conclusion, &Cell)| match one.is_trusted() {
        true => *cell,
        false => Cell::default(),
    };
    each.map(trusted).collect()
}

fn is_tibia(part: &Part<'_>) -> bool {
    part.role() == Some(Role::Tibia)
}

/// The other component of a component's joint.
fn other_of(number: usize, parts: &[Part<'_>]) -> Option<usize> {
    let own = parts[number].role()?;
    parts
        .iter()
        .position(|other| other.role() == Some(own.other()))
}

/// A component followed by itself.
fn of_part(run: &Run<'_>, part: &Part<'_>, anchors: &[Anchor]) -> Result<Vec<Cell>> {
    let mut cells = vec![Cell::default(); run.film.count()];
    let anchors = again(run, part, anchors)?;
    follow(run, part, &anchors, 0..cells.len(), &mut cells)?;
    fill(run, part, &mut cells)?;
    Ok(cells)
}

/// The femur of a tibia, where both components' axes are known.
fn femur_of(part: &Part<'_>, parts: &[Part<'_>], films: &[Vec<Cell>]) -> Option<KnownFemur> {
    let axes = part.axes.filter(|_| is_tibia(part))?;
    let is_femur = |part: &Part<'_>| part.role() == Some(Role::Femur);
    let femur = parts.iter().position(is_femur)?;
    let in_field = parts[femur].axes?;
    let pose = |cell: &Cell| cell.found().map(|found| found.pose.compose(&in_field));
    Some(KnownFemur {
        poses: films[femur].iter().map(pose).collect(),
        axes,
    })
}

/// The frames in which each component is good as it was followed, with its poses.
fn good(
    run: &Run<'_>,
    parts: &[Part<'_>],
    films: &[Vec<Cell>],
    margins: &[Margins],
) -> Vec<Vec<(usize, Pose)>> {
    let of_part = |number: usize| {
        let trusted = trusted(run, (number, parts), films, margins);
        let found = trusted.iter().enumerate();
        let found = found.filter_map(|(frame, cell)| Some((frame, cell.found()?.pose)));
        found.collect()
    };
    (0..parts.len()).map(of_part).collect()
}

/// A component's whole film judged, with what is told of its `joint`.
fn judged(
    run: &Run<'_>,
    (number, parts): (usize, &[Part<'_>]),
    films: &[Vec<Cell>],
    margins: &[Margins],
    joint: &[Option<Beside>],
) -> Vec<Conclusion> {
    let part = &parts[number];
    let depths = other_of(number, parts).map_or(Vec::new(), |other| {
        trusted_depths(&films[other], &margins[other], &parts[other].middle())
    });
    let femur = femur_of(part, parts, films);
    let known = KnownBeside {
        other_depths_mm: &depths,
        femur: femur.as_ref(),
        joint,
        other_shape: part.other_shape(),
        longest_gap: run.request.interpolate,
    };
    conclude(&films[number], &margins[number], &known, &part.middle())
}

/// Judges, and writes the files.
fn finish(
    run: &Run<'_>,
    parts: &[Part<'_>],
    films: &[Vec<Cell>],
    margins: &[Margins],
) -> Result<Vec<Tracked>> {
    let out = &run.request.out;
    let mut tracked = Vec::new();
    let joint = beside(run, parts, films)?;
    for (number, part) in parts.iter().enumerate() {
        let (cells, middle) = (&films[number], part.middle());
        let judged = judged(run, (number, parts), films, margins, &joint);
        let poses: Vec<Option<EulerPose>> = judged
            .iter()
            .map(|one: &Conclusion| one.pose.map(EulerPose::from))
            .collect();
        write_poses(&out.join(format!("{}.jts", part.name())), &poses)?;
        let covariances = out.join(format!("{}.covariances.csv", part.name()));
        write_text(&covariances, &covariance_table(cells))?;
        let rows = cells.iter().zip(&judged).enumerate();
        let row = |(frame, (cell, judged))| Row::of(frame, cell, judged, &middle);
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
