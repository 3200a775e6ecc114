//! Shutters: shapes outside of which a frame is no picture.

use std::ops::Range;

/// The most corners of a shutter's polygon that are used: filling takes rows times corners.
pub const MAX_CORNERS: usize = 1000;

/// What a shutter leaves open: pixels whose centres lie in all of its shapes, borders among them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Shutter {
    shapes: Vec<Shape>,
}

/// A shape in continuous image coordinates: columns to the right and rows down, a pixel's centre at its index + 0.5.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Shape {
    /// Left, top, right, bottom: what lies between is open.
    Rectangle([f64; 4]),
    /// Column and row of the middle, and the radius.
    Circle([f64; 3]),
    /// Columns and rows of the corners, filled by parity.
    Polygon(Vec<[f64; 2]>),
}

impl Shutter {
    /// What lies in all shapes.
    pub(crate) fn of(shapes: Vec<Shape>) -> Self {
        Self { shapes }
    }

    /// The same for a frame in squares of `side` x `side` pixels of this one.
    #[must_use]
    pub fn reduced(&self, side: u32) -> Self {
        let shapes = self
            .shapes
            .iter()
            .map(|shape| shape.reduced(f64::from(side)));
        Self::of(shapes.collect())
    }

    /// The open pixels of a row of `width` pixels: ranges of columns from the left, none of them empty.
    #[must_use]
    pub fn open(&self, row: u32, width: u32) -> Vec<Range<u32>> {
        let mut open: Vec<Range<u32>> = std::iter::once(0..width).collect();
        for shape in &self.shapes {
            let spans = shape.spans(f64::from(row) + 0.5, width);
            let both = |a: &Range<u32>, b: &Range<u32>| a.start.max(b.start)..a.end.min(b.end);
            open = open
                .iter()
                .flat_map(|a| spans.iter().map(move |b| both(a, b)))
                .filter(|range| !range.is_empty())
                .collect();
        }
        open
    }

    /// The covered pixels of a frame, numbered row by row: of each run the first one, and the one after its last.
    #[must_use]
    pub fn covered(&self, width: u32, height: u32) -> Vec<u32> {
        let mut ends = Vec::new();
        for row in 0..height {
            for open in self.open(row, width) {
                ends.extend([open.start, open.end].map(|column| row * width + column));
            }
        }
        // Between the runs that are open; those that touch are one.
        let all = std::iter::once(0).chain(ends).chain([width * height]);
        let mut covered: Vec<u32> = Vec::new();
        for end in all {
            match covered.last() {
                Some(&last) if last == end => drop(covered.pop()),
                _ => covered.push(end),
            }
        }
        covered
    }

    /// Gives covered pixels the value of the nearest in their row that is open, and rows without one that of the nearest row: whatever
    /// looks at neighbours finds no edge there.
    pub(crate) fn continue_behind<P: Copy>(&self, pixels: &mut [P], width: u32) {
        let length = width.max(1) as usize;
        let mut last_open: Option<usize> = None;
        let rows = pixels.len() / length;
        for row in 0..rows {
            let open = self.open(row as u32, width);
            let Some(line) = pixels.get_mut(row * length..(row + 1) * length) else {
                return;
            };
            if !continue_row(line, &open) {
                continue;
            }
            for covered in last_open.map_or(0, |last| last + 1)..row {
                let nearest = last_open.filter(|last| covered - last <= row - covered);
                let from = nearest.unwrap_or(row) * length;
                pixels.copy_within(from..from + length, covered * length);
            }
            last_open = Some(row);
        }
        if let Some(last) = last_open {
            for covered in last + 1..rows {
                pixels.copy_within(last * length..(last + 1) * length, covered * length);
            }
        }
    }

    /// How many pixels of a frame are open.
    pub(crate) fn open_area(&self, width: u32, height: u32) -> u64 {
        let spans = (0..height).flat_map(|row| self.open(row, width));
        spans.map(|span| u64::from(span.end - span.start)).sum()
    }
}

