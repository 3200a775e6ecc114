//! The pixels of one region, and where its outer border begins.

use super::cut::Cut;
use crate::error::TracingError;
use crate::morphology::{Neighbours, grow, shrink};
use fluoropose::image::border::{Crack, Heading, first_pixel};
use fluoropose::image::contour::Point;
use fluoropose::image::mask::{Mask, MaskMut, Word};
use fluoropose::math::floor;

/// How far from the cursor a region may begin, pixels.
pub(super) const NEAR: usize = 3;
/// Steps by which corners are restored that were lost when bridges were cut.
const CORNERS: usize = 2;

/// A mask and the crack where the outer border of one of its regions begins.
pub(super) struct Region<'a> {
    pub(super) mask: Mask<'a>,
    pub(super) start: Crack,
}

impl<'a> Region<'a> {
    /// The region at or near the cursor; `None` where there is none. `masks` are three of the frame's size.
    pub(super) fn at(
        cut: &Cut<'_>,
        cursor: Point,
        bridge: usize,
        masks: [&'a mut [Word]; 3],
    ) -> Result<Option<Self>, TracingError> {
        let (width, height) = (cut.frame.width(), cut.frame.height());
        // The lengths are right, so the only other fault is a frame that is too large for a mask.
        let [bits, a, b] = masks.map(|words| MaskMut::new(words, width, height));
        let (Ok(mut bits), Ok(a), Ok(b)) = (bits, a, b) else {
            return Err(TracingError::OtherFrame);
        };
        cut.fill(&mut bits);
        let bits = bits.into_mask();
        if bridge > 0
            && let Some(opened) = opened(&bits, cursor, bridge, a, b)
        {
            return Ok(Some(opened));
        }
        // Also taken where the part under the cursor is itself as thin as a bridge.
        let seed = nearest_set(&bits, cursor, NEAR);
        Ok(seed.map(|seed| Self {
            start: outer_border(seed, |column, row| bits.get(column, row)),
            mask: bits,
        }))
    }
}

/// The region without what is thinner than a bridge: eroded, its holes filled, dilated again.
fn opened<'a>(
    bits: &Mask<'_>,
    cursor: Point,
    bridge: usize,
    a: MaskMut<'a>,
    b: MaskMut<'a>,
) -> Option<Region<'a>> {
    let (mut now, mut other) = (a, b);
    shrink(bits, Neighbours::of_step(0), &mut now);
    for number in 1..bridge {
        shrink(&now.as_mask(), Neighbours::of_step(number), &mut other);
        core::mem::swap(&mut now, &mut other);
    }
    let seed = nearest_set(&now.as_mask(), cursor, NEAR + bridge)?;
    fill_region(&now.as_mask(), seed, &mut other);
    core::mem::swap(&mut now, &mut other);
    for number in 0..bridge {
        grow(&now.as_mask(), Neighbours::of_step(number), &mut other);
        core::mem::swap(&mut now, &mut other);
    }
    for number in 0..CORNERS {
        grow(&now.as_mask(), Neighbours::of_step(number), &mut other);
        for row in 0..bits.height() {
            let before = now.as_mask();
            let known = |index: usize| bits.row(row)[index] | before.row(row)[index];
            other.replace_row(row, |index, grown| grown & known(index));
        }
        core::mem::swap(&mut now, &mut other);
    }
    let mask = now.into_mask();
    let (column, row) = first_pixel(&mask)?;
    let start = Crack {
        column: column as i64,
        row: row as i64,
        heading: Heading::Right,
    };
    Some(Region { mask, start })
}

/// Fills the region of a pixel and its holes.
fn fill_region(mask: &Mask<'_>, seed: (usize, usize), out: &mut MaskMut<'_>) {
    out.clear();
    let start = outer_border(seed, |column, row| mask.get(column, row));
    let mut at = start;
    loop {
        let next = at.step();
        if at.row != next.row {
            // Upwards and downwards alike: a row's parity changes at each.
            out.toggle(at.column as usize, at.row.min(next.row) as usize);
        }
        at = next.turn(mask);
        if at == start {
            break;
        }
    }
    out.fill_parity();
}

/// The set pixel nearest to the cursor, at most `reach` columns and rows away.
fn nearest_set(mask: &Mask<'_>, cursor: Point, reach: usize) -> Option<(usize, usize)> {
    let size = (mask.width(), mask.height());
    nearest_where(size, cursor, reach, |column, row| mask.get(column, row))
}

/// The pixel nearest to the cursor for which `inside` is true, at most `reach` columns and rows away.
pub(super) fn nearest_where(
    (width, height): (usize, usize),
    cursor: Point,
    reach: usize,
    inside: impl Fn(usize, usize) -> bool,
) -> Option<(usize, usize)> {
    let pixel = |value: f64| floor(value) as i64;
    let (column, row) = (pixel(cursor.column), pixel(cursor.row));
    let reach = reach as i64;
    let mut best = None;
    for down in -reach..=reach {
        for right in -reach..=reach {
            let away = right * right + down * down;
            let nearer = best.is_none_or(|(least, _)| away < least);
            let place = usize::try_from(column.saturating_add(right))
                .ok()
                .zip(usize::try_from(row.saturating_add(down)).ok());
            if let Some((column, row)) = place.filter(|_| nearer)
                && column < width
                && row < height
                && inside(column, row)
            {
                best = Some((away, (column, row)));
            }
        }
    }
    best.map(|(_, pixel)| pixel)
}

/// A crack of the outer border of the region that a pixel belongs to, the region on the right hand.
///
/// The first border to the left of the pixel may be that of a hole. The region then continues to the left of the hole,
/// where the search goes on: each step begins farther to the left.
pub(super) fn outer_border(
    (column, row): (usize, usize),
    inside: impl Fn(usize, usize) -> bool,
) -> Crack {
    let (mut column, mut row) = (column, row);
    loop {
        while column > 0 && inside(column - 1, row) {
            column -= 1;
        }
        let start = Crack {
            column: column as i64,
            row: row as i64 + 1,
            heading: Heading::Up,
        };
        let (twice_area, leftmost) = walk(start, &inside);
        if twice_area > 0 || leftmost.column <= 0 {
            return start;
        }
        // The pixel on the other side of the hole's leftmost side.
        let next = leftmost.column as usize - 1;
        if next >= column {
            return start;
        }
        column = next;
        row = leftmost.row.min(leftmost.step().row) as usize;
    }
}

/// Twice the area that a border encloses, positive for an outer one, and its leftmost crack that runs along a column.
fn walk(start: Crack, inside: &impl Fn(usize, usize) -> bool) -> (i64, Crack) {
    let (mut at, mut leftmost, mut twice_area) = (start, start, 0);
    loop {
        let next = at.step();
        if next.row != at.row && at.column < leftmost.column {
            leftmost = at;
        }
        twice_area += at.column * next.row - at.row * next.column;
        at = next.turn_where(inside);
        if at == start {
            return (twice_area, leftmost);
        }
    }
}
