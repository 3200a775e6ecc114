//! All regions that a threshold could cut out of a picture, wherever they lie, and those with the sharpest borders.
//!
//! They are the nodes of the component tree (Najman and Couprie, *Building the component tree in quasi-linear time*, IEEE TIP 15, 2006):
//! cells join in rising order of their levels, and whatever joins becomes the child of the cell that joins it. `one_click` has the one branch
//! that holds a click; here nobody clicked.

use fluoropose::memory::{TooLittleMemory, first};
use fluoropose::shortlist::keep;
use heapless::Vec;

use crate::one_click::window::{BLOCKED, Window};

/// The greatest number of regions that are looked at.
pub(crate) const REGIONS: usize = 48;
/// Regions of which the one holds the other and is at most so many times as large count as one: that with the sharper border stays.
const SAME: f64 = 1.5;

const NONE: u32 = u32::MAX;
/// Arrays of a number for each cell that a tree takes.
const ARRAYS: usize = 7;

/// Numbers that [`DarkRegions::new`] borrows for so many cells.
pub(crate) const fn numbers_needed(cells: usize) -> usize {
    ARRAYS * cells
}

/// The regions of a picture. A region is named by the cell that joined it last.
pub(crate) struct DarkRegions<'m> {
    levels: &'m [u16],
    /// Cells in rising order of their levels; those that are blocked are none.
    order: &'m [u32],
    parent: &'m [u32],
    /// First what finds the root of a cell, then marks.
    marks: &'m mut [u32],
    area: &'m [u32],
    /// Sides between a cell of the region and one outside, and sum of the differences of levels across them.
    sides: &'m [u32],
    contrast: &'m [u32],
    /// Sides beyond which the picture ends.
    open: &'m [u32],
}

impl<'m> DarkRegions<'m> {
    /// Of the levels of all cells of a picture; those that are [`BLOCKED`] are not of it.
    ///
    /// # Errors
    /// [`TooLittleMemory`] where there are fewer than [`numbers_needed`].
    pub(crate) fn new(
        levels: &'m [u16],
        picture: &Window,
        numbers: &'m mut [u32],
    ) -> Result<Self, TooLittleMemory> {
        let cells = levels.len();
        let numbers = first("numbers of regions", numbers_needed(cells), numbers)?;
        let (order, numbers) = numbers.split_at_mut(cells);
        let (parent, numbers) = numbers.split_at_mut(cells);
        let (marks, numbers) = numbers.split_at_mut(cells);
        let (area, numbers) = numbers.split_at_mut(cells);
        let (sides, numbers) = numbers.split_at_mut(cells);
        let (contrast, open) = numbers.split_at_mut(cells);
        let seen = in_rising_order(levels, order);
        let order = &order[..seen];
        join(levels, picture, order, parent, marks);
        area.fill(1);
        count_borders(levels, picture, order, [&mut *sides, contrast, open]);
        for counts in [&mut *area, &mut *sides, &mut *contrast, &mut *open] {
            add_to_parents(counts, order, parent);
        }
        Ok(Self {
            levels,
            order,
            parent,
            marks,
            area,
            sides,
            contrast,
            open,
        })
    }

    /// Mean difference of levels across the border of a region, where what lies beyond the picture is no difference.
    fn sharpness(&self, region: usize) -> f64 {
        let sides = f64::from(self.sides[region]) + f64::from(self.open[region]);
        f64::from(self.contrast[region]) / sides.max(1.0)
    }

    /// The part of a region's border beyond which the picture ends.
    pub(crate) fn cut(&self, region: usize) -> f64 {
        let (sides, open) = (f64::from(self.sides[region]), f64::from(self.open[region]));
        open / (sides + open).max(1.0)
    }

    /// The regions of `least` to `most` cells whose border is sharper than that of any that counts as the same, the sharpest first.
    pub(crate) fn sharpest(&mut self, [least, most]: [f64; 2]) -> Vec<usize, REGIONS> {
        self.marks.fill(0);
        let fits = |area: u32| (least..=most).contains(&f64::from(area));
        for &cell in self.order {
            let cell = cell as usize;
            if !fits(self.area[cell]) || !self.is_whole(cell) {
                self.marks[cell] = 1;
                continue;
            }
            let own = self.sharpness(cell);
            let mut above = self.parent[cell] as usize;
            while self.area.get(above).is_some_and(|&area| {
                fits(area) && f64::from(area) <= SAME * f64::from(self.area[cell])
            }) {
                if self.is_whole(above) {
                    let duller = if self.sharpness(above) > own {
                        cell
                    } else {
                        above
                    };
                    self.marks[duller] = 1;
                }
                above = self.parent[above] as usize;
            }
        }
        let mut best: Vec<(f64, usize), REGIONS> = Vec::new();
        for &cell in self.order {
            let cell = cell as usize;
            if self.marks[cell] == 0 {
                keep(&mut best, (self.sharpness(cell), cell), |&(sharp, _)| {
                    -sharp
                });
            }
        }
        best.into_iter().map(|(_, cell)| cell).collect()
    }

