//! Places of a whole frame where one click may be worth trying, for who has no click to give: dark things of the right size.
//!
//! Metal is darker than what surrounds it in every direction, the border of a field or of a limb is not: the mean of a box is
//! compared with those of boxes around it, and the direction with nearly the least difference counts. Sums over boxes are read
//! from a table of sums (Crow, SIGGRAPH 1984).

use fluoropose::camera::Camera;
use fluoropose::finder::Component;
use fluoropose::image::contour::Point;
use fluoropose::image::grey::Grey;
use fluoropose::image::mask::Mask;
use fluoropose::math::sqrt;
use fluoropose::memory::{TooLittleMemory, first};
use fluoropose::refine::{ImageTarget, Polarity};
use fluoropose::shortlist::keep;
use heapless::Vec;

use crate::cells::Cells;

/// Most places: as many by turns of each kind.
pub const SEEDS: usize = KINDS * TURNS;
const KINDS: usize = 4;
const TURNS: usize = 4;

/// Half sides of boxes, parts of the component's size, and where those around lie, the same.
const INNER: [f64; 2] = [0.06, 0.12];
const AROUND: [f64; 3] = [0.4, 0.7, 1.0];
/// Directions to each of which there are boxes, clockwise.
const DIRECTIONS: [[f64; 2]; 8] = [
    [1.0, 0.0],
    [0.7, 0.7],
    [0.0, 1.0],
    [-0.7, 0.7],
    [-1.0, 0.0],
    [-0.7, -0.7],
    [0.0, -1.0],
    [0.7, -0.7],
];
/// So many directions may be as dark: there the other component may be, or bone.
const AS_DARK: usize = 2;
/// Light that is as good as none, as a part of the frame's range.
const DARK: f64 = 1.0 / 16.0;
/// With less light than this, the same, a cell is as black as its frame can be: a part beyond the picture, a shutter, or metal that
/// is clipped. Places of four kinds are given by turns, for any of them may be many: far from such cells, near them (as the rim of a
/// field is), on them, and at the frame's border, where nothing is known of some directions.
const CLIPPED: f64 = 1.0 / 64.0;
/// The kind at the border.
const AT_BORDER: usize = 3;
/// So many directions tell, where the frame's corner leaves no more.
const TELLING: usize = 3;
/// Places nearer to each other than this part of the component's size are one.
const SAME: f64 = 0.4;

/// Numbers that [`seeds`] borrows.
#[must_use]
pub fn seeds_needed(camera: &Camera) -> usize {
    let cells = Cells::of(camera);
    2 * (cells.columns + 1) * (cells.rows + 1)
}

/// Square root of the mean area of a component's silhouettes in frames of a camera, at the library's distance, pixels.
#[must_use]
pub fn expected_size(component: &Component<'_>, camera: &Camera) -> f64 {
    let info = component.library.info();
    let [fx, fy] = camera.focal();
    let unit = fx * fy / (info.focal * info.focal);
    let views = component.library.views();
    let every = (views / 256).max(1);
    let (mut sum, mut count) = (0.0, 0.0);
    for view in (0..views).step_by(every) {
        sum += f64::from(component.library.record(view).area) * unit;
        count += 1.0;
    }
    sqrt(sum / count)
}

/// Places of a frame where something as large as `size_px` is set off from its surroundings, the darkest first; none where its pixels
/// are unknown.
///
/// # Errors
/// [`TooLittleMemory`] where `sums` are fewer than [`seeds_needed`].
pub fn seeds(
    image: &ImageTarget<'_>,
    camera: &Camera,
    size_px: f64,
    sums: &mut [f64],
) -> Result<Vec<Point, SEEDS>, TooLittleMemory> {
    let cells = Cells::of(camera);
    let (columns, rows, cell) = (cells.columns, cells.rows, cells.side);
    let sums = first("sums", seeds_needed(camera), sums)?;
    let table = Table::of(image, cells, sums);
    let mut kinds: [Shortlist; KINDS] = Default::default();
    let apart = SAME * size_px;
    for part in INNER {
        let half = (part * size_px / cell).max(1.0) as usize;
        for row in (half..rows.saturating_sub(half)).step_by(half) {
            for column in (half..columns.saturating_sub(half)).step_by(half) {
                let (darker, kind) = table.darker(column, row, half, size_px / cell);
                let at = cells.middle(column, row);
                let is_unknown = |mask: &Mask<'_>| mask.get(at.column as usize, at.row as usize);
                let known = table.is_seen(column, row) && !image.unknown.is_some_and(is_unknown);
                if darker > 0.0 && known {
                    insert(&mut kinds[kind], (darker, at), apart);
                }
            }
        }
    }
    Ok(by_turns(&kinds))
}

