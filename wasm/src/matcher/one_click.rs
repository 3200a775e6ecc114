//! One click or one box: a first outline and pose, in steps between which a worker can be called off.

mod near;
mod offered;
mod steps_near;

use fluoropose::camera::Camera;
use fluoropose::camera::calibration::Calibration;
use fluoropose::film::{FilmModel, LineMemory};
use fluoropose::finder::choice::RivalPose as Contender;
use fluoropose::finder::{Component, Verdict};
use fluoropose::follow::{InJoint, JointPlaces};
use fluoropose::image::contour::Point;
use fluoropose::image::mask::{Word, words_needed};
use fluoropose::locate::Workspace;
use fluoropose::mesh::anatomy::KneeComponent;
use fluoropose::pose::Pose;
use fluoropose::refine::{Polarity, RefineMemory};
use fluoropose::search::kernels::Kernels;
use fluoropose_tracing::one_click::{
    Answer, Observation, OneClick as Work, OneClickBuffers, OneClickMemory, Progress, Prompt,
};
use wasm_bindgen::prelude::*;

use self::near::Near;
use self::offered::{contender, is_open, offered, possible, rivals};
use super::Matcher;
use super::answer::{OneClickAnswer, told};
use super::from_here::{hide_model, model_of};
use super::on_frame::{OnFrame, Seen, outline_of};
use crate::choice::{Chosen, Surroundings};
use crate::film::film_model;
use crate::found::{Candidate, Match};
use crate::hidden::{hide, with_mask};
use crate::shape::Shape;
use crate::squares::of_pixels;
use fluoropose_page::calibration::calibration_of;
use fluoropose_page::error::sentence;
use fluoropose_page::frame_image::FrameImage;
use fluoropose_page::pose_numbers::from_numbers;

/// Numbers of a prompt: a click's column and row, or a box's left, top, right and bottom.
fn prompt_of(numbers: &[f64]) -> Result<Prompt, JsError> {
    match *numbers {
        [column, row] => Ok(Prompt::Click(Point::new(column, row))),
        [left, top, right, bottom] => Ok(Prompt::Box(
            Point::new(left, top),
            Point::new(right, bottom),
        )),
        _ => Err(JsError::new(&format!(
            "A click is 2 numbers and a box is 4, but {} were given",
            numbers.len()
        ))),
    }
}

/// The joint's other component in this frame.
struct Beside {
    joint: InJoint,
    /// The component that is clicked, as its shape tells it.
    clicked: Shape,
    /// Pixels that are the other one's.
    hidden: Vec<Word>,
}

/// The work from a click or a box on a film to outlines and poses.
#[wasm_bindgen]
pub struct OneClick {
    film: FrameImage,
    camera: Camera,
    calibration: Calibration,
    polarity: Polarity,
    prompt: Prompt,
    excluded: Option<Vec<Word>>,
    /// What the joint's other component tells, where that is known.
    beside: Option<Beside>,
    work: Option<Work>,
    /// Why its regions led to nothing, and what places near it lead to.
    vain: Option<String>,
    near: Near,
    /// A pose that was found before, refined, and its mirror images.
    given: Vec<OnFrame>,
    buffers: OneClickBuffers,
    /// What the film makes of the component, and the largest usual misfit on it, pixels.
    known: Option<FilmModel>,
    usual: Option<f64>,
    /// Distance of a library that nobody told, mm, where the calibration does not tell it either.
    untold: Option<f64>,
}

#[wasm_bindgen]
impl OneClick {
    /// Begins with a film, its calibration and a click (column, row) or a rough box (left, top, right, bottom). Where it is not said
    /// whether metal is brighter than what surrounds it, the film tells it there.
    ///
    /// # Errors
    /// A sentence about the calibration or the prompt.
    #[wasm_bindgen(constructor)]
    pub fn new(
        film: &FrameImage,
        calibration: &str,
        prompt: &[f64],
        bright_implant: Option<bool>,
    ) -> Result<OneClick, JsError> {
        let (width, height) = film.size();
        let prompt = prompt_of(prompt)?;
        let (calibration, camera) = calibration_of(calibration, width as u32, height as u32)?;
        let tells = calibration.principal_distance().is_some();
        Ok(Self {
            untold: (!tells).then(|| calibration.expected_distance()),
            film: film.shared(),
            camera,
            calibration,
            polarity: match bright_implant {
                Some(is_bright) => Polarity::of(is_bright),
                None => film.look(|frame| Ok(prompt.polarity(frame)))?,
            },
            prompt,
            excluded: None,
            beside: None,
            work: None,
            vain: None,
            near: Near::Unasked,
            given: Vec::new(),
            buffers: OneClickBuffers::default(),
            known: None,
            usual: None,
        })
    }

