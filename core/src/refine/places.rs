//! Which pixels of a frame are samples of an outline, and which sample each is.
//!
//! Samples are listed row by row, and from left to right in a row: it is enough to know where each row begins in the list. A row
//! has few of them.

use core::ops::Range;

use super::border::BorderPixel;

/// Numbers that [`super::RefineMemory::places`] has for a frame of so many rows.
#[must_use]
pub const fn places_needed(rows: usize) -> usize {
    rows + 1
}

/// Places of samples in the rows of a frame.
pub(super) struct Places<'p> {
    /// How many samples come before each of the rows, and how many there are.
    before: &'p mut [u16],
    rows: Range<usize>,
}

/// Samples of a row, or of three beside each other, that are sooner looked at than searched.
const FEW: usize = 24;

impl<'p> Places<'p> {
    /// No sample yet in some rows of a frame. `memory` is [`places_needed`] numbers of any value.
    pub(super) fn new(memory: &'p mut [u16], rows: Range<usize>) -> Self {
        let before = memory.get_mut(..places_needed(rows.len()));
        Self {
            before: before.unwrap_or_default(),
            rows,
        }
    }

    /// Says how many samples come before a row, or before the one after the last: rows one after the other.
    pub(super) fn begin(&mut self, row: usize, samples: usize) {
        let at = row.wrapping_sub(self.rows.start);
        if let Some(before) = self.before.get_mut(at) {
            *before = samples.min(usize::from(u16::MAX)) as u16;
        }
    }

    /// Calls `visit` with the samples of a list that are in a row's columns.
    #[inline]
    pub(super) fn within(
        &self,
        samples: &mut [BorderPixel],
        row: usize,
        columns: Range<usize>,
        mut visit: impl FnMut(&mut BorderPixel),
    ) {
        let at = row.wrapping_sub(self.rows.start);
        if let Some(&[first, end]) = self.before.get(at..).and_then(<[u16]>::first_chunk) {
            let own = samples.get_mut(usize::from(first)..usize::from(end));
            visit_columns(own.unwrap_or_default(), &columns, &mut visit);
        }
    }

    /// The same of the samples in a pixel and beside it.
    #[inline]
    pub(super) fn around(
        &self,
        samples: &mut [BorderPixel],
        [column, row]: [usize; 2],
        mut visit: impl FnMut(&mut BorderPixel),
    ) {
        let columns = column.saturating_sub(1)..column + 2;
        // One number more than there are rows.
        let (before, rows) = (&*self.before, self.rows.len());
        let first = row.saturating_sub(1 + self.rows.start);
        let end = (row + 2).saturating_sub(self.rows.start).min(rows);
        let (Some(&all), Some(&after)) = (before.get(first), before.get(end)) else {
            return;
        };
        let own = samples.get_mut(usize::from(all)..usize::from(after));
        let own = own.unwrap_or_default();
        if own.len() <= FEW {
            for sample in own {
                let right = usize::from(sample.column).wrapping_sub(columns.start);
                if right < columns.len() {
                    visit(sample);
                }
            }
            return;
        }
        let ends = before.get(first..end + 1).unwrap_or_default();
        for ends in ends.windows(2) {
            let own = samples.get_mut(usize::from(ends[0])..usize::from(ends[1]));
            visit_columns(own.unwrap_or_default(), &columns, &mut visit);
        }
    }
}

/// Calls `visit` with those of a row's samples that are in some columns.
#[inline(always)]
fn visit_columns(
    own: &mut [BorderPixel],
    columns: &Range<usize>,
    visit: &mut impl FnMut(&mut BorderPixel),
) {
    // Most rows have a few, some have all of a flat side.
    let first = match own.len() {
        ..=FEW => 0,
        _ => own.partition_point(|sample| usize::from(sample.column) < columns.start),
    };
    for sample in own.get_mut(first..).unwrap_or_default() {
        let column = usize::from(sample.column);
        if column >= columns.end {
            return;
        }
        if column >= columns.start {
            visit(sample);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::vec::Vec;

    const WIDTH: usize = 100;
    const HEIGHT: usize = 9;

    properties! {
        #[test]
        fn samples_are_those_that_a_list_has(
            mut samples in proptest::collection::btree_set((2..7usize, 0..WIDTH), 0..300),
            row in 0..HEIGHT, from in 0..WIDTH, length in 0..WIDTH,
        ) {
            // What the memory held before does not matter.
            let mut memory = [77; places_needed(HEIGHT)];
            let mut places = Places::new(&mut memory, 2..7);
            samples.insert((6, WIDTH - 1));
            for row in 2..=7 {
                places.begin(row, samples.iter().filter(|at| at.0 < row).count());
            }
            let mut list: Vec<BorderPixel> = samples
                .iter()
                .map(|&(row, column)| BorderPixel {
                    column: column as u16,
                    row: row as u16,
                    ..BorderPixel::EMPTY
                })
                .collect();
            let columns = from..(from + length).min(WIDTH);
            places.within(&mut list, row, columns.clone(), |sample| sample.cover(1.0));
            for (sample, at) in list.iter().zip(&samples) {
                prop_assert_eq!(sample.is_on_surface(), at.0 == row && columns.contains(&at.1));
            }
        }
    }
}
