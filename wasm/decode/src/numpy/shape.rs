//! What the axes of an array are.

use super::problem::not_read;
use crate::error::Problem;

/// How many there are, and from one to the next, numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Axis {
    pub(super) count: usize,
    pub(super) step: usize,
}

impl Axis {
    const ONE: Self = Self { count: 1, step: 0 };
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Shape {
    pub(super) frames: Axis,
    pub(super) rows: Axis,
    pub(super) columns: Axis,
    pub(super) channels: Axis,
}

impl Shape {
    /// Rows and columns; frames before them, and not behind, as other programs have them; grey or three or four colours behind them, or one plane between as networks have it.
    pub(super) fn of(sides: &[usize], is_by_columns: bool) -> Result<Self, Problem> {
        let one = Axis::ONE;
        let [frames, rows, columns, channels] = match *axes(sides, is_by_columns).as_slice() {
            [rows, columns] => [one, rows, columns, one],
            [rows, columns, last] if is_channels(last) && !is_channels(columns) => {
                [one, rows, columns, last]
            }
            [frames, rows, columns] if !is_frames_last(frames, rows, columns) => {
                [frames, rows, columns, one]
            }
            [frames, rows, columns, last] if is_channels(last) => [frames, rows, columns, last],
            [frames, plane, rows, columns] if plane.count == 1 => [frames, rows, columns, one],
            _ => {
                let sides: Vec<String> = sides.iter().map(usize::to_string).collect();
                return Err(not_read(format!(
                    "an array of shape ({})",
                    sides.join(", ")
                )));
            }
        };
        Ok(Self {
            frames,
            rows,
            columns,
            channels,
        })
    }

    /// Where the first number of each pixel of a frame is, row by row.
    pub(super) fn pixels(&self, frame: usize) -> impl Iterator<Item = usize> + use<> {
        let Self {
            frames,
            rows,
            columns,
            ..
        } = *self;
        let places = move |row: usize| {
            let first = frame * frames.step + row * rows.step;
            (0..columns.count).map(move |column| first + column * columns.step)
        };
        (0..rows.count).flat_map(places)
    }
}

fn is_channels(axis: Axis) -> bool {
    matches!(axis.count, 1 | 3 | 4)
}

/// Whether the last of three axes seems to be that of the frames: as of square frames, or of such that would else be narrow strips.
fn is_frames_last(first: Axis, second: Axis, last: Axis) -> bool {
    const STRIP: usize = 4;
    let is_strip = |a: Axis, b: Axis| a.count.max(b.count) > STRIP * a.count.min(b.count);
    let is_square = first.count == second.count && second.count != last.count;
    is_square || (is_strip(second, last) && !is_strip(first, second))
}

fn axes(sides: &[usize], is_by_columns: bool) -> Vec<Axis> {
    let mut step = 1_usize;
    let mut axis = |&count: &usize| {
        let axis = Axis { count, step };
        // What is too large is refused before anything is looked for there.
        step = step.saturating_mul(count);
        axis
    };
    if is_by_columns {
        return sides.iter().map(axis).collect();
    }
    let mut axes: Vec<Axis> = sides.iter().rev().map(&mut axis).collect();
    axes.reverse();
    axes
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Frames, rows, columns, channels.
    fn counts(sides: &[usize]) -> Option<[usize; 4]> {
        let shape = Shape::of(sides, false).ok()?;
        let Shape {
            frames,
            rows,
            columns,
            channels,
        } = shape;
        Some([frames, rows, columns, channels].map(|axis| axis.count))
    }

    #[test]
    fn axes_are_told_by_their_number_and_by_how_few_colours_there_are() {
        assert_eq!(counts(&[20, 30]), Some([1, 20, 30, 1]));
        assert_eq!(counts(&[7, 20, 30]), Some([7, 20, 30, 1]));
        assert_eq!(counts(&[1, 20, 30]), Some([1, 20, 30, 1]));
        assert_eq!(counts(&[20, 30, 1]), Some([1, 20, 30, 1]));
        assert_eq!(counts(&[20, 30, 3]), Some([1, 20, 30, 3]));
        assert_eq!(counts(&[7, 20, 30, 4]), Some([7, 20, 30, 4]));
        assert_eq!(counts(&[7, 1, 20, 30]), Some([7, 20, 30, 1]));
        assert_eq!(counts(&[30, 30, 30]), Some([30, 30, 30, 1]));
        let frames_last = [&[30, 30, 7][..], &[512, 512, 600], &[480, 640, 60]];
        let others = [&[20][..], &[], &[2, 7, 20, 30], &[1, 2, 7, 20, 30]];
        for none in frames_last.into_iter().chain(others) {
            assert_eq!(counts(none), None, "{none:?}");
        }
    }

    #[test]
    fn either_order_leads_to_the_same_pixels() {
        let sides = [2, 3, 4];
        let [rows, columns] = [false, true].map(|order| Shape::of(&sides, order).unwrap());
        for frame in 0..2 {
            let by_rows = rows.pixels(frame);
            for (at, (row_first, column_first)) in by_rows.zip(columns.pixels(frame)).enumerate() {
                let [row, column] = [at / 4, at % 4];
                assert_eq!(row_first, frame * 12 + row * 4 + column);
                assert_eq!(column_first, frame + 2 * row + 6 * column);
            }
        }
    }
}