    /// Leaves out the pixels inside an outline (columns and rows by turns), and some round it: another component's, whose edges
    /// are as wide as the film's blur. Where a model is looked for, only where its edges lie on a known film.
    ///
    /// # Errors
    /// The core's sentence about the outline.
    pub fn avoid(&mut self, outline: &[f64]) -> Result<(), JsError> {
        let fresh = || vec![0; words_needed(self.camera.width(), self.camera.height())];
        let all = self.excluded.get_or_insert_with(fresh);
        hide(outline, &self.camera, all)
    }

    /// Says where the joint's other component is in this frame (six numbers of its pose), so that the one that is clicked is looked for
    /// where its joint leaves it too. `axes` are both components' (nine numbers each, as `axes_from` takes them), this one's first, and so
    /// is whether their shape tells the front. Without the other one's model it tells nothing.
    ///
    /// # Errors
    /// A sentence about the numbers, and the core's where the other one cannot be drawn.
    #[wasm_bindgen(js_name = knowOther)]
    pub fn know_other(
        &mut self,
        other: &mut Matcher,
        pose: &[f64],
        femoral: bool,
        axes: &[f64],
        fronts: &[u8],
    ) -> Result<(), JsError> {
        let Some(model) = &mut other.model else {
            return Ok(());
        };
        let pose = Pose::from(from_numbers(pose)?);
        let (own, others) = axes.split_at(axes.len() / 2);
        let front = |k: usize| fronts.get(k).is_some_and(|&told| told != 0);
        let (clicked, known) = match femoral {
            true => (KneeComponent::Femur, KneeComponent::Tibia),
            false => (KneeComponent::Tibia, KneeComponent::Femur),
        };
        let known = Shape::of(known, others, front(1))?;
        let mut hidden = vec![0; words_needed(self.camera.width(), self.camera.height())];
        hide_model(model, &pose, &self.camera, &mut hidden)?;
        self.beside = Some(Beside {
            joint: InJoint::beside(&known.limb(*model.model().mesh()), &pose),
            clicked: Shape::of(clicked, own, front(0))?,
            hidden,
        });
        Ok(())
    }

    /// What the film makes of the component, as `FilmFacts.model` gives it: poses are then where it puts the edges. Around one
    /// that leaves more than is `usual` (as `usualMisfit` gives it) others are looked for.
    ///
    /// # Errors
    /// A sentence about the numbers.
    #[wasm_bindgen(js_name = knowFilm)]
    pub fn know_film(&mut self, film: &[f64], usual: Option<f64>) -> Result<(), JsError> {
        self.known = film_model(film)?;
        self.usual = usual;
        Ok(())
    }

    /// Whether metal is taken to be brighter than what surrounds it.
    #[wasm_bindgen(getter, js_name = brightImplant)]
    pub fn bright_implant(&self) -> bool {
        self.polarity == Polarity::BrightImplant
    }

    /// Part of the work that is done, 0 to 1.
    #[wasm_bindgen(getter)]
    pub fn progress(&self) -> f64 {
        if let Some(part) = self.near.progress() {
            return part;
        }
        match self.work.as_ref().map(Work::progress) {
            None => 0.0,
            Some(Progress::Regions(done) | Progress::Poses(done)) => done,
            Some(Progress::Done) => 1.0,
        }
    }

    /// What is being done.
    #[wasm_bindgen(getter)]
    pub fn doing(&self) -> String {
        let words = match self.work.as_ref().map(Work::progress) {
            _ if self.near.progress().is_some() => "Looking once more near the click",
            None | Some(Progress::Regions(_)) => "Looking for the implant's region",
            Some(Progress::Poses(_)) => "Bringing the model onto the edges",
            Some(Progress::Done) => "Done",
        };
        words.to_owned()
    }

    /// One step with a library and its model. Gives whether there is more to do. Where its regions lead to nothing that convinces, places near
    /// the click are tried.
    ///
    /// # Errors
    /// A sentence about why there is no outline.
    pub fn step(&mut self, matcher: &mut Matcher) -> Result<bool, JsError> {
        if self.near.progress().is_some() {
            return self.step_near(matcher);
        }
        match self.step_regions(matcher)? {
            true => Ok(true),
            false => self.begin_near(matcher),
        }
    }

