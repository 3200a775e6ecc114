//! Working memory whose size is known when a program is built: of an implant file, and of the part of a frame that is looked at.

use super::wire::{COUNTS_AT, LIBRARY_BYTES_AT};
use crate::image::mask::{Word, words_needed};
use crate::locate::LocateNeeds;
use crate::refine::{BorderPixel, places_needed};
use crate::render::{Projected, scratch_for};

/// Lengths of the working memory with which [`crate::find()`] finds the implant of a file in a part of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ArenaNeeds {
    /// Words of a canonical mask.
    pub canonical: usize,
    /// Scores of the library's views.
    pub scores: usize,
    /// Bytes to compare a silhouette with views; none where the words of the mask serve.
    pub bytes: usize,
    /// Projected vertices and silhouette edges.
    pub projected: usize,
    /// Words of a mask of the part of the frame.
    pub words: usize,
    /// Numbers by which samples of the outline are found in its rows.
    pub places: usize,
}

/// What the address of an arena is a multiple of.
const LARGEST: usize = {
    let (records, words) = (align_of::<Projected>(), align_of::<Word>());
    if records > words { records } else { words }
};

impl ArenaNeeds {
    /// Bytes of all of it, for outlines of at most `border` pixels: those of the type that [`crate::finder_arena`] declares.
    #[must_use]
    pub const fn bytes_for(&self, border: usize) -> usize {
        let masks = 2 * size_of::<Word>() * self.canonical + 2 * size_of::<Word>() * self.words;
        let lists = size_of::<u32>() * self.scores + self.bytes + size_of::<u16>() * self.places;
        let records = size_of::<Projected>() * self.projected + size_of::<BorderPixel>() * border;
        let all: usize = masks + lists + records;
        all.next_multiple_of(LARGEST)
    }

    /// Read from the header of an implant file when a program is built, for a part of `columns` x `rows` pixels. Of bytes
    /// that are no such file, building ends with a panic.
    #[must_use]
    pub const fn of(file: &[u8], columns: usize, rows: usize) -> Self {
        // It is the last part.
        let library = file.len() - u32_at(file, LIBRARY_BYTES_AT) as usize;
        let vertices = u32_at(file, COUNTS_AT) as usize;
        let edges = u32_at(file, COUNTS_AT + 24) as usize;
        let LocateNeeds {
            canonical,
            scores,
            bytes,
        } = LocateNeeds::of(file, library);
        let serves = words_needed(columns, rows) * size_of::<Word>() >= bytes;
        Self {
            canonical,
            scores,
            bytes: if serves { 0 } else { bytes },
            projected: scratch_for(vertices, rows, edges),
            words: words_needed(columns, rows),
            places: places_needed(rows),
        }
    }
}

const fn u32_at(bytes: &[u8], at: usize) -> u32 {
    u32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]])
}

/// Declares a type that owns all working memory with which [`crate::find()`] finds the implant of a file in a part of a frame,
/// of one size that is known when the program is built: for a `static`.
///
/// ```text
/// static FEMUR: Aligned<[u8; 98_304]> = Aligned(*include_bytes!("femur.implant"));
/// fluoropose::finder_arena!(pub Arena, &FEMUR.0, columns: 192, rows: 192, border: 900);
/// static ARENA: Mutex<Arena> = Mutex::new(Arena::new());
/// // Where it is used: the words that the silhouette is drawn into, and the `FinderMemory`.
/// let (words, mut memory) = arena.borrow();
/// ```
///
/// `columns` and `rows` are those of the largest [`crate::image::crop::Crop`], `border` is the number of pixels of the longest
/// outline. An outline that is longer, or a larger part of a frame, is refused by what it does not fit into. There is no memory
/// for pieces of outlines: of a silhouette that something hides in part no pose is good.
#[macro_export]
macro_rules! finder_arena {
    ($visible:vis $name:ident, $file:expr, columns: $columns:expr, rows: $rows:expr, border: $border:expr) => {
        /// All working memory of the finder.
        $visible struct $name {
            silhouette: [$crate::image::mask::Word; Self::NEEDS.words],
            canonical: [$crate::image::mask::Word; Self::NEEDS.canonical],
            rotated: [$crate::image::mask::Word; Self::NEEDS.canonical],
            scores: [u32; Self::NEEDS.scores],
            bytes: [u8; Self::NEEDS.bytes],
            projected: [$crate::render::Projected; Self::NEEDS.projected],
            drawn: [$crate::image::mask::Word; Self::NEEDS.words],
            places: [u16; Self::NEEDS.places],
            border: [$crate::refine::BorderPixel; $border],
        }

        impl $name {
            const NEEDS: $crate::implant::ArenaNeeds =
                $crate::implant::ArenaNeeds::of($file, $columns, $rows);

            /// Empty working memory.
            $visible const fn new() -> Self {
                Self {
                    silhouette: [0; Self::NEEDS.words],
                    canonical: [0; Self::NEEDS.canonical],
                    rotated: [0; Self::NEEDS.canonical],
                    scores: [0; Self::NEEDS.scores],
                    bytes: [0; Self::NEEDS.bytes],
                    projected: [$crate::render::Projected::ZERO; Self::NEEDS.projected],
                    drawn: [0; Self::NEEDS.words],
                    places: [0; Self::NEEDS.places],
                    border: [$crate::refine::BorderPixel::EMPTY; $border],
                }
            }

            /// The words that the silhouette is drawn into, and the memory of the finder.
            $visible fn borrow(
                &mut self,
            ) -> (
                &mut [$crate::image::mask::Word],
                $crate::finder::FinderMemory<'_>,
            ) {
                let workspace = $crate::locate::Workspace {
                    canonical: &mut self.canonical,
                    rotated: &mut self.rotated,
                    scores: &mut self.scores,
                    bytes: &mut self.bytes,
                    kernels: $crate::search::kernels::Kernels::PORTABLE,
                };
                let refine = $crate::refine::RefineMemory {
                    projected: &mut self.projected,
                    drawn: &mut self.drawn,
                    places: &mut self.places,
                    border: &mut self.border,
                    film: $crate::film::LineMemory::default(),
                };
                let memory = $crate::finder::FinderMemory {
                    workspace,
                    partial: $crate::locate::partial::PartialMemory::default(),
                    refine,
                };
                (&mut self.silhouette, memory)
            }
        }
    };
}
