//! Area and border of the regions of all thresholds, and which thresholds are worth trying.

use heapless::Vec;

use super::background::BACKGROUND;
use super::flooding::NEVER;
use super::window::{LEVELS, Window, step_between};
use fluoropose::shortlist;

/// Length of the working memory.
pub(super) const STATISTICS: usize = 3 * LEVELS;

// The background is found in the same memory.
const _: () = assert!(STATISTICS >= BACKGROUND);

/// The greatest number of thresholds that are tried.
pub(super) const CHOSEN: usize = 6;

/// A region that grows by more than this factor from one threshold to the next has merged with another.
const LEAP: f64 = 1.1;
/// Further thresholds that are tried, as fractions of the way from the seed's level to that of the sharpest border.
const BETWEEN: [f64; 2] = [0.35, 0.65];
/// Thresholds whose regions differ in area by less than this fraction count as one.
const SAME: f64 = 0.02;

/// Area and border of the regions of all thresholds.
pub(super) struct ThresholdStatistics<'m> {
    area: &'m [u32],
    /// Number of sides between a pixel of the region and one outside.
    sides: &'m [u32],
    /// Sum of the differences of levels across them.
    contrast: &'m [u32],
    base: usize,
}

impl<'m> ThresholdStatistics<'m> {
    /// Measures the regions in `reached`, for a seed that is reached at `base`. Each side between two pixels belongs to
    /// the border at the thresholds from the lower to the greater of the two: it is added at the first and subtracted at
    /// the last.
    pub(super) fn new(
        grey: &[u16],
        reached: &[u16],
        window: &Window,
        base: u16,
        memory: &'m mut [u32],
    ) -> Self {
        memory.fill(0);
        let (area, rest) = memory.split_at_mut(LEVELS.min(memory.len()));
        let (sides, contrast) = rest.split_at_mut(LEVELS.min(rest.len()));
        let enter = |counts: &mut [u32], at: u16, amount: u32| {
            if let Some(count) = counts.get_mut(usize::from(at)) {
                *count = count.wrapping_add(amount);
            }
        };
        for (index, &here) in reached.iter().enumerate() {
            enter(area, here, 1);
            window.neighbours(index, |next| {
                let there = reached.get(next).copied().unwrap_or(NEVER);
                if here >= there {
                    return;
                }
                let step = step_between(grey, index, next).unsigned_abs();
                enter(sides, here, 1);
                enter(sides, there, 1u32.wrapping_neg());
                enter(contrast, here, step);
                enter(contrast, there, step.wrapping_neg());
            });
        }
        for counts in [&mut *area, &mut *sides, &mut *contrast] {
            let mut sum = 0u32;
            for count in counts {
                sum = sum.wrapping_add(*count);
                *count = sum;
            }
        }
        Self {
            area,
            sides,
            contrast,
            base: usize::from(base),
        }
    }

    /// Number of pixels of a threshold's region.
    pub(super) fn area(&self, level: usize) -> f64 {
        f64::from(self.area.get(level).copied().unwrap_or(0))
    }

    /// Mean difference of levels across the border of a threshold's region; 0 where it has no border.
    pub(super) fn sharpness(&self, level: usize) -> f64 {
        let at = |counts: &[u32]| f64::from(counts.get(level).copied().unwrap_or(0));
        let sides = at(self.sides);
        if sides > 0.0 {
            at(self.contrast) / sides
        } else {
            0.0
        }
    }

    /// Thresholds whose regions have `least` to `most` pixels.
    fn possible(&self, [least, most]: [f64; 2]) -> impl Iterator<Item = usize> + '_ {
        let fits = move |level: &usize| (least..=most).contains(&self.area(*level));
        (self.base..LEVELS).filter(fits)
    }

    fn sharpest(&self, levels: impl Iterator<Item = usize>) -> Option<usize> {
        levels.max_by(|&a, &b| self.sharpness(a).total_cmp(&self.sharpness(b)))
    }

    /// The threshold of the sharpest border among regions of `least` to `most` pixels.
    pub(super) fn peak(&self, sizes: [f64; 2]) -> Option<usize> {
        self.sharpest(self.possible(sizes))
    }

    /// Thresholds worth trying, each region once: that of the sharpest border; some below it, where two things that touch
    /// are still apart; and, for each range in which the region grows steadily, that of its sharpest border, the sharpest
    /// range first.
    pub(super) fn levels(&self, sizes: [f64; 2]) -> Vec<u16, CHOSEN> {
        let mut chosen = Vec::new();
        let Some(peak) = self.peak(sizes) else {
            return chosen;
        };
        let mut keep = |level: usize| {
            let area = self.area(level);
            let same = |other: &u16| (area / self.area(usize::from(*other)) - 1.0).abs() < SAME;
            if !chosen.iter().any(same) {
                // If there are more thresholds than are tried, the first stay.
                let _ = chosen.push(level as u16);
            }
        };
        keep(peak);
        for fraction in BETWEEN {
            keep(self.base + (fraction * (peak - self.base) as f64) as usize);
        }
        let mut rest: Vec<usize, CHOSEN> = Vec::new();
        let mut from = self.base;
        for level in self.base + 1..=LEVELS {
            let ends = level == LEVELS || self.area(level) > LEAP * self.area(level - 1);
            if !ends {
                continue;
            }
            let stretch = (from..level).filter(|&l| (sizes[0]..=sizes[1]).contains(&self.area(l)));
            if let Some(best) = self.sharpest(stretch) {
                shortlist::keep(&mut rest, best, |&level| -self.sharpness(level));
            }
            from = level;
        }
        rest.into_iter().for_each(keep);
        chosen
    }
}