/// The best places of one kind.
type Shortlist = Vec<(f64, Point), SEEDS>;

/// The places of all kinds by turns, as many as there is room for.
fn by_turns(kinds: &[Shortlist; KINDS]) -> Vec<Point, SEEDS> {
    let turns = (0..SEEDS).flat_map(|k| kinds.iter().map(move |places| places.get(k)));
    turns.flatten().map(|&(_, at)| at).take(SEEDS).collect()
}

/// Sums over all cells above and to the left of each corner: of light, and of cells that are clipped.
struct Table<'m> {
    frame: &'m dyn Grey,
    cells: Cells,
    light: &'m [f64],
    clipped: &'m [f64],
    /// The difference between the brightest and the darkest cell.
    range: f64,
}

impl<'m> Table<'m> {
    fn of(image: &ImageTarget<'m>, cells: Cells, sums: &'m mut [f64]) -> Self {
        let (frame, columns, rows) = (image.frame, cells.columns, cells.rows);
        let at = |column: usize, row: usize| cells.grey(frame, column, row);
        let mut limits = [f64::INFINITY, f64::NEG_INFINITY];
        for row in 0..rows {
            for value in (0..columns).filter_map(|column| at(column, row)) {
                limits = [value.min(limits[0]), value.max(limits[1])];
            }
        }
        let [black, white] = limits;
        // On a negative the greatest grey value is no light at all.
        let lit = |column, row| {
            let value = at(column, row)?;
            Some(match image.polarity {
                Polarity::DarkImplant => value - black,
                Polarity::BrightImplant => white - value,
            })
        };
        let range = white - black;
        let (light, clipped) = sums.split_at_mut(sums.len() / 2);
        sum_up(light, (columns, rows), lit);
        sum_up(clipped, (columns, rows), |column, row| {
            let is_clipped = lit(column, row).is_some_and(|light| light < CLIPPED * range);
            Some(f64::from(u8::from(is_clipped)))
        });
        Self {
            frame,
            cells,
            light,
            clipped,
            range,
        }
    }

    /// Whether a cell is of the picture.
    fn is_seen(&self, column: usize, row: usize) -> bool {
        self.cells.grey(self.frame, column, row).is_some()
    }

    /// By how much a box is darker than those around it in nearly every direction, as a part of both, and of which kind it is.
    fn darker(&self, column: usize, row: usize, half: usize, size: f64) -> (f64, usize) {
        let dark = (DARK * self.range).max(f64::MIN_POSITIVE);
        let light = |column, row| self.mean(self.light, column, row, half);
        let inside = light(column, row);
        let mut least: Vec<f64, 8> = Vec::new();
        for [right, down] in DIRECTIONS {
            let at = |part: f64| {
                let (x, y) = (
                    column as f64 + part * size * right,
                    row as f64 + part * size * down,
                );
                let within = |at: f64, count: usize| (0.0..count as f64).contains(&at);
                let seen = within(x, self.cells.columns)
                    && within(y, self.cells.rows)
                    && self.is_seen(x as usize, y as usize);
                seen.then(|| {
                    let outside = light(x as usize, y as usize);
                    (outside - inside) / (outside + inside + dark)
                })
            };
            if let Some(most) = AROUND.into_iter().filter_map(at).reduce(f64::max) {
                // There is a place for each direction.
                let _ = least.push(most);
            }
        }
        least.sort_unstable_by(f64::total_cmp);
        // What lies beyond the frame may be as dark: of fewer directions fewer may be, in proportion.
        let seen = least.len();
        let as_dark = AS_DARK * seen / DIRECTIONS.len();
        let told = least.get(as_dark).filter(|_| seen >= TELLING);
        let darker = told.copied().unwrap_or(0.0);
        if seen < DIRECTIONS.len() {
            return (darker, AT_BORDER);
        }
        let is_clipped = |half| usize::from(self.mean(self.clipped, column, row, half) > 0.0);
        (darker, is_clipped(size as usize) + is_clipped(half))
    }

