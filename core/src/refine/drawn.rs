//! Where the film's model puts the edge of the model as drawn: what a frame's edge is compared with.

use super::border::{BorderPixel, NormalReading};
use super::error::RefineError;
use super::stages::Stage;
use super::view::CameraView;
use crate::film::edge::EdgeFilter;
use crate::film::lines::measure_by;
use crate::film::{LineMemory, PathLine};
use crate::memory::first;
use crate::mesh::Model;
use crate::pose::Pose;
use crate::render::{Projected, VERTICES, project};

/// Lines across the outline, one for each sample; none where edges are taken to lie on the outline.
#[derive(Clone, Copy)]
pub(super) struct DrawnEdges<'l> {
    filter: Option<EdgeFilter>,
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
        (scratch, all): (&mut [Projected], bool),
        memory: &'l mut LineMemory<'_>,
    ) -> Result<Self, RefineError> {
        let film = view.target.film().filter(|_| stage.drawn);
        let filter = film.map(EdgeFilter::from);
        let Some(first_place) = filter.as_ref().map(EdgeFilter::first) else {
            return Ok(Self { filter, lines: &[] });
        };
        let lines = first("lines across the outline", border.len(), memory.lines)?;
        for (line, sample) in lines.iter_mut().zip(&mut *border) {
            // It stands for those that are left out.
            sample.weight *= stage.every.unwrap_or(1) as f32;
            let across = PathLine::at(sample.place(), sample.normal().map(f64::from));
            *line = across.starting_at(first_place);
        }
        let images = match all {
            true => first(VERTICES, model.vertices().len(), scratch)?,
            false => project(model.mesh(), view.camera, pose, scratch)?,
        };
        let seen = (model, view.camera, pose);
        measure_by(images, seen, lines, memory.heads, memory.groups)?;
        for (line, sample) in lines.iter().zip(border) {
            if let Some(depths) = line.depths() {
                depths
                    .into_iter()
                    .for_each(|depth| sample.cover(depth as f32));
            }
        }
        Ok(Self { filter, lines })
    }

    /// Where the edge of a sample is to be expected, `own` being where the outline itself is.
    pub(super) fn at(&self, number: usize, own: f64) -> NormalReading {
        match &self.filter {
            None => NormalReading::At(own),
            Some(filter) => {
                let line = self.lines.get(number);
                filter.edge(line.and_then(PathLine::paths), own)
            }
        }
    }
}
