//! Films of one kind as one study: its constants are estimated from poses found without them, which are then corrected.

use std::time::Instant;

use anyhow::Result;
use fluoropose::camera::Camera;
use fluoropose::film::pool::profiles_of_each;
use fluoropose::film::{FilmModel, FilmPool, FilmProfile, GivenFilm};
use fluoropose::finder::choice::{ChoiceContext, Counterpart};
use fluoropose::finder::{Candidate, Verdict, correct_candidates, look_around};
use fluoropose::image::mask::Mask;
use fluoropose::mesh::Model;
use fluoropose::mesh::symmetry::{is_nearly_symmetric, symmetry_planes};
use fluoropose::refine::{ImageTarget, Polarity, RefineBuffers, RefineOptions, film_profiles};
use rayon::prelude::*;

use super::draw::Film;
use super::outcome::{Outcome, chosen};
use super::trial::{Attempt, FilmWay};
use crate::files::MaskBuffer;
use crate::finding::misfits::Misfits;
use crate::finding::{Beside, hidden};

/// Rounds of estimating the constants and correcting poses by them.
const ROUNDS: usize = 2;

/// Films of one kind, and the poses of both components in each.
pub(super) struct Study<'s> {
    pub(super) films: &'s [Film],
    pub(super) models: [Model<'s>; 2],
    pub(super) camera: Camera,
    pub(super) attempts: Vec<[Attempt; 2]>,
}

