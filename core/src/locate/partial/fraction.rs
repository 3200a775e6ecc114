//! How much of a mask's outline is known, counted side by side.

use crate::image::mask::{Mask, WORD_BITS, Word};
use crate::image::silhouette::Silhouette;

/// What is known of a silhouette: its sides (the borders between set and clear pixels) and its area.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct KnownFraction {
    /// All sides, those between a set pixel and the frame's border among them.
    pub sides: u64,
    /// Sides of which both pixels are known.
    pub known: u64,
    /// Sides between a set pixel and the frame's border.
    pub cut: u64,
    /// Set pixels.
    pub area: u64,
    /// Set pixels that are unknown.
    pub doubtful: u64,
}

/// Unknown fraction of the sides or of the area beyond which area and centroid are no longer what a library expects. It is
/// small, because few sides may stand for much that is hidden: where a whole stem is hidden, the sides across its root are
/// 1 % of what is left; where a notch is hidden and traced as filled, its sides may be fewer still, but not its pixels.
const DOUBT: f64 = 0.005;

impl KnownFraction {
    /// Known fraction of the outline, 0 to 1; 1 for an empty mask. What is hidden has no length in
    /// the mask: it counts by the sides that stand for it.
    #[must_use]
    pub fn fraction(&self) -> f64 {
        if self.sides == 0 {
            1.0
        } else {
            self.known as f64 / self.sides as f64
        }
    }

    /// Whether [`super::locate_partial`] is the way to a first pose: the frame's border cuts the
    /// silhouette off, or more than 0.5 % of its sides or of its pixels are unknown.
    /// [`crate::locate::whole::locate`] rests on area and moments, which that breaks.
    #[must_use]
    pub fn is_partial(&self) -> bool {
        let doubtful = self.doubtful as f64 > DOUBT * self.area as f64;
        self.cut > 0 || doubtful || self.fraction() < 1.0 - DOUBT
    }
}

/// Counts what is known of a silhouette, a word of pixels at a time.
#[must_use]
pub fn known_fraction(silhouette: &Silhouette<'_>) -> KnownFraction {
    let mask = silhouette.mask();
    let mut count = KnownFraction::default();
    for row in 0..mask.height() {
        let here = Row::new(silhouette, row);
        let above = row.checked_sub(1).map(|above| Row::new(silhouette, above));
        if here.is_clear() && above.as_ref().is_none_or(Row::is_clear) {
            continue;
        }
        for at in 0..mask.row(row).len() {
            let (set, known) = (here.set(at), here.known(at));
            count.add(set ^ here.set_right(at), known & here.known_right(at));
            count.area += u64::from(set.count_ones());
            count.doubtful += u64::from((set & !known).count_ones());
        }
        let left = here.set(0) & 1;
        count.add(left, 0);
        count.cut += u64::from(left) + u64::from(mask.get(mask.width() - 1, row));
        let below = row + 1 == mask.height();
        count.across(&here, above.as_ref(), mask.row(row).len());
        if below {
            count.across(&here, None, mask.row(row).len());
        }
    }
    count
}

impl KnownFraction {
    fn add(&mut self, sides: Word, known: Word) {
        self.sides += u64::from(sides.count_ones());
        self.known += u64::from((sides & known).count_ones());
    }

    /// The sides between a row and its neighbour, or the frame's border.
    fn across(&mut self, here: &Row<'_>, other: Option<&Row<'_>>, words: usize) {
        for at in 0..words {
            let (set, known) = other.map_or((0, 0), |row| (row.set(at), row.known(at)));
            self.add(here.set(at) ^ set, here.known(at) & known);
            if other.is_none() {
                self.cut += u64::from(here.set(at).count_ones());
            }
        }
    }
}

/// One row: what is set and what is not known.
struct Row<'a> {
    set: &'a [Word],
    unknown: &'a [Word],
    /// Pixels of the row.
    width: usize,
}

