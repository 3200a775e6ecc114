//! Working memory.

use super::flooding::links_needed;
use super::statistics::STATISTICS;
use fluoropose::camera::Camera;
use fluoropose::film::LineMemory;
use fluoropose::image::mask::{Word, words_needed};
use fluoropose::locate::Workspace;
use fluoropose::memory::{TooLittleMemory, first};
use fluoropose::refine::RefineMemory;

/// Masks of the frame's size: the region, and what is in doubt of it.
const MASKS: usize = 2;

/// Working memory of [`super::OneClick::step`], the same from the first step to the last. Each of its own slices is at least
/// as long as [`super::OneClick::needs`] says.
#[derive(Debug)]
pub struct OneClickMemory<'a> {
    /// Grey levels of the window's pixels.
    pub grey: &'a mut [u16],
    /// For each pixel the least threshold that connects it with the seed.
    pub reached: &'a mut [u16],
    /// A distance for each pixel.
    pub distance: &'a mut [u16],
    /// Flags of each pixel.
    pub marks: &'a mut [u8],
    /// Lists of pixels.
    pub links: &'a mut [u32],
    /// Threshold statistics.
    pub statistics: &'a mut [u32],
    /// Two masks of the frame.
    pub words: &'a mut [Word],
    /// As for [`fluoropose::locate::locate`]; empty without a component.
    pub workspace: Workspace<'a>,
    /// As for [`fluoropose::refine::refine`]; unused without a component.
    pub refine: RefineMemory<'a>,
}

/// Lengths of the own slices of a [`OneClickMemory`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OneClickNeeds {
    /// Of `grey`, `reached`, `distance` and `marks` each.
    pub pixels: usize,
    /// Of `links`.
    pub links: usize,
    /// Of `statistics`.
    pub statistics: usize,
    /// Of `words`.
    pub words: usize,
}

impl OneClickNeeds {
    /// For a window of so many pixels in frames of a camera.
    pub(super) fn of(pixels: usize, camera: &Camera) -> Self {
        Self {
            pixels,
            links: links_needed(pixels),
            statistics: STATISTICS,
            words: MASKS * words_needed(camera.width(), camera.height()),
        }
    }
}

impl OneClickMemory<'_> {
    /// The first part of the same memory, with exactly the lengths that are needed.
    pub(super) fn borrow(
        &mut self,
        needs: &OneClickNeeds,
    ) -> Result<OneClickMemory<'_>, TooLittleMemory> {
        Ok(OneClickMemory {
            grey: first("grey values", needs.pixels, self.grey)?,
            reached: first("thresholds", needs.pixels, self.reached)?,
            distance: first("distances", needs.pixels, self.distance)?,
            marks: first("marks", needs.pixels, self.marks)?,
            links: first("links", needs.links, self.links)?,
            statistics: first("statistics", needs.statistics, self.statistics)?,
            words: first("words", needs.words, self.words)?,
            workspace: self.workspace.reborrow(),
            refine: RefineMemory {
                projected: &mut *self.refine.projected,
                drawn: &mut *self.refine.drawn,
                places: &mut *self.refine.places,
                border: &mut *self.refine.border,
                film: LineMemory {
                    lines: &mut *self.refine.film.lines,
                    heads: &mut *self.refine.film.heads,
                    groups: &mut *self.refine.film.groups,
                },
            },
        })
    }
}
