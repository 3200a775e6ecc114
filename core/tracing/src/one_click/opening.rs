//! One region: cut out at a threshold, opened with a disc, its small holes filled.
//!
//! The opening cuts bridges: what is nowhere as wide as the disc is removed, and of what remains the part nearest to the
//! seed stays. Distances are those of the chamfer 3-4 (Borgefors, *Distance transformations in digital images*, CVGIP 34,
//! 1986).

use super::window::{Window, step_between};
use fluoropose::image::mask::MaskMut;

/// Chamfer lengths of a step to the side, and across a corner.
const SIDE: u16 = 3;
const CORNER: u16 = 4;

/// Flags of a pixel: at or below the threshold; kept by the opening; outside of the region and connected with the window's
/// border; in a hole that was measured.
const LEVEL: u8 = 1;
const KEPT: u8 = 2;
const OUTSIDE: u8 = 4;
const HOLE: u8 = 8;

/// Holes smaller than this fraction of the region are filled.
const SPECK: f64 = 0.02;

/// An opening, with working memory of one number for each pixel of the window.
pub(super) struct Opening<'m> {
    pub(super) window: Window,
    pub(super) reached: &'m [u16],
    pub(super) distance: &'m mut [u16],
    pub(super) marks: &'m mut [u8],
    pub(super) stack: &'m mut [u32],
}