    /// The mean of a box of cells around one, as far as it lies in the frame.
    fn mean(&self, sums: &[f64], column: usize, row: usize, half: usize) -> f64 {
        let (left, right) = (
            column.saturating_sub(half),
            (column + half + 1).min(self.cells.columns),
        );
        let (top, bottom) = (
            row.saturating_sub(half),
            (row + half + 1).min(self.cells.rows),
        );
        let at = |column: usize, row: usize| sums[row * (self.cells.columns + 1) + column];
        let sum = at(right, bottom) - at(left, bottom) - at(right, top) + at(left, top);
        sum / ((right - left) * (bottom - top)).max(1) as f64
    }
}

/// Sums of a value over all cells above and to the left of each corner. What is not of the picture has that of what lies beside it in its
/// row, and a row of which nothing is has those of the row beside it: there is no edge.
fn sum_up(
    sums: &mut [f64],
    (columns, rows): (usize, usize),
    value: impl Fn(usize, usize) -> Option<f64>,
) {
    let width = columns + 1;
    sums[..width].fill(0.0);
    let first_of = |row| (0..columns).find_map(|column| value(column, row));
    let mut seen = (0..rows).find_map(|row| first_of(row).map(|first| (row, first)));
    for row in 0..rows {
        seen = first_of(row).map(|first| (row, first)).or(seen);
        let (from, mut before) = seen.unwrap_or_default();
        let mut line = 0.0;
        sums[(row + 1) * width] = 0.0;
        for column in 0..columns {
            before = value(column, from).unwrap_or(before);
            line += before;
            sums[(row + 1) * width + column + 1] = sums[row * width + column + 1] + line;
        }
    }
}

/// Keeps the darkest of places that are one.
fn insert(best: &mut Shortlist, (darker, at): (f64, Point), apart: f64) {
    let same = |other: &(f64, Point)| {
        let (right, down) = (other.1.column - at.column, other.1.row - at.row);
        right * right + down * down < apart * apart
    };
    if best.iter().any(|other| same(other) && other.0 >= darker) {
        return;
    }
    best.retain(|other| !same(other));
    keep(best, (darker, at), |&(darker, _)| -darker);
}

#[cfg(test)]
mod tests {
    use super::*;
    use fluoropose::image::frame::Frame;
    use fluoropose::image::mask::{MaskMut, words_needed};

