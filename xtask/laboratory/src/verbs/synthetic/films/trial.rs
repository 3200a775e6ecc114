//! Both components of a film, found from a click and refined from the truth.

use std::time::Instant;

use anyhow::Result;
use fluoropose::camera::Camera;
use fluoropose::finder::choice::{ChoiceContext, Counterpart, choose};
use fluoropose::finder::{Candidate, Limits, Verdict, contenders, judge};
use fluoropose::image::frame::Frame;
use fluoropose::math::solve_spd;
use fluoropose::mesh::Model;
use fluoropose::pose::covariance::Deviations;
use fluoropose::pose::{Pose, Quaternion};
use fluoropose::refine::{CameraView, ImageTarget, Polarity, RefineOptions, assess};

use super::draw::Film;
use crate::finding::{Clicker, Refiner};
use crate::measure::accuracy::Errors;

/// Squared radii that hold 68.3 and 95 % of a normal distribution, of one number and of three.
const OF_ONE: [f64; 2] = [1.0, 3.841];
const OF_THREE: [f64; 2] = [3.527, 7.815];
/// Poses farther from the truth than this many standard deviations are wrong.
const WRONG_SD: f64 = 3.0;

/// How a pose was come by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FilmWay {
    /// From one click; the tray's with the femur's pose known.
    Click,
    /// Refined on the film from the true pose.
    Image,
}

impl FilmWay {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Click, Self::Image];

    /// The word for it in tables.
    pub fn word(self) -> &'static str {
        match self {
            Self::Click => "click",
            Self::Image => "image",
        }
    }
}

/// What came of one component of one film.
#[derive(Clone, Copy, Debug)]
pub(super) struct Outcome {
    /// Whether it was good, doubtful or none.
    pub(super) verdict: &'static str,
    /// Of a pose that was not refused, in the chosen place.
    pub(super) found: Option<Found>,
    /// Wall time, ms.
    pub(super) ms: f64,
}

/// A pose against the truth.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    pub(super) errors: Errors,
    /// How sure the pose was said to be.
    pub(super) sd: Option<Deviations>,
    /// Whether the truth lies in the regions of 68 and 95 % of z and of the rotation.
    pub(super) z_inside: [bool; 2],
    pub(super) rotation_inside: [bool; 2],
    /// Whether depth or rotation is off by more than three standard deviations.
    pub(super) wrong: bool,
}

