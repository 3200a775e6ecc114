//! Borders of a mask as stretches of pixel sides of which both pixels are known.

use heapless::Vec;

use crate::image::border::{Crack, Heading};
use crate::image::mask::MaskMut;
use crate::image::silhouette::Silhouette;

/// Stretches that are kept of one outline; of more, the longest.
pub(super) const STRETCHES: usize = 16;

/// Middle of a pixel side, in half pixels from the frame's upper left corner. Opaque: the caller only provides memory
/// for a number of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PixelSide {
    pub(super) column: u16,
    pub(super) row: u16,
}

/// Consecutive elements of a list that follow each other along an outline, the silhouette on the
/// right hand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Stretch {
    pub(super) start: usize,
    pub(super) end: usize,
    /// Whether the last is followed by the first.
    pub(super) closed: bool,
}

impl Stretch {
    pub(super) fn len(&self) -> usize {
        self.end - self.start
    }
}

/// The stretches of an outline, in the order in which they were found.
pub(super) type Stretches = Vec<Stretch, STRETCHES>;

/// Follows every border of a silhouette, outer ones and those of holes, and writes the sides that
/// are known to `sides`: those between a set and a clear pixel that both are. Borders and stretches
/// of fewer than `least` sides are left out. `visited` is working memory of the mask's size.
///
/// `None` where `sides` is too short.
pub(super) fn trace(
    silhouette: &Silhouette<'_>,
    visited: &mut MaskMut<'_>,
    sides: &mut [PixelSide],
    least: usize,
) -> Option<Stretches> {
    visited.clear();
    let mut tracer = Tracer {
        silhouette,
        sides,
        used: 0,
        least,
        stretches: Stretches::new(),
    };
    for row in 0..silhouette.mask().height() {
        for run in silhouette.mask().runs(row) {
            if !visited.as_mask().get(run.start, row) {
                let start = Crack {
                    column: run.start as i64,
                    row: row as i64 + 1,
                    heading: Heading::Up,
                };
                tracer.follow(start, visited)?;
            }
        }
    }
    Some(tracer.stretches)
}

struct Tracer<'a> {
    silhouette: &'a Silhouette<'a>,
    sides: &'a mut [PixelSide],
    used: usize,
    least: usize,
    stretches: Stretches,
}

impl Tracer<'_> {
    fn next(&self, at: Crack) -> Crack {
        at.step().turn(self.silhouette.mask())
    }

    /// Whether the pixels on both hands are known.
    fn is_known(&self, at: Crack) -> bool {
        let known = |left_hand| {
            let pixel = at.pixel_ahead(left_hand);
            pixel.is_some_and(|(column, row)| self.silhouette.is_known(column, row))
        };
        known(false) && known(true)
    }

    /// Follows one border twice: to mark it and to find where it is unknown, then to list it.
    fn follow(&mut self, start: Crack, visited: &mut MaskMut<'_>) -> Option<()> {
        let mut gap = None;
        let mut length = 0;
        let mut at = start;
        loop {
            if at.heading == Heading::Up {
                // Upward sides are the left ends of runs: each border has some.
                visited.set(at.column as usize, at.row as usize - 1, true);
            }
            if gap.is_none() && !self.is_known(at) {
                gap = Some(at);
            }
            length += 1;
            at = self.next(at);
            if at == start {
                break;
            }
        }
        if length < self.least {
            return Some(());
        }
        self.list(gap.unwrap_or(start), length, gap.is_none())
    }

    fn list(&mut self, start: Crack, length: usize, closed: bool) -> Option<()> {
        let mut first = self.used;
        let mut at = start;
        for _ in 0..length {
            if self.is_known(at) {
                *self.sides.get_mut(self.used)? = middle(at);
                self.used += 1;
            } else {
                self.end(first, false);
                first = self.used;
            }
            at = self.next(at);
        }
        self.end(first, closed);
        Some(())
    }

    /// Keeps the stretch from `first` to the last side listed, where it is long enough.
    fn end(&mut self, first: usize, closed: bool) {
        let stretch = Stretch {
            start: first,
            end: self.used,
            closed,
        };
        if stretch.len() < self.least {
            self.used = first;
            return;
        }
        if let Err(stretch) = self.stretches.push(stretch) {
            let shortest = self.stretches.iter_mut().min_by_key(|other| other.len());
            if let Some(shortest) = shortest.filter(|other| other.len() < stretch.len()) {
                *shortest = stretch;
            }
        }
    }
}

