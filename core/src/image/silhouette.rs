//! A silhouette of which a part may be unknown: hidden by the other component, cut off by the
//! frame, or never traced.

use crate::image::crop::Crop;
use crate::image::mask::{Mask, MaskError};
use crate::math::sqrt;

/// A mask, and the pixels of which it says nothing.
///
/// Whether an unknown pixel belongs to the implant is not known, whatever the mask holds there.
/// What lies beyond the frame is always unknown. Nor is it known how far all of its outline lies outside of the implant's, unless it is
/// told who laid it ([`Silhouette::laid_by`]): [`CommonOffset::OF_MASKS`].
#[derive(Clone, Copy, Debug)]
pub struct Silhouette<'a> {
    mask: &'a Mask<'a>,
    unknown: Option<&'a Mask<'a>>,
    common: CommonOffset,
    uneven_px: f64,
    crop: Option<Crop>,
}

/// How far an outline lies outside of the implant's everywhere alike, which leaves no residual and moves depth: masks of a
/// network, outlines that a tool laid on a frame's edges.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CommonOffset {
    /// How far, pixels; below zero inside.
    pub px: f64,
    /// The standard deviation of that.
    pub deviation_px: f64,
}

impl CommonOffset {
    /// Of outlines on the edges of a frame whose film is not known: edges of films seen so far lie 0.2 to 0.9 px inside.
    pub const ON_EDGES: Self = Self {
        px: 0.0,
        deviation_px: 0.65,
    };
    /// Of masks and outlines of which nobody knows more: four sources of masks seen so far, networks and hands of two laboratories, lie
    /// 0.87, 0.51, 0.13 and 0.0 px outside, 0.5 px root mean square.
    pub const OF_MASKS: Self = Self {
        px: 0.0,
        deviation_px: 0.5,
    };
    /// What edges of a known film leave unknown of it.
    const OF_FILM_PX: f64 = 0.1;

    /// That of masks of one source, from what single ones lie off by; `None` of none. What it deviates by is that of single masks.
    #[must_use]
    pub fn of(single: &[f64]) -> Option<Self> {
        let px = median(single, |px| px)?;
        // As if they were normal, whatever lies far out.
        let spread = 1.4826 * median(single, |one| (one - px).abs())?;
        Some(Self {
            px,
            deviation_px: sqrt(spread * spread + Self::OF_FILM_PX * Self::OF_FILM_PX),
        })
    }
}

/// How far a mask's outline lies off on one side alone: it is shifted as a whole, or wider along one line than across. Nothing makes both sides of
/// a mask err alike, so each of these is as large as what is common to all of it ([`CommonOffset::OF_MASKS`]). Of left8's network, root mean square of its
/// frames: 0.5 and 0.9 px to the right and downwards (femur), 2.0 and 0.9 (tray), wider along a line 0.35 to 0.5 px; in common 0.7 and 0.3.
const UNEVEN_PX: f64 = 0.5;

/// Who laid an outline on a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum OutlineOrigin {
    /// A person's hand, a network, or nobody knows.
    #[default]
    Hand,
    /// A program that drew the model, so that it lies on its outline: simulations, phantoms whose edges are calibrated.
    Drawn,
    /// A tool that follows the frame's edges: threshold, live-wire, snapping, one click.
    Tool,
    /// Such a tool in part, a hand in part.
    Mixed,
}

impl OutlineOrigin {
    /// That of the word `hand`, `drawn`, `tool` or `mixed`.
    #[must_use]
    pub fn of_word(word: &str) -> Option<Self> {
        match word {
            "hand" => Some(Self::Hand),
            "drawn" => Some(Self::Drawn),
            "tool" => Some(Self::Tool),
            "mixed" => Some(Self::Mixed),
            _ => None,
        }
    }

    /// How far such an outline lies off the implant's everywhere alike, while the film is not known. Nobody knows how much of a
    /// mixed one lies on edges: as much as of a tool's.
    #[must_use]
    pub fn common_offset(self) -> CommonOffset {
        match self {
            Self::Hand => CommonOffset::OF_MASKS,
            Self::Drawn => CommonOffset::default(),
            Self::Tool | Self::Mixed => CommonOffset::ON_EDGES,
        }
    }
}

/// The lower median; not of many, so that it is found by counting.
fn median(values: &[f64], of: impl Fn(f64) -> f64) -> Option<f64> {
    let rank = values.len().checked_sub(1)? / 2;
    let mut all = values.iter().map(|&value| of(value));
    all.find(|&value| {
        let count =
            |is: &dyn Fn(f64) -> bool| values.iter().filter(|&&other| is(of(other))).count();
        count(&|other| other < value) <= rank && rank < count(&|other| other <= value)
    })
}

