//! The constants of the film, from the first frames in which components are known.

use anyhow::Result;
use fluoropose::film::estimate::MOST_COMPONENTS;
use fluoropose::film::{FilmPool, FilmProfile};
use fluoropose::follow::Anchor;
use fluoropose::refine::film_profiles;

use super::follow::beside;
use super::part::Part;
use super::record::Films;
use super::run::Run;
use crate::finding::Stated;

/// Anchors of a component that are looked at, and frames to each side of them.
const ANCHORS: usize = 3;
const BESIDE: usize = 6;
/// Profiles of each frame and component.
const PROFILES: usize = 96;

/// Takes the constants as they are stated, or estimates them from the anchors and the frames beside them, and tells the parts. They are estimated once for a
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
            for (part, film) in parts.iter().zip(models) {
                if let Some(film) = film {
                    part.set_film(*film);
                }
            }
            return Ok(());
        }
    };
    let films = run.journal.step("film", || {
        let mut pool = FilmPool::default();
        for (number, part) in parts.iter().enumerate().take(MOST_COMPONENTS) {
            for anchor in anchors[number].iter().take(ANCHORS) {
                for (frame, pose) in beside(run, part, anchor, BESIDE)? {
                    let name = part.name();
                    run.say(format!(
                        "{name} frame {}: profiles of the film are read",
                        frame + 1
                    ));
                    let names = (number as u8, frame as u16);
                    let mut read = vec![FilmProfile::default(); PROFILES];
                    let count = part.see(run.film, frame, |subject, image, memory| {
                        let (model, camera) = (subject.model, subject.camera);
                        film_profiles(model, camera, &pose, image, names, memory, &mut read)
                    })?;
                    read.truncate(count.unwrap_or(0));
                    pool.take(names.0, names.1, read);
                }
            }
        }
        run.say("film: its constants are estimated".to_owned());
        let found = pool.estimate(given);
        if let Some(found) = &found {
            run.say(format!("film: {found}"));
        }
        let models = |number: usize| found.as_ref().map(|found| found.model(number));
        let films: Option<Vec<_>> = (0..parts.len()).map(models).collect();
        Ok(Films(films.unwrap_or_default()))
    })?;
    for (part, film) in parts.iter().zip(films.0) {
        part.set_film(film);
    }
    Ok(())
}
