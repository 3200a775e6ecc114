//! A click whose regions lead to nothing that convinces: there and at places near it once more, in the frame from afar.

use fluoropose::camera::Camera;
use fluoropose::finder::Component;
use fluoropose::follow::{
    FramePose, From, Subject, holds_place, leads_by_itself, refined_on_frame,
};
use fluoropose::image::contour::Point;
use fluoropose::image::mask::{MaskMut, words_needed};
use fluoropose::locate::Workspace;
use fluoropose::pose::Pose;
use fluoropose::refine::{ImageTarget, RefineMemory};
use fluoropose::render::{Projected, render, scratch_needed};
use fluoropose_tracing::PlacesBuffers;
use fluoropose_tracing::one_click::{Answer, OneClickBuffers, Prompt};
use fluoropose_tracing::whole_frame::WholeFrame;
use wasm_bindgen::JsError;

use super::super::Matcher;
use super::super::from_here::model_of;
use super::super::on_frame::OnFrame;
use super::offered::possible;
use super::{OneClick, Work};
use crate::hidden::with_mask;
use crate::squares::of_pixels;

use fluoropose_page::error::sentence;

/// Of the answers to a click so many are refined once more and compared.
const ANSWERS: usize = 4;

/// What a click leads to beside its regions.
#[derive(Default)]
pub(super) enum Near {
    /// Nobody has asked.
    #[default]
    Unasked,
    Searched(Box<Search>),
    /// Its regions tell it, or nothing near it does.
    Over,
}

pub(super) struct Search {
    search: WholeFrame,
    places: PlacesBuffers,
}

/// A frame in which somebody clicked.
pub(super) struct Clicked<'c> {
    pub(super) image: ImageTarget<'c>,
    pub(super) component: &'c Component<'c>,
    pub(super) camera: &'c Camera,
    pub(super) place: Point,
}

impl Clicked<'_> {
    fn subject(&self) -> Subject<'_> {
        Subject::new(self.component.model, self.component.planes, self.camera)
    }

    /// Whether one of the answers of its regions leads by itself.
    fn convinces(&self, answers: &[&Answer], memory: &mut RefineMemory<'_>) -> bool {
        answers.iter().take(ANSWERS).any(|answer| {
            let start = (&answer.refined.pose, From::Far);
            let found = refined_on_frame(&self.subject(), &self.image, start, memory);
            found.is_ok_and(|found| leads_by_itself(&found))
        })
    }

    /// Whether what is drawn at a pose holds the place.
    fn holds(&self, pose: &Pose) -> Result<bool, JsError> {
        let (width, height) = (self.camera.width(), self.camera.height());
        let model = self.component.model;
        let mut words = vec![0; words_needed(width, height)];
        let mut projected = vec![Projected::default(); scratch_needed(model)];
        let mut mask = MaskMut::new(&mut words, width, height).map_err(sentence)?;
        render(model, self.camera, pose, &mut projected, &mut mask).map_err(sentence)?;
        let place = [self.place.column, self.place.row];
        Ok(holds_place(&mask.as_mask(), place))
    }
}

impl Near {
    /// Begins where no answer of its regions convinces.
    ///
    /// # Errors
    /// The core's sentence about memory.
    pub(super) fn begun(
        clicked: &Clicked<'_>,
        answers: &[&Answer],
        (workspace, mut refine): (Workspace<'_>, RefineMemory<'_>),
    ) -> Result<Self, JsError> {
        if clicked.convinces(answers, &mut refine) {
            return Ok(Self::Over);
        }
        let mut places = PlacesBuffers::default();
        let (image, component, camera) = (&clicked.image, clicked.component, clicked.camera);
        let mut memory = places.borrow(camera, workspace);
        let search = WholeFrame::near(image, component, camera, clicked.place, &mut memory);
        Ok(Self::Searched(Box::new(Search {
            search: search.map_err(sentence)?,
            places,
        })))
    }

    /// The part of it that is done, 0 to 1; nothing while it is not searched.
    pub(super) fn progress(&self) -> Option<f64> {
        match self {
            Self::Searched(near) => Some(near.search.progress()),
            _ => None,
        }
    }
}