impl Shape {
    fn reduced(&self, factor: f64) -> Self {
        match self {
            Self::Rectangle(sides) => Self::Rectangle(sides.map(|side| side / factor)),
            Self::Circle(circle) => Self::Circle(circle.map(|part| part / factor)),
            Self::Polygon(corners) => {
                let reduced = corners.iter().map(|corner| corner.map(|at| at / factor));
                Self::Polygon(reduced.collect())
            }
        }
    }

    /// The columns whose centres lie in the shape, of the row whose centres are at `y`.
    fn spans(&self, y: f64, width: u32) -> Vec<Range<u32>> {
        match self {
            Self::Rectangle([left, top, right, bottom]) => match (*top..=*bottom).contains(&y) {
                true => vec![columns(*left, *right, width)],
                false => Vec::new(),
            },
            Self::Circle([column, row, radius]) => {
                let square = radius * radius - (y - row) * (y - row);
                match square >= 0.0 {
                    true => vec![columns(
                        column - square.sqrt(),
                        column + square.sqrt(),
                        width,
                    )],
                    false => Vec::new(),
                }
            }
            Self::Polygon(corners) => polygon(corners, y, width),
        }
    }
}

/// Continues a row beyond what is open of it; false where nothing is.
fn continue_row<P: Copy>(line: &mut [P], open: &[Range<u32>]) -> bool {
    let mut covered = 0;
    let mut before = None;
    for span in open {
        let (start, end) = (span.start as usize, span.end as usize);
        let Some(&after) = line.get(start) else {
            return false;
        };
        // The left one of two that are as near.
        let middle = before.map_or(covered, |_| covered + (start - covered).div_ceil(2));
        line[covered..middle].fill(before.unwrap_or(after));
        line[middle..start].fill(after);
        before = line.get(end - 1).copied();
        covered = end;
    }
    if let Some(value) = before {
        line[covered..].fill(value);
    }
    before.is_some()
}

/// The columns whose centres lie from `from` to `to`.
fn columns(from: f64, to: f64, width: u32) -> Range<u32> {
    let first = (from - 0.5).ceil().clamp(0.0, width.into()) as u32;
    let end = ((to - 0.5).floor() + 1.0).clamp(0.0, width.into()) as u32;
    first..end.max(first)
}