/// Everything that finds the poses of one film's components; a copy for each core.
pub(super) struct Bench<'b> {
    pub(super) models: [Model<'b>; 2],
    /// Where there are libraries.
    pub(super) clickers: Option<[Clicker<'b>; 2]>,
    pub(super) refiners: [Refiner<'b>; 2],
    pub(super) camera: Camera,
}

impl<'b> Bench<'b> {
    /// Opens the libraries of both models, which clicks need.
    ///
    /// # Errors
    /// Those of [`Clicker::open`].
    pub(super) fn open(
        libraries: Option<&'b [Vec<u8>; 2]>,
        models: [Model<'b>; 2],
        camera: Camera,
    ) -> Result<Self> {
        let clickers = libraries.map(|libraries| -> Result<[Clicker<'b>; 2]> {
            let open = |part: usize| Clicker::open(&libraries[part], models[part], camera);
            Ok([open(0)?, open(1)?])
        });
        Ok(Self {
            clickers: clickers.transpose()?,
            refiners: models.map(|model| Refiner::new(model, RefineOptions::default())),
            models,
            camera,
        })
    }

    /// Both components of a film, the femur first.
    ///
    /// # Errors
    /// For a film of another size.
    pub(super) fn run(&mut self, film: &Film, way: FilmWay) -> Result<[Outcome; 2]> {
        let (width, height) = (self.camera.width(), self.camera.height());
        let frame = Frame::new(&film.pixels, width, height, width)?;
        if way == FilmWay::Image {
            return Ok([self.refined(&frame, film, 0), self.refined(&frame, film, 1)]);
        }
        let (femur, known) = self.clicked(&frame, film, 0, None);
        let known = known.map(Counterpart::Femur);
        let (tibia, _) = self.clicked(&frame, film, 1, known);
        Ok([femur, tibia])
    }

    /// One click, and the pose that it led to unless that was refused.
    fn clicked(
        &mut self,
        frame: &Frame<'_, u8>,
        film: &Film,
        part: usize,
        counterpart: Option<Counterpart>,
    ) -> (Outcome, Option<Pose>) {
        let begin = Instant::now();
        let clicked = self.clickers.as_mut().and_then(|clickers| {
            let click = film.clicks[part];
            clickers[part]
                .click(frame, click, Polarity::DarkImplant)
                .ok()
        });
        let ms = begin.elapsed().as_secs_f64() * 1e3;
        let candidates = clicked.map_or_else(Vec::new, |clicked| clicked.candidates);
        let context = ChoiceContext {
            counterpart,
            ..ChoiceContext::default()
        };
        let outcome = self.judged(&candidates, &context, &film.truth[part], part, ms);
        let pose = chosen(&candidates, &context).filter(|_| outcome.found.is_some());
        (outcome, pose.map(|(candidate, _)| candidate.pose))
    }

    /// Refinement on the film from the truth.
    fn refined(&mut self, frame: &Frame<'_, u8>, film: &Film, part: usize) -> Outcome {
        let target = ImageTarget {
            frame,
            unknown: None,
            polarity: Polarity::DarkImplant,
            film: None,
        };
        let view = CameraView::only(&self.camera, target);
        let (truth, refiner) = (film.truth[part], &mut self.refiners[part]);
        let begin = Instant::now();
        let refined = refiner.refine_as_given(&[view], &[truth]);
        let candidate = refined.ok().and_then(|found| {
            let refined = found.first()?.refined;
            let mut memory = refiner.memory(&self.camera);
            let assessment = assess(&self.models[part], &[view], &refined, &mut memory).ok()?;
            Some(Candidate {
                pose: refined.pose,
                start: truth,
                located: None,
                refined: Some(refined),
                covariance: assessment.covariance,
                fit: assessment.fit,
            })
        });
        let ms = begin.elapsed().as_secs_f64() * 1e3;
        let context = ChoiceContext::default();
        self.judged(candidate.as_slice(), &context, &truth, part, ms)
    }

    fn judged(
        &self,
        candidates: &[Candidate],
        context: &ChoiceContext<'_>,
        truth: &Pose,
        part: usize,
        ms: f64,
    ) -> Outcome {
        let chosen = chosen(candidates, context);
        let middle = self.models[part].bounds().centre;
        Outcome {
            verdict: chosen.map_or("none", |(_, verdict)| verdict.word()),
            found: chosen
                .filter(|(_, verdict)| !matches!(verdict, Verdict::NoFit(_)))
                .map(|(candidate, _)| Found::of(&candidate, truth, &middle)),
            ms,
        }
    }
}

fn chosen(candidates: &[Candidate], context: &ChoiceContext<'_>) -> Option<(Candidate, Verdict)> {
    let choice = choose(&contenders(candidates), context)?;
    let verdict = judge(candidates, &choice, &Limits::USUAL)?;
    Some((*candidates.get(choice.index)?, verdict))
}

impl Found {
    fn of(candidate: &Candidate, truth: &Pose, middle: &[f64; 3]) -> Self {
        let errors = Errors::of(&candidate.pose, truth);
        let sd = candidate
            .covariance
            .map(|covariance| covariance.deviations(&candidate.pose, middle));
        let z = sd.map(|sd| (errors.z_mm / sd.z_mm).powi(2));
        let rotation = turn_squared(candidate, truth);
        let inside = |square: Option<f64>, radii: [f64; 2]| {
            radii.map(|radius| square.is_some_and(|square| square <= radius))
        };
        let beyond = |error: f64, sd: f64| error.abs() > WRONG_SD * sd;
        Self {
            errors,
            sd,
            z_inside: inside(z, OF_ONE),
            rotation_inside: inside(rotation, OF_THREE),
            wrong: sd.is_none_or(|sd| {
                beyond(errors.z_mm, sd.z_mm) || beyond(errors.geodesic_deg, sd.rotation_deg)
            }),
        }
    }
}

/// The turn to the truth in units of its covariance, squared.
fn turn_squared(candidate: &Candidate, truth: &Pose) -> Option<f64> {
    let covariance = candidate.covariance?;
    let matrix = std::array::from_fn(|i| std::array::from_fn(|j| covariance.matrix[i][j]));
    let back = fluoropose::math::transpose(&candidate.pose.rotation);
    let turn = fluoropose::math::multiply(&truth.rotation, &back);
    let turn = vector_of(Quaternion::from(turn));
    let solved: [f64; 3] = solve_spd(matrix, turn)?;
    Some(turn.iter().zip(solved).map(|(a, b)| a * b).sum())
}

/// The rotation vector of a unit quaternion, radians.
fn vector_of(turn: Quaternion) -> [f64; 3] {
    let Quaternion { w, x, y, z } = turn;
    let sine = x.hypot(y).hypot(z);
    let angle = 2.0 * sine.atan2(w.abs());
    let factor = if sine > 0.0 { angle / sine } else { 2.0 };
    [x, y, z].map(|part| part * factor * w.signum())
}
