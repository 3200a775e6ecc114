//! One-click outlines, with the memory that the core wants lent.

use std::time::{Duration, Instant};

use anyhow::Result;
use fluoropose::camera::Camera;
use fluoropose::finder::{Candidate, Component, FindError, FinderBuffers, Goal, find};
use fluoropose::follow::{InJoint, JointPlaces, Limb, Places, Subject};
use fluoropose::image::grey::Grey;
use fluoropose::image::mask::Mask;
use fluoropose::image::silhouette::{OutlineOrigin, Silhouette};
use fluoropose::library::Library;
use fluoropose::math::Vector3;
use fluoropose::mesh::Model;
use fluoropose::mesh::symmetry::{SymmetryPlane, symmetry_planes};
use fluoropose::refine::{ImageTarget, Polarity, RefineOptions};
use fluoropose_tracing::PlacesBuffers;
use fluoropose_tracing::one_click::{
    Answer, Observation, OneClick, OneClickBuffers, OneClickError, Prompt, Start, candidates,
};
use fluoropose_tracing::whole_frame::{Discovery, WholeFrame};

/// What came of a prompt.
pub struct Clicked {
    /// First poses, best first.
    pub starts: Vec<Start>,
    /// Refined poses, best first; at least one.
    pub answers: Vec<Answer>,
    /// Those of them that are rivals, as the finder chooses among them and judges them.
    pub candidates: Vec<Candidate>,
    /// Wall time of all steps.
    pub took: Duration,
    /// Wall time of the longest step.
    pub longest: Duration,
}

/// The joint's other component in a frame into which somebody clicks.
pub struct Neighbour<'n> {
    /// Where its joint leaves the component that is clicked.
    pub joint: &'n InJoint,
    /// The component that is clicked, as its shape tells it.
    pub clicked: &'n Limb<'n>,
    /// What the other one covers, and its edges.
    pub covered: Mask<'n>,
}

/// A component and the camera that saw it, ready for prompts.
pub struct Clicker<'l> {
    library: Library<'l>,
    mesh: Model<'l>,
    planes: Vec<SymmetryPlane>,
    camera: Camera,
    own: OneClickBuffers,
    finder: FinderBuffers,
    farther: bool,
}

impl<'l> Clicker<'l> {
    /// Opens the bytes of a library of `mesh` for frames of `camera`.
    ///
    /// # Errors
    /// Those of [`Library::open`].
    pub fn open(bytes: &'l [u8], mesh: Model<'l>, camera: Camera) -> Result<Self> {
        let library = Library::open(bytes)?;
        Ok(Self {
            planes: symmetry_planes(mesh.mesh()).to_vec(),
            own: OneClickBuffers::default(),
            finder: FinderBuffers::default(),
            farther: false,
            library,
            mesh,
            camera,
        })
    }

    /// From now on what a click does not find is looked for farther away than the library serves ([`OneClick::or_farther`]).
    #[must_use]
    pub fn or_farther(mut self) -> Self {
        self.farther = true;
        self
    }

    /// The model's planes of near-symmetry.
    pub fn planes(&self) -> &[SymmetryPlane] {
        &self.planes
    }

    /// Outlines and poses for a prompt on a frame, in which the joint's other component may be known.
    ///
    /// # Errors
    /// Those of [`OneClick::new`] and [`OneClick::step`].
    pub fn click(
        &mut self,
        frame: &dyn Grey,
        prompt: Prompt,
        polarity: Polarity,
        neighbour: Option<&Neighbour<'_>>,
    ) -> Result<Clicked, OneClickError> {
        let begin = Instant::now();
        let observation = Observation {
            frame,
            camera: &self.camera,
            polarity,
            excluded: None,
            beside: neighbour.map(|other| &other.covered),
            film: None,
        };
        let component = Component {
            library: &self.library,
            model: &self.mesh,
            planes: &self.planes,
        };
        let mut work = OneClick::new(prompt, &self.camera, Some(&component))?;
        if self.farther {
            work = work.or_farther(&self.camera, &component);
        }
        if let Some(Neighbour { joint, clicked, .. }) = neighbour {
            work = work.in_joint(JointPlaces::new(frame, joint, clicked));
        }
        let kernels = fluoropose_kernels::fastest();
        let finder = self.finder.borrow(&component, &self.camera, kernels);
        let needs = work.needs(&self.camera);
        let mut memory = self.own.borrow(&needs, finder.workspace, finder.refine);
        let mut longest = Duration::ZERO;
        loop {
            let step = Instant::now();
            let more = work.step(&observation, Some(&component), &mut memory)?;
            longest = longest.max(step.elapsed());
            if !more {
                break;
            }
        }
        let took = begin.elapsed();
        let answers = work.answers();
        let rivals = candidates(answers, &observation, &self.mesh, &mut memory.refine)?;
        Ok(Clicked {
            candidates: rivals.to_vec(),
            starts: work.starts().to_vec(),
            answers: answers.to_vec(),
            took,
            longest,
        })
    }

    /// Poses that explain an outline which a tool laid on the edges of a frame.
    ///
    /// # Errors
    /// Those of [`find`].
    pub fn trace(&mut self, outline: &Mask<'_>) -> Result<Vec<Candidate>, FindError> {
        let component = Component {
            library: &self.library,
            model: &self.mesh,
            planes: &self.planes,
        };
        let kernels = fluoropose_kernels::fastest();
        let mut memory = self.finder.borrow(&component, &self.camera, kernels);
        let (camera, options) = (&self.camera, RefineOptions::default());
        let outline = Silhouette::from(outline).laid_by(OutlineOrigin::Tool);
        let goal = Goal::Outline;
        let found = find(&component, camera, &outline, goal, options, &mut memory)?;
        Ok(found.candidates.to_vec())
    }

    /// Looks for the component at places of a whole frame, or `beside` the middle of the joint's other one (mm, in the camera's frame). It takes
    /// seconds, so that `goes_on` hears the part that is done, 0 to 1, and may end it.
    ///
    /// # Errors
    /// Those of [`WholeFrame::step`] and of `goes_on`.
    pub fn search(
        &mut self,
        subject: &Subject<'_>,
        image: &ImageTarget<'_>,
        where_to: (Places, Option<Vector3>),
        mut goes_on: impl FnMut(f64) -> Result<()>,
    ) -> Result<Option<Discovery>> {
        let component = Component {
            library: &self.library,
            model: &self.mesh,
            planes: &self.planes,
        };
        let camera = &self.camera;
        let kernels = fluoropose_kernels::fastest();
        let mut places = PlacesBuffers::default();
        let mut room = places.borrow(camera, self.finder.workspace(&self.library, kernels));
        let mut search = WholeFrame::new(image, &component, camera, where_to, &mut room)?;
        while let Some(needs) = search.needs() {
            goes_on(search.progress())?;
            let finder = self.finder.borrow(&component, camera, kernels);
            let mut memory = self.own.borrow(&needs, finder.workspace, finder.refine);
            search.step(subject, image, &component, &mut memory, places.written())?;
        }
        Ok(search.found().copied())
    }
}