impl<'s> Study<'s> {
    /// What comes of each film, by component, once poses are corrected.
    ///
    /// # Errors
    /// For a film of another size.
    pub(super) fn outcomes(mut self, way: FilmWay) -> Result<Vec<[Outcome; 2]>> {
        for round in 0..ROUNDS {
            let known = known_films(&self.profiles(way)?, way);
            // Where the other component is, is known once it was on the film itself.
            let beside = match round {
                0 => [Vec::new(), Vec::new()],
                _ => self.beside_each(),
            };
            self.correct(&known, &beside)?;
            if way.is_found() {
                self.look_around(&known, &beside)?;
            }
        }
        let middles = self.models.map(|model| model.bounds().centre);
        let misfits = self.misfits();
        let films = self.films.iter().zip(&self.attempts).enumerate();
        let outcomes = films.map(|(frame, (film, attempts))| {
            let outcome = |part: usize, context: ChoiceContext<'_>| {
                let Attempt { candidates, ms } = &attempts[part];
                let beside = misfits.beside(part, frame);
                let truth = &film.truth[part];
                Outcome::of(candidates, (&context, &beside), truth, &middles[part], *ms)
            };
            let femur = outcome(0, ChoiceContext::default());
            let known = femur.found.map(|found| Counterpart::Femur(found.pose));
            [femur, outcome(1, with_femur(known))]
        });
        Ok(outcomes.collect())
    }

    /// The pose of a component that is chosen in a frame, and how far it is trusted.
    fn judged(&self, frame: usize, part: usize) -> Option<(Candidate, Verdict)> {
        let [femur, tibia] = &self.attempts[frame];
        let chosen_femur = chosen(&femur.candidates, &ChoiceContext::default())?;
        if part == 0 {
            return Some(chosen_femur);
        }
        let context = with_femur(Some(Counterpart::Femur(chosen_femur.0.pose)));
        chosen(&tibia.candidates, &context)
    }

    fn chosen(&self, frame: usize, part: usize) -> Option<Candidate> {
        self.judged(frame, part).map(|(chosen, _)| chosen)
    }

    /// Beside each component the other one, where it is chosen and fits.
    fn beside_each(&self) -> [Vec<Beside<'s>>; 2] {
        let frames = 0..self.films.len();
        [1, 0].map(|other| {
            let pose = |frame| {
                let (chosen, verdict) = self.judged(frame, other)?;
                (!matches!(verdict, Verdict::NoFit(_))).then_some(chosen.pose)
            };
            vec![Beside {
                model: self.models[other],
                poses: frames.clone().map(pose).collect(),
            }]
        })
    }

    fn misfits(&self) -> Misfits {
        let misfit = |frame: usize, part: usize| Some(self.chosen(frame, part)?.misfit());
        let frames = 0..self.films.len();
        Misfits(
            (0..2)
                .map(|part| frames.clone().map(|frame| misfit(frame, part)).collect())
                .collect(),
        )
    }

    /// Looks around poses that leave more than is usual on their film.
    fn look_around(
        &mut self,
        known: &[[Option<FilmModel>; 2]],
        beside: &[Vec<Beside<'_>>; 2],
    ) -> Result<()> {
        let (misfits, camera) = (self.misfits(), self.camera);
        let parts = self
            .models
            .map(|model| (model, symmetry_planes(model.mesh())));
        let look = |buffers: &mut RefineBuffers, (frame, (film, attempts)): (usize, Seen<'_>)| {
            let pixels = film.frame(&camera)?;
            for (part, (model, planes)) in parts.iter().enumerate() {
                let begin = Instant::now();
                let attempt = &mut attempts[part];
                let misfit = misfits.0[part][frame];
                let symmetric = is_nearly_symmetric(model, planes);
                let unusual = misfits.beside(part, frame);
                let limit = misfit.and_then(|px| unusual.look_beyond(px, symmetric));
                let (Some(limit), Some(film)) = (limit, known[frame][part]) else {
                    continue;
                };
                let hidden = hidden(&beside[part], &camera, frame, None)?;
                let hidden = hidden.as_ref().map(MaskBuffer::mask);
                let seen = (&camera, image(&pixels, hidden.as_ref(), Some(film)));
                let how = (RefineOptions::default(), limit);
                let mut memory = buffers.borrow(model, &camera);
                let candidates = &attempt.candidates;
                let found = look_around(model, seen, planes, candidates, how, &mut memory)?;
                attempt.candidates = found.to_vec();
                attempt.ms += begin.elapsed().as_secs_f64() * 1e3;
            }
            Ok(())
        };
        let films = self.films.par_iter().zip(&mut self.attempts).enumerate();
        films
            .map_init(RefineBuffers::default, look)
            .collect::<Result<()>>()
    }

    /// Profiles of each film and component.
    fn profiles(&self, way: FilmWay) -> Result<Vec<[Vec<FilmProfile>; 2]>> {
        let each = match way {
            FilmWay::Alone => profiles_of_each(1),
            _ => profiles_of_each(2 * self.films.len()),
        };
        let read = |buffers: &mut RefineBuffers, (number, film): (usize, &Film)| {
            let frame = film.frame(&self.camera)?;
            let image = image(&frame, None, None);
            Ok([0, 1].map(|part| {
                let Some(Candidate { pose, .. }) = self.chosen(number, part) else {
                    return Vec::new();
                };
                let model = &self.models[part];
                let mut memory = buffers.borrow(model, &self.camera);
                let mut read = vec![FilmProfile::default(); each];
                let names = (part as u8, number as u16);
                let (camera, memory) = (&self.camera, &mut memory);
                let count = film_profiles(model, camera, &pose, &image, names, memory, &mut read);
                read.truncate(count.unwrap_or(0));
                read
            }))
        };
        let films = self.films.par_iter().enumerate();
        films.map_init(RefineBuffers::default, read).collect()
    }

    /// Corrects all poses by what is known of the film.
    fn correct(
        &mut self,
        known: &[[Option<FilmModel>; 2]],
        beside: &[Vec<Beside<'_>>; 2],
    ) -> Result<()> {
        let camera = self.camera;
        let parts = self
            .models
            .map(|model| (model, symmetry_planes(model.mesh())));
        let correct = |buffers: &mut RefineBuffers,
                       (number, (film, of)): (usize, (&Film, Of<'_>))| {
            let frame = film.frame(&camera)?;
            let (attempts, known) = of;
            let each = parts.iter().zip(attempts).zip(known).zip(beside);
            for ((((model, planes), attempt), known), beside) in each {
                let begin = Instant::now();
                let hidden = hidden(beside, &camera, number, None)?;
                let hidden = hidden.as_ref().map(MaskBuffer::mask);
                let image = image(&frame, hidden.as_ref(), *known);
                let mut memory = buffers.borrow(model, &camera);
                let (candidates, options) = (&attempt.candidates, RefineOptions::default());
                if known.is_none() || candidates.is_empty() {
                    continue;
                }
                let seen = (&camera, image);
                let corrected =
                    correct_candidates(model, seen, planes, candidates, options, &mut memory);
                if let Ok(corrected) = corrected {
                    attempt.candidates = corrected.to_vec();
                }
                attempt.ms += begin.elapsed().as_secs_f64() * 1e3;
            }
            Ok(())
        };
        let of = self.attempts.par_iter_mut().zip(known);
        let films = self.films.par_iter().zip(of).enumerate();
        films
            .map_init(RefineBuffers::default, correct)
            .collect::<Result<()>>()
    }
}

/// A film and the poses of both components in it.
type Seen<'a> = (&'a Film, &'a mut [Attempt; 2]);

/// Poses of both components in a film, and what is known of it.
type Of<'a> = (&'a mut [Attempt; 2], &'a [Option<FilmModel>; 2]);

fn with_femur(counterpart: Option<Counterpart>) -> ChoiceContext<'static> {
    ChoiceContext {
        counterpart,
        ..ChoiceContext::default()
    }
}

fn image<'a>(
    frame: &'a fluoropose::image::frame::Frame<'a, u8>,
    unknown: Option<&'a Mask<'a>>,
    film: Option<FilmModel>,
) -> ImageTarget<'a> {
    ImageTarget {
        frame,
        unknown,
        polarity: Polarity::DarkImplant,
        film,
    }
}

/// What the profiles tell of the film of each component in each frame: those of all frames, or of it alone.
fn known_films(profiles: &[[Vec<FilmProfile>; 2]], way: FilmWay) -> Vec<[Option<FilmModel>; 2]> {
    let take = |pool: &mut FilmPool, frame: usize, part: usize| {
        pool.take(part as u8, frame as u16, profiles[frame][part].clone());
    };
    if way == FilmWay::Alone {
        let alone = |frame: usize, part: usize| {
            let mut pool = FilmPool::default();
            take(&mut pool, frame, part);
            Some(pool.estimate(GivenFilm::default())?.model(part))
        };
        let frames = (0..profiles.len()).into_par_iter();
        return frames
            .map(|frame| [0, 1].map(|part| alone(frame, part)))
            .collect();
    }
    let mut pool = FilmPool::default();
    for frame in 0..profiles.len() {
        (0..2).for_each(|part| take(&mut pool, frame, part));
    }
    let film = pool.estimate(GivenFilm::default());
    let known = [0, 1].map(|part| film.map(|film| film.model(part)));
    vec![known; profiles.len()]
}
