//! A silhouette of which a part may be unknown: hidden by the other component, cut off by the
//! frame, or never traced.

use crate::image::mask::{Mask, MaskError};

/// A mask, and the pixels of which it says nothing.
///
/// Whether an unknown pixel belongs to the implant is not known, whatever the mask holds there.
/// What lies beyond the frame is always unknown.
#[derive(Clone, Copy, Debug)]
pub struct Silhouette<'a> {
    mask: &'a Mask<'a>,
    unknown: Option<&'a Mask<'a>>,
}

impl<'a> From<&'a Mask<'a>> for Silhouette<'a> {
    fn from(mask: &'a Mask<'a>) -> Self {
        Self {
            mask,
            unknown: None,
        }
    }
}

impl<'a> Silhouette<'a> {
    /// A mask of which the pixels of `unknown` are not to be trusted.
    ///
    /// # Errors
    /// [`MaskError::Sizes`] where the two differ in size.
    pub fn new(mask: &'a Mask<'a>, unknown: &'a Mask<'a>) -> Result<Self, MaskError> {
        if (mask.width(), mask.height()) != (unknown.width(), unknown.height()) {
            return Err(MaskError::Sizes);
        }
        Ok(Self {
            mask,
            unknown: Some(unknown),
        })
    }

    /// The mask, unknown pixels among the rest.
    #[must_use]
    pub fn mask(&self) -> &'a Mask<'a> {
        self.mask
    }

    /// The unknown pixels, where there are any.
    #[must_use]
    pub fn unknown(&self) -> Option<&'a Mask<'a>> {
        self.unknown
    }

    /// Whether a pixel lies in the frame and what the mask says of it can be trusted.
    #[must_use]
    pub fn is_known(&self, column: usize, row: usize) -> bool {
        let inside = column < self.mask.width() && row < self.mask.height();
        inside && !self.unknown.is_some_and(|unknown| unknown.get(column, row))
    }

    /// Number of known pixels set in the silhouette or in `other` and not in both; `None` where
    /// their shapes differ.
    #[must_use]
    pub fn unmatched(&self, other: &Mask<'_>) -> Option<u64> {
        let Some(unknown) = self.unknown else {
            return self.mask.unmatched(other);
        };
        let same = (self.mask.width(), self.mask.height()) == (other.width(), other.height());
        let pairs = self.mask.words().iter().zip(other.words());
        let count = pairs
            .zip(unknown.words())
            .map(|((a, b), unknown)| u64::from(((a ^ b) & !unknown).count_ones()));
        same.then(|| count.sum())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::mask::words_needed;
    use proptest::prelude::*;

    const WIDTH: usize = 64;
    const HEIGHT: usize = 5;
    const WORDS: usize = words_needed(WIDTH, HEIGHT);

    proptest! {
        #[test]
        fn unknown_pixels_are_not_counted(
            words in proptest::collection::vec(any::<u32>(), 3 * WORDS)
        ) {
            let masks: std::vec::Vec<Mask<'_>> = words
                .chunks(WORDS)
                .map(|words| Mask::new(words, WIDTH, HEIGHT).expect("valid"))
                .collect();
            let silhouette = Silhouette::new(&masks[0], &masks[1]).expect("one size");
            let mut naive = 0;
            for row in 0..HEIGHT {
                for column in 0..WIDTH {
                    let differ = masks[0].get(column, row) != masks[2].get(column, row);
                    naive += u64::from(differ && silhouette.is_known(column, row));
                }
            }
            prop_assert_eq!(silhouette.unmatched(&masks[2]), Some(naive));
        }
    }

    #[test]
    fn sizes_must_agree() {
        let words = [0; 8];
        let small = Mask::new(&words[..4], 32, 4).expect("valid");
        let large = Mask::new(&words, 32, 8).expect("valid");
        assert_eq!(
            Silhouette::new(&small, &large).err(),
            Some(MaskError::Sizes)
        );
        assert_eq!(Silhouette::from(&small).unmatched(&large), None);
        assert!(!Silhouette::from(&small).is_known(3, 4));
    }
}