    #[test]
    fn discs_of_the_right_size_come_first_and_shading_does_not_matter() {
        const SIDE: usize = 256;
        let middles = [[60.0, 70.0], [180.0, 150.0]];
        let pixels: std::vec::Vec<u8> = (0..SIDE * SIDE)
            .map(|k| {
                let (column, row) = ((k % SIDE) as f64, (k / SIDE) as f64);
                let near = |[x, y]: [f64; 2]| libm::hypot(column - x, row - y) < 14.0;
                let shade = 120.0 + 0.4 * column;
                (if middles.into_iter().any(near) {
                    shade - 60.0
                } else {
                    shade
                }) as u8
            })
            .collect();
        let frame = Frame::new(&pixels, SIDE, SIDE, SIDE).expect("fits");
        let camera = Camera::new(SIDE, SIDE, [900.0; 2], [128.0; 2]).expect("valid");
        let mut sums = std::vec![0.0; seeds_needed(&camera)];
        let mut image = ImageTarget {
            frame: &frame,
            unknown: None,
            polarity: Polarity::DarkImplant,
            film: None,
        };
        let near =
            |[x, y]: [f64; 2]| move |at: &Point| libm::hypot(at.column - x, at.row - y) < 14.0;
        let found = seeds(&image, &camera, 50.0, &mut sums).expect("enough memory");
        for middle in middles {
            assert!(found[..4].iter().any(near(middle)), "{found:?}");
        }
        let few = seeds(&image, &camera, 50.0, &mut sums[1..]);
        assert!(few.is_err());
        let other_units: std::vec::Vec<u16> = pixels
            .iter()
            .map(|&grey| 300 + 20 * u16::from(grey))
            .collect();
        let other_units = Frame::new(&other_units, SIDE, SIDE, SIDE).expect("fits");
        image.frame = &other_units;
        let same = seeds(&image, &camera, 50.0, &mut sums).expect("enough memory");
        assert_eq!(same, found, "units and offset of grey values do not matter");
        image.frame = &frame;
        let least = pixels.iter().min().expect("pixels");
        let negative: std::vec::Vec<u8> = pixels.iter().map(|grey| 255 - (grey - least)).collect();
        let negative = Frame::new(&negative, SIDE, SIDE, SIDE).expect("fits");
        image.frame = &negative;
        image.polarity = Polarity::BrightImplant;
        let same = seeds(&image, &camera, 50.0, &mut sums).expect("enough memory");
        for middle in middles {
            assert!(same.iter().take(4).any(near(middle)), "{same:?}");
        }
        (image.frame, image.polarity) = (&frame, Polarity::DarkImplant);

        let mut words = std::vec![0; words_needed(SIDE, SIDE)];
        let mut known = MaskMut::new(&mut words, SIDE, SIDE).expect("fits");
        for row in 50..90 {
            (40..80).for_each(|column| known.set(column, row, true));
        }
        let known = known.into_mask();
        image.unknown = Some(&known);
        let found = seeds(&image, &camera, 50.0, &mut sums).expect("enough memory");
        assert!(!found.iter().any(near(middles[0])), "{found:?}");
        assert!(found.iter().take(4).any(near(middles[1])), "{found:?}");
    }

    /// Places in a square picture of dark metal, of 50 mm at a metre.
    fn places_in<const SIDE: usize>(shade: impl Fn(f64, f64) -> u8) -> Vec<Point, SEEDS> {
        let pixels: std::vec::Vec<u8> = (0..SIDE * SIDE)
            .map(|k| shade((k % SIDE) as f64, (k / SIDE) as f64))
            .collect();
        let frame = Frame::new(&pixels, SIDE, SIDE, SIDE).expect("fits");
        let middle = SIDE as f64 / 2.0;
        let camera = Camera::new(SIDE, SIDE, [900.0; 2], [middle; 2]).expect("valid");
        let mut sums = std::vec![0.0; seeds_needed(&camera)];
        let image = ImageTarget {
            frame: &frame,
            unknown: None,
            polarity: Polarity::DarkImplant,
            film: None,
        };
        seeds(&image, &camera, 50.0, &mut sums).expect("enough memory")
    }

    /// Parts beyond the picture that are blacker than all metal, and as many as there are places, do not outvote it.
    #[test]
    fn a_grey_disc_is_given_among_many_that_are_clipped() {
        const SIDE: usize = 512;
        let middle = [300.0, 290.0];
        let shade = |column: f64, row: f64| {
            let rim = libm::hypot(column - 256.0, row - 256.0) > 236.0;
            let hole = libm::hypot((column % 34.0) - 17.0, (row % 34.0) - 17.0) < 9.0;
            match () {
                () if rim && hole => 0,
                () if libm::hypot(column - middle[0], row - middle[1]) < 14.0 => 150,
                () => 200,
            }
        };
        let found = places_in::<SIDE>(shade);
        let near = |at: &Point| libm::hypot(at.column - middle[0], at.row - middle[1]) < 14.0;
        assert!(found[..3].iter().any(near), "{found:?}");
        let clipped = |at: &&Point| shade(at.column, at.row) == 0;
        assert!(found.iter().filter(clipped).count() >= 4, "{found:?}");
    }