    /// Whether all cells of its level that touch it have joined it.
    fn is_whole(&self, cell: usize) -> bool {
        let above = self.levels.get(self.parent[cell] as usize);
        above.is_none_or(|&level| level > self.levels[cell])
    }

    /// Calls `visit` with each cell of a region.
    pub(crate) fn cells(&mut self, region: usize, mut visit: impl FnMut(usize)) {
        self.marks.fill(0);
        self.marks[region] = 1;
        for &cell in self.order.iter().rev() {
            let cell = cell as usize;
            if self.marks.get(self.parent[cell] as usize) == Some(&1) {
                self.marks[cell] = 1;
            }
            if self.marks[cell] == 1 {
                visit(cell);
            }
        }
    }
}

/// Writes the cells that are of the picture in rising order of their levels; returns their number.
fn in_rising_order(levels: &[u16], order: &mut [u32]) -> usize {
    let mut seen = 0;
    for (cell, _) in levels
        .iter()
        .enumerate()
        .filter(|(_, level)| **level != BLOCKED)
    {
        order[seen] = cell as u32;
        seen += 1;
    }
    order[..seen].sort_unstable_by_key(|&cell| (levels[cell as usize], cell));
    seen
}

/// Writes for each cell the one that joined it with others; none for the last.
fn join(levels: &[u16], picture: &Window, order: &[u32], parent: &mut [u32], roots: &mut [u32]) {
    parent.fill(NONE);
    roots.fill(NONE);
    for &cell in order {
        roots[cell as usize] = cell;
        picture.neighbours(cell as usize, |next| {
            if levels[next] == BLOCKED || roots[next] == NONE {
                return;
            }
            let root = root_of(roots, next as u32);
            if root != cell {
                roots[root as usize] = cell;
                parent[root as usize] = cell;
            }
        });
    }
}

/// Counts, for each cell that is of the picture, the sides that its region's border has more than those of the regions in it (wrapping below 0), the
/// differences of levels across them, and the sides beyond which the picture ends.
fn count_borders(
    levels: &[u16],
    picture: &Window,
    order: &[u32],
    [sides, contrast, open]: [&mut [u32]; 3],
) {
    for counts in [&mut *sides, &mut *contrast, &mut *open] {
        counts.fill(0);
    }
    for &cell in order {
        let cell = cell as usize;
        let mut inner = 0;
        picture.neighbours(cell, |next| {
            if levels[next] == BLOCKED {
                return;
            }
            inner += 1;
            // A side is the border's of all regions that hold the one cell, up to those that hold the other too.
            let step = levels[next].checked_sub(levels[cell]);
            if let Some(step) = step.filter(|&step| step > 0).map(u32::from) {
                sides[cell] = sides[cell].wrapping_add(1);
                contrast[cell] = contrast[cell].wrapping_add(step);
                sides[next] = sides[next].wrapping_sub(1);
                contrast[next] = contrast[next].wrapping_sub(step);
            }
        });
        open[cell] = 4 - inner;
    }
}

/// Adds what was counted for each region to the one that holds it, the smallest first.
fn add_to_parents(counts: &mut [u32], order: &[u32], parent: &[u32]) {
    for &cell in order {
        let own = counts[cell as usize];
        if let Some(above) = counts.get_mut(parent[cell as usize] as usize) {
            *above = above.wrapping_add(own);
        }
    }
}

/// The root of what a cell has joined, to which the way is shortened.
fn root_of(roots: &mut [u32], mut cell: u32) -> u32 {
    while roots[cell as usize] != cell {
        let above = roots[roots[cell as usize] as usize];
        roots[cell as usize] = above;
        cell = above;
    }
    cell
}

#[cfg(test)]
mod tests {
    use super::*;

    const WIDTH: usize = 9;
    const HEIGHT: usize = 7;
    const PICTURE: Window = Window {
        left: 0,
        top: 0,
        width: WIDTH,
        height: HEIGHT,
    };

