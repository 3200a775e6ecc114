//! Palettes: stored values that are numbers of colours.

use super::problem::{FORMAT, damaged};
use super::tags::{PALETTE_ENTRIES, PALETTE_SHAPES};
use super::values::Values;
use crate::error::Problem;
use crate::luminance::luminance;

/// The luminance of each number.
#[derive(Debug, PartialEq)]
pub(super) struct Palette {
    /// The stored value of the first entry. Lower ones have its colour, and those above the last that of the last.
    first: i32,
    entries: Vec<u16>,
    /// Bits of an entry, 8 or 16.
    pub bits: u16,
}

impl Palette {
    /// Reads the tables of red, green and blue. `signed` is whether stored values are.
    pub(super) fn read(values: Values<'_>, signed: bool) -> Result<Self, Problem> {
        let shapes = PALETTE_SHAPES.map(|tag| values.numbers(tag).unwrap_or_default());
        let &[count, first, bits] = shapes[0].as_slice() else {
            return Err(damaged("it does not say the shape of its palette"));
        };
        if shapes[1] != shapes[0] || shapes[2] != shapes[0] || !matches!(bits, 8.0 | 16.0) {
            return Err(damaged(
                "the three tables of its palette are of different shapes",
            ));
        }
        // The number of entries takes 16 bits, and 0 stands for one more than they hold.
        let count = if count == 0.0 { 65_536 } else { count as usize };
        let tables = PALETTE_ENTRIES.map(|tag| values.table(tag, count));
        let [Some(red), Some(green), Some(blue)] = tables else {
            let what = "a palette in segments or without entries";
            return Err(Problem::unsupported(
                FORMAT,
                what,
                "Export it as MONOCHROME2 or RGB",
            ));
        };
        let entries: Vec<u16> = red
            .iter()
            .zip(&green)
            .zip(&blue)
            .take(count)
            .map(|((&r, &g), &b)| luminance(r, g, b))
            .collect();
        if entries.len() < count {
            return Err(damaged(format!(
                "its palette has {} of {count} entries",
                entries.len()
            )));
        }
        let first = if signed {
            (first as u16).cast_signed().into()
        } else {
            first as i32
        };
        Ok(Self {
            first,
            entries,
            bits: bits as u16,
        })
    }

    /// The luminance of a stored value.
    pub(super) fn luminance(&self, value: i32) -> u16 {
        let last = self.entries.len() - 1;
        let place = usize::try_from(value.saturating_sub(self.first)).unwrap_or(0);
        self.entries[place.min(last)]
    }
}
