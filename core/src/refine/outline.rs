//! The model's occluding contour as drawn: border pixels, their normals, and the depth of the
//! surface behind them.
//!
//! Border pixels and normals are read from what was drawn, so holes and mixed winding do not matter.

use core::ops::Range;

use super::border::BorderPixel;
use super::places::Places;
use super::stages::Stage;
use super::view::Target;
use crate::camera::Camera;
use crate::image::mask::{Mask, WORD_BITS, Word};
use crate::math::root_of_whole;
use crate::memory::{TooLittleMemory, first};
use crate::mesh::Model;
use crate::pose::Pose;
use crate::render::Projected;

/// Where the depth of the contour is taken from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Depth {
    /// The silhouette edges, where the model is drawn from them: found twice as soon.
    Edges,
    /// All triangles.
    Surface,
    /// The triangles that lines across the outline meet at their origins: whoever measures those writes it.
    Lines,
}

impl Depth {
    /// Against a silhouette both end alike within their uncertainty, and from further away with edges.
    /// Against a grey frame refinement ends less dependent on its start with the surface: 0.07 instead
    /// of 0.10 degrees on a real tibia.
    pub(super) fn of(target: &Target<'_>, stage: &Stage) -> Self {
        match target {
            Target::Silhouette(_) => Self::Edges,
            Target::Image(_) if stage.drawn => Self::Lines,
            Target::Image(_) => Self::Surface,
        }
    }
}

/// Which border pixels are samples, and where their depth is taken from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sampling {
    pub(super) depth: Depth,
    /// One of this many is a sample.
    pub(super) every: usize,
    /// Which of them: as many different turns as `every` are all border pixels.
    pub(super) turn: usize,
}

impl Sampling {
    /// All border pixels, with the depth of the silhouette edges.
    pub(super) const ALL: Self = Self {
        depth: Depth::Edges,
        every: 1,
        turn: 0,
    };

    /// Those that are taken in the frame, of a part of it that `[columns, rows]` come before.
    pub(super) fn in_part(self, [columns, rows]: [usize; 2]) -> Self {
        Self {
            turn: self.turn + columns + 3 * rows,
            ..self
        }
    }

    /// All along an edge, whatever its direction.
    fn takes(&self, column: usize, row: usize) -> bool {
        (column + 3 * row + self.turn).is_multiple_of(self.every)
    }
}

/// A model as drawn at a pose.
pub(super) struct DrawnModel<'a> {
    pub(super) model: &'a Model<'a>,
    pub(super) camera: &'a Camera,
    pub(super) pose: &'a Pose,
    pub(super) drawn: &'a Mask<'a>,
    pub(super) sampling: Sampling,
    /// Whether the images of all vertices were made.
    pub(super) all: bool,
}

impl DrawnModel<'_> {
    /// Writes the border pixels to `border` and returns them. `scratch` is as drawing left it; `places` has
    /// [`super::places_needed`] numbers of any value.
    ///
    /// # Errors
    /// [`TooLittleMemory`] where there are more of them than `border` holds or may hold.
    pub(super) fn border<'b>(
        &self,
        scratch: &mut [Projected],
        places: &mut [u16],
        border: &'b mut [BorderPixel],
    ) -> Result<&'b mut [BorderPixel], TooLittleMemory> {
        let room = border.len().min(usize::from(u16::MAX));
        let border = border.get_mut(..room).unwrap_or_default();
        // The frame's own border is no border of the model: what is cut off is not known.
        let rows = self.drawn.rows();
        let rows = rows.start.max(1)..rows.end.min(self.drawn.height().saturating_sub(1));
        let mut places = Places::new(places, rows.clone());
        let count = self.find(rows, &mut places, border);
        let border = first("border pixels", count, border)?;
        self.measure_depth(scratch, &places, border);
        Ok(border)
    }

    /// Lists the border pixels of some rows, enters their places, and counts those too for which there is no room.
    fn find(
        &self,
        rows: Range<usize>,
        places: &mut Places<'_>,
        border: &mut [BorderPixel],
    ) -> usize {
        let width = self.drawn.width();
        let mut count = 0;
        let end = rows.end;
        let mut around = Around::above(self.drawn, rows.start);
        for row in rows {
            places.begin(row, count);
            around.next_row(self.drawn);
            for column in around.border_columns() {
                if column == 0 || column + 1 >= width {
                    continue;
                }
                if !self.sampling.takes(column, row) {
                    continue;
                }
                let Some(pixel) = around.sample_at(column) else {
                    continue;
                };
                if let Some(listed) = border.get_mut(count) {
                    *listed = pixel;
                }
                count += 1;
            }
        }
        places.begin(end, count);
        count
    }
}

