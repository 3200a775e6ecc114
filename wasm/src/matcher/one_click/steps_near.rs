//! The steps of looking near a click.

use fluoropose::locate::Workspace;
use fluoropose::refine::{ImageTarget, RefineMemory};
use fluoropose_tracing::one_click::{OneClick as Work, Prompt};
use wasm_bindgen::JsError;

use super::super::Matcher;
use super::super::from_here::model_of;
use super::super::on_frame::OnFrame;
use super::OneClick;
use super::near::{Clicked, Near};
use super::offered::possible;
use crate::hidden::with_mask;
use crate::squares::of_pixels;

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
            middle.is_none_or(|middle| self.calibration.may_be_at(pose, &middle))
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
