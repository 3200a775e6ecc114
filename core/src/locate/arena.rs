//! Working memory of matching alone, whose size is known when a program is built: of a library file, and of the part of a frame that is
//! looked at.

use crate::canonical::CanonicalSpec;
use crate::image::mask::{Word, words_needed};
use crate::search::scores_needed;

use super::whole::workspace_bytes_needed;

/// Lengths of the working memory with which [`crate::locate::locate_form`] finds poses of a library's model in a part of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LocateNeeds {
    /// Words of a canonical mask.
    pub canonical: usize,
    /// Scores of the library's views.
    pub scores: usize,
    /// Bytes to compare a silhouette with views.
    pub bytes: usize,
}

impl LocateNeeds {
    /// Read from a library that begins at byte `first` of a file when a program is built. Of bytes that are no library, building ends
    /// with a panic.
    #[must_use]
    pub const fn of(file: &[u8], first: usize) -> Self {
        let [area, size, x, y] = [
            u16_at(file, first + 12) | u16_at(file, first + 14) << 16,
            u16_at(file, first + 16),
            u16_at(file, first + 18),
            u16_at(file, first + 20),
        ];
        let Some(canonical) = CanonicalSpec::possible(size as usize, area) else {
            panic!("the library has no canonical frame");
        };
        Self {
            canonical: canonical.words_needed(),
            scores: scores_needed((x * y) as usize),
            bytes: workspace_bytes_needed(&canonical),
        }
    }

    /// Words that the silhouette of a part of `columns` x `rows` pixels and, after it, the comparing take.
    #[must_use]
    pub const fn shared(&self, columns: usize, rows: usize) -> usize {
        let (mask, bytes) = (
            words_needed(columns, rows),
            self.bytes.div_ceil(size_of::<Word>()),
        );
        if mask > bytes { mask } else { bytes }
    }
}

const fn u16_at(bytes: &[u8], at: usize) -> u32 {
    u16::from_le_bytes([bytes[at], bytes[at + 1]]) as u32
}

/// Declares a type that owns all working memory of matching without refinement, of one size that is known when the program is built: for
/// a `static`. `columns` and `rows` are those of the largest [`crate::image::crop::Crop`]; a larger one is refused.
///
/// ```text
/// static FEMUR: &[u8] = include_bytes!("femur.library");
/// fluoropose::locate_arena!(pub Arena, FEMUR, columns: 224, rows: 288);
/// ```
#[macro_export]
macro_rules! locate_arena {
    ($visible:vis $name:ident, $file:expr, columns: $columns:expr, rows: $rows:expr) => {
        /// All working memory of matching.
        $visible struct $name {
            shared: [$crate::image::mask::Word; Self::NEEDS.shared($columns, $rows)],
            canonical: [$crate::image::mask::Word; Self::NEEDS.canonical],
            rotated: [$crate::image::mask::Word; Self::NEEDS.canonical],
            scores: [u32; Self::NEEDS.scores],
        }

        impl $name {
            const NEEDS: $crate::locate::LocateNeeds = $crate::locate::LocateNeeds::of($file, 0);

            /// Empty working memory.
            $visible const fn new() -> Self {
                Self {
                    shared: [0; Self::NEEDS.shared($columns, $rows)],
                    canonical: [0; Self::NEEDS.canonical],
                    rotated: [0; Self::NEEDS.canonical],
                    scores: [0; Self::NEEDS.scores],
                }
            }

            /// The words that the silhouette is drawn into, and the memory to locate it with, which takes these words when its form is
            /// known ([`$crate::locate::Workspace::with_words`]).
            $visible fn borrow(
                &mut self,
            ) -> (
                &mut [$crate::image::mask::Word],
                $crate::locate::Workspace<'_>,
            ) {
                let workspace = $crate::locate::Workspace {
                    canonical: &mut self.canonical,
                    rotated: &mut self.rotated,
                    scores: &mut self.scores,
                    bytes: &mut [],
                    kernels: $crate::search::kernels::Kernels::PORTABLE,
                };
                (&mut self.shared, workspace)
            }
        }
    };
}
