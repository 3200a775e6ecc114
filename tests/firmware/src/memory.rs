//! All memory that the way from outline to pose uses, of one size known when it is built.

use fluoropose::canonical::CanonicalSpec;
use fluoropose::image::contour::Contour;
use fluoropose::image::mask::{Word, words_needed};
use fluoropose::locate::workspace_bytes_needed;
use fluoropose::search::scores_needed;

/// Columns and rows of the frame, pixels.
pub const FRAME_SIDE: usize = 512;
/// Most vertices of an outline.
pub const MAX_POINTS: usize = 1024;
/// Views of the library: 7 rotations about x times 9 about y.
pub const MAX_VIEWS: usize = 63;

const CANONICAL_WORDS: usize =
    words_needed(CanonicalSpec::USUAL.size(), CanonicalSpec::USUAL.size());

/// The working memory; a microcontroller holds one in a static.
pub struct Memory {
    pub(crate) points: Contour<MAX_POINTS>,
    pub(crate) mask: [Word; words_needed(FRAME_SIDE, FRAME_SIDE)],
    pub(crate) canonical: [Word; CANONICAL_WORDS],
    pub(crate) turned: [Word; CANONICAL_WORDS],
    pub(crate) scores: [u32; scores_needed(MAX_VIEWS)],
    pub(crate) bytes: [u8; workspace_bytes_needed(&CanonicalSpec::USUAL)],
}

impl Memory {
    /// Empty working memory.
    pub const fn new() -> Self {
        Self {
            points: Contour::new(),
            mask: [0; words_needed(FRAME_SIDE, FRAME_SIDE)],
            canonical: [0; CANONICAL_WORDS],
            turned: [0; CANONICAL_WORDS],
            scores: [0; scores_needed(MAX_VIEWS)],
            bytes: [0; workspace_bytes_needed(&CanonicalSpec::USUAL)],
        }
    }
}

impl Default for Memory {
    fn default() -> Self {
        Self::new()
    }
}
