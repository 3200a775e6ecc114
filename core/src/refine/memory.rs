//! Working memory of refinement.

use super::border::BorderPixel;
use super::error::RefineError;
use super::places::places_needed;
use crate::camera::Camera;
use crate::film::LineMemory;
use crate::image::mask::{Word, words_needed};
use crate::memory::check_length;
use crate::render::Projected;

/// Working memory of [`super::refine()`], for the largest of its views.
#[derive(Debug)]
pub struct RefineMemory<'a> {
    /// [`crate::render::scratch_needed`] vertices, or [`crate::render::scratch_for`].
    pub projected: &'a mut [Projected],
    /// [`crate::image::mask::words_needed`] words of the frame's size: the model as drawn.
    pub drawn: &'a mut [Word],
    /// [`places_needed`] numbers of the frame's rows: which samples of the outline are in each.
    pub places: &'a mut [u16],
    /// Samples of the outline, one for each border pixel of the drawing; some 4000 serve an implant in a frame of
    /// 1024 x 1024 pixels. An outline that is longer at any pose on the way is refused: a part of it would not say where
    /// the model is. No more than 65 535 are used.
    pub border: &'a mut [BorderPixel],
    /// For targets with a film model: one line for each [`FILM_EVERY`] border pixels, or for every third, by which poses are
    /// corrected where there is room for as many, with
    /// [`crate::film::lines::heads_needed`] heads of lists and
    /// [`crate::film::lines::groups_needed`] groups of lines.
    pub film: LineMemory<'a>,
}

/// One of this many border pixels is compared with what is drawn: frames are averaged over five pixels along an outline.
pub const FILM_EVERY: usize = 5;

pub(super) fn check_memory(camera: &Camera, memory: &RefineMemory<'_>) -> Result<(), RefineError> {
    let (width, height) = (camera.width(), camera.height());
    check_length("words", words_needed(width, height), memory.drawn.len())?;
    check_length("places", places_needed(height), memory.places.len())?;
    Ok(())
}