    /// Takes a pose (six numbers) that was found before instead of looking for one: what came of it is that and its mirror images.
    ///
    /// # Errors
    /// A sentence about the numbers, and the core's where it cannot be refined.
    #[wasm_bindgen(js_name = takePose)]
    pub fn take_pose(&mut self, matcher: &mut Matcher, pose: &[f64]) -> Result<(), JsError> {
        let pose = Pose::from(from_numbers(pose)?);
        self.given = matcher.given_pose(&pose, &self.seen())?;
        Ok(())
    }

    /// One step without library and model: the region and its edges alone.
    ///
    /// # Errors
    /// A sentence about why there is no outline.
    #[wasm_bindgen(js_name = stepAlone)]
    pub fn step_alone(&mut self) -> Result<bool, JsError> {
        self.alone(|work, observation, memory| {
            work.step(observation, None, memory).map_err(sentence)
        })
    }

    /// What came of it without library and model: the region with the sharpest border.
    ///
    /// # Errors
    /// A sentence where there is none.
    #[wasm_bindgen(js_name = finishAlone)]
    pub fn finish_alone(&mut self) -> Result<OneClickAnswer, JsError> {
        let outline = self.alone(|work, observation, memory| {
            let region = work.draw_region(observation, memory).map_err(sentence)?;
            outline_of(&region)
        })?;
        Ok(OneClickAnswer {
            outlines: vec![outline],
            sentence: "The region with the sharpest border round there; open the implant's model for an outline that knows its shape.".to_owned(),
            ..OneClickAnswer::new(false)
        })
    }

    /// What came of it: the chosen pose first, then its rivals, each with the model's silhouette as its outline.
    ///
    /// # Errors
    /// A sentence where the work is not done or the model cannot be drawn.
    pub fn finish(
        &mut self,
        matcher: &mut Matcher,
        around: &Surroundings,
    ) -> Result<OneClickAnswer, JsError> {
        let work = self.work.as_ref().filter(|_| self.given.is_empty());
        let all = work.map_or(&[][..], Work::answers);
        let middle = model_of(&mut matcher.model)?.model().bounds().centre;
        let answers = possible(all, &self.calibration, &middle);
        let found = rivals(&answers).map(OnFrame::from);
        let (seen, found) = (self.seen(), self.given.iter().copied().chain(found));
        let mut answers = matcher.in_squares(found.collect(), &seen)?;
        let among = |answers: &[OnFrame]| {
            let contenders: Vec<Contender> = answers.iter().map(contender).collect();
            Chosen::among(&contenders, around, |_, _| true)
                .ok_or_else(|| JsError::new("The first outline is not worked out yet"))
        };
        let mut chosen = among(&answers)?;
        let others = matcher.around(&answers[chosen.index()], &seen)?;
        if !others.is_empty() {
            answers.extend(others);
            chosen = among(&answers)?;
        }
        let mut answer = OneClickAnswer::new(self.known.is_some());
        let mut candidates = Vec::new();
        for place in offered(&answers, &chosen) {
            let one = &answers[place];
            let candidate = matcher.on_frame(one, &seen)?;
            // The chosen one stays for its reason.
            let fits = !matches!(candidate.verdict, Some(Verdict::NoFit(_)));
            if !fits && !candidates.is_empty() {
                continue;
            }
            answer
                .outlines
                .push(matcher.outline_at(&one.refined.pose, &self.camera)?);
            answer.supports.push(one.support);
            candidates.push(candidate);
        }
        let share = answer.supports.first().copied().unwrap_or(0.0);
        let covariance = candidates.first().and_then(Candidate::covariance);
        let is_open = is_open(&answers, &chosen, covariance.as_ref(), &middle);
        if !is_open {
            chosen = chosen.without_open();
        }
        answer.sentence = told(share, is_open);
        let alone = candidates.first().and_then(|first| first.verdict);
        answer.matched = Some(Match {
            candidates,
            compared: answers.len(),
            clipped: false,
            partial: false,
            chosen: Some(match alone {
                Some(alone) => chosen.judged(alone),
                None => chosen,
            }),
        });
        Ok(answer)
    }
}

