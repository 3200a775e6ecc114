//! Working memory of the search for places that grows with what needs it, for callers that have an allocator.

use alloc::vec::Vec;

use fluoropose::camera::Camera;
use fluoropose::image::mask::{Word, words_needed};
use fluoropose::locate::Workspace;
use fluoropose::memory::grow;

use crate::reduced::{ReducedMemory, ReducedPixels, reduced_needed};
use crate::seeds::seeds_needed;
use crate::shapes::{ShapeMemory, shapes_needed};
use crate::whole_frame::{PlacesMemory, Written};

/// Owns what a [`PlacesMemory`] borrows of its own; what it shares with the finder comes from there.
#[derive(Clone, Debug, Default)]
pub struct PlacesBuffers {
    sums: Vec<f64>,
    levels: Vec<u16>,
    depths: Vec<u16>,
    numbers: Vec<u32>,
    words: Vec<Word>,
    reduced: Vec<u16>,
    unknown: Vec<Word>,
    surround: Vec<Word>,
}

impl PlacesBuffers {
    /// Memory for frames of a camera, with that of a finder. It never shrinks.
    pub fn borrow<'m>(&'m mut self, camera: &Camera, workspace: Workspace<'m>) -> PlacesMemory<'m> {
        let needs = shapes_needed(camera);
        grow(&mut self.sums, seeds_needed(camera));
        grow(&mut self.levels, needs.cells);
        grow(&mut self.depths, needs.cells);
        grow(&mut self.numbers, needs.numbers);
        grow(&mut self.words, needs.words);
        let needs = reduced_needed(camera);
        grow(&mut self.reduced, needs.pixels);
        grow(&mut self.unknown, needs.words);
        grow(
            &mut self.surround,
            words_needed(camera.width(), camera.height()),
        );
        PlacesMemory {
            sums: &mut self.sums,
            shapes: ShapeMemory {
                levels: &mut self.levels,
                depths: &mut self.depths,
                numbers: &mut self.numbers,
                words: &mut self.words,
                workspace,
            },
            reduced: ReducedMemory {
                pixels: &mut self.reduced,
                unknown: &mut self.unknown,
            },
            surround: &mut self.surround,
        }
    }

    /// What [`crate::whole_frame::WholeFrame::new`] wrote for its steps.
    #[must_use]
    pub fn written(&self) -> Written<'_> {
        Written {
            reduced: ReducedPixels {
                pixels: &self.reduced,
                unknown: &self.unknown,
            },
            surround: &self.surround,
        }
    }
}
