//! One click or one box: a first outline and pose, in steps between which a worker can be called off.

mod answer;

pub use answer::OneClickAnswer;

use fluoropose::camera::Camera;
use fluoropose::film::LineMemory;
use fluoropose::finder::choice::RivalPose as Contender;
use fluoropose::finder::{Component, Verdict};
use fluoropose::image::border::follow_border;
use fluoropose::image::contour::{Contour, Outline, Point};
use fluoropose::image::mask::{Mask, MaskMut, Word, words_needed};
use fluoropose::image::region::largest_region;
use fluoropose::locate::Workspace;
use fluoropose::math::{multiply, transpose};
use fluoropose::pose::{EulerPose, Pose, view_rotation};
use fluoropose::refine::{CameraView, ImageTarget, Polarity, RefineMemory, Refined};
use fluoropose::search::kernels::Kernels;
use fluoropose_tracing::one_click::{
    Answer, Observation, OneClick as Work, OneClickBuffers, OneClickMemory, Progress, Prompt,
};
use wasm_bindgen::prelude::*;

use super::from_here::model_of;
use super::{Matcher, OFFERED, RIVAL_WITHIN};
use crate::choice::{Chosen, Surroundings};
use crate::exchange::simplified;
use crate::found::{Candidate, Match, deviation_numbers};
use crate::working_model::Assessed;
use answer::{FAIR, told};
use fluoropose_page::calibration::camera;
use fluoropose_page::error::sentence;
use fluoropose_page::frame_image::FrameImage;
use fluoropose_page::pose_numbers::to_numbers;

/// The outline that is handed out stays so near to the silhouette, pixels.
const TOLERANCE: f64 = 0.5;
/// An answer whose edges are weaker than this part of the best's is no rival.
const RIVAL_STRENGTH: f64 = 0.75;

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

/// The work from a click or a box on a film to outlines and poses.
#[wasm_bindgen]
pub struct OneClick {
    film: FrameImage,
    camera: Camera,
    polarity: Polarity,
    prompt: Prompt,
    excluded: Option<Vec<Word>>,
    work: Option<Work>,
    buffers: OneClickBuffers,
}

#[wasm_bindgen]
impl OneClick {
    /// Begins with a film, its calibration and a click (column, row) or a rough box (left, top, right, bottom).
    ///
    /// # Errors
    /// A sentence about the calibration or the prompt.
    #[wasm_bindgen(constructor)]
    pub fn new(
        film: &FrameImage,
        calibration: &str,
        prompt: &[f64],
        bright_implant: bool,
    ) -> Result<OneClick, JsError> {
        let (width, height) = film.size();
        Ok(Self {
            film: film.shared(),
            camera: camera(calibration, width as u32, height as u32)?,
            polarity: if bright_implant {
                Polarity::BrightImplant
            } else {
                Polarity::DarkImplant
            },
            prompt: prompt_of(prompt)?,
            excluded: None,
            work: None,
            buffers: OneClickBuffers::default(),
        })
    }

    /// Leaves out the pixels inside an outline (columns and rows by turns): another component's.
    ///
    /// # Errors
    /// The core's sentence about the outline.
    pub fn avoid(&mut self, outline: &[f64]) -> Result<(), JsError> {
        let (width, height) = (self.camera.width(), self.camera.height());
        let pairs = outline.as_chunks().0.iter();
        let points: Vec<Point> = pairs
            .map(|&[column, row]| Point::new(column, row))
            .collect();
        let outline = Outline::new(&points, width, height).map_err(sentence)?;
        let mut words = vec![0; words_needed(width, height)];
        let mut mask = MaskMut::new(&mut words, width, height).map_err(sentence)?;
        mask.fill_outline(&outline);
        match &mut self.excluded {
            Some(all) => all
                .iter_mut()
                .zip(&words)
                .for_each(|(all, word)| *all |= word),
            None => self.excluded = Some(words),
        }
        Ok(())
    }

