//! A mask's outline as a polygon with few points, for a person to work on.

use heapless::VecView;

use super::OneClickError;
use crate::aids::Vertex;
use crate::aids::list::List;
use crate::aids::simplify::simplify;
use crate::border::follow_border;
use crate::contour::Point;
use crate::mask::Mask;

/// Largest distance of the polygon from the border that it stands for, pixels.
const TOLERANCE: f64 = 0.5;

/// Working memory of [`outline_points`]: as long as the border has pixel sides, all of one
/// length.
#[derive(Debug)]
pub struct PolygonMemory<'a> {
    /// The corners of the border.
    pub corners: &'a mut VecView<Point>,
    /// Its line.
    pub line: &'a mut [Vertex],
    /// Which points stay.
    pub marks: &'a mut [bool],
    /// The points that stay.
    pub kept: &'a mut [Vertex],
}

/// The outline of a mask's first region, clockwise on the screen: the line through the middles of
/// its pixels' outer sides, and no more of its points than keep it within half a pixel.
///
/// # Errors
/// [`OneClickError`] for an empty mask or a border too long for the memory.
pub fn outline_points<'m>(
    mask: &Mask<'_>,
    memory: PolygonMemory<'m>,
) -> Result<impl Iterator<Item = Point> + use<'m>, OneClickError> {
    follow_border(mask, memory.corners)?;
    let mut line = List::new(memory.line);
    let corners = memory.corners.iter();
    let next = corners.clone().cycle().skip(1);
    for (from, to) in corners.zip(next) {
        let (right, down) = (to.column - from.column, to.row - from.row);
        // One of them is 0: sides of pixels run along rows and columns.
        let sides = right.abs().max(down.abs());
        for side in 0..sides as usize {
            let share = (side as f64 + 0.5) / sides;
            let middle = Point::new(from.column + share * right, from.row + share * down);
            line.push(Vertex::new(middle))?;
        }
    }
    let mut kept = List::new(memory.kept);
    simplify(line.as_slice(), true, TOLERANCE, |_| false, memory.marks, &mut kept)?;
    let kept = kept.into_slice();
    Ok(kept.iter().map(|vertex| vertex.at))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contour::{Contour, Outline};
    use crate::mask::{MaskMut, words_needed};

    const SIDE: usize = 160;
    const LONG: usize = 1024;

    #[test]
    fn few_points_stand_for_the_mask() {
        // An ellipse with a tab whose corners are square.
        let mut words = std::vec![0; words_needed(SIDE, SIDE)];
        let mut mask = MaskMut::new(&mut words, SIDE, SIDE).expect("fits");
        for (column, row) in (0..SIDE * SIDE).map(|k| (k % SIDE, k / SIDE)) {
            let (x, y) = ((column as f64 - 70.2) / 52.0, (row as f64 - 80.7) / 31.0);
            let tab = (100..140).contains(&column) && (70..90).contains(&row);
            mask.set(column, row, x * x + y * y < 1.0 || tab);
        }
        let memory = PolygonMemory {
            corners: &mut Contour::<LONG>::new(),
            line: &mut [Vertex::default(); LONG],
            marks: &mut [false; LONG],
            kept: &mut [Vertex::default(); LONG],
        };
        let mask = mask.into_mask();
        let points: Contour<LONG> = outline_points(&mask, memory).expect("fits").collect();
        assert!((20..80).contains(&points.len()), "{}", points.len());
        let outline = Outline::new(&points, SIDE, SIDE).expect("simple");
        let mut again = std::vec![0; words_needed(SIDE, SIDE)];
        let mut filled = MaskMut::new(&mut again, SIDE, SIDE).expect("fits");
        filled.fill_outline(&outline);
        let differ = filled.as_mask().unmatched(&mask).expect("one size") as f64;
        assert!(differ < 0.015 * mask.area() as f64, "{differ}");
    }

    #[test]
    fn an_empty_mask_and_short_memory_are_errors() {
        let mut words = std::vec![0; words_needed(SIDE, SIDE)];
        let short = |words: &[u32]| {
            let memory = PolygonMemory {
                corners: &mut Contour::<8>::new(),
                line: &mut [Vertex::default(); 8],
                marks: &mut [false; 8],
                kept: &mut [Vertex::default(); 8],
            };
            let mask = Mask::new(words, SIDE, SIDE).expect("valid");
            outline_points(&mask, memory).map(|_| ()).err()
        };
        assert!(matches!(short(&words), Some(OneClickError::Border(_))));
        words[50..53].fill(0xffff);
        assert!(matches!(short(&words), Some(OneClickError::Aid(_))));
    }
}
