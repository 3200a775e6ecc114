//! The canonical frame, and what is taken away to reach it.

use thiserror::Error;

use crate::image::contour::Point;
use crate::image::mask::{MaskError, WORD_BITS, words_needed};

/// Size and area of the canonical frame, which must be the same for a library and its queries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CanonicalSpec {
    size: usize,
    area: u32,
}

impl Default for CanonicalSpec {
    fn default() -> Self {
        Self::USUAL
    }
}

/// Why a silhouette has no canonical form.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum CanonicalError {
    /// The canonical frame cannot be that large or hold that area.
    #[error(
        "a canonical frame of {size} x {size} pixels with an area of {area} is not possible: the size must be a multiple of 32 up to 1024, the area between 64 pixels and half the frame"
    )]
    Spec {
        /// Side, pixels.
        size: usize,
        /// Area, pixels.
        area: u32,
    },
    /// The working memory has the wrong length, or the mask is empty.
    #[error(transparent)]
    Mask(#[from] MaskError),
    /// A single pixel has a place and nothing else.
    #[error("the silhouette is a single pixel")]
    Pixel,
}

impl CanonicalSpec {
    /// 15 000 pixels in a frame of 256 x 256, as in Walker et al. 1996.
    pub const USUAL: Self = Self {
        size: 256,
        area: 15_000,
    };

    /// 938 pixels in a frame of 64 x 64, the same part of it: enough to tell directions some degrees apart.
    pub const COARSE: Self = Self {
        size: 64,
        area: 938,
    };

    /// A canonical frame of `size` x `size` pixels in which every silhouette has `area` pixels.
    ///
    /// # Errors
    /// [`CanonicalError::Spec`].
    pub fn new(size: usize, area: u32) -> Result<Self, CanonicalError> {
        Self::possible(size, area).ok_or(CanonicalError::Spec { size, area })
    }

    /// The same where that is possible.
    #[must_use]
    pub const fn possible(size: usize, area: u32) -> Option<Self> {
        if !size.is_multiple_of(WORD_BITS) || size < WORD_BITS || size > 1024 {
            return None;
        }
        let most = size * size / 2;
        if area < 64 || area as usize > most {
            return None;
        }
        Some(Self { size, area })
    }

    /// Side of the canonical frame, pixels.
    #[must_use]
    pub const fn size(&self) -> usize {
        self.size
    }

    /// Area of every canonical silhouette before sampling, pixels.
    #[must_use]
    pub const fn area(&self) -> u32 {
        self.area
    }

    /// Words of a canonical mask: the working memory of [`super::canonicalise()`].
    #[must_use]
    pub const fn words_needed(&self) -> usize {
        words_needed(self.size, self.size)
    }
}

/// What was taken away to reach canonical form.
///
/// Lengths are in *square pixels' widths*: columns count as they are, rows are multiplied by
/// `aspect`. The angle is counter-clockwise as seen on the screen (y up).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CanonicalForm {
    /// Pixels of the silhouette as it was given.
    pub area_px: u64,
    /// Centroid of the silhouette, continuous image coordinates.
    pub centroid: Point,
    /// Direction of the principal axis, radians, -pi/2 to pi/2. An axis has two directions:
    /// this angle and this angle plus pi describe the same silhouette. 0 where no axis is longer than the others.
    pub angle: f64,
    /// Canonical pixels per frame pixel.
    pub scale: f64,
    /// Height of a frame pixel divided by its width.
    pub aspect: f64,
    /// `(a - b) / (a + b)` of the principal second moments: 0 for a disc, 1 for a line. Near 0
    /// the angle is ill determined.
    pub elongation: f64,
    /// Whether the canonical silhouette touches its frame's border and may have been cut: long
    /// or hollow shapes reach further than compact ones of the same area. Area, centroid and
    /// axis are those of the whole silhouette all the same; only the score does not see what
    /// was cut, alike in library and query.
    pub clipped: bool,
}
