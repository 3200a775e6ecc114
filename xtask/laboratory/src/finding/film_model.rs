//! The constants of a film from the frames at hand, and poses corrected by them.

use anyhow::{Error, Result};
use fluoropose::camera::Camera;
use fluoropose::film::{FilmConstants, FilmEstimate, FilmModel};
use fluoropose::finder::rivals::{RefinedRival, refine_rivals};
use fluoropose::finder::{
    Candidate, Limits, Verdict, correct_candidates, judge_fit, look_around, onto_target,
};
use fluoropose::image::blank::{BLANK, ONE_GREY, is_blank};
use fluoropose::mesh::symmetry::{is_nearly_symmetric, symmetry_planes};
use fluoropose::pose::Pose;
use fluoropose::refine::{
    CameraView, ImageTarget, Polarity, RefineBuffers, RefineOptions, polarity_at,
};
use fluoropose_report::plus_minus;
use rayon::prelude::*;

use super::beside::{Beside, hidden};
use super::film::FrameFound;
use super::film_squares::{choose_squares, read};
use super::filmed::{Filmed, Stated, in_squares};
use super::misfits::Misfits;
use crate::files::MaskBuffer;
use crate::options::{Shown, most};

/// Rounds of estimating the film from poses and correcting these by it.
const ROUNDS: usize = 2;

/// What is known of the film that some components are on.
pub struct KnownFilm {
    /// What it makes of each component.
    pub models: Vec<Option<FilmModel>>,
    /// The same in words.
    pub words: String,
}

/// Brings poses that outlines led to onto the grey frames. What the film makes of each component is estimated from the frames
/// themselves, unless it is stated.
pub fn bring_onto_frames(parts: &mut [Filmed<'_>], stated: &Stated) -> KnownFilm {
    tell_polarity(parts);
    choose_squares(parts, stated);
    let mut known = film_of(parts, stated);
    for (part, film) in parts.iter_mut().zip(&known.models) {
        *part.found = part.brought(*film);
    }
    for _ in 1..ROUNDS {
        if matches!(stated, Stated::Whole(..)) && parts.len() < 2 {
            break;
        }
        known = film_of(parts, stated);
        let beside = beside_each(parts);
        for ((part, film), beside) in parts.iter_mut().zip(&known.models).zip(&beside) {
            if let Some(film) = film {
                part.correct(*film, beside);
            }
        }
    }
    look_around_unusual(parts, &known);
    for part in parts {
        let side = part.square_px;
        let found = part.found.iter_mut().flat_map(|one| &mut one.candidates);
        found.for_each(|one| *one = one.in_pixels(side));
    }
    known
}

/// How the frames show metal, by the poses that outlines led to, unless that was said.
fn tell_polarity(parts: &mut [Filmed<'_>]) {
    if parts.iter().any(|part| part.edges.shown.stated().is_some()) {
        return;
    }
    let votes = parts.iter().flat_map(Filmed::polarities);
    let Some(told) = most(votes) else { return };
    for part in parts {
        part.edges.shown = Shown::told(told);
    }
}

/// Of each component the others, where they seem to be by now. A pose that fits nowhere says nothing of another component.
fn beside_each<'f>(parts: &[Filmed<'f>]) -> Vec<Vec<Beside<'f>>> {
    let fits = |found: &&Candidate| {
        let verdict = judge_fit(&found.fit, true, &Limits::USUAL);
        !matches!(verdict, Verdict::NoFit(_))
    };
    let beside = |part: &Filmed<'f>| Beside {
        model: part.model,
        poses: part
            .found
            .iter()
            .map(|found| {
                found
                    .candidates
                    .first()
                    .filter(fits)
                    .map(|found| found.pose)
            })
            .collect(),
    };
    let all: Vec<Beside<'f>> = parts.iter().map(beside).collect();
    let others = |number: usize| {
        let others = all.iter().enumerate().filter(|(other, _)| *other != number);
        others.map(|(_, beside)| beside.clone()).collect()
    };
    (0..parts.len()).map(others).collect()
}