impl OneClick {
    /// One step of the regions that hold the click.
    fn step_regions(&mut self, matcher: &mut Matcher) -> Result<bool, JsError> {
        matcher.with_component(&self.camera, |component, workspace, refine| {
            let mut work = match self.work.take() {
                Some(work) => work,
                None => {
                    let work = begun(self.prompt, &self.camera, self.untold, component)?;
                    match &self.beside {
                        Some(beside) => in_joint(work, beside, &self.film, component)?,
                        None => work,
                    }
                }
            };
            let mut memory = self
                .buffers
                .borrow(&work.needs(&self.camera), workspace, refine);
            let (camera, polarity, film) = (&self.camera, self.polarity, of_pixels(self.known));
            let hidden = self.beside.as_ref().map(|beside| &*beside.hidden);
            let more = self.film.look(|frame| {
                with_mask(hidden, camera, |beside| {
                    let observation = Observation {
                        frame,
                        camera,
                        polarity,
                        // Without what the other component covers a silhouette over which that lies would have a gap. Its edges are left
                        // out where the film is known.
                        excluded: None,
                        beside,
                        film,
                    };
                    Ok(work.step(&observation, Some(component), &mut memory))
                })
            });
            self.work = Some(work);
            // Places near the click may lead somewhere.
            Ok(more?.unwrap_or_else(|error| {
                self.vain = Some(error.to_string());
                false
            }))
        })
    }

    fn seen(&self) -> Seen<'_> {
        Seen {
            frame: &self.film,
            camera: &self.camera,
            polarity: self.polarity,
            unknown: self.excluded.as_deref(),
            film: self.known,
            usual: self.usual,
        }
    }

    fn alone<T>(
        &mut self,
        with: impl FnOnce(&mut Work, &Observation<'_>, &mut OneClickMemory<'_>) -> Result<T, JsError>,
    ) -> Result<T, JsError> {
        let fresh = || Work::new(self.prompt, &self.camera, None);
        let mut work = self.work.take().map_or_else(fresh, Ok).map_err(sentence)?;
        let workspace = Workspace {
            canonical: &mut [],
            rotated: &mut [],
            scores: &mut [],
            bytes: &mut [],
            kernels: Kernels::PORTABLE,
        };
        let refine = RefineMemory {
            projected: &mut [],
            drawn: &mut [],
            places: &mut [],
            border: &mut [],
            film: LineMemory::default(),
        };
        let mut memory = self
            .buffers
            .borrow(&work.needs(&self.camera), workspace, refine);
        let (camera, polarity, excluded) = (&self.camera, self.polarity, &self.excluded);
        let done = self.film.look(|frame| {
            with_mask(excluded.as_deref(), camera, |excluded| {
                let observation = Observation {
                    frame,
                    camera,
                    polarity,
                    excluded,
                    beside: None,
                    film: None,
                };
                with(&mut work, &observation, &mut memory)
            })
        });
        self.work = Some(work);
        done
    }
}

/// The work for a component; farther away too, where its library is at a distance that was `untold`.
fn begun(
    prompt: Prompt,
    camera: &Camera,
    untold: Option<f64>,
    component: &Component<'_>,
) -> Result<Work, JsError> {
    let work = Work::new(prompt, camera, Some(component)).map_err(sentence)?;
    let distance = component.library.info().distance;
    Ok(match untold {
        Some(untold) if (untold - distance).abs() < 1.0 => work.or_farther(camera, component),
        _ => work,
    })
}

/// The same work, with what the joint tells.
fn in_joint(
    work: Work,
    beside: &Beside,
    film: &FrameImage,
    component: &Component<'_>,
) -> Result<Work, JsError> {
    let clicked = beside.clicked.limb(*component.model.mesh());
    let places = film.look(|frame| Ok(JointPlaces::new(frame, &beside.joint, &clicked)))?;
    Ok(work.in_joint(places))
}

impl Matcher {
    /// Calls `with` with the component and the memory to match and refine it.
    fn with_component<T>(
        &mut self,
        camera: &Camera,
        with: impl FnOnce(&Component<'_>, Workspace<'_>, RefineMemory<'_>) -> Result<T, JsError>,
    ) -> Result<T, JsError> {
        let library = self.library.borrow_dependent();
        let model = model_of(&mut self.model)?;
        model.with_component(library, camera, |component, memory| {
            with(component, memory.workspace, memory.refine)
        })
    }
}

impl From<&Answer> for OnFrame {
    fn from(answer: &Answer) -> Self {
        Self {
            refined: answer.refined,
            start: answer.start,
            support: answer.support.fraction,
        }
    }
}

#[cfg(test)]
mod tests;