#[cfg(test)]
mod tests {
    use super::super::flooding::{flood, links_needed};
    use super::super::window::BLOCKED;
    use super::*;

    const SIDE: usize = 40;

    /// Two dark discs on a bright background, joined by a bridge that is less dark.
    fn frame() -> std::vec::Vec<u16> {
        let inside = |column: usize, row: usize, middle: [f64; 2], radius: f64| {
            libm::hypot(column as f64 - middle[0], row as f64 - middle[1]) < radius
        };
        (0..SIDE * SIDE)
            .map(|k| {
                let (column, row) = (k % SIDE, k / SIDE);
                if inside(column, row, [10.0, 20.0], 8.0) {
                    100
                } else if inside(column, row, [30.0, 20.0], 6.0) {
                    110
                } else if (10..30).contains(&column) && (18..22).contains(&row) {
                    300
                } else {
                    800
                }
            })
            .collect()
    }

    fn statistics(memory: &mut [u32]) -> ThresholdStatistics<'_> {
        statistics_of(&frame(), memory)
    }

    fn statistics_of<'m>(grey: &[u16], memory: &'m mut [u32]) -> ThresholdStatistics<'m> {
        let window = Window {
            left: 0,
            top: 0,
            width: SIDE,
            height: SIDE,
        };
        let mut reached = std::vec![0; grey.len()];
        let mut links = std::vec![0; links_needed(grey.len())];
        let seed = 20 * SIDE + 10;
        flood(grey, &window, seed, &mut reached, &mut links);
        ThresholdStatistics::new(grey, &reached, &window, grey[seed], memory)
    }

    #[test]
    fn areas_and_borders_are_those_of_the_regions() {
        let mut memory = [0; STATISTICS];
        let statistics = statistics(&mut memory);
        let disc = frame().iter().filter(|&&grey| grey == 100).count() as f64;
        let dark = frame().iter().filter(|&&grey| grey < 800).count() as f64;
        assert_eq!(
            [99, 100, 299].map(|l| statistics.area(l)),
            [0.0, disc, disc]
        );
        assert_eq!([300, 799].map(|l| statistics.area(l)), [dark, dark]);
        assert_eq!(statistics.area(800), (SIDE * SIDE) as f64);
        // Every side of the union but none between its parts leads to the bright background.
        let sharp = statistics.sharpness(300);
        assert!(sharp > 500.0 && sharp < 700.0, "{sharp}");
        // The disc ends at the bridge or the ground.
        assert!((statistics.sharpness(200) - 650.0).abs() < 50.0);
        assert_eq!(statistics.sharpness(800), 0.0);
    }

    /// Thresholds are of the seed's own grey: a frame that is brighter everywhere has them as much higher.
    #[test]
    fn a_brighter_frame_has_thresholds_as_much_higher() {
        // Rings that grow slowly, so that thresholds between the seed and the sharpest border are tried.
        let grey: std::vec::Vec<u16> = (0..SIDE * SIDE)
            .map(|k| {
                let away = libm::hypot((k % SIDE) as f64 - 10.0, (k / SIDE) as f64 - 20.0);
                (50.0 + 6.0 * away + if away > 9.0 { 300.0 } else { 0.0 }) as u16
            })
            .collect();
        let levels = |more: u16| {
            let grey: std::vec::Vec<u16> = grey.iter().map(|value| value + more).collect();
            let mut memory = [0; STATISTICS];
            let levels = statistics_of(&grey, &mut memory).levels([4.0, 600.0]);
            levels
                .iter()
                .map(|level| level - more)
                .collect::<std::vec::Vec<_>>()
        };
        let own = levels(0);
        assert!(own.len() > 2, "{own:?}");
        assert_eq!([levels(100), levels(400)], [own.clone(), own.clone()]);
        let below = own.iter().filter(|&&level| level < own[0]);
        assert!(below.count() > 0 && own[0] >= 150, "{own:?}");
    }

    #[test]
    fn where_a_shutter_ends_a_region_it_has_no_border() {
        let mut memory = [0; STATISTICS];
        let mut grey = frame();
        let behind = (0..SIDE * SIDE).filter(|k| k / SIDE < 5 || k / SIDE >= SIDE - 5);
        behind.for_each(|k| grey[k] = BLOCKED);
        let statistics = statistics_of(&grey, &mut memory);
        let ground = (SIDE * (SIDE - 10)) as f64;
        assert_eq!(
            (statistics.area(800), statistics.sharpness(800)),
            (ground, 0.0)
        );
        assert_eq!(
            statistics.peak([0.0, ground]),
            statistics.peak([0.0, ground - 1.0])
        );
    }

    #[test]
    fn one_threshold_for_each_region_is_tried() {
        let mut memory = [0; STATISTICS];
        let statistics = statistics(&mut memory);
        let levels = statistics.levels([50.0, 1000.0]);
        let mut areas: std::vec::Vec<f64> = levels
            .iter()
            .map(|&level| statistics.area(usize::from(level)))
            .collect();
        areas.sort_by(f64::total_cmp);
        assert_eq!(areas, [statistics.area(100), statistics.area(300)]);
        assert!(statistics.levels([2000.0, 3000.0]).is_empty());
        let sharper = if statistics.sharpness(300) > statistics.sharpness(100) {
            300
        } else {
            100
        };
        // No threshold lets the whole frame in.
        let peak = statistics.peak([0.0, 1000.0]);
        assert_eq!(
            peak.map(|l| statistics.area(l)),
            Some(statistics.area(sharper))
        );
    }
}