/// Looks around poses that leave more than is usual on their film.
fn look_around_unusual(parts: &mut [Filmed<'_>], known: &KnownFilm) {
    let best = |found: &FrameFound| Some(found.candidates.first()?.misfit());
    let misfits = Misfits(
        parts
            .iter()
            .map(|part| part.found.iter().map(best).collect())
            .collect(),
    );
    let beside = beside_each(parts);
    for (number, (part, film)) in parts.iter_mut().zip(&known.models).enumerate() {
        let symmetric = is_nearly_symmetric(&part.model, &symmetry_planes(part.model.mesh()));
        let beyond = |frame: usize| {
            let px = misfits.0[number][frame]?;
            misfits.beside(number, frame).look_beyond(px, symmetric)
        };
        if let Some(film) = film {
            part.look_around(*film, &beside[number], &beyond);
        }
    }
}

/// Side of the squares that the film is read in, pixels.
fn square_px(parts: &[Filmed<'_>]) -> usize {
    parts.first().map_or(1, |part| part.square_px)
}

fn film_of(parts: &[Filmed<'_>], stated: &Stated) -> KnownFilm {
    let given = match stated {
        Stated::Part(given) => *given,
        Stated::Whole(constants, models) => {
            return KnownFilm {
                models: in_squares(models, square_px(parts)),
                words: constants.to_string(),
            };
        }
    };
    let side = square_px(parts);
    let pool = read(parts, side, usize::MAX);
    let untold = || {
        match pool.clipped() {
        Some(clipped) => format!("not told, because {clipped}"),
        None => "not told by these frames: edges are taken to lie on the outline, and z is uncertain by millimetres".to_owned(),
    }
    };
    match pool.estimate(given) {
        Some(film) => KnownFilm {
            models: (0..parts.len())
                .map(|part| Some(film.model(part)))
                .collect(),
            words: words(&film, parts),
        },
        None => KnownFilm {
            models: vec![None; parts.len()],
            words: untold(),
        },
    }
}

/// The constants of a film and how sure they are.
fn words(film: &FilmEstimate, parts: &[Filmed<'_>]) -> String {
    let sure = |number: usize| film.covariance[number][number].sqrt();
    let metal = parts.iter().enumerate().map(|(number, part)| {
        let (name, attenuation) = (part.name, film.attenuation[number]);
        let percent = 100.0 * sure(2 + number);
        format!(", {name} {attenuation:.2} a mm ± {percent:.0} %")
    });
    let metal: String = metal.collect();
    let FilmConstants { curvature, .. } = film.constants;
    format!(
        "{film} ± {:.0} %{metal}; curvature {} a grey value, {} profiles, {:.1} grey values unexplained",
        100.0 * sure(1),
        plus_minus(curvature, sure(0), 4),
        film.profiles,
        film.residual
    )
}

impl Filmed<'_> {
    /// How each frame shows metal, by its best pose.
    fn polarities(&self) -> Vec<Polarity> {
        let tell = |buffers: &mut RefineBuffers, (frame, found): (usize, &FrameFound)| {
            let best = found.candidates.first()?;
            let told = self.see(frame, None, |camera, ImageTarget { frame, .. }| {
                let mut memory = buffers.borrow(&self.model, camera);
                let (model, pose) = (&self.model, &best.pose);
                Ok(polarity_at(model, camera, pose, frame, &mut memory)?)
            });
            told.ok()
        };
        let frames = self.found.par_iter().enumerate();
        let told: Vec<_> = frames.map_init(RefineBuffers::default, tell).collect();
        told.into_iter().flatten().collect()
    }

    pub(super) fn options(&self) -> RefineOptions {
        RefineOptions {
            edge_offset: self.edges.edge_offset,
            ..RefineOptions::default()
        }
    }

    /// The poses of outlines brought onto the edges of the frames, by the film's model where there is one. A frame that leads
    /// nowhere has no candidates, and says why.
    fn brought(&self, film: Option<FilmModel>) -> Vec<FrameFound> {
        let bring = |buffers: &mut RefineBuffers, (frame, outline): (usize, &FrameFound)| {
            let mut found = outline.clone();
            if outline.candidates.is_empty() {
                return found;
            }
            let brought = self.see(frame, film, |camera, image| {
                let mut memory = buffers.borrow(&self.model, camera);
                let (model, options) = (&self.model, self.options());
                let outline = &outline.candidates;
                Ok(onto_target(
                    model,
                    camera,
                    image,
                    outline,
                    options,
                    &mut memory,
                )?)
            });
            match brought {
                Ok(candidates) => found.candidates = candidates.to_vec(),
                Err(error) => {
                    found.candidates.clear();
                    found.failure = Some(self.why(frame, &error));
                }
            }
            found
        };
        let frames = self.found.par_iter().enumerate();
        frames.map_init(RefineBuffers::default, bring).collect()
    }

    /// Why a frame leads nowhere: that there is nothing in it, rather than that it fits nowhere.
    fn why(&self, frame: usize, error: &Error) -> String {
        let blank = self.see(frame, None, |_, image| Ok(is_blank(image.frame, ONE_GREY)));
        match blank {
            Ok(true) => BLANK.to_owned(),
            _ => format!("{error:#}"),
        }
    }

    /// Corrects all poses by the film's model, which has become better known. A frame that cannot be corrected stays as it is,
    /// and says so on standard error.
    fn correct(&mut self, film: FilmModel, beside: &[Beside<'_>]) {
        let (model, options) = (&self.model, self.options());
        let planes = symmetry_planes(model.mesh());
        let correct = |buffers: &mut RefineBuffers, (frame, found): (usize, &FrameFound)| {
            if found.candidates.is_empty() {
                return None;
            }
            let corrected = self.see_beside(frame, beside, film, |camera, image| {
                let mut memory = buffers.borrow(model, camera);
                let (seen, candidates) = ((camera, image), &found.candidates);
                let memory = &mut memory;
                Ok(correct_candidates(model, seen, &planes, candidates, options, memory)?.to_vec())
            });
            let told = |error| eprintln!("frame {} is not corrected: {error:#}", frame + 1);
            corrected.map_err(told).ok()
        };
        self.take(self.each(correct));
    }

    /// Looks around the poses of frames for which `beyond` gives when the search may end.
    fn look_around(
        &mut self,
        film: FilmModel,
        beside: &[Beside<'_>],
        beyond: &(impl Fn(usize) -> Option<f64> + Sync),
    ) {
        let (model, options) = (&self.model, self.options());
        let planes = symmetry_planes(model.mesh());
        let look = |buffers: &mut RefineBuffers, (frame, found): (usize, &FrameFound)| {
            let how = (options, beyond(frame)?);
            let around = self.see_beside(frame, beside, film, |camera, image| {
                let mut memory = buffers.borrow(model, camera);
                let (seen, candidates) = ((camera, image), &found.candidates);
                let memory = &mut memory;
                Ok(look_around(model, seen, &planes, candidates, how, memory)?.to_vec())
            });
            let told = |error| eprintln!("around frame {} nothing is found: {error:#}", frame + 1);
            around.map_err(told).ok()
        };
        self.take(self.each(look));
    }

    /// What becomes of each frame's candidates, where anything does.
    fn each(
        &self,
        led_to: impl Fn(&mut RefineBuffers, (usize, &FrameFound)) -> Option<Vec<Candidate>>
        + Send
        + Sync,
    ) -> Vec<Option<Vec<Candidate>>> {
        let frames = self.found.par_iter().enumerate();
        frames.map_init(RefineBuffers::default, led_to).collect()
    }

    fn take(&mut self, candidates: Vec<Option<Vec<Candidate>>>) {
        for (found, candidates) in self.found.iter_mut().zip(candidates) {
            if let Some(candidates) = candidates {
                found.candidates = candidates;
            }
        }
    }

    /// Calls `look` with a frame in which the components beside the one that is looked at are hidden.
    fn see_beside<T>(
        &self,
        frame: usize,
        beside: &[Beside<'_>],
        film: FilmModel,
        look: impl FnOnce(&Camera, ImageTarget<'_>) -> Result<T>,
    ) -> Result<T> {
        self.see(frame, Some(film), |camera, image| {
            let hidden = hidden(beside, camera, frame, image.unknown)?;
            let unknown = hidden.as_ref().map(MaskBuffer::mask);
            let unknown = unknown.as_ref();
            look(camera, ImageTarget { unknown, ..image })
        })
    }

    /// Brings a pose onto the edges of a frame, by the film's model where there is one; best first.
    ///
    /// # Errors
    /// Where there is no frame, and where the pose cannot be refined.
    pub fn refine(
        &self,
        frame: usize,
        start: &Pose,
        film: Option<FilmModel>,
        buffers: &mut RefineBuffers,
    ) -> Result<Vec<RefinedRival>> {
        self.see(frame, film, |camera, image| {
            let view = CameraView::only(camera, image);
            let mut memory = buffers.borrow(&self.model, camera);
            let (model, options) = (&self.model, self.options());
            Ok(refine_rivals(model, &[view], &[*start], &[], options, &mut memory)?.to_vec())
        })
    }
}
