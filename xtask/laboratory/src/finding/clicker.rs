//! One-click outlines, with the memory that the core wants lent.

use std::time::{Duration, Instant};

use anyhow::Result;
use fluoropose::camera::Camera;
use fluoropose::finder::{Component, FinderBuffers};
use fluoropose::image::frame::Grey;
use fluoropose::image::mask::Word;
use fluoropose::library::Library;
use fluoropose::mesh::Model;
use fluoropose::mesh::symmetry::{SymmetryPlane, symmetry_planes};
use fluoropose::refine::Polarity;
use fluoropose_tracing::one_click::{
    Answer, Observation, OneClick, OneClickError, OneClickMemory, OneClickNeeds, Prompt, Start,
};

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
    finder: FinderBuffers,
}

impl Buffers {
    fn lend(
        &mut self,
        needs: &OneClickNeeds,
        component: &Component<'_>,
        camera: &Camera,
    ) -> OneClickMemory<'_> {
        for pixels in [&mut self.grey, &mut self.reached, &mut self.distance] {
            pixels.resize(needs.pixels, 0);
        }
        self.marks.resize(needs.pixels, 0);
        self.links.resize(needs.links, 0);
        self.statistics.resize(needs.statistics, 0);
        self.words.resize(needs.words, 0);
        let kernels = fluoropose_kernels::fastest();
        let memory = self.finder.borrow(component, camera, kernels);
        OneClickMemory {
            grey: &mut self.grey,
            reached: &mut self.reached,
            distance: &mut self.distance,
            marks: &mut self.marks,
            links: &mut self.links,
            statistics: &mut self.statistics,
            words: &mut self.words,
            workspace: memory.workspace,
            refine: memory.refine,
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
            buffers: Buffers::default(),
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
        let mut memory = self
            .buffers
            .lend(&work.needs(&self.camera), &component, &self.camera);
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