    /// Nothing is known of what lies beyond the frame: it is no reason to pass over a disc at its side, or in its corner.
    #[test]
    fn discs_at_the_border_are_given() {
        const SIDE: usize = 256;
        for middle in [[8.0, 120.0], [130.0, 249.0], [247.0, 9.0]] {
            let near = |column: f64, row: f64| libm::hypot(column - middle[0], row - middle[1]);
            let found = places_in::<SIDE>(|column, row| match near(column, row) < 14.0 {
                true => 90,
                false => 180,
            });
            let is_near = |at: &Point| near(at.column, at.row) < 14.0;
            assert!(found.iter().any(is_near), "{middle:?}: {found:?}");
        }
    }

    /// A shutter over any side, or over a corner: its border is no dark thing, and all of them are one picture turned or mirrored.
    #[test]
    fn what_is_not_of_the_picture_is_as_bright_as_what_lies_beside_it() {
        use fluoropose::image::shuttered::Shuttered;
        const SIDE: usize = 256;
        const COVERED: usize = 50;
        let pixels: std::vec::Vec<u8> = (0..SIDE * SIDE)
            .map(|k| {
                let off = [k % SIDE, k / SIDE].map(|at| at as f64 - 127.5);
                if libm::hypot(off[0], off[1]) < 14.0 {
                    90
                } else {
                    180
                }
            })
            .collect();
        let camera = Camera::new(SIDE, SIDE, [900.0; 2], [128.0; 2]).expect("valid");
        let mut sums = std::vec![0.0; seeds_needed(&camera)];
        type Covers = fn(usize, usize) -> bool;
        let shutters: [Covers; 6] = [
            |_, row| row < COVERED,
            |_, row| row >= SIDE - COVERED,
            |column, _| column < COVERED,
            |column, _| column >= SIDE - COVERED,
            |column, row| column + row < 3 * COVERED,
            |column, row| column + row > 2 * SIDE - 3 * COVERED,
        ];
        for (number, covers) in shutters.iter().enumerate() {
            let mut words = std::vec![0; words_needed(SIDE, SIDE)];
            let mut mask = MaskMut::new(&mut words, SIDE, SIDE).expect("fits");
            for place in 0..SIDE * SIDE {
                let (column, row) = (place % SIDE, place / SIDE);
                if covers(column, row) {
                    mask.set(column, row, true);
                }
            }
            let frame = Frame::new(&pixels, SIDE, SIDE, SIDE).expect("fits");
            let frame = Shuttered::new(frame, &words[..]).expect("as large");
            let image = ImageTarget {
                frame: &frame,
                unknown: None,
                polarity: Polarity::DarkImplant,
                film: None,
            };
            let found = seeds(&image, &camera, 50.0, &mut sums).expect("enough memory");
            let is_in = |at: &Point| libm::hypot(at.column - 128.0, at.row - 128.0) < 20.0;
            assert!(
                !found.is_empty() && found.iter().all(is_in),
                "{number}: {found:?}"
            );
        }
    }

    #[test]
    fn of_places_that_are_one_the_darkest_stays() {
        let mut best = Shortlist::new();
        for (darker, column, row) in [
            (5.0, 10.0, 10.0),
            (4.0, 12.0, 11.0),
            (6.0, 10.0, 12.5),
            (3.0, 13.0, 10.0),
            (2.0, 10.0, 15.5),
        ] {
            insert(&mut best, (darker, Point::new(column, row)), 3.0);
        }
        let kept: std::vec::Vec<_> = best
            .iter()
            .map(|&(darker, at)| (darker, at.column, at.row))
            .collect();
        assert_eq!(
            kept,
            [(6.0, 10.0, 12.5), (3.0, 13.0, 10.0), (2.0, 10.0, 15.5)]
        );
    }
}
