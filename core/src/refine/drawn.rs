//! Where the film's model puts the edge of the model as drawn: what a frame's edge is compared with.

use super::border::{BorderPixel, NormalReading};
use super::error::RefineError;
use super::memory::FILM_EVERY;
use super::stages::Stage;
use super::view::CameraView;
use crate::film::lines::measure;
use crate::film::{FilmModel, LineMemory, PathLine};
use crate::memory::first;
use crate::mesh::Model;
use crate::pose::Pose;
use crate::render::Projected;

/// Lines across the outline, one for each sample; none where edges are taken to lie on the outline.
#[derive(Clone, Copy)]
pub(super) struct DrawnEdges<'l> {
    film: Option<FilmModel>,
    lines: &'l [PathLine],
}

impl<'l> DrawnEdges<'l> {
    /// Measures the paths through the model at the samples of its outline, where a stage asks for them.
    ///
    /// # Errors
    /// [`RefineError::Memory`] where there are more samples than lines.
    pub(super) fn of(
        model: &Model<'_>,
        pose: &Pose,
        view: &CameraView<'_>,
        stage: &Stage,
        border: &mut [BorderPixel],
        scratch: &mut [Projected],
        memory: &'l mut LineMemory<'_>,
    ) -> Result<Self, RefineError> {
        let film = view.target.film().filter(|_| stage.drawn).copied();
        if film.is_none() {
            return Ok(Self { film, lines: &[] });
        }
        let lines = first("lines across the outline", border.len(), memory.lines)?;
        for (line, sample) in lines.iter_mut().zip(&mut *border) {
            // It stands for those that are left out.
            sample.weight *= if stage.whole { 1.0 } else { FILM_EVERY as f32 };
            *line = PathLine::at(sample.place(), sample.normal.map(f64::from));
        }
        measure(model, view.camera, pose, scratch, lines, memory.heads)?;
        Ok(Self { film, lines })
    }

    /// Where the edge of a sample is to be expected, `own` being where the outline itself is.
    pub(super) fn at(&self, number: usize, own: f64) -> NormalReading {
        match self.film {
            None => NormalReading::At(own),
            Some(film) => {
                let line = self.lines.get(number);
                film.edge(line.and_then(PathLine::paths), own)
            }
        }
    }
}