/// Half width of the window from which a normal is read, pixels.
const WINDOW: usize = 3;
const SIDE: usize = 2 * WINDOW + 1;
/// A tent weighs the middle most.
const TENT: [i32; SIDE] = [1, 2, 3, 4, 3, 2, 1];

/// The tent times the distance down from the middle.
const DOWN: [i32; SIDE] = [-3, -4, -3, 0, 3, 4, 3];

/// For each row of a window as bits: the sum of the tent over its set pixels, and as many times [`RIGHT`] as that of the tent
/// times the distance to the right of the middle. Of both a window has sums that can be told apart.
const ROWS: [i16; 1 << SIDE] = {
    let mut rows = [0; 1 << SIDE];
    let mut bits = 0;
    while bits < rows.len() {
        let mut at = 0;
        while at < SIDE {
            if bits >> at & 1 == 1 {
                rows[bits] += (TENT[at] * (1 + (at as i32 - WINDOW as i32) * RIGHT)) as i16;
            }
            at += 1;
        }
        bits += 1;
    }
    rows
};

/// More than twice any sum of the tent over a window.
const RIGHT: i32 = 1 << RIGHT_BIT;
const RIGHT_BIT: u32 = 10;

/// A row of a mask with those from [`WINDOW`] above to as many below it; none where the mask has none.
struct Around<'m> {
    row: usize,
    rows: [&'m [Word]; SIDE],
}

impl<'m> Around<'m> {
    /// Before a row, which is the next.
    fn above(mask: &Mask<'m>, row: usize) -> Self {
        let rows = core::array::from_fn(|down| {
            let row = (row + down).checked_sub(WINDOW + 1);
            row.map_or(&[] as &[Word], |row| mask.row(row))
        });
        let row = row.wrapping_sub(1);
        Self { row, rows }
    }

    /// Goes on to the next row.
    fn next_row(&mut self, mask: &Mask<'m>) {
        self.row = self.row.wrapping_add(1);
        // By name: a list moved within itself is a call, and longer than all of this.
        let [_, a, b, c, d, e, f] = self.rows;
        self.rows = [a, b, c, d, e, f, mask.row(self.row + WINDOW)];
    }

