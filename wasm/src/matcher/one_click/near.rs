//! A click whose regions lead to nothing that convinces: there and at places near it once more, in the frame from afar.

use fluoropose::camera::Camera;
use fluoropose::finder::Component;
use fluoropose::follow::{FramePose, From, Subject, leads_by_itself, refined_on_frame};
use fluoropose::image::contour::Point;
use fluoropose::locate::Workspace;
use fluoropose::pose::Pose;
use fluoropose::refine::{ImageTarget, RefineMemory};
use fluoropose_tracing::PlacesBuffers;
use fluoropose_tracing::one_click::{Answer, OneClickBuffers};
use fluoropose_tracing::whole_frame::WholeFrame;
use wasm_bindgen::JsError;

use crate::held::holds;
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
        let place = [clicked.place.column, clicked.place.row];
        match found {
            Some(found) if holds(clicked.component.model, clicked.camera, &found.pose, place)? => {
                Ok(Some(found.pose))
            }
            _ => Ok(None),
        }
    }
}
