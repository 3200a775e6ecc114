//! Border following: from a mask back to an outline.

use heapless::VecView;
use thiserror::Error;

use crate::image::contour::Point;
use crate::image::mask::Mask;

/// Why no border was written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum BorderError {
    /// No pixel is set.
    #[error("the mask is empty: there is no border to follow")]
    Empty,
    /// The border has more corners than the contour holds.
    #[error("the border has more than {0} corners, which the contour does not hold")]
    TooLong(usize),
}

/// Directions along pixel borders, clockwise on the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Heading {
    /// Along a row, columns growing.
    Right,
    /// Along a column, rows growing.
    Down,
    /// Along a row, columns shrinking.
    Left,
    /// Along a column, rows shrinking.
    Up,
}

impl Heading {
    fn turn_right(self) -> Self {
        match self {
            Self::Right => Self::Down,
            Self::Down => Self::Left,
            Self::Left => Self::Up,
            Self::Up => Self::Right,
        }
    }

    fn turn_left(self) -> Self {
        self.turn_right().turn_right().turn_right()
    }
}

/// A corner between four pixels and the way taken from it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Crack {
    /// Column of the corner: that of the pixel to its right.
    pub column: i64,
    /// Row of the corner: that of the pixel below it.
    pub row: i64,
    /// The way taken from it.
    pub heading: Heading,
}

impl Crack {
    /// The corner one pixel further that way.
    #[must_use]
    pub fn step(self) -> Self {
        let (right, down) = match self.heading {
            Heading::Right => (1, 0),
            Heading::Down => (0, 1),
            Heading::Left => (-1, 0),
            Heading::Up => (0, -1),
        };
        Self {
            column: self.column + right,
            row: self.row + down,
            ..self
        }
    }

    /// Column and row of the pixel ahead, on the left or the right hand; `None` beyond the upper
    /// and the left border of any mask.
    pub fn pixel_ahead(self, left_hand: bool) -> Option<(usize, usize)> {
        let (right, down) = match (self.heading, left_hand) {
            (Heading::Right, true) | (Heading::Up, false) => (0, -1),
            (Heading::Right, false) | (Heading::Down, true) => (0, 0),
            (Heading::Down, false) | (Heading::Left, true) => (-1, 0),
            (Heading::Left, false) | (Heading::Up, true) => (-1, -1),
        };
        let column = usize::try_from(self.column + right).ok()?;
        let row = usize::try_from(self.row + down).ok()?;
        Some((column, row))
    }

    /// The way to go on with the silhouette on the right hand. Pixels that touch by a corner
    /// alone are kept apart, so the border never meets itself in a side.
    pub fn turn(self, mask: &Mask<'_>) -> Self {
        self.turn_where(|column, row| mask.get(column, row))
    }

    /// [`Crack::turn`] around the pixels for which `inside` is true; it is called for pixels beyond the right and the
    /// lower border too.
    pub fn turn_where(self, inside: impl Fn(usize, usize) -> bool) -> Self {
        let ahead = |left_hand| {
            let pixel = self.pixel_ahead(left_hand);
            pixel.is_some_and(|(column, row)| inside(column, row))
        };
        let heading = if !ahead(false) {
            self.heading.turn_right()
        } else if ahead(true) {
            self.heading.turn_left()
        } else {
            self.heading
        };
        Self { heading, ..self }
    }
}

/// Writes the outer border of the first region (in reading order) to `border`, clockwise on the
/// screen, along the cracks between pixels: filling the result gives the region back exactly,
/// its holes filled. Only corners are written. For a mask of several regions, take
/// [`crate::image::region::largest_region`] first.
///
/// # Errors
/// [`BorderError::Empty`] or [`BorderError::TooLong`].
pub fn follow_border(mask: &Mask<'_>, border: &mut VecView<Point>) -> Result<(), BorderError> {
    border.clear();
    let start = first_pixel(mask).map(|(column, row)| Crack {
        column: column as i64,
        row: row as i64,
        heading: Heading::Right,
    });
    let start = start.ok_or(BorderError::Empty)?;
    let mut at = start;
    loop {
        let next = at.step().turn(mask);
        if next.heading != at.heading {
            let corner = Point::new(next.column as f64, next.row as f64);
            let capacity = border.capacity();
            border
                .push(corner)
                .map_err(|_| BorderError::TooLong(capacity))?;
        }
        at = next;
        if at == start {
            return Ok(());
        }
    }
}

/// Column and row of the first set pixel in reading order.
#[must_use]
pub fn first_pixel(mask: &Mask<'_>) -> Option<(usize, usize)> {
    (0..mask.height()).find_map(|row| mask.runs(row).next().map(|run| (run.start, row)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::contour::{Contour, Outline};
    use crate::image::mask::{MaskMut, words_needed};

    const W: usize = 40;
    const H: usize = 24;

    fn draw(points: &[(f64, f64)], words: &mut [u32]) {
        let points: Contour<16> = points.iter().map(|&(c, r)| Point::new(c, r)).collect();
        let outline = Outline::new(&points, W, H).expect("simple");
        let mut mask = MaskMut::new(words, W, H).expect("fits");
        mask.fill_outline(&outline);
    }

    #[test]
    fn filling_the_border_gives_the_mask_back() {
        let shapes: [&[(f64, f64)]; 3] = [
            &[
                (2.2, 3.1),
                (35.0, 1.2),
                (39.9, 23.9),
                (20.0, 9.0),
                (4.0, 22.0),
            ],
            &[(0.0, 0.0), (40.0, 0.0), (40.0, 24.0), (0.0, 24.0)],
            &[(10.0, 10.0), (11.0, 10.0), (11.0, 11.0), (10.0, 11.0)],
        ];
        for shape in shapes {
            let mut words = [0; words_needed(W, H)];
            draw(shape, &mut words);
            let mask = Mask::new(&words, W, H).expect("valid");
            let mut border = Contour::<256>::new();
            follow_border(&mask, &mut border).expect("fits");
            let outline = Outline::new(&border, W, H).expect("a border is simple");
            let mut again = [0; words_needed(W, H)];
            let mut filled = MaskMut::new(&mut again, W, H).expect("fits");
            filled.fill_outline(&outline);
            assert_eq!(filled.as_mask().unmatched(&mask), Some(0));
        }
    }

    #[test]
    fn what_cannot_be_followed_is_said() {
        let mut words = [0; words_needed(W, H)];
        let mask = Mask::new(&words, W, H).expect("valid");
        let mut border = Contour::<3>::new();
        assert_eq!(follow_border(&mask, &mut border), Err(BorderError::Empty));
        words[0] = 1;
        let mask = Mask::new(&words, W, H).expect("valid");
        assert_eq!(
            follow_border(&mask, &mut border),
            Err(BorderError::TooLong(3))
        );
    }
}