impl Search {
    /// The next part of it. Returns whether there is more to do.
    ///
    /// # Errors
    /// The core's sentence about memory.
    pub(super) fn step(
        &mut self,
        clicked: &Clicked<'_>,
        buffers: &mut OneClickBuffers,
        (workspace, refine): (Workspace<'_>, RefineMemory<'_>),
    ) -> Result<bool, JsError> {
        let Some(needs) = self.search.needs() else {
            return Ok(false);
        };
        let mut memory = buffers.borrow(&needs, workspace, refine);
        let (subject, written) = (clicked.subject(), self.places.written());
        let step = self.search.step(
            &subject,
            &clicked.image,
            clicked.component,
            &mut memory,
            written,
        );
        step.map_err(sentence)
    }

    /// What it led to, where that holds the place.
    ///
    /// # Errors
    /// The core's sentence where it cannot be drawn.
    pub(super) fn found(&self, clicked: &Clicked<'_>) -> Result<Option<Pose>, JsError> {
        let found: Option<&FramePose> = self.search.found().map(|found| &found.pose);
        match found {
            Some(found) if clicked.holds(&found.pose)? => Ok(Some(found.pose)),
            _ => Ok(None),
        }
    }
}

impl OneClick {
    /// Begins to look near the click, once its regions are done. Returns whether there is more to do.
    pub(super) fn begin_near(&mut self, matcher: &mut Matcher) -> Result<bool, JsError> {
        let all = self.work.as_ref().map_or(&[][..], Work::answers);
        let all = if self.vain.is_some() { &[] } else { all };
        let middle = model_of(&mut matcher.model)?.model().bounds().centre;
        let answers = possible(all, &self.calibration, &middle);
        let near = self.clicked(matcher, |clicked, memory| {
            Near::begun(clicked, &answers, memory)
        });
        self.near = near.unwrap_or(Ok(Near::Over))?;
        match self.near {
            Near::Searched(_) => Ok(true),
            _ => self.end_near(None),
        }
    }

    pub(super) fn step_near(&mut self, matcher: &mut Matcher) -> Result<bool, JsError> {
        let Near::Searched(mut near) = core::mem::take(&mut self.near) else {
            return Ok(false);
        };
        let mut buffers = core::mem::take(&mut self.buffers);
        let more = self.clicked(matcher, |clicked, memory| {
            near.step(clicked, &mut buffers, memory)
        });
        self.buffers = buffers;
        if more.unwrap_or(Ok(false))? {
            self.near = Near::Searched(near);
            return Ok(true);
        }
        let found = self.clicked(matcher, |clicked, _| near.found(clicked));
        let found = found.unwrap_or(Ok(None))?;
        let found = found.filter(|pose| {
            let middle = matcher
                .model
                .as_ref()
                .map(|model| model.model().bounds().centre);
            middle.is_none_or(|middle| self.calibration.may_hold(-pose.transform(&middle)[2]))
        });
        let given = found.map(|pose| matcher.given_pose(&pose, &self.seen()));
        self.end_near(given.transpose()?)
    }

    /// Calls `with` with the click and the memory to look near it; nothing where a box was drawn.
    fn clicked<T>(
        &self,
        matcher: &mut Matcher,
        with: impl FnOnce(&Clicked<'_>, (Workspace<'_>, RefineMemory<'_>)) -> Result<T, JsError>,
    ) -> Option<Result<T, JsError>> {
        let Prompt::Click(place) = self.prompt else {
            return None;
        };
        let (camera, polarity, film) = (&self.camera, self.polarity, of_pixels(self.known));
        let hidden = self.beside.as_ref().map(|beside| &*beside.hidden);
        Some(
            matcher.with_component(camera, |component, workspace, refine| {
                self.film.look(|frame| {
                    with_mask(hidden, camera, |unknown| {
                        let image = ImageTarget {
                            frame,
                            unknown,
                            polarity,
                            film,
                        };
                        let clicked = Clicked {
                            image,
                            component,
                            camera,
                            place,
                        };
                        with(&clicked, (workspace, refine))
                    })
                })
            }),
        )
    }

    /// Takes what was found near the click. Without it the answers of its regions are what there is, or the error.
    fn end_near(&mut self, given: Option<Vec<OnFrame>>) -> Result<bool, JsError> {
        self.near = Near::Over;
        match (given, self.vain.take()) {
            (Some(given), _) => self.given = given,
            (None, Some(vain)) => return Err(JsError::new(&vain)),
            (None, None) => {}
        }
        Ok(false)
    }
}
