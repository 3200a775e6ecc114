//! A bounded list of what is met along an outline: of a longer one every second, every fourth and so on.

use heapless::Vec;

/// What is kept of a row of things whose length is not known before its end: of more than there is room for every second, and so on.
pub(super) struct Thinned<T, const ROOM: usize> {
    kept: Vec<T, ROOM>,
    /// One of so many counts.
    every: usize,
    /// Number of the last that was met.
    number: usize,
}

impl<T, const ROOM: usize> Thinned<T, ROOM> {
    /// Nothing.
    pub(super) fn new() -> Self {
        Self {
            kept: Vec::new(),
            every: 1,
            number: 0,
        }
    }

    /// Whether the next one counts.
    pub(super) fn counts_next(&mut self) -> bool {
        self.number += 1;
        self.number.is_multiple_of(self.every)
    }

    /// Keeps one that counts.
    pub(super) fn keep(&mut self, one: T) {
        if self.kept.push(one).is_err() {
            let mut at = 0;
            self.kept.retain(|_| {
                at += 1;
                at % 2 == 1
            });
            self.every *= 2;
        }
    }

    /// What was kept, in its order.
    pub(super) fn into_kept(self) -> Vec<T, ROOM> {
        self.kept
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    properties! {
        /// However many there are, those that are kept lie evenly, one of as many as leave room for all.
        #[test]
        fn what_is_kept_is_spread_evenly_over_all(count in 0usize..3000) {
            let mut thinned = Thinned::<usize, 64>::new();
            for number in 1..=count {
                if thinned.counts_next() {
                    thinned.keep(number);
                }
            }
            let kept = thinned.into_kept();
            if count <= 64 {
                prop_assert!(kept.iter().copied().eq(1..=count));
            } else {
                let steps = kept.windows(2).map(|pair| pair[1] - pair[0]);
                let (least, most) = steps.fold((usize::MAX, 0), |(least, most), step| (least.min(step), most.max(step)));
                prop_assert!((32..=64).contains(&kept.len()), "{}", kept.len());
                prop_assert!(least.is_power_of_two() && most < 2 * least, "{least} {most}");
                prop_assert!(kept[0] == 1 && count - kept[kept.len() - 1] < 3 * least, "{kept:?}");
            }
        }
    }
}