    /// Columns of the row's pixels that are set and have a neighbour, of four, that is not.
    fn border_columns(&self) -> impl Iterator<Item = usize> + use<'m> {
        let [_, _, above, own, below, _, _] = self.rows;
        let word = |words: &[Word], at: usize| words.get(at).copied().unwrap_or(0);
        // Pixels of the border that are left in the present word, which is the one before the next.
        let (mut next, mut bits) = (0, 0);
        core::iter::from_fn(move || {
            while bits == 0 {
                let (at, &middle) = (next, own.get(next)?);
                next += 1;
                if middle == 0 {
                    continue;
                }
                let before = at.checked_sub(1).map_or(0, |at| word(own, at));
                let left = middle << 1 | before >> (WORD_BITS - 1);
                let right = middle >> 1 | word(own, at + 1) << (WORD_BITS - 1);
                bits = middle & !(left & right & word(above, at) & word(below, at));
            }
            let bit = bits.trailing_zeros() as usize;
            bits &= bits - 1;
            Some((next - 1) * WORD_BITS + bit)
        })
    }

    /// The outline in a border pixel: its outward normal, from the slope of the mask smoothed over
    /// 7 x 7 pixels, and its arc length, from the sides that face outside: along a border with the
    /// normal `n` there are `|n_x|` vertical and `|n_y|` horizontal sides for each pixel of length,
    /// and `n_x^2 + n_y^2 = 1`.
    fn sample_at(&self, column: usize) -> Option<BorderPixel> {
        // The bits of the rows that came last, so that those of the last are the lowest.
        let mut window: u32 = 0;
        let (mut all, mut down) = (0, 0);
        let place = Place::of(column);
        for (row, (tent, far)) in self.rows.iter().zip(TENT.iter().zip(&DOWN)) {
            let bits = place.bits_round(row);
            window = window << SIDE | bits;
            let sums = i32::from(ROWS[bits as usize % ROWS.len()]);
            all += tent * sums;
            down += far * sums;
        }
        // What is below those to the right, with its sign.
        let sums = |both: i32| both << (i32::BITS - RIGHT_BIT) >> (i32::BITS - RIGHT_BIT);
        let slope = [(sums(all) - all) >> RIGHT_BIT, -sums(down)];
        let [right, down] = slope;
        if slope == [0; 2] {
            return None;
        }
        // As far as sides face outside, times the length of the slope: whole numbers.
        const BELOW: usize = 2 * SIDE + WINDOW;
        const OWN: usize = BELOW + SIDE;
        const ABOVE: usize = OWN + SIDE;
        let beside = |along: i32, before: usize, after: usize| {
            let outside = if along > 0 { after } else { before };
            (window >> outside & 1 ^ 1) as i32 * along.abs()
        };
        let facing = beside(right, OWN - 1, OWN + 1) + beside(down, ABOVE, BELOW);
        let length = root_of_whole((right * right + down * down) as u32);
        Some(BorderPixel {
            column: column as u16,
            row: self.row as u16,
            slope: slope.map(|component| component as i16),
            weight: facing as f32 / length,
            near: f32::INFINITY,
            ..BorderPixel::EMPTY
        })
    }
}

/// Where the words of a row hold the pixels from [`WINDOW`] to the left of a column to as many to its right.
struct Place {
    word: usize,
    /// Pixels before them in the word; as many more or fewer than none as the row has none of.
    before: i32,
}

impl Place {
    fn of(column: usize) -> Self {
        let first = column.saturating_sub(WINDOW);
        Self {
            word: first / WORD_BITS,
            before: (first % WORD_BITS) as i32 - (first + WINDOW - column) as i32,
        }
    }

