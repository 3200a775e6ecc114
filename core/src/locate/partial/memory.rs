//! Working memory of the search for a first pose from a part of an outline.

use super::field::FIELD_CELLS;
use super::hypothesis::Hypothesis;
use super::outline::OutlinePoint;
use super::scale_levels::LEVEL_NUMBERS;
use super::search::{PER_VIEW, VIEW_NUMBERS, VIEW_SAMPLES, coarse_views};
use super::trace::PixelSide;
use crate::camera::Camera;
use crate::image::mask::{Word, words_needed};
use crate::library::Library;
use crate::memory::{TooLittleMemory, check_length};
use crate::mesh::Model;
use crate::render::{Projected, scratch_needed};

/// Working memory of [`super::locate_partial`]: each slice at least as long as [`partial_needed`] says; by default none, for
/// whoever looks for no pieces of outlines.
#[derive(Debug, Default)]
pub struct PartialMemory<'a> {
    /// Masks of the frame's size and of the canonical frame's.
    pub words: &'a mut [Word],
    /// Sides of pixels along an outline.
    pub sides: &'a mut [PixelSide],
    /// Points along the known outline and that of a view.
    pub points: &'a mut [OutlinePoint],
    /// The nearest point of the known outline, place by place.
    pub cells: &'a mut [u16],
    /// Samples of outlines.
    pub numbers: &'a mut [f32],
    /// What the coarse search proposes.
    pub hypotheses: &'a mut [Hypothesis],
    /// Vertices of the model.
    pub projected: &'a mut [Projected],
}

/// Lengths of a [`PartialMemory`]'s slices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PartialNeeds {
    /// Of `words`.
    pub words: usize,
    /// Of `sides`.
    pub sides: usize,
    /// Of `points`.
    pub points: usize,
    /// Of `cells`.
    pub cells: usize,
    /// Of `numbers`.
    pub numbers: usize,
    /// Of `hypotheses`.
    pub hypotheses: usize,
    /// Of `projected`.
    pub projected: usize,
}

/// Most points of the known outline: some ten outlines of an implant.
pub(super) const KNOWN_POINTS: usize = 4096;
/// Sides for each column and row of a frame, and for those of a canonical frame.
const SIDES_PER_LINE: usize = 8;

/// How much working memory a library, a camera and a model take: for 1271 views, a frame of
/// 1024 x 1024 pixels and 6000 vertices some 600 KB.
#[must_use]
pub fn partial_needed(library: &Library<'_>, camera: &Camera, model: &Model<'_>) -> PartialNeeds {
    let size = library.info().canonical.size();
    let lines = (camera.width() + camera.height()).max(2 * size);
    PartialNeeds {
        words: words_needed(camera.width(), camera.height()) + 2 * words_needed(size, size),
        sides: SIDES_PER_LINE * lines,
        points: KNOWN_POINTS + VIEW_SAMPLES,
        cells: FIELD_CELLS,
        numbers: LEVEL_NUMBERS + VIEW_NUMBERS,
        hypotheses: PER_VIEW * coarse_views(library),
        projected: scratch_needed(model),
    }
}

impl PartialMemory<'_> {
    /// The same memory, borrowed for a shorter time.
    pub fn reborrow(&mut self) -> PartialMemory<'_> {
        PartialMemory {
            words: self.words,
            sides: self.sides,
            points: self.points,
            cells: self.cells,
            numbers: self.numbers,
            hypotheses: self.hypotheses,
            projected: self.projected,
        }
    }

    /// # Errors
    /// [`TooLittleMemory`] names the first slice that is too short.
    pub(super) fn check(&self, needs: &PartialNeeds) -> Result<(), TooLittleMemory> {
        let lengths = [
            ("words", needs.words, self.words.len()),
            ("sides", needs.sides, self.sides.len()),
            ("points", needs.points, self.points.len()),
            ("cells", needs.cells, self.cells.len()),
            ("numbers", needs.numbers, self.numbers.len()),
            ("hypotheses", needs.hypotheses, self.hypotheses.len()),
            ("projected vertices", needs.projected, self.projected.len()),
        ];
        for (what, needed, given) in lengths {
            check_length(what, needed, given)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::canonical::CanonicalSpec;
    use crate::library::fake::plain_library;

    /// By hand: of hypotheses too few would be lost without a word.
    #[test]
    fn each_length_is_what_frame_library_and_model_take() {
        let spec = CanonicalSpec::new(64, 900).expect("possible");
        let views = std::vec![std::vec![1; spec.words_needed()]; 54];
        let bytes = plain_library(&views, 9, spec);
        let library = Library::open(&bytes).expect("valid");
        let vertices = [
            [0.0; 3],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
            [2.0; 3],
        ];
        let model = Model::from_triangles(&vertices, &[[0, 1, 2]]).expect("valid");
        for (width, height, lines) in [(320, 240, 560), (33, 20, 128)] {
            let camera = Camera::new(width, height, [500.0; 2], [9.0; 2]).expect("valid");
            let needs = partial_needed(&library, &camera, &model);
            let expected = PartialNeeds {
                // Rows of whole words, and two canonical frames.
                words: width.div_ceil(32) * height + 2 * (2 * 64),
                sides: 8 * lines,
                points: 4096 + 512,
                cells: FIELD_CELLS,
                // Columns and rows of 512 samples at 24 scales; of a view those twice, and two sums.
                numbers: 2 * 512 * 24 + 6 * 512,
                // Three of each view: of nine columns and six rows a degree apart, every fourth.
                hypotheses: 3 * (3 * 2),
                projected: 5,
            };
            assert_eq!(needs, expected);
        }
    }
}