impl<'a> From<&'a Mask<'a>> for Silhouette<'a> {
    fn from(mask: &'a Mask<'a>) -> Self {
        Self {
            mask,
            unknown: None,
            common: CommonOffset::OF_MASKS,
            uneven_px: UNEVEN_PX,
            crop: None,
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
            common: CommonOffset::OF_MASKS,
            uneven_px: UNEVEN_PX,
            crop: None,
        })
    }

    /// The same, known to lie off the implant's outline by so much everywhere: refinement takes that away, and what is not known
    /// of it widens the covariance.
    #[must_use]
    pub fn lying_off(self, common: CommonOffset) -> Self {
        Self { common, ..self }
    }

    /// The same, whose mask is of a part of the frame: the frame goes on beyond it and holds nothing of the implant there.
    /// Only of a silhouette that is known as a whole; pieces of an outline are looked for in all of a frame.
    ///
    /// # Errors
    /// [`MaskError::Sizes`] where the mask is not of that part's size or has unknown pixels beside it,
    /// [`MaskError::Cropped`] where the silhouette reaches a side beyond which the frame goes on.
    pub fn in_crop(self, crop: &Crop) -> Result<Self, MaskError> {
        let size = (self.mask.width(), self.mask.height());
        if size != (crop.width(), crop.height()) || self.unknown.is_some() {
            return Err(MaskError::Sizes);
        }
        if crop.is_near_side(self.mask, 1) {
            return Err(MaskError::Cropped);
        }
        Ok(Self {
            crop: Some(*crop),
            ..self
        })
    }

    /// The part of the frame that the mask is of; `None` where it is the frame's.
    #[must_use]
    pub fn crop(&self) -> Option<&Crop> {
        self.crop.as_ref()
    }

    /// Whether a place beyond the mask, to the right of and below the middle of a pixel that is counted from the first, is known
    /// to hold nothing of the implant.
    pub(crate) fn is_clear_beyond(&self, column: i32, row: i32) -> bool {
        let Some(crop) = &self.crop else {
            return false;
        };
        let [left, top, right, bottom] = crop.beyond().map(|pixels| pixels as i32);
        let last = |side: usize| side as i32 - 1;
        (-left..last(crop.width()) + right).contains(&column)
            && (-top..last(crop.height()) + bottom).contains(&row)
    }

    /// The same, laid on a frame by whom it was: what a tool laid on edges lies off the implant's outline by a distance that nobody
    /// knows. Where the film is known, the frame itself tells more than such an outline.
    #[must_use]
    pub fn laid_by(self, origin: OutlineOrigin) -> Self {
        let uneven_px = match origin {
            OutlineOrigin::Hand => UNEVEN_PX,
            OutlineOrigin::Drawn | OutlineOrigin::Tool | OutlineOrigin::Mixed => 0.0,
        };
        Self {
            uneven_px,
            ..self.lying_off(origin.common_offset())
        }
    }

    /// How far it may lie off on one side alone, pixels (one standard deviation of each way to be uneven: shifted to the right or downwards, wider along
    /// one line than across).
    #[must_use]
    pub(crate) fn uneven_px(&self) -> f64 {
        self.uneven_px
    }

    /// How far it lies off everywhere alike.
    #[must_use]
    pub fn common_offset(&self) -> CommonOffset {
        self.common
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

    properties! {
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
    fn masks_of_a_source_lie_off_by_their_median() {
        assert_eq!(CommonOffset::of(&[]), None);
        let off = CommonOffset::of(&[0.5, 0.4, 0.6, 7.0]).expect("some");
        assert_eq!(off.px, 0.5);
        assert!((off.deviation_px - 0.178).abs() < 1e-3, "{off:?}");
    }

    #[test]
    fn what_a_tool_laid_lies_off_by_what_nobody_knows() {
        let words = [0; 4];
        let mask = Mask::new(&words, 32, 4).expect("valid");
        let laid = |word| {
            let origin = OutlineOrigin::of_word(word).expect("a word of them");
            Silhouette::from(&mask).laid_by(origin).common_offset()
        };
        assert_eq!(laid("hand"), CommonOffset::OF_MASKS);
        assert_eq!(laid("drawn"), CommonOffset::default());
        assert_eq!(laid("tool"), CommonOffset::ON_EDGES);
        assert_eq!(laid("mixed"), laid("tool"));
        assert_eq!(OutlineOrigin::of_word("Tool"), None);
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

    /// The four pixels around a place tell, of which some may lie in the mask.
    #[test]
    fn beyond_a_crop_it_is_clear_as_far_as_the_frame_goes() {
        for (columns, rows) in [(10..42, 7..12), (0..32, 0..5), (3..35, 15..20)] {
            let crop = Crop::around(columns.clone(), rows.clone(), 0, [45, 20]).expect("possible");
            let words = [0; words_needed(32, 5)];
            let mask = Mask::new(&words, 32, 5).expect("valid");
            let cropped = Silhouette::from(&mask)
                .in_crop(&crop)
                .expect("nothing near a side");
            let [left, top] = [columns.start as i32, rows.start as i32];
            for (column, row) in
                (-20..60).flat_map(|column| (-20..30).map(move |row| (column, row)))
            {
                let in_frame = |dx: i32, dy: i32| {
                    (0..45).contains(&(column + dx + left)) && (0..20).contains(&(row + dy + top))
                };
                let around = [(0, 0), (1, 0), (0, 1), (1, 1)];
                let expected = around.into_iter().all(|(dx, dy)| in_frame(dx, dy));
                assert_eq!(
                    cropped.is_clear_beyond(column, row),
                    expected,
                    "{column} {row}"
                );
            }
            assert!(!Silhouette::from(&mask).is_clear_beyond(3, 3));
        }
    }
}