    fn levels(seed: u64) -> std::vec::Vec<u16> {
        let mut state = seed.wrapping_mul(6_364_136_223_846_793_005) + 1;
        let mut draw = move || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 40) as u16 % 8
        };
        let level = |level| if level == 7 { BLOCKED } else { level };
        (0..WIDTH * HEIGHT).map(|_| level(draw())).collect()
    }

    /// Oracle: the cells that a threshold leaves around one, found step by step, with sides, contrast and sides beyond the picture.
    fn around(levels: &[u16], start: usize) -> (std::vec::Vec<usize>, [u32; 3]) {
        let threshold = levels[start];
        let mut cells = std::vec![start];
        let mut at = 0;
        while let Some(&cell) = cells.get(at) {
            PICTURE.neighbours(cell, |next| {
                if levels[next] <= threshold && !cells.contains(&next) {
                    cells.push(next);
                }
            });
            at += 1;
        }
        cells.sort_unstable();
        let mut sums = [0, 0, 4 * cells.len() as u32];
        for &cell in &cells {
            PICTURE.neighbours(cell, |next| {
                if levels[next] != BLOCKED {
                    sums[2] -= 1;
                }
                if levels[next] != BLOCKED && !cells.contains(&next) {
                    sums[0] += 1;
                    sums[1] += u32::from(levels[next] - levels[cell]);
                }
            });
        }
        (cells, sums)
    }

    #[test]
    fn every_region_of_every_threshold_is_a_node_with_its_border() {
        let mut whole = 0;
        for seed in 0..200 {
            let levels = levels(seed);
            let mut numbers = std::vec![0; numbers_needed(levels.len())];
            let mut tree = DarkRegions::new(&levels, &PICTURE, &mut numbers).expect("enough");
            for cell in (0..levels.len()).filter(|&cell| levels[cell] != BLOCKED) {
                if !tree.is_whole(cell) {
                    continue;
                }
                whole += 1;
                let (cells, sums) = around(&levels, cell);
                let mut own = std::vec::Vec::new();
                tree.cells(cell, |cell| own.push(cell));
                own.sort_unstable();
                assert_eq!(own, cells, "seed {seed}");
                assert_eq!(tree.area[cell] as usize, cells.len());
                assert_eq!(
                    [tree.sides[cell], tree.contrast[cell], tree.open[cell]],
                    sums,
                    "seed {seed}"
                );
            }
        }
        assert!(whole > 1000, "{whole}");
        let levels = levels(0);
        let few = &mut std::vec![0; numbers_needed(levels.len()) - 1];
        assert!(DarkRegions::new(&levels, &PICTURE, few).is_err());
    }

    #[test]
    fn of_regions_that_count_as_one_the_sharpest_stays() {
        // A block of 3 x 3 on a rim that is a little brighter, before bright cells.
        let levels: std::vec::Vec<u16> = (0..WIDTH * HEIGHT)
            .map(
                |k| match ((k % WIDTH).abs_diff(4), (k / WIDTH).abs_diff(3)) {
                    (0..=1, 0..=1) => 10,
                    (2, 0) => 20,
                    _ => 100,
                },
            )
            .collect();
        let mut numbers = std::vec![0; numbers_needed(levels.len())];
        let mut tree = DarkRegions::new(&levels, &PICTURE, &mut numbers).expect("enough");
        let found = tree.sharpest([4.0, 30.0]);
        assert_eq!(found.len(), 1);
        let mut cells = 0;
        tree.cells(found[0], |_| cells += 1);
        assert_eq!(cells, 11);
        assert!(tree.sharpest([12.0, 30.0]).is_empty());
    }

    #[test]
    fn the_part_of_a_border_that_the_picture_cuts_off_is_told() {
        // Three cells of a corner: of eight sides three are the picture's, and one is against what is blocked.
        let mut levels = [9; WIDTH * HEIGHT];
        for (cell, level) in [(0, 1), (1, 1), (WIDTH, 1), (2, BLOCKED)] {
            levels[cell] = level;
        }
        let mut numbers = std::vec![0; numbers_needed(levels.len())];
        let mut tree = DarkRegions::new(&levels, &PICTURE, &mut numbers).expect("enough");
        let corner = tree.sharpest([3.0, 3.0])[0];
        let (_, [sides, contrast, open]) = around(&levels, 0);
        assert_eq!([sides, contrast, open], [3, 24, 5]);
        assert_eq!(tree.cut(corner), 5.0 / 8.0);
        assert_eq!(tree.sharpness(corner), 3.0);
    }
}