impl<'a> Row<'a> {
    fn new(silhouette: &Silhouette<'a>, row: usize) -> Self {
        let unknown = silhouette.unknown().map(|mask: &Mask<'a>| mask.row(row));
        Self {
            set: silhouette.mask().row(row),
            unknown: unknown.unwrap_or_default(),
            width: silhouette.mask().width(),
        }
    }

    fn is_clear(&self) -> bool {
        self.set.iter().all(|&word| word == 0)
    }

    fn set(&self, at: usize) -> Word {
        self.set.get(at).copied().unwrap_or(0)
    }

    fn set_right(&self, at: usize) -> Word {
        self.set(at) >> 1 | self.set(at + 1) << (WORD_BITS - 1)
    }

    /// Pixels of the row that are known; nothing beyond it is.
    fn known(&self, at: usize) -> Word {
        let left = self.width.saturating_sub(at * WORD_BITS).min(WORD_BITS);
        let inside = if left == WORD_BITS {
            Word::MAX
        } else {
            (1 << left) - 1
        };
        inside & !self.unknown.get(at).copied().unwrap_or(0)
    }

    fn known_right(&self, at: usize) -> Word {
        self.known(at) >> 1 | self.known(at + 1) << (WORD_BITS - 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::mask::words_needed;
    use proptest::prelude::*;

    const HEIGHT: usize = 6;

    /// Oracle: pixel by pixel.
    fn naive(silhouette: &Silhouette<'_>) -> KnownFraction {
        let mask = silhouette.mask();
        let (width, height) = (mask.width() as isize, mask.height() as isize);
        let set = |c: isize, r: isize| c >= 0 && r >= 0 && mask.get(c as usize, r as usize);
        let known =
            |c: isize, r: isize| c >= 0 && r >= 0 && silhouette.is_known(c as usize, r as usize);
        let inside = |c: isize, r: isize| (0..width).contains(&c) && (0..height).contains(&r);
        let mut count = KnownFraction::default();
        for row in -1..height {
            for column in -1..width {
                count.area += u64::from(set(column, row));
                count.doubtful += u64::from(set(column, row) && !known(column, row));
                for (c, r) in [(column + 1, row), (column, row + 1)] {
                    if set(column, row) != set(c, r) {
                        count.sides += 1;
                        count.known += u64::from(known(column, row) && known(c, r));
                        count.cut += u64::from(!inside(column, row) || !inside(c, r));
                    }
                }
            }
        }
        count
    }

    properties! {
        #[test]
        fn words_count_what_pixels_count(
            words in proptest::collection::vec(any::<u32>(), 36),
            width in prop_oneof![Just(64usize), 1..=96usize]
        ) {
            let length = words_needed(width, HEIGHT);
            let row = length / HEIGHT;
            let cut = |words: &[u32]| -> std::vec::Vec<u32> {
                let tail = if width % 32 == 0 { u32::MAX } else { (1 << (width % 32)) - 1 };
                let keep = |(at, &word): (usize, &u32)| {
                    if at % row == row - 1 { word & tail } else { word }
                };
                words.iter().enumerate().map(keep).collect()
            };
            let (a, b) = (cut(&words[..length]), cut(&words[18..18 + length]));
            let mask = Mask::new(&a, width, HEIGHT).expect("valid");
            let unknown = Mask::new(&b, width, HEIGHT).expect("valid");
            for silhouette in [
                Silhouette::from(&mask),
                Silhouette::new(&mask, &unknown).expect("one size"),
            ] {
                prop_assert_eq!(known_fraction(&silhouette), naive(&silhouette));
            }
        }
    }

    #[test]
    fn what_is_cut_or_hidden_is_partial() {
        let mut words = [0; 64];
        words[10..50].fill(0x00ff_ff00);
        let whole = words;
        let mask = Mask::new(&whole, 32, 64).expect("valid");
        assert!(!known_fraction(&Silhouette::from(&mask)).is_partial());
        assert_eq!(known_fraction(&Silhouette::from(&mask)).fraction(), 1.0);
        // Hidden within: the outline is known, the area is not.
        let mut hidden = [0; 64];
        hidden[20..30].fill(0x0000_3000);
        let unknown = Mask::new(&hidden, 32, 64).expect("valid");
        let silhouette = Silhouette::new(&mask, &unknown).expect("one size");
        assert_eq!(known_fraction(&silhouette).fraction(), 1.0);
        assert!(known_fraction(&silhouette).is_partial());
        // Reaching the frame's border by one pixel.
        words[0..10].fill(0x0000_0100);
        let mask = Mask::new(&words, 32, 64).expect("valid");
        let known = known_fraction(&Silhouette::from(&mask));
        assert_eq!((known.cut, known.sides - known.known), (1, 1));
        assert!(known.is_partial());
        let nothing = [0; 64];
        let mask = Mask::new(&nothing, 32, 64).expect("valid");
        assert!(!known_fraction(&Silhouette::from(&mask)).is_partial());
    }
}
