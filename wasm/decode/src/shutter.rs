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

    /// How many pixels of a frame are open.
    pub(crate) fn open_area(&self, width: u32, height: u32) -> u64 {
        let spans = (0..height).flat_map(|row| self.open(row, width));
        spans.map(|span| u64::from(span.end - span.start)).sum()
    }
}

impl Shape {
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
            }
        }
    }
}
