//! The constants of the film, from the first frames in which components are known.

use anyhow::Result;
use fluoropose::film::estimate::MOST_COMPONENTS;
use fluoropose::film::{FilmEstimate, FilmModel, FilmPool, FilmProfile, SquareChoice};
use fluoropose::follow::{Anchor, FilmReading};
use fluoropose::pose::Pose;
use rayon::prelude::*;
use sha2::{Digest, Sha256};

use super::follow::mark;
use super::part::Part;
use super::record::{Films, LearntFrom};
use super::request::Told;
use super::run::Run;
use crate::finding::{Stated, in_squares};

/// Takes the constants as they are stated, or estimates them from the frames around the anchors, and tells the parts. They are estimated once for a
/// folder, so that a correction of one frame does not change all others.
pub(super) fn learn_film(
    run: &Run<'_>,
    stated: &Stated,
    parts: &[Part<'_>],
    anchors: &[Vec<Anchor>],
) -> Result<()> {
    let given = match stated {
        Stated::Part(given) => *given,
        Stated::Whole(constants, models) => {
            run.say(format!("film: {constants}"));
            let models = in_squares(models, run.film.square_px());
            for (part, film) in parts.iter().zip(models) {
                if let Some(film) = film {
                    part.set_film(film);
                }
            }
            return Ok(());
        }
    };
    let films = run.journal.step("film", || {
        let each = parts.par_iter().zip(anchors).take(MOST_COMPONENTS);
        let read: Vec<_> = each
            .map(|(part, anchors)| profiles(run, part, anchors))
            .collect::<Result<_>>()?;
        run.say("film: its constants are estimated".to_owned());
        let pool = pooled(run.film.square_px(), read);
        let found = pool.estimate(given);
        if let Some(found) = &found {
            run.say(format!("film: {found}"));
        }
        if let Some(clipped) = pool.clipped() {
            (run.request.listener)(Told::Remark(format!("film: {clipped}")));
        }
        let models = |number: usize| found.as_ref().map(|found| found.model(number));
        let films: Option<Vec<_>> = (0..parts.len()).map(models).collect();
        Ok(Films(films.unwrap_or_default()))
    })?;
    let from = learnt_from(anchors);
    if run.journal.step("film/from", || Ok(learnt_from(anchors)))? != from {
        run.say(
            "film: its constants are those of this folder's first run, from other clicks or fixed poses; --anew estimates them anew"
                .to_owned(),
        );
    }
    for (part, film) in parts.iter().zip(films.0) {
        part.set_film(film);
    }
    Ok(())
}

fn learnt_from(anchors: &[Vec<Anchor>]) -> LearntFrom {
    let mut hash = Sha256::new();
    for part in anchors {
        hash.update([0]);
        part.iter().for_each(|anchor| hash.update(mark(anchor)));
    }
    let [a, b, c, d, ..] = hash.finalize()[..] else {
        return LearntFrom(0);
    };
    LearntFrom(u32::from_le_bytes([a, b, c, d]))
}

/// Whether the constants, as they were learnt from the frames around the anchors, are others by frames that were followed since and are good, and
/// `asked`; tells the parts. So they do not hang on a first pose that is wrong.
pub(super) fn learn_again(
    run: &Run<'_>,
    stated: &Stated,
    parts: &[Part<'_>],
    asked: &[Vec<(usize, Pose)>],
) -> Result<bool> {
    let Stated::Part(given) = stated else {
        return Ok(false);
    };
    let known: Option<Vec<FilmModel>> = parts.iter().map(Part::film).collect();
    let Some(known) = known.filter(|_| asked.iter().all(|asked| !asked.is_empty())) else {
        return Ok(false);
    };
    let films = run.journal.step("film/again", || {
        run.say("film: its constants are compared with all frames".to_owned());
        let found = pool_of(run, parts, asked)?.learnt_again(&known, *given);
        if let Some(found) = &found {
            run.say(format!("film: as followed, {found}"));
        }
        let models = |found: FilmEstimate| (0..parts.len()).map(|part| found.model(part)).collect();
        Ok(Films(found.map_or(Vec::new(), models)))
    })?;
    for (part, film) in parts.iter().zip(&films.0) {
        part.set_film(*film);
    }
    Ok(!films.0.is_empty())
}

/// Profiles of all components in the frames that are asked.
fn pool_of(run: &Run<'_>, parts: &[Part<'_>], asked: &[Vec<(usize, Pose)>]) -> Result<FilmPool> {
    let of_part = |(part, asked): (&Part<'_>, &Vec<(usize, Pose)>)| {
        let mut reading = FilmReading::new(part.middle(), run.film.count(), part.number as u8);
        for &(frame, pose) in asked {
            reading.ask(frame, pose);
        }
        read(run, part, reading)
    };
    let each = parts.par_iter().zip(asked).take(MOST_COMPONENTS);
    let read: Vec<_> = each.map(of_part).collect::<Result<_>>()?;
    Ok(pooled(run.film.square_px(), read))
}

/// Profiles of frames by the numbers of their components, read in squares.
pub(super) fn pooled(square_px: usize, read: Vec<Vec<(usize, Vec<FilmProfile>)>>) -> FilmPool {
    let mut pool = FilmPool::in_squares(square_px);
    for (number, frames) in (0..).zip(read) {
        for (frame, profiles) in frames {
            pool.take(number, frame as u16, profiles);
        }
    }
    pool
}

/// Profiles of a component in the first frames that are known of it.
pub(super) fn first_profiles(
    run: &Run<'_>,
    part: &Part<'_>,
    anchors: &[Anchor],
) -> Result<Vec<(usize, Vec<FilmProfile>)>> {
    let mut reading = FilmReading::new(part.middle(), run.film.count(), part.number as u8);
    for anchor in anchors.iter().take(SquareChoice::FRAMES) {
        reading.ask(anchor.frame, anchor.found.pose);
    }
    read(run, part, reading)
}

/// Profiles of a component in the frames around its anchors.
fn profiles(
    run: &Run<'_>,
    part: &Part<'_>,
    anchors: &[Anchor],
) -> Result<Vec<(usize, Vec<FilmProfile>)>> {
    let mut reading = FilmReading::new(part.middle(), run.film.count(), part.number as u8);
    for anchor in anchors {
        reading.give(anchor.frame, anchor.found.pose);
    }
    read(run, part, reading)
}

/// All that a reading asks for, in its order: the ways to both sides of a pose side by side.
fn read(
    run: &Run<'_>,
    part: &Part<'_>,
    mut reading: FilmReading,
) -> Result<Vec<(usize, Vec<FilmProfile>)>> {
    let mut done = Vec::new();
    while let Some(frame) = reading.wanted() {
        if let Some(rest) = reading.split() {
            let (own, rest) = rayon::join(|| read(run, part, reading), || read(run, part, rest));
            done.extend(own?);
            done.extend(rest?);
            break;
        }
        run.request.stop.check()?;
        let name = part.name();
        run.say(format!(
            "{name} frame {}: grey values across its edges are read",
            frame + 1
        ));
        let profiles = part.see(run.film, frame, |subject, image, memory| {
            reading.take(subject, image, memory)
        })?;
        done.push((frame, profiles));
    }
    Ok(done)
}