    /// Part of the work that is done, 0 to 1.
    #[wasm_bindgen(getter)]
    pub fn progress(&self) -> f64 {
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
            None | Some(Progress::Regions(_)) => "Looking for the implant's region",
            Some(Progress::Poses(_)) => "Bringing the model onto the edges",
            Some(Progress::Done) => "Done",
        };
        words.to_owned()
    }

    /// One step with a library and its model. Gives whether there is more to do.
    ///
    /// # Errors
    /// A sentence about why there is no outline.
    pub fn step(&mut self, matcher: &mut Matcher) -> Result<bool, JsError> {
        matcher.with_component(&self.camera, |component, workspace, refine| {
            let fresh = || Work::new(self.prompt, &self.camera, Some(component));
            let mut work = self.work.take().map_or_else(fresh, Ok).map_err(sentence)?;
            let mut memory = self
                .buffers
                .borrow(&work.needs(&self.camera), workspace, refine);
            let (camera, polarity, excluded) = (&self.camera, self.polarity, &self.excluded);
            let more = self.film.look(|frame| {
                with_mask(excluded.as_deref(), camera, |excluded| {
                    let observation = Observation {
                        frame,
                        camera,
                        polarity,
                        excluded,
                        film: None,
                    };
                    work.step(&observation, Some(component), &mut memory)
                        .map_err(sentence)
                })
            });
            self.work = Some(work);
            more
        })
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
            supports: Vec::new(),
            matched: None,
            sentence: "The region with the sharpest border round there; open the implant's model for an outline that knows its shape.".to_owned(),
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
        let answers = self.work.as_ref().map_or(&[][..], Work::answers);
        let strongest = answers.first().map_or(0.0, |best| best.score);
        let rivals = |answer: &&Answer| answer.score >= RIVAL_STRENGTH * strongest;
        let answers: Vec<Answer> = answers.iter().filter(rivals).copied().collect();
        let contenders: Vec<Contender> = answers.iter().map(contender).collect();
        let Some(chosen) = Chosen::among(&contenders, around) else {
            return Err(JsError::new("The first outline is not worked out yet"));
        };
        let mut answer = OneClickAnswer {
            outlines: Vec::new(),
            supports: Vec::new(),
            matched: None,
            sentence: String::new(),
        };
        let mut candidates = Vec::new();
        for place in offered(&answers, &chosen) {
            let one = &answers[place];
            let candidate = self.candidate(one, matcher)?;
            // The chosen one stays for its reason.
            let fits = !matches!(candidate.verdict, Some(Verdict::NoFit(_)));
            if !fits && !candidates.is_empty() {
                continue;
            }
            answer
                .outlines
                .push(matcher.outline_at(&one.refined.pose, &self.camera)?);
            answer.supports.push(one.support.fraction);
            candidates.push(candidate);
        }
        let share = answer.supports.first().copied().unwrap_or(0.0);
        answer.sentence = told(share, chosen.open().is_some());
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
                    film: None,
                };
                with(&mut work, &observation, &mut memory)
            })
        });
        self.work = Some(work);
        done
    }

    fn candidate(&self, answer: &Answer, matcher: &mut Matcher) -> Result<Candidate, JsError> {
        let (camera, polarity) = (&self.camera, self.polarity);
        let assessed = self.film.look(|frame| {
            with_mask(self.excluded.as_deref(), camera, |unknown| {
                let target = ImageTarget {
                    frame,
                    unknown,
                    polarity,
                    film: None,
                };
                matcher.assess_on(&answer.refined, CameraView::only(camera, target))
            })
        })?;
        let assessed = supported(assessed, answer.support.fraction);
        let pose = &answer.refined.pose;
        let (view, at_border) = matcher.view_of(pose)?;
        Ok(Candidate {
            pose: to_numbers(&EulerPose::from(*pose)),
            unmatched: None,
            drawn: None,
            residual_px: Some(answer.refined.residual_px),
            misfit: Some(misfit(answer)),
            verdict: Some(assessed.verdict()),
            deviations: assessed.deviations.as_ref().map(deviation_numbers),
            start: Some(to_numbers(&EulerPose::from(answer.start))),
            view,
            at_border,
            input: Vec::new(),
            library: Vec::new(),
        })
    }
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

    /// How sure a pose is that was refined on a film, and how well it fits.
    fn assess_on(&mut self, refined: &Refined, view: CameraView<'_>) -> Result<Assessed, JsError> {
        model_of(&mut self.model)?.assess(refined, view)
    }

    /// The model's silhouette at a pose as an outline: columns and rows by turns.
    fn outline_at(&mut self, pose: &Pose, camera: &Camera) -> Result<Vec<f64>, JsError> {
        let (width, height) = (camera.width(), camera.height());
        let model = model_of(&mut self.model)?;
        let drawn = model.drawn_at(pose, camera)?;
        outline_of(&Mask::new(drawn, width, height).map_err(sentence)?)
    }

    /// The library's view of a pose (rotations about x and y, degrees), and whether it lies at the border of the library
    /// or beyond.
    fn view_of(&mut self, pose: &Pose) -> Result<([f64; 2], bool), JsError> {
        let info = *self.library.borrow_dependent().info();
        let ray = pose.transform(&info.reference);
        let rotation = multiply(&transpose(&view_rotation(&ray)), &pose.rotation);
        let seen = EulerPose::from(Pose { rotation, ..*pose });
        let view = [seen.x_rot_deg, seen.y_rot_deg];
        let axes = [info.grid.x, info.grid.y];
        let inner = view.iter().zip(axes).all(|(&at, axis)| {
            let last = axis.at(axis.count.saturating_sub(1) as f64);
            axis.first < at && at < last
        });
        Ok((view, !inner && self.has_border()))
    }
}