impl Opening<'_> {
    /// Draws the region of a threshold around `seed`, opened with a disc of `radius` pixels, to `region`, and what the
    /// opening removed to `doubt`. Both are masks of the frame.
    pub(super) fn draw(
        &mut self,
        seed: usize,
        level: u16,
        radius: f64,
        region: &mut MaskMut<'_>,
        doubt: &mut MaskMut<'_>,
    ) {
        for (mark, &reached) in self.marks.iter_mut().zip(self.reached) {
            *mark = if reached <= level { LEVEL } else { 0 };
        }
        if radius > 0.0 {
            self.open(seed, Self::length(radius));
        } else {
            for mark in self.marks.iter_mut().filter(|mark| **mark & LEVEL != 0) {
                *mark |= KEPT;
            }
        }
        self.fill_specks();
        region.clear();
        doubt.clear();
        for (row, marks) in self.marks.chunks(self.window.width).enumerate() {
            let row = self.window.top + row;
            for (column, &mark) in marks.iter().enumerate() {
                if mark & KEPT != 0 {
                    region.set(self.window.left + column, row, true);
                } else if mark & LEVEL != 0 {
                    doubt.set(self.window.left + column, row, true);
                }
            }
        }
    }

    /// Keeps what is covered by discs that fit into the region and are connected with the disc nearest to the seed.
    fn open(&mut self, seed: usize, reach: u16) {
        self.measure(|mark| mark & LEVEL == 0);
        let Some(start) = self.nearest_core(seed, reach) else {
            return;
        };
        self.flood(start, [LEVEL | KEPT, LEVEL], KEPT, reach);
        self.measure(|mark| mark & KEPT != 0);
        for (mark, &distance) in self.marks.iter_mut().zip(&*self.distance) {
            if *mark & LEVEL != 0 && distance <= reach {
                *mark |= KEPT;
            }
        }
    }

    /// A length in pixels as `distance` holds it.
    fn length(pixels: f64) -> u16 {
        (pixels * f64::from(SIDE)) as u16
    }

    /// The pixel at or below a threshold that is farthest from all pixels above it and from the window's border; `None`
    /// where there is no such pixel.
    pub(super) fn thickest(&mut self, level: u16) -> Option<usize> {
        for (mark, &grey) in self.marks.iter_mut().zip(self.reached) {
            *mark = if grey <= level { LEVEL } else { 0 };
        }
        for index in border(&self.window) {
            if let Some(mark) = self.marks.get_mut(index) {
                *mark = 0;
            }
        }
        self.measure(|mark| mark & LEVEL == 0);
        let deepest = self
            .distance
            .iter()
            .enumerate()
            .max_by_key(|&(_, distance)| distance);
        deepest
            .filter(|&(_, &distance)| distance > 0)
            .map(|(index, _)| index)
    }

    /// The pixel nearest to the seed that lies deeper than `reach`.
    fn nearest_core(&self, seed: usize, reach: u16) -> Option<usize> {
        let (column, row) = self.window.place(seed);
        let away = |&index: &usize| {
            let (c, r) = self.window.place(index);
            let (c, r) = (c.abs_diff(column), r.abs_diff(row));
            c * c + r * r
        };
        let deep = |index: &usize| {
            let inside = self.marks.get(*index).is_some_and(|mark| mark & LEVEL != 0);
            inside && self.distance.get(*index).is_some_and(|&d| d > reach)
        };
        (0..self.window.pixels()).filter(deep).min_by_key(away)
    }

    /// Writes the chamfer distance to the nearest pixel for which `is_source` is true. There is none beyond the window.
    fn measure(&mut self, is_source: impl Fn(u8) -> bool) {
        for (distance, &mark) in self.distance.iter_mut().zip(&*self.marks) {
            *distance = if is_source(mark) { 0 } else { u16::MAX };
        }
        let (width, pixels) = (self.window.width, self.window.pixels());
        for first in (0..pixels).step_by(width) {
            let (above, rest) = self.distance.split_at_mut(first);
            let row = rest.get_mut(..width).unwrap_or_default();
            step_from(
                row,
                above.get(first.wrapping_sub(width)..).unwrap_or_default(),
            );
            step_along(row.iter_mut());
        }
        for first in (0..pixels).step_by(width).rev() {
            let (rest, below) = self.distance.split_at_mut(first + width);
            let row = rest.get_mut(first..).unwrap_or_default();
            step_from(row, below.get(..width).unwrap_or_default());
            step_along(row.iter_mut().rev());
        }
    }

    /// Sets the flag `set` on all pixels connected with `start` whose flags `of` are `are` and which, unless `reach` is 0,
    /// lie deeper than `reach`. Returns their number.
    fn flood(&mut self, start: usize, [of, are]: [u8; 2], set: u8, reach: u16) -> usize {
        let width = self.window.width;
        let (marks, stack) = (&mut *self.marks, &mut *self.stack);
        let distance = &*self.distance;
        let is_open = |marks: &[u8], pixel: usize| {
            let deep = reach == 0 || distance.get(pixel).is_some_and(|&d| d > reach);
            deep && marks.get(pixel).is_some_and(|&mark| mark & of == are)
        };
        let (mut count, mut waiting) = (0, 0);
        // Each pixel waits once at most, so there is room.
        let enter = |pixel: usize, marks: &mut [u8], stack: &mut [u32], waiting: &mut usize| {
            if let (Some(mark), Some(place)) = (marks.get_mut(pixel), stack.get_mut(*waiting)) {
                *mark |= set;
                *place = pixel as u32;
                *waiting += 1;
            }
        };
        if is_open(marks, start) {
            enter(start, marks, stack, &mut waiting);
            count += 1;
        }
        while waiting > 0 {
            waiting -= 1;
            let pixel = stack.get(waiting).copied().unwrap_or(0) as usize;
            let first = pixel - self.window.place(pixel).0;
            // What is open to both sides of it in its row, which is entered at once.
            let mut run = pixel..pixel + 1;
            while run.start > first && is_open(marks, run.start - 1) {
                run.start -= 1;
            }
            while run.end < first + width && is_open(marks, run.end) {
                run.end += 1;
            }
            for index in run.clone().filter(|&index| index != pixel) {
                if let Some(mark) = marks.get_mut(index) {
                    *mark |= set;
                }
            }
            count += run.len() - 1;
            // Of the runs beside it in the rows above and below one pixel each waits.
            let above = first.checked_sub(width).map(|_| width);
            let below = (first + width < self.window.pixels()).then_some(width);
            for (row, up) in [(above, true), (below, false)] {
                let Some(row) = row else { continue };
                let beside = |index: usize| if up { index - row } else { index + row };
                let mut before = false;
                for index in run.clone() {
                    let next = beside(index);
                    let open = is_open(marks, next);
                    if open && !before {
                        enter(next, marks, stack, &mut waiting);
                        count += 1;
                    }
                    before = open;
                }
            }
        }
        count
    }

    /// Fills small holes, which noise makes and no implant has.
    fn fill_specks(&mut self) {
        for index in border(&self.window) {
            self.flood(index, [KEPT | OUTSIDE, 0], OUTSIDE, 0);
        }
        let area = self.marks.iter().filter(|mark| **mark & KEPT != 0).count();
        let covered = KEPT | OUTSIDE | HOLE;
        for index in 0..self.window.pixels() {
            if self.marks.get(index).is_none_or(|mark| mark & covered != 0) {
                continue;
            }
            let hole = self.flood(index, [covered, 0], HOLE, 0);
            if (hole as f64) < SPECK * area as f64 {
                self.flood(index, [HOLE | KEPT, HOLE], KEPT, 0);
            }
        }
    }
}