fn middle(at: Crack) -> PixelSide {
    let next = at.step();
    // A mask has at most 16 384 pixels a side.
    PixelSide {
        column: (at.column + next.column) as u16,
        row: (at.row + next.row) as u16,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::mask::{Mask, words_needed};
    use proptest::prelude::*;

    const WIDTH: usize = 64;
    const HEIGHT: usize = 8;
    const WORDS: usize = words_needed(WIDTH, HEIGHT);

    /// Oracle: every pair of neighbours of which one is set, both known.
    fn naive(silhouette: &Silhouette<'_>) -> std::vec::Vec<(u16, u16)> {
        let mut sides = std::vec::Vec::new();
        for row in 0..HEIGHT {
            for column in 0..WIDTH {
                for (c, r) in [(column + 1, row), (column, row + 1)] {
                    let mask = silhouette.mask();
                    let known = silhouette.is_known(column, row) && silhouette.is_known(c, r);
                    if known && mask.get(column, row) != mask.get(c, r) {
                        sides.push(((column + c + 1) as u16, (row + r + 1) as u16));
                    }
                }
            }
        }
        sides
    }

    properties! {
        #[test]
        fn every_known_side_is_listed_once(
            words in proptest::collection::vec(any::<u32>(), 3 * WORDS)
        ) {
            let mut blobs = words[..WORDS].to_vec();
            // Fewer, larger regions than noise has, so that they fit the list of stretches.
            for row in 0..HEIGHT {
                for at in 0..2 {
                    let solid = if at == 1 { 0x00ff_0000 } else { 0 };
                    blobs[2 * row + at] = if (2..=5).contains(&row) { solid } else { 0 };
                }
            }
            blobs[7] ^= words[0] & 0x0010_0000;
            blobs[9] |= words[1] & 0x3f00_0000;
            let mask = Mask::new(&blobs, WIDTH, HEIGHT).expect("valid");
            // Some known pixels among unknown ones, and some rows wholly known.
            let hidden: std::vec::Vec<u32> = words[2 * WORDS..]
                .iter()
                .enumerate()
                .map(|(at, word)| if at % 4 == 1 { word & (word >> 1) & (word >> 2) } else { 0 })
                .collect();
            let unknown = Mask::new(&hidden, WIDTH, HEIGHT).expect("valid");
            let silhouette = Silhouette::new(&mask, &unknown).expect("one size");
            let mut memory = [0; WORDS];
            let mut visited = MaskMut::new(&mut memory, WIDTH, HEIGHT).expect("fits");
            let mut sides = [PixelSide::default(); 512];
            let stretches = trace(&silhouette, &mut visited, &mut sides, 1).expect("fits");
            prop_assume!(!stretches.is_full());
            let mut listed: std::vec::Vec<_> = stretches
                .iter()
                .flat_map(|stretch| &sides[stretch.start..stretch.end])
                .map(|side| (side.column, side.row))
                .collect();
            let mut wanted = naive(&silhouette);
            listed.sort_unstable();
            wanted.sort_unstable();
            prop_assert_eq!(listed, wanted);
            // Within a stretch each side begins where the one before it ended.
            for stretch in &stretches {
                for pair in sides[stretch.start..stretch.end].windows(2) {
                    let far = (pair[0].column.abs_diff(pair[1].column))
                        .max(pair[0].row.abs_diff(pair[1].row));
                    prop_assert!(far <= 2);
                }
            }
        }
    }

    #[test]
    fn holes_and_the_frames_border() {
        let mut words = [0u32; 16];
        // A ring that reaches the upper border: an outer border that is open, a closed hole.
        for (row, word) in words.iter_mut().enumerate().take(8) {
            *word = if (2..6).contains(&row) {
                0x0000_f81f
            } else {
                0x0000_ffff
            };
        }
        let mask = Mask::new(&words, 32, 16).expect("valid");
        let mut memory = [0; 16];
        let mut visited = MaskMut::new(&mut memory, 32, 16).expect("fits");
        let mut sides = [PixelSide::default(); 100];
        let silhouette = Silhouette::from(&mask);
        let stretches = trace(&silhouette, &mut visited, &mut sides, 4).expect("fits");
        let found: std::vec::Vec<_> = stretches.iter().map(|s| (s.len(), s.closed)).collect();
        // 16 sides below and 8 to the right; the hole is 6 by 4.
        assert_eq!(found, [(24, false), (20, true)]);
        let short = &mut sides[..40];
        assert_eq!(trace(&silhouette, &mut visited, short, 4), None);
        let long = trace(&silhouette, &mut visited, &mut sides, 21).expect("fits");
        assert_eq!(long.len(), 1);
    }

    #[test]
    fn of_many_stretches_the_longest_stay() {
        let mut words = [0u32; 64];
        // 20 bars, of 2 to 21 rows.
        for bar in 0..20 {
            for row in 0..bar + 2 {
                words[2 * (row + 1) + bar / 10] |= 1 << (3 * (bar % 10) + 1);
            }
        }
        let mask = Mask::new(&words, 64, 32).expect("valid");
        let mut memory = [0; 64];
        let mut visited = MaskMut::new(&mut memory, 64, 32).expect("fits");
        let mut sides = [PixelSide::default(); 2000];
        let silhouette = Silhouette::from(&mask);
        let stretches = trace(&silhouette, &mut visited, &mut sides, 1).expect("fits");
        let least = stretches.iter().map(Stretch::len).min();
        assert_eq!((stretches.len(), least), (STRETCHES, Some(2 * (4 + 2 + 1))));
    }
}
