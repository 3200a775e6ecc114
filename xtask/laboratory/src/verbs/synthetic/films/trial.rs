//! Both components of a film, found from a click or refined from the truth, before anything is known of the film.

use std::time::Instant;

use anyhow::Result;
use fluoropose::camera::Camera;
use fluoropose::finder::choice::ChoiceContext;
use fluoropose::finder::{Candidate, Verdict};
use fluoropose::follow::{InJoint, Limb};
use fluoropose::image::frame::Frame;
use fluoropose::mesh::Model;
use fluoropose::mesh::anatomy::{KneeComponent, anatomical_axes};
use fluoropose::mesh::symmetry::symmetry_planes;
use fluoropose::pose::Pose;
use fluoropose::refine::{CameraView, ImageTarget, Polarity, RefineOptions, assess};

use super::draw::Film;
use super::outcome::chosen;
use crate::finding::{Clicker, Neighbour, Refiner, covered, threshold_outline, wire_outline};
use fluoropose_tracing::one_click::Prompt;

/// How a pose was come by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum FilmWay {
    /// From one click, the tray's with the femur's pose known; corrected by what all frames of both components tell of the film
    Click,
    /// From the region around the click at a grey level, an outline on edges; corrected alike
    Threshold,
    /// From a live-wire around the component, the same
    Wire,
    /// Refined on the film from the true pose, and corrected alike
    Image,
    /// The same, but the film is told by this component in this frame alone
    Alone,
}

impl FilmWay {
    /// Those that are measured where none is named.
    pub const USUAL: [Self; 3] = [Self::Click, Self::Image, Self::Alone];

    /// Whether poses are found, by libraries, and not refined from the truth.
    pub(super) fn is_found(self) -> bool {
        matches!(self, Self::Click | Self::Threshold | Self::Wire)
    }

    /// The word for it in tables.
    pub fn word(self) -> &'static str {
        match self {
            Self::Click => "click",
            Self::Threshold => "threshold",
            Self::Wire => "wire",
            Self::Image => "image",
            Self::Alone => "alone",
        }
    }
}

/// Poses of one component in one film, best first.
#[derive(Clone, Debug, Default)]
pub(super) struct Attempt {
    pub(super) candidates: Vec<Candidate>,
    /// Wall time, ms.
    pub(super) ms: f64,
}

/// Everything that finds the poses of one film's components; a copy for each core.
pub(super) struct Bench<'b> {
    models: [Model<'b>; 2],
    /// As their shapes tell them.
    limbs: [Option<Limb<'b>>; 2],
    /// Where there are libraries.
    clickers: Option<[Clicker<'b>; 2]>,
    refiners: [Refiner<'b>; 2],
    camera: Camera,
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
            limbs: [
                limb(&models[0], KneeComponent::Femur),
                limb(&models[1], KneeComponent::Tibia),
            ],
            models,
            camera,
        })
    }

    /// Both components of a film, the femur first.
    ///
    /// # Errors
    /// For a film of another size.
    pub(super) fn attempt(&mut self, film: &Film, way: FilmWay) -> Result<[Attempt; 2]> {
        let frame = film.frame(&self.camera)?;
        let mut femur = None;
        let mut attempt = |part: usize| -> Result<Attempt> {
            let begin = Instant::now();
            let candidates = match way {
                FilmWay::Click => self.clicked(&frame, film, part, femur)?,
                FilmWay::Threshold | FilmWay::Wire => self.traced(&frame, film, part, way),
                FilmWay::Image | FilmWay::Alone => self.refined(&frame, film, part),
            };
            femur = chosen(&candidates, &ChoiceContext::default())
                .filter(|(_, verdict)| !matches!(verdict, Verdict::NoFit(_)))
                .map(|(candidate, _)| candidate.pose);
            Ok(Attempt {
                candidates,
                ms: begin.elapsed().as_secs_f64() * 1e3,
            })
        };
        Ok([attempt(0)?, attempt(1)?])
    }

    /// From a click into a component, a tray's beside the pose of its `femur`.
    fn clicked(
        &mut self,
        frame: &Frame<'_, u8>,
        film: &Film,
        part: usize,
        femur: Option<Pose>,
    ) -> Result<Vec<Candidate>> {
        let beside = match (femur, &self.limbs) {
            (Some(femur), [Some(known), Some(clicked)]) if part == 1 => Some((
                InJoint::beside(known, &femur),
                clicked,
                covered(&self.models[0], &self.camera, &femur)?,
            )),
            _ => None,
        };
        let neighbour = beside.as_ref().map(|(joint, clicked, covered)| Neighbour {
            joint,
            clicked,
            covered: covered.mask(),
        });
        let clicked = self.clickers.as_mut().and_then(|clickers| {
            let (click, dark) = (film.clicks[part], Polarity::DarkImplant);
            let clicker = &mut clickers[part];
            clicker.click(frame, click, dark, neighbour.as_ref()).ok()
        });
        Ok(clicked.map_or_else(Vec::new, |clicked| clicked.candidates))
    }

    /// From the outline of a tool; none where the tool gives none or nothing explains it.
    fn traced(
        &mut self,
        frame: &Frame<'_, u8>,
        film: &Film,
        part: usize,
        way: FilmWay,
    ) -> Vec<Candidate> {
        let outline = match (way, film.clicks[part]) {
            (FilmWay::Threshold, Prompt::Click(at)) => threshold_outline(frame, at),
            _ => film
                .silhouette(part, &self.camera)
                .and_then(|mask| wire_outline(frame, &mask).map(Some)),
        };
        let (Ok(Some(outline)), Some(clickers)) = (outline, &mut self.clickers) else {
            return Vec::new();
        };
        let found = clickers[part].trace(&outline.mask());
        found.unwrap_or_default()
    }

    /// Refinement on the film from the truth.
    fn refined(&mut self, frame: &Frame<'_, u8>, film: &Film, part: usize) -> Vec<Candidate> {
        let view = CameraView::only(&self.camera, target(frame));
        let (truth, refiner) = (film.truth[part], &mut self.refiners[part]);
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
        candidate.into_iter().collect()
    }
}

fn limb<'m>(model: &Model<'m>, component: KneeComponent) -> Option<Limb<'m>> {
    let mesh = *model.mesh();
    let axes = anatomical_axes(&mesh, &symmetry_planes(&mesh), component)?;
    Some(Limb {
        mesh,
        component,
        axes,
    })
}

/// A film of which nothing is known.
fn target<'a>(frame: &'a Frame<'a, u8>) -> ImageTarget<'a> {
    ImageTarget {
        frame,
        unknown: None,
        polarity: Polarity::DarkImplant,
        film: None,
    }
}