    /// These pixels, from the lowest bit; none where the row has none.
    #[inline(always)]
    fn bits_round(&self, row: &[Word]) -> Word {
        const ALL: Word = (1 << SIDE) - 1;
        let word = |at: usize| row.get(at).copied().unwrap_or(0);
        let (own, before) = (word(self.word), self.before);
        if before < 0 {
            return own << -before & ALL;
        }
        // A word has more pixels than a window, so that of the next one those that matter stay.
        let next = match before as usize + SIDE > WORD_BITS {
            true => word(self.word + 1) << (WORD_BITS as i32 - before),
            false => 0,
        };
        (own >> before | next) & ALL
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::mask::{MaskMut, words_needed};
    use crate::math::sqrt;
    use proptest::prelude::*;

    const SIDE: usize = 200;

    /// Oracle: the tent over 7 x 7 pixels, one by one.
    fn slope(mask: &Mask<'_>, column: usize, row: usize) -> [i32; 2] {
        let mut slope = [0; 2];
        for (down, right) in
            (-3..=3i32).flat_map(|down| (-3..=3i32).map(move |right| (down, right)))
        {
            let (x, y) = (column as i32 + right, row as i32 + down);
            if x >= 0 && y >= 0 && mask.get(x as usize, y as usize) {
                let tent = (4 - right.abs()) * (4 - down.abs());
                slope[0] -= tent * right;
                slope[1] -= tent * down;
            }
        }
        slope
    }

    properties! {
        #[test]
        fn normals_are_those_of_the_tent_over_single_pixels(
            mut words in proptest::collection::vec(any::<Word>(), words_needed(70, 9)),
            column in 0usize..70, row in 0usize..9,
        ) {
            words.iter_mut().skip(2).step_by(3).for_each(|word| *word &= 0b11_1111);
            let mask = Mask::new(&words, 70, 9).expect("no bit beyond the last column");
            let [right, down] = slope(&mask, column, row).map(f64::from);
            let length = sqrt(right * right + down * down);
            let mut around = Around::above(&mask, row);
            around.next_row(&mask);
            let sample = around.sample_at(column);
            prop_assert_eq!(sample.is_none(), length == 0.0);
            let Some(sample) = sample else { return Ok(()) };
            prop_assert_eq!(sample.slope.map(f64::from), [right, down]);
            for (found, wanted) in sample.normal().into_iter().zip([right, down]) {
                prop_assert!((f64::from(found) - wanted / length).abs() < 2e-7);
            }
            let neighbours = [(1, 0), (-1, 0), (0, 1), (0, -1)];
            let weight: f64 = neighbours.iter().map(|&(x, y)| {
                let (c, r) = (column as i32 + x, row as i32 + y);
                let set = c >= 0 && r >= 0 && mask.get(c as usize, r as usize);
                let along = (right * f64::from(x) + down * f64::from(y)) / length;
                if set { 0.0 } else { along.max(0.0) }
            }).sum();
            prop_assert!((f64::from(sample.weight) - weight).abs() < 1e-6);
        }
    }

    properties! {
        #[test]
        fn a_part_takes_the_samples_that_its_frame_takes(
            columns in 0usize..50, rows in 0usize..50, column in 0usize..99, row in 0usize..99,
            every in 1usize..8, turn in 0usize..8,
        ) {
            let frame = Sampling { every, turn, ..Sampling::ALL };
            let part = frame.in_part([columns, rows]);
            prop_assert_eq!(part.takes(column, row), frame.takes(columns + column, rows + row));
        }
    }

    #[test]
    fn a_discs_border_has_its_circumference_and_radial_normals() {
        let (centre, radius) = (99.7, 80.3);
        let mut words = std::vec![0; words_needed(SIDE, SIDE)];
        let mut mask = MaskMut::new(&mut words, SIDE, SIDE).expect("fits");
        for row in 0..SIDE {
            for column in 0..SIDE {
                let (x, y) = (column as f64 + 0.5 - centre, row as f64 + 0.5 - centre);
                mask.set(column, row, x * x + y * y < radius * radius);
            }
        }
        let mask = mask.into_mask();
        let mut length = 0.0;
        let mut around = Around::above(&mask, 1);
        for row in 1..SIDE - 1 {
            around.next_row(&mask);
            for column in around.border_columns() {
                let set = |c: usize, r: usize| mask.get(c, r);
                let inside = set(column - 1, row)
                    && set(column + 1, row)
                    && set(column, row - 1)
                    && set(column, row + 1);
                assert!(set(column, row) && !inside);
                let sample = around.sample_at(column).expect("a slope");
                length += f64::from(sample.weight);
                let (x, y) = (column as f64 + 0.5 - centre, row as f64 + 0.5 - centre);
                let [right, down] = sample.normal().map(f64::from);
                let along = (x * right + y * down) / libm::hypot(x, y);
                assert!(along > 0.97, "normal off by {} rad", libm::acos(along));
            }
        }
        let circumference = 2.0 * core::f64::consts::PI * radius;
        assert!((length / circumference - 1.0).abs() < 0.02, "{length}");
    }
}
