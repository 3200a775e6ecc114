//! Working memory of one click that grows with what needs it, for callers that have an allocator.

use alloc::vec::Vec;

use super::memory::{OneClickMemory, OneClickNeeds};
use fluoropose::image::mask::Word;
use fluoropose::locate::Workspace;
use fluoropose::memory::grow;
use fluoropose::refine::RefineMemory;

/// Owns what a [`OneClickMemory`] borrows of its own; what it shares with the finder comes from there.
#[derive(Clone, Debug, Default)]
pub struct OneClickBuffers {
    grey: Vec<u16>,
    reached: Vec<u16>,
    distance: Vec<u16>,
    marks: Vec<u8>,
    links: Vec<u32>,
    statistics: Vec<u32>,
    words: Vec<Word>,
}

impl OneClickBuffers {
    /// Memory of these lengths, with that of a finder. It never shrinks.
    pub fn borrow<'m>(
        &'m mut self,
        needs: &OneClickNeeds,
        workspace: Workspace<'m>,
        refine: RefineMemory<'m>,
    ) -> OneClickMemory<'m> {
        for pixels in [&mut self.grey, &mut self.reached, &mut self.distance] {
            grow(pixels, needs.pixels);
        }
        grow(&mut self.marks, needs.pixels);
        grow(&mut self.links, needs.links);
        grow(&mut self.statistics, needs.statistics);
        grow(&mut self.words, needs.words);
        OneClickMemory {
            grey: &mut self.grey,
            reached: &mut self.reached,
            distance: &mut self.distance,
            marks: &mut self.marks,
            links: &mut self.links,
            statistics: &mut self.statistics,
            words: &mut self.words,
            workspace,
            refine,
        }
    }
}