/// The pixels along the sides of a window; those in its corners may come twice.
fn border(window: &Window) -> impl Iterator<Item = usize> + use<> {
    let (width, pixels) = (window.width, window.pixels());
    let sides = (0..pixels).step_by(width);
    let ends = (0..width).chain(pixels.saturating_sub(width)..pixels);
    ends.chain(sides.flat_map(move |first| [first, first + width - 1]))
}

/// Lowers the distances of a row to what a step from the row beside it leads to; that is empty where there is none.
fn step_from(row: &mut [u16], beside: &[u16]) {
    let lower = |row: &mut [u16], beside: &[u16], step: u16| {
        for (here, there) in row.iter_mut().zip(beside) {
            *here = (*here).min(there.saturating_add(step));
        }
    };
    lower(row, beside, SIDE);
    lower(row, beside.get(1..).unwrap_or_default(), CORNER);
    lower(row.get_mut(1..).unwrap_or_default(), beside, CORNER);
}

/// Lowers the distances of a row to what steps from one to the next lead to.
fn step_along<'d>(row: impl Iterator<Item = &'d mut u16>) {
    let mut last = u16::MAX;
    for here in row {
        *here = (*here).min(last.saturating_add(SIDE));
        last = *here;
    }
}

/// Mean difference of levels across the border of the region that was drawn last, given by its `marks`.
pub(super) fn sharpness(window: &Window, grey: &[u16], marks: &[u8]) -> f64 {
    let (mut sides, mut sum) = (0u64, 0i64);
    for (index, _) in marks
        .iter()
        .enumerate()
        .filter(|(_, mark)| **mark & KEPT != 0)
    {
        window.neighbours(index, |next| {
            let outside = marks.get(next).is_some_and(|mark| mark & KEPT == 0);
            if outside {
                sides += 1;
                sum += i64::from(step_between(grey, index, next));
            }
        });
    }
    sum as f64 / sides.max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use fluoropose::image::mask::{Mask, words_needed};

    const WIDTH: usize = 64;
    const HEIGHT: usize = 40;

    /// Two blocks joined by a bar 3 px thick, the left one with a speck and a hole.
    fn dark(column: usize, row: usize) -> bool {
        let block =
            |left: usize, right: usize| (left..right).contains(&column) && (8..32).contains(&row);
        let bar = (26..40).contains(&column) && (18..21).contains(&row);
        let speck = column == 12 && row == 12;
        let hole = (14..20).contains(&column) && (20..26).contains(&row);
        (block(4, 26) || block(40, 60) || bar) && !speck && !hole
    }

    fn opened(radius: f64, seed: (usize, usize)) -> [std::vec::Vec<u32>; 2] {
        let window = Window {
            left: 0,
            top: 0,
            width: WIDTH,
            height: HEIGHT,
        };
        let reached: std::vec::Vec<u16> = (0..WIDTH * HEIGHT)
            .map(|k| if dark(k % WIDTH, k / WIDTH) { 7 } else { 500 })
            .collect();
        let mut opening = Opening {
            window,
            reached: &reached,
            distance: &mut std::vec![0; reached.len()],
            marks: &mut std::vec![0; reached.len()],
            stack: &mut std::vec![0; reached.len()],
        };
        let mut words = [(); 2].map(|()| std::vec![0; words_needed(WIDTH, HEIGHT)]);
        let [region, doubt] = &mut words;
        let mut region = MaskMut::new(region, WIDTH, HEIGHT).expect("fits");
        let mut doubt = MaskMut::new(doubt, WIDTH, HEIGHT).expect("fits");
        let seed = seed.1 * WIDTH + seed.0;
        opening.draw(seed, 7, radius, &mut region, &mut doubt);
        words
    }

    #[test]
    fn without_a_radius_the_region_stays_but_for_specks() {
        let [region, doubt] = opened(0.0, (5, 10));
        let region = Mask::new(&region, WIDTH, HEIGHT).expect("valid");
        for (column, row) in (0..WIDTH * HEIGHT).map(|k| (k % WIDTH, k / WIDTH)) {
            let filled = dark(column, row) || (column, row) == (12, 12);
            assert_eq!(region.get(column, row), filled, "{column} {row}");
        }
        assert!(doubt.iter().all(|&word| word == 0));
    }

    #[test]
    fn a_bridge_is_cut_on_the_side_of_the_seed() {
        for (seed, other) in [((6, 10), (50, 20)), ((50, 20), (6, 10))] {
            let [region, doubt] = opened(2.0, seed);
            let region = Mask::new(&region, WIDTH, HEIGHT).expect("valid");
            let doubt = Mask::new(&doubt, WIDTH, HEIGHT).expect("valid");
            assert!(region.get(seed.0, seed.1) && !region.get(other.0, other.1));
            // Between the blocks and in the other one nothing is certain.
            assert!(doubt.get(33, 19) && doubt.get(other.0, other.1));
            assert!(!region.get(33, 19) && !doubt.get(33, 10));
        }
    }

    fn random(seed: u64, of: u64) -> std::vec::Vec<u8> {
        let mut state = seed;
        let mut next = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 33) % of
        };
        (0..WIDTH * HEIGHT).map(|_| next() as u8).collect()
    }

    /// Oracle: steps from pixel to pixel until nothing changes.
    fn naive_distance(sources: &[bool]) -> std::vec::Vec<u16> {
        let far = |&source: &bool| if source { 0 } else { u16::MAX };
        let mut distance: std::vec::Vec<u16> = sources.iter().map(far).collect();
        loop {
            let before = distance.clone();
            for (index, here) in distance.iter_mut().enumerate() {
                let (column, row) = (index % WIDTH, index / WIDTH);
                for (c, r) in (0..9).map(|k| (column + k % 3, row + k / 3)) {
                    if (1..=WIDTH).contains(&c) && (1..=HEIGHT).contains(&r) {
                        let across = c != column + 1 && r != row + 1;
                        let step = if across { CORNER } else { SIDE };
                        let there = before[(r - 1) * WIDTH + c - 1].saturating_add(step);
                        *here = (*here).min(there);
                    }
                }
            }
            if distance == before {
                return distance;
            }
        }
    }

    #[test]
    fn distances_and_floods_are_those_of_the_definition() {
        let window = Window {
            left: 0,
            top: 0,
            width: WIDTH,
            height: HEIGHT,
        };
        for seed in 0..12 {
            // From a few sources to a maze.
            let marks = random(seed, 2 + seed % 4);
            let marks: std::vec::Vec<u8> = marks.iter().map(|&k| u8::from(k == 0)).collect();
            let sources: std::vec::Vec<bool> = marks.iter().map(|&mark| mark == 0).collect();
            let mut opening = Opening {
                window,
                reached: &[],
                distance: &mut std::vec![0; marks.len()],
                marks: &mut marks.clone(),
                stack: &mut std::vec![0; marks.len()],
            };
            opening.measure(|mark| mark == 0);
            assert_eq!(opening.distance, naive_distance(&sources));
            for start in [0, 100, 1000, marks.len() - 1] {
                for reach in [0, SIDE] {
                    opening.marks.copy_from_slice(&marks);
                    let count = opening.flood(start, [LEVEL | KEPT, LEVEL], KEPT, reach);
                    let open = |index: usize| {
                        marks[index] == LEVEL && (reach == 0 || opening.distance[index] > reach)
                    };
                    let mut joined = std::vec![false; marks.len()];
                    joined[start] = open(start);
                    while {
                        let before = joined.clone();
                        for (index, is_in) in joined.iter_mut().enumerate() {
                            window.neighbours(index, |next| {
                                *is_in |= before[next] && open(index);
                            });
                        }
                        joined != before
                    } {}
                    let kept: std::vec::Vec<bool> =
                        opening.marks.iter().map(|mark| mark & KEPT != 0).collect();
                    assert_eq!(kept, joined, "seed {seed}, start {start}, reach {reach}");
                    assert_eq!(count, joined.iter().filter(|is_in| **is_in).count());
                }
            }
        }
    }

    #[test]
    fn where_no_disc_fits_nothing_is_kept() {
        let [region, doubt] = opened(20.0, (6, 10));
        assert!(region.iter().all(|&word| word == 0));
        let doubt = Mask::new(&doubt, WIDTH, HEIGHT).expect("valid");
        assert!(doubt.get(6, 10));
    }

    #[test]
    fn the_sharpness_of_a_region_is_the_mean_step_across_its_border() {
        let window = Window {
            left: 0,
            top: 0,
            width: 4,
            height: 1,
        };
        // What is not kept may be marked otherwise; the frame's end is no border.
        let marks = [KEPT, KEPT | !KEPT, !KEPT, 0];
        assert_eq!(sharpness(&window, &[10, 12, 40, 90], &marks), 28.0);
        assert_eq!(
            sharpness(&window, &[10, 12, 40, 90], &[0, KEPT, 0, 0]),
            (28.0 - 2.0) / 2.0
        );
        assert_eq!(sharpness(&window, &[10, 12, 40, 90], &[0; 4]), 0.0);
    }
}
