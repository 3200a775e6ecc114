//! One-click outlines, with the memory that the core wants lent.

use std::time::{Duration, Instant};

use anyhow::Result;
use fluoropose::camera::Camera;
use fluoropose::image::frame::Grey;
use fluoropose::image::mask::{Word, words_needed};
use fluoropose::library::Library;
use fluoropose::locate::{Workspace, workspace_needed};
use fluoropose::mesh::Model;
use fluoropose::mesh::symmetry::{SymmetryPlane, symmetry_planes};
use fluoropose::refine::{BorderPixel, Polarity, RefineMemory};
use fluoropose::render::{Projected, scratch_needed};
use fluoropose_tracing::one_click::{
    Answer, Component, Observation, OneClick, OneClickError, OneClickMemory, OneClickNeeds, Prompt,
    Start,
};

/// Border pixels that are lent.
const BORDER: usize = 16_384;

/// What came of a prompt.
pub struct Clicked {
    /// First poses, best first.
    pub starts: Vec<Start>,
    /// Refined poses, best first; at least one.
    pub answers: Vec<Answer>,
    /// Wall time of all steps.
    pub took: Duration,
    /// Wall time of the longest step.
    pub longest: Duration,
}

/// A component and the camera that saw it, ready for prompts.
pub struct Clicker<'l> {
    library: Library<'l>,
    mesh: Model<'l>,
    planes: Vec<SymmetryPlane>,
    camera: Camera,
    buffers: Buffers,
}

#[derive(Default)]
struct Buffers {
    grey: Vec<u16>,
    reached: Vec<u16>,
    distance: Vec<u16>,
    marks: Vec<u8>,
    links: Vec<u32>,
    statistics: Vec<u32>,
    words: Vec<Word>,
    canonical: Vec<Word>,
    turned: Vec<Word>,
    scores: Vec<u32>,
    bytes: Vec<u8>,
    projected: Vec<Projected>,
    drawn: Vec<Word>,
    places: Vec<u16>,
    border: Vec<BorderPixel>,
}

impl Buffers {
    fn new(library: &Library<'_>, mesh: &Model<'_>, camera: &Camera) -> Self {
        let needs = workspace_needed(library);
        Self {
            canonical: vec![0; needs.words],
            turned: vec![0; needs.words],
            scores: vec![0; needs.scores],
            bytes: vec![0; needs.bytes],
            projected: vec![Projected::default(); scratch_needed(mesh)],
            drawn: vec![0; words_needed(camera.width(), camera.height())],
            places: vec![0; camera.width() * camera.height()],
            border: vec![BorderPixel::default(); BORDER],
            ..Self::default()
        }
    }

    fn lend(&mut self, needs: &OneClickNeeds) -> OneClickMemory<'_> {
        for pixels in [&mut self.grey, &mut self.reached, &mut self.distance] {
            pixels.resize(needs.pixels, 0);
        }
        self.marks.resize(needs.pixels, 0);
        self.links.resize(needs.links, 0);
        self.statistics.resize(needs.statistics, 0);
        self.words.resize(needs.words, 0);
        OneClickMemory {
            grey: &mut self.grey,
            reached: &mut self.reached,
            distance: &mut self.distance,
            marks: &mut self.marks,
            links: &mut self.links,
            statistics: &mut self.statistics,
            words: &mut self.words,
            workspace: Workspace {
                canonical: &mut self.canonical,
                rotated: &mut self.turned,
                scores: &mut self.scores,
                bytes: &mut self.bytes,
                kernels: fluoropose_kernels::fastest(),
            },
            refine: RefineMemory {
                projected: &mut self.projected,
                drawn: &mut self.drawn,
                places: &mut self.places,
                border: &mut self.border,
            },
        }
    }
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
            buffers: Buffers::new(&library, &mesh, &camera),
            library,
            mesh,
            camera,
        })
    }

    /// The model's planes of near-symmetry.
    pub fn planes(&self) -> &[SymmetryPlane] {
        &self.planes
    }

    /// Outlines and poses for a prompt on a frame.
    ///
    /// # Errors
    /// Those of [`OneClick::new`] and [`OneClick::step`].
    pub fn click(
        &mut self,
        frame: &dyn Grey,
        prompt: Prompt,
        polarity: Polarity,
    ) -> Result<Clicked, OneClickError> {
        let begin = Instant::now();
        let observation = Observation {
            frame,
            camera: &self.camera,
            polarity,
            excluded: None,
        };
        let component = Component {
            library: &self.library,
            model: &self.mesh,
            planes: &self.planes,
        };
        let mut work = OneClick::new(prompt, &self.camera, Some(&component))?;
        let mut memory = self.buffers.lend(&work.needs(&self.camera));
        let mut longest = Duration::ZERO;
        loop {
            let step = Instant::now();
            let more = work.step(&observation, Some(&component), &mut memory)?;
            longest = longest.max(step.elapsed());
            if !more {
                break;
            }
        }
        Ok(Clicked {
            starts: work.starts().to_vec(),
            answers: work.answers().to_vec(),
            took: begin.elapsed(),
            longest,
        })
    }
}
