//! Every region that a threshold could cut out around a seed, in one pass.
//!
//! `reached` of a pixel is the least threshold that connects it with the seed: the greatest level on the darkest way there.
//! It holds the nested regions of all thresholds, that is the branch of the component tree with the seed (Matas et al.,
//! *Robust wide-baseline stereo from maximally stable extremal regions*, BMVC 2002). Pixels leave a queue of buckets in
//! rising order, so that each is visited once.

use super::window::{BLOCKED, LEVELS, Window};

/// The threshold of pixels that are never reached.
pub(super) const NEVER: u16 = u16::MAX;

/// End of a list of pixels.
const NONE: u32 = u32::MAX;

/// Length of the working memory for a window of `pixels` pixels.
pub(super) const fn links_needed(pixels: usize) -> usize {
    pixels + LEVELS
}

/// Lists of pixels by their level, linked through borrowed memory.
struct Buckets<'m> {
    heads: &'m mut [u32],
    links: &'m mut [u32],
}

impl Buckets<'_> {
    fn push(&mut self, level: usize, pixel: usize) {
        if let (Some(head), Some(link)) = (self.heads.get_mut(level), self.links.get_mut(pixel)) {
            *link = *head;
            *head = pixel as u32;
        }
    }

    fn pop(&mut self, level: usize) -> Option<usize> {
        let head = self.heads.get_mut(level)?;
        let pixel = *head;
        *head = *self.links.get(pixel as usize)?;
        Some(pixel as usize)
    }
}

/// Writes for every pixel of the window the least threshold that connects it with `seed`. Blocked pixels are never
/// reached. `links` has [`links_needed`] numbers, the other slices one for each pixel.
pub(super) fn flood(
    grey: &[u16],
    window: &Window,
    seed: usize,
    reached: &mut [u16],
    links: &mut [u32],
) {
    reached.fill(NEVER);
    links.fill(NONE);
    let (heads, links) = links.split_at_mut(LEVELS.min(links.len()));
    let mut buckets = Buckets { heads, links };
    let level_of = |pixel: usize| grey.get(pixel).copied().unwrap_or(BLOCKED);
    let start = level_of(seed);
    if start == BLOCKED {
        return;
    }
    if let Some(first) = reached.get_mut(seed) {
        *first = start;
    }
    buckets.push(usize::from(start), seed);
    for level in usize::from(start)..LEVELS {
        while let Some(pixel) = buckets.pop(level) {
            window.neighbours(pixel, |next| {
                let Some(place) = reached.get_mut(next) else {
                    return;
                };
                let own = level_of(next);
                if *place != NEVER || own == BLOCKED {
                    return;
                }
                *place = own.max(level as u16);
                buckets.push(usize::from(*place), next);
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const WIDTH: usize = 9;
    const HEIGHT: usize = 7;

    /// Oracle: thresholds one by one, each flooded until nothing changes.
    fn naive(grey: &[u16], window: &Window, seed: usize) -> std::vec::Vec<u16> {
        let mut reached = std::vec![NEVER; grey.len()];
        for level in 0..LEVELS as u16 {
            let mut joined: std::vec::Vec<bool> = std::vec![false; grey.len()];
            joined[seed] = grey[seed] <= level;
            loop {
                let before = joined.clone();
                for pixel in 0..grey.len() {
                    window.neighbours(pixel, |next| {
                        joined[pixel] |= before[next] && grey[pixel] <= level;
                    });
                }
                if joined == before {
                    break;
                }
            }
            for (place, _) in reached
                .iter_mut()
                .zip(&joined)
                .filter(|(_, joined)| **joined)
            {
                *place = (*place).min(level);
            }
        }
        reached
    }

    proptest! {
        #[test]
        fn one_pass_gives_the_regions_of_all_thresholds(
            grey in proptest::collection::vec(
                prop_oneof![8 => 0u16..12, 1 => Just(BLOCKED)], WIDTH * HEIGHT),
            seed in 0..WIDTH * HEIGHT
        ) {
            let window = Window { left: 3, top: 5, width: WIDTH, height: HEIGHT };
            let mut reached = std::vec![0; grey.len()];
            let mut links = std::vec![0; links_needed(grey.len())];
            flood(&grey, &window, seed, &mut reached, &mut links);
            prop_assert_eq!(reached, naive(&grey, &window, seed));
        }
    }
}