/// Corners of a border that a silhouette may have.
const BORDER_CORNERS: usize = 16_384;

/// The outline of a mask's largest region with few points: columns and rows by turns.
fn outline_of(mask: &Mask<'_>) -> Result<Vec<f64>, JsError> {
    let (width, height) = (mask.width(), mask.height());
    let mut memory: [Vec<Word>; 2] = std::array::from_fn(|_| vec![0; words_needed(width, height)]);
    let [a, b] = &mut memory;
    let [mut rest, mut largest] = [
        MaskMut::new(a, width, height).map_err(sentence)?,
        MaskMut::new(b, width, height).map_err(sentence)?,
    ];
    largest_region(mask, &mut rest, &mut largest).map_err(sentence)?;
    let mut border = Box::<Contour<BORDER_CORNERS>>::default();
    follow_border(&largest.as_mask(), border.as_mut()).map_err(sentence)?;
    let points = simplified(&border, TOLERANCE)?;
    Ok(points.iter().flat_map(|p| [p.column, p.row]).collect())
}

/// Calls `with` with a mask of the camera's frame, where there is one.
fn with_mask<T>(
    words: Option<&[Word]>,
    camera: &Camera,
    with: impl FnOnce(Option<&Mask<'_>>) -> Result<T, JsError>,
) -> Result<T, JsError> {
    let mask = words.map(|words| Mask::new(words, camera.width(), camera.height()));
    let mask = mask.transpose().map_err(sentence)?;
    with(mask.as_ref())
}

fn contender(answer: &Answer) -> Contender {
    Contender {
        pose: answer.refined.pose,
        residual_px: misfit(answer),
    }
}

/// What else lies near an outline is no counterpart where only a little of its length lies on strong edges of the right
/// polarity.
fn supported(mut assessed: Assessed, part: f64) -> Assessed {
    if part < FAIR {
        assessed.fit.met = assessed.fit.met.min(part);
    }
    assessed
}

/// By what answers are compared, as the finder compares its candidates: it counts outline that lies on no edge.
fn misfit(answer: &Answer) -> f64 {
    (2.0 * answer.refined.loss).sqrt()
}

/// Numbers of the answers that are offered: the chosen one, the rival that is still open, and others that come near.
fn offered(answers: &[Answer], chosen: &Chosen) -> Vec<usize> {
    let misfit = |at: usize| misfit(&answers[at]);
    let least = (0..answers.len()).map(misfit).fold(f64::MAX, f64::min);
    let first = [chosen.index()].into_iter().chain(chosen.open());
    let near = (0..answers.len()).filter(|&at| misfit(at) <= RIVAL_WITHIN * least);
    let mut places: Vec<usize> = Vec::new();
    for place in first.chain(near) {
        if place < answers.len() && places.len() < OFFERED && !places.contains(&place) {
            places.push(place);
        }
    }
    places
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_prompt_is_a_click_or_a_box() {
        let click = prompt_of(&[3.0, 4.0]).ok();
        assert_eq!(click, Some(Prompt::Click(Point::new(3.0, 4.0))));
        let boxed = prompt_of(&[1.0, 2.0, 3.0, 4.0]).ok();
        let wanted = Prompt::Box(Point::new(1.0, 2.0), Point::new(3.0, 4.0));
        assert_eq!(boxed, Some(wanted));
    }
}
