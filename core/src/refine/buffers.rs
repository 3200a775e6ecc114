//! Working memory of refinement that grows with what needs it, for callers that have an allocator.

use alloc::vec::Vec;

use super::border::BorderPixel;
use super::memory::RefineMemory;
use super::places::places_needed;
use super::view::CameraView;
use crate::camera::Camera;
use crate::film::lines::{LineGroup, groups_needed, heads_needed};
use crate::film::{LineMemory, PathLine};
use crate::image::mask::{Word, words_needed};
use crate::memory::grow;
use crate::mesh::Model;
use crate::render::{Projected, scratch_needed};

/// Border pixels there is room for: the outline of an implant in a large frame has some thousands.
const BORDER: usize = 16_384;
/// Lines across an outline there is room for.
const LINES: usize = 2048;

/// Owns what a [`RefineMemory`] borrows.
#[derive(Clone, Debug, Default)]
pub struct RefineBuffers {
    projected: Vec<Projected>,
    drawn: Vec<Word>,
    places: Vec<u16>,
    border: Vec<BorderPixel>,
    lines: Vec<PathLine>,
    heads: Vec<u16>,
    groups: Vec<LineGroup>,
}

impl RefineBuffers {
    /// Memory for a model and one camera. It never shrinks.
    pub fn borrow(&mut self, model: &Model<'_>, camera: &Camera) -> RefineMemory<'_> {
        self.make_room(model, camera);
        self.all()
    }

    /// Memory for a model and the cameras of several views. It never shrinks.
    pub fn borrow_for(&mut self, model: &Model<'_>, views: &[CameraView<'_>]) -> RefineMemory<'_> {
        for view in views {
            self.make_room(model, view.camera);
        }
        self.all()
    }

    fn make_room(&mut self, model: &Model<'_>, camera: &Camera) {
        let (width, height) = (camera.width(), camera.height());
        grow(&mut self.projected, scratch_needed(model));
        grow(&mut self.drawn, words_needed(width, height));
        grow(&mut self.places, places_needed(height));
        grow(&mut self.border, BORDER);
        grow(&mut self.lines, LINES);
        grow(&mut self.heads, heads_needed());
        grow(&mut self.groups, groups_needed(LINES));
    }

    fn all(&mut self) -> RefineMemory<'_> {
        RefineMemory {
            projected: &mut self.projected,
            drawn: &mut self.drawn,
            places: &mut self.places,
            border: &mut self.border,
            film: LineMemory {
                lines: &mut self.lines,
                heads: &mut self.heads,
                groups: &mut self.groups,
            },
        }
    }
}