fn polygon(corners: &[[f64; 2]], y: f64, width: u32) -> Vec<Range<u32>> {
    let following = corners.iter().cycle().skip(1);
    let mut crossings: Vec<f64> = Vec::new();
    let mut on_border = Vec::new();
    for (&[ax, ay], &[bx, by]) in corners.iter().zip(following) {
        if (ay <= y) != (by <= y) {
            crossings.push(ax + (y - ay) / (by - ay) * (bx - ax));
        }
        // Sides along the row, and corners on it, are borders, which parity may leave out.
        if ay == y {
            let to = if by == y { bx } else { ax };
            on_border.push(columns(ax.min(to), ax.max(to), width));
        }
    }
    crossings.sort_by(f64::total_cmp);
    let pairs = crossings.as_chunks::<2>().0.iter();
    let inside = pairs.map(|&[from, to]| columns(from, to, width));
    let mut spans: Vec<Range<u32>> = inside.chain(on_border).collect();
    spans.retain(|span| !span.is_empty());
    spans.sort_by_key(|span| span.start);
    let mut joined: Vec<Range<u32>> = Vec::new();
    for span in spans {
        match joined.last_mut() {
            Some(last) if span.start <= last.end => last.end = last.end.max(span.end),
            _ => joined.push(span),
        }
    }
    joined
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether a pixel's centre lies in a shape, by its definition.
    fn holds(shape: &Shape, column: u32, row: u32) -> bool {
        let (x, y) = (f64::from(column) + 0.5, f64::from(row) + 0.5);
        match shape {
            Shape::Rectangle([left, top, right, bottom]) => {
                (*left..=*right).contains(&x) && (*top..=*bottom).contains(&y)
            }
            Shape::Circle([column, row, radius]) => (x - column).hypot(y - row) <= *radius,
            Shape::Polygon(corners) => {
                let sides = corners.iter().zip(corners.iter().cycle().skip(1));
                let mut inside = false;
                for (&[ax, ay], &[bx, by]) in sides {
                    let across = (bx - ax) * (y - ay) - (by - ay) * (x - ax);
                    let between = (x - ax) * (x - bx) + (y - ay) * (y - by) <= 0.0;
                    if across == 0.0 && between {
                        return true;
                    }
                    if (ay <= y) != (by <= y) && (across > 0.0) == (by > ay) {
                        inside = !inside;
                    }
                }
                inside
            }
        }
    }

    #[test]
    fn what_is_open_lies_in_every_shape() {
        let corner = |column: u32, row: u32| [f64::from(column) + 0.5, f64::from(row) + 0.5];
        let shapes = [
            Shape::Rectangle([3.5, 2.5, 15.5, 9.5]),
            Shape::Rectangle([-5.0, -5.0, 300.0, 4.0]),
            Shape::Rectangle([9.0, 2.0, 3.0, 9.0]),
            Shape::Circle([8.5, 6.5, 5.0]),
            Shape::Circle([0.5, 0.5, 7.3]),
            Shape::Circle([400.0, 6.5, 5.0]),
            Shape::Polygon(vec![
                corner(2, 1),
                corner(17, 1),
                corner(14, 9),
                corner(5, 11),
            ]),
            // A notch, and a spike upwards.
            Shape::Polygon(vec![
                corner(1, 10),
                corner(5, 2),
                corner(9, 7),
                corner(13, 2),
                corner(18, 10),
            ]),
            Shape::Polygon(vec![corner(4, 4), corner(4, 4), corner(4, 4)]),
        ];
        for first in &shapes {
            for second in &shapes {
                let shutter = Shutter::of(vec![first.clone(), second.clone()]);
                let mut area = 0;
                for row in 0..13 {
                    let open = shutter.open(row, 20);
                    for column in 0..20 {
                        let due = holds(first, column, row) && holds(second, column, row);
                        let found = open.iter().any(|span| span.contains(&column));
                        assert_eq!(found, due, "{first:?} {second:?} {column} {row}");
                        area += u64::from(due);
                    }
                    assert!(open.iter().all(|span| !span.is_empty()));
                }
                assert_eq!(shutter.open_area(20, 13), area);
                what_is_covered_is_continued(&shutter);
            }
        }
    }

    /// By looking for the nearest at each pixel: in its row, the left of two; else in the nearest row, the upper of two.
    fn what_is_covered_is_continued(shutter: &Shutter) {
        let (width, height) = (20, 13);
        let open: Vec<bool> = (0..height)
            .flat_map(|row| {
                let spans = shutter.open(row, width);
                (0..width).map(move |column| spans.iter().any(|span| span.contains(&column)))
            })
            .collect();
        let covered = shutter.covered(width, height);
        assert!(covered.is_sorted_by(|a, b| a < b), "{covered:?}");
        for (number, &is_open) in open.iter().enumerate() {
            let ends_before = covered.partition_point(|&end| end as usize <= number);
            assert_eq!(ends_before % 2 == 0, is_open, "{covered:?} {number}");
        }

        let (width, height) = (width as usize, height as usize);
        let is_open = |row: usize, column: usize| open[row * width + column];
        let nearest = |row: usize, column: usize| {
            let columns = (0..width).filter(|&at| is_open(row, at));
            columns.min_by_key(|&at| (at.abs_diff(column), at))
        };
        let stored: Vec<u16> = (0..260).collect();
        let mut continued = stored.clone();
        shutter.continue_behind(&mut continued, 20);
        for row in 0..height {
            let rows = (0..height).filter(|&at| nearest(at, 0).is_some());
            let from = rows.min_by_key(|&at| (at.abs_diff(row), at));
            for column in 0..width {
                let due = from.map_or(stored[row * width + column], |from| {
                    stored[from * width + nearest(from, column).expect("an open pixel")]
                });
                assert_eq!(continued[row * width + column], due, "{row} {column}");
            }
        }
    }
}
