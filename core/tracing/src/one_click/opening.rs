//! One region: cut out at a threshold, opened with a disc, its small holes filled.
//!
//! The opening cuts bridges: what is nowhere as wide as the disc is removed, and of what remains the part nearest to the
//! seed stays. Distances are those of the chamfer 3-4 (Borgefors, *Distance transformations in digital images*, CVGIP 34,
//! 1986).

use super::window::{LEVELS, Window};
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
        for (index, &mark) in self.marks.iter().enumerate() {
            let (column, row) = self.window.place(index);
            let (column, row) = (self.window.left + column, self.window.top + row);
            if mark & KEPT != 0 {
                region.set(column, row, true);
            } else if mark & LEVEL != 0 {
                doubt.set(column, row, true);
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
        let (width, height) = (self.window.width, self.window.height);
        for index in 0..self.window.pixels() {
            let (column, row) = self.window.place(index);
            let inner = column > 0 && row > 0 && column + 1 < width && row + 1 < height;
            let dark = self.reached.get(index).is_some_and(|&grey| grey <= level);
            if let Some(mark) = self.marks.get_mut(index) {
                *mark = if inner && dark { LEVEL } else { 0 };
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
        let (width, height) = (self.window.width, self.window.height);
        let mut relax = |column: usize, row: usize, up: bool| {
            let other = if up { row.wrapping_sub(1) } else { row + 1 };
            let beside = if up {
                column.wrapping_sub(1)
            } else {
                column + 1
            };
            let index = row * width + column;
            let near = [
                (beside, row, SIDE),
                (column, other, SIDE),
                (column.wrapping_sub(1), other, CORNER),
                (column + 1, other, CORNER),
            ];
            let mut least = self.distance.get(index).copied().unwrap_or(0);
            for (column, row, step) in near {
                if column < width && row < height {
                    let there = self.distance.get(row * width + column).copied();
                    least = least.min(there.unwrap_or(u16::MAX).saturating_add(step));
                }
            }
            if let Some(place) = self.distance.get_mut(index) {
                *place = least;
            }
        };
        for row in 0..height {
            (0..width).for_each(|column| relax(column, row, true));
        }
        for row in (0..height).rev() {
            (0..width)
                .rev()
                .for_each(|column| relax(column, row, false));
        }
    }

    /// Sets the flag `set` on all pixels connected with `start` whose flags `of` are `are` and which, unless `reach` is 0,
    /// lie deeper than `reach`. Returns their number.
    fn flood(&mut self, start: usize, [of, are]: [u8; 2], set: u8, reach: u16) -> usize {
        let (marks, stack) = (&mut *self.marks, &mut *self.stack);
        let (distance, window) = (&*self.distance, self.window);
        let (mut count, mut waiting) = (0, 0);
        let mut enter = |pixel: usize, stack: &mut [u32], waiting: &mut usize| {
            let deep = reach == 0 || distance.get(pixel).is_some_and(|&d| d > reach);
            let mark = marks.get_mut(pixel).filter(|mark| **mark & of == are);
            // Each pixel waits once at most, so there is room.
            if let (true, Some(mark), Some(place)) = (deep, mark, stack.get_mut(*waiting)) {
                *mark |= set;
                *place = pixel as u32;
                *waiting += 1;
                count += 1;
            }
        };
        enter(start, stack, &mut waiting);
        while waiting > 0 {
            waiting -= 1;
            let pixel = stack.get(waiting).copied().unwrap_or(0) as usize;
            window.neighbours(pixel, |next| enter(next, stack, &mut waiting));
        }
        count
    }

    /// Fills small holes, which noise makes and no implant has.
    fn fill_specks(&mut self) {
        let (width, height) = (self.window.width, self.window.height);
        for index in 0..self.window.pixels() {
            let (column, row) = self.window.place(index);
            if column == 0 || row == 0 || column + 1 == width || row + 1 == height {
                self.flood(index, [KEPT | OUTSIDE, 0], OUTSIDE, 0);
            }
        }
        let area = self.marks.iter().filter(|mark| **mark & KEPT != 0).count();
        for index in 0..self.window.pixels() {
            let hole = self.flood(index, [KEPT | OUTSIDE | HOLE, 0], HOLE, 0);
            if hole > 0 && (hole as f64) < SPECK * area as f64 {
                self.flood(index, [HOLE | KEPT, HOLE], KEPT, 0);
            }
        }
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
            let step = |pixel: usize| grey.get(pixel).copied().unwrap_or(0).min(LEVELS as u16);
            if outside {
                sides += 1;
                sum += i64::from(step(next)) - i64::from(step(index));
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

    #[test]
    fn where_no_disc_fits_nothing_is_kept() {
        let [region, doubt] = opened(20.0, (6, 10));
        assert!(region.iter().all(|&word| word == 0));
        let doubt = Mask::new(&doubt, WIDTH, HEIGHT).expect("valid");
        assert!(doubt.get(6, 10));
    }
}
