//! What the person pointed at: the window to search, the seeds of regions, and how well a silhouette agrees with it.

use heapless::Vec;

use super::error::OneClickError;
use super::memory::OneClickMemory;
use super::opening::Opening;
use super::window::{BLOCKED, LEVELS, Window};
use fluoropose::camera::Camera;
use fluoropose::image::contour::Point;
use fluoropose::image::grey::Grey;
use fluoropose::image::mask::Mask;
use fluoropose::refine::{Polarity, polarity_inside, polarity_near};

/// The greatest number of seeds.
pub(super) const SEEDS: usize = 4;

/// Fractions of a box that are taken to be metal, one after the other.
const DARKEST: [f64; SEEDS] = [0.2, 0.1, 0.35, 0.5];
/// The seed is the darkest pixel at most this number of columns and rows from a click.
const AROUND: isize = 3;

/// The least length of a side of a box, pixels.
const LEAST_BOX: f64 = 16.0;
/// A box is widened by this fraction of its sides, because it may be drawn a little too tight.
const WIDEN: f64 = 0.03;

/// A click that misses the silhouette by at most this many pixels agrees fully.
const MISSED: usize = 4;
/// A click that misses it by this many pixels does not agree at all.
const FAR: usize = 24;
/// A box agrees fully whose intersection with the box around the silhouette is this fraction of their union.
const ROUGH: f64 = 0.5;

/// What the person pointed at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Prompt {
    /// A place inside the implant, pixels.
    Click(Point),
    /// A rough box around it: two opposite corners, pixels.
    Box(Point, Point),
}

impl Prompt {
    /// Whether the frame shows metal darker or brighter than what surrounds it, by what was pointed at.
    #[must_use]
    pub fn polarity(&self, frame: &dyn Grey) -> Polarity {
        match *self {
            Self::Click(Point { column, row }) => polarity_near(frame, [column, row]),
            Self::Box(a, b) => {
                let ([left, right], [top, bottom]) = ([a.column, b.column], [a.row, b.row]);
                let area = [
                    left.min(right),
                    top.min(bottom),
                    left.max(right),
                    top.max(bottom),
                ];
                polarity_inside(frame, area)
            }
        }
    }

    /// The part of the frame to search, for a component that reaches no farther than `extent` pixels from the click.
    pub(super) fn window(&self, camera: &Camera, extent: f64) -> Result<Window, OneClickError> {
        let size = (camera.width(), camera.height());
        let (width, height) = (size.0 as f64, size.1 as f64);
        match *self {
            Self::Click(Point { column, row }) => {
                if !((0.0..width).contains(&column) && (0.0..height).contains(&row)) {
                    return Err(OneClickError::Outside);
                }
                let sides = [column - extent, row - extent, column + extent, row + extent];
                Ok(Window::cut(sides, size))
            }
            Self::Box(low, high) => {
                let cut = |a: f64, b: f64, most: f64| (a.min(b).max(0.0), a.max(b).min(most));
                let (left, right) = cut(low.column, high.column, width);
                let (top, bottom) = cut(low.row, high.row, height);
                // A NaN is in no range.
                let large = |side: f64| (LEAST_BOX..=f64::INFINITY).contains(&side);
                if !(large(right - left) && large(bottom - top)) {
                    return Err(OneClickError::SmallBox {
                        width: right - left,
                        height: bottom - top,
                        least: LEAST_BOX,
                    });
                }
                let (x, y) = (WIDEN * (right - left), WIDEN * (bottom - top));
                Ok(Window::cut(
                    [left - x, top - y, right + x, bottom + y],
                    size,
                ))
            }
        }
    }

    /// The seeds of regions, in a window whose levels are in `memory`.
    pub(super) fn seeds(
        &self,
        window: &Window,
        memory: &mut OneClickMemory<'_>,
    ) -> Vec<usize, SEEDS> {
        match *self {
            Self::Click(click) => {
                core::iter::once(darkest_near(click, window, memory.grey)).collect()
            }
            Self::Box(..) => thickest(window, memory),
        }
    }

    /// Whether a drawn silhouette agrees with the prompt once it is moved by at most so many pixels.
    pub(super) fn is_within(&self, drawn: &Mask<'_>, px: f64) -> bool {
        match *self {
            Self::Click(at) => {
                let away = FAR + px as usize;
                let near = |at: f64| (at as usize).saturating_sub(away)..=at as usize + away;
                near(at.row).any(|row| near(at.column).any(|column| drawn.get(column, row)))
            }
            Self::Box(low, high) => {
                let (columns, rows) = drawn.bounds();
                let apart = |first: usize, end: usize, a: f64, b: f64| {
                    first as f64 - px > a.max(b) || end as f64 + px < a.min(b)
                };
                !(apart(columns.start, columns.end, low.column, high.column)
                    || apart(rows.start, rows.end, low.row, high.row))
            }
        }
    }

    /// How well a drawn silhouette agrees with the prompt, 0 to 1.
    pub(super) fn agreement(&self, drawn: &Mask<'_>) -> f64 {
        match *self {
            Self::Click(at) => {
                let missed = (0..=FAR).find(|&missed| touches(drawn, at, missed));
                missed.map_or(0.0, |missed| {
                    let more = missed.saturating_sub(MISSED) as f64;
                    1.0 - more / (FAR - MISSED) as f64
                })
            }
            Self::Box(low, high) => {
                let (columns, rows) = drawn.bounds();
                let own = [columns.start, rows.start, columns.end, rows.end];
                let wanted = [
                    low.column.min(high.column),
                    low.row.min(high.row),
                    low.column.max(high.column),
                    low.row.max(high.row),
                ];
                (common(&own.map(|side| side as f64), &wanted) / ROUGH).min(1.0)
            }
        }
    }
}

/// Whether a mask has a pixel on the square around a place, `away` pixels from it.
fn touches(mask: &Mask<'_>, at: Point, away: usize) -> bool {
    let (column, row) = (at.column as usize, at.row as usize);
    let near = |at: usize| at.saturating_sub(away)..=at + away;
    let far = |c: usize, r: usize| c.abs_diff(column).max(r.abs_diff(row)) == away;
    let hit = |r: usize| near(column).any(|c| far(c, r) && mask.get(c, r));
    near(row).any(hit)
}

/// Intersection of two boxes divided by their union.
fn common(a: &[f64; 4], b: &[f64; 4]) -> f64 {
    let area =
        |[left, top, right, bottom]: [f64; 4]| (right - left).max(0.0) * (bottom - top).max(0.0);
    let both = [
        a[0].max(b[0]),
        a[1].max(b[1]),
        a[2].min(b[2]),
        a[3].min(b[3]),
    ];
    let inside = area(both);
    inside / (area(*a) + area(*b) - inside).max(f64::MIN_POSITIVE)
}

/// The darkest pixel near a click, which may have hit a speck of noise or missed a thin part.
fn darkest_near(click: Point, window: &Window, grey: &[u16]) -> usize {
    let middle = window.index(click.column, click.row);
    let mut best = (grey.get(middle).copied().unwrap_or(BLOCKED), middle);
    for down in -AROUND..=AROUND {
        for right in -AROUND..=AROUND {
            let at = window.index(click.column + right as f64, click.row + down as f64);
            let value = grey.get(at).copied().unwrap_or(BLOCKED);
            if value < best.0 {
                best = (value, at);
            }
        }
    }
    best.1
}

/// The middle of the thickest dark thing in a window for each fraction of dark pixels among those that are known, each pixel once.
fn thickest(window: &Window, memory: &mut OneClickMemory<'_>) -> Vec<usize, SEEDS> {
    let mut seeds = Vec::new();
    let histogram = &mut *memory.statistics;
    histogram.fill(0);
    for &grey in memory
        .grey
        .iter()
        .filter(|&&grey| usize::from(grey) < LEVELS)
    {
        if let Some(count) = histogram.get_mut(usize::from(grey)) {
            *count += 1;
        }
    }
    let known: f64 = histogram.iter().copied().map(f64::from).sum();
    for fraction in DARKEST {
        let wanted = fraction * known;
        let mut sum = 0.0;
        let level = memory.statistics.iter().position(|&count| {
            sum += f64::from(count);
            sum >= wanted
        });
        let mut opening = Opening {
            window: *window,
            reached: &*memory.grey,
            distance: &mut *memory.distance,
            marks: &mut *memory.marks,
            stack: &mut *memory.links,
        };
        let seed = opening.thickest(level.unwrap_or(0) as u16);
        if let Some(seed) = seed.filter(|seed| !seeds.contains(seed)) {
            // There is a place for each fraction.
            let _ = seeds.push(seed);
        }
    }
    seeds
}

#[cfg(test)]
mod tests {
    use super::*;
    use fluoropose::film::LineMemory;
    use fluoropose::image::mask::{MaskMut, words_needed};
    use fluoropose::locate::Workspace;
    use fluoropose::refine::RefineMemory;
    use fluoropose::search::kernels::Kernels;

    const SIDE: usize = 64;

    fn boxed([left, top, right, bottom]: [f64; 4]) -> Prompt {
        Prompt::Box(Point::new(left, top), Point::new(right, bottom))
    }

    #[test]
    fn a_prompt_agrees_with_what_it_points_at() {
        let mut words = std::vec![0; words_needed(SIDE, SIDE)];
        let mut mask = MaskMut::new(&mut words, SIDE, SIDE).expect("fits");
        (20..40).for_each(|row| mask.fill_span(row, 10, 50));
        let drawn = mask.into_mask();
        let click = |column, row| Prompt::Click(Point::new(column, row)).agreement(&drawn);
        assert_eq!([click(30.0, 30.0), click(7.5, 18.0)], [1.0, 1.0]);
        assert_eq!(
            [click(30.0, 54.0), click(30.0, 63.9)],
            [1.0 - 11.0 / 20.0, 0.0]
        );
        let agreement = |corners| boxed(corners).agreement(&drawn);
        assert_eq!(agreement([8.0, 18.0, 52.0, 42.0]), 1.0);
        // A fifth of the union is common, whichever corners are given.
        for corners in [[10.0, 20.0, 50.0, 120.0], [50.0, 20.0, 10.0, 120.0]] {
            assert!((agreement(corners) - 0.4).abs() < 1e-12);
        }
        assert_eq!(agreement([51.0, 0.0, 60.0, 60.0]), 0.0);
    }

    /// Oracle: every pixel that is drawn, moved by as much to each side.
    #[test]
    fn a_silhouette_is_within_a_prompt_where_a_little_moved_it_meets_it() {
        let mut words = std::vec![0; words_needed(SIDE, SIDE)];
        let mut mask = MaskMut::new(&mut words, SIDE, SIDE).expect("fits");
        (25..35).for_each(|row| mask.fill_span(row, 28, 36));
        let drawn = mask.into_mask();
        for (px, number) in (0..6usize).flat_map(|px| (0..64).map(move |number| (px, number))) {
            let (column, row) = (number % 8 * 9, number / 8 * 9);
            let reach = FAR + px;
            let beyond = |at: usize, first: usize, end: usize| {
                first.saturating_sub(at).max((at + 1).saturating_sub(end))
            };
            let away = beyond(column, 28, 36).max(beyond(row, 25, 35));
            let click = Prompt::Click(Point::new(column as f64 + 0.5, row as f64 + 0.5));
            assert_eq!(
                click.is_within(&drawn, px as f64),
                away <= reach,
                "{column} {row} {px}"
            );
            let side = |at: usize| (at as f64, at as f64 + 9.0);
            let ((left, right), (top, bottom)) = (side(column), side(row));
            let gap = |from: f64, to: f64, first: f64, end: f64| (first - to).max(from - end);
            let gap = gap(left, right, 28.0, 36.0).max(gap(top, bottom, 25.0, 35.0));
            for corners in [[left, top, right, bottom], [right, top, left, bottom]] {
                assert_eq!(
                    boxed(corners).is_within(&drawn, px as f64),
                    gap <= px as f64,
                    "{corners:?} {px}"
                );
            }
        }
    }

    #[test]
    fn prompts_beside_the_frame_are_refused() {
        let camera = Camera::new(SIDE, SIDE, [400.0, 400.0], [32.0, 32.0]).expect("valid");
        for at in [-1.0, 64.0, f64::NAN] {
            let click = Prompt::Click(Point::new(at, 5.0));
            assert_eq!(click.window(&camera, 20.0), Err(OneClickError::Outside));
        }
        let click = Prompt::Click(Point::new(30.5, 40.5));
        let window = click.window(&camera, 9.0).expect("inside");
        // As far to all sides.
        assert_eq!((window.left, window.width), (21, 19));
        assert_eq!((window.top, window.height), (31, 19));
        let small = boxed([60.0, 3.0, 90.0, 40.0]).window(&camera, 20.0);
        assert!(matches!(small, Err(OneClickError::SmallBox { .. })));
        let nothing = boxed([f64::NAN, 3.0, 90.0, 40.0]).window(&camera, 20.0);
        assert!(matches!(nothing, Err(OneClickError::SmallBox { .. })));
        let window = boxed([50.0, 30.0, 10.0, 10.0])
            .window(&camera, 20.0)
            .expect("large");
        assert_eq!(
            (window.left, window.top, window.width, window.height),
            (8, 9, 44, 22)
        );
    }

    /// Of a box most of which is excluded the fractions are those of what is left.
    #[test]
    fn what_is_excluded_of_a_box_is_no_part_of_it() {
        let window = Window {
            left: 0,
            top: 0,
            width: 40,
            height: 40,
        };
        let levels = |k: usize| match (k % 40, k / 40) {
            (36, 30) => 0,
            (35..39, 14..26) => 100,
            (34.., _) => 900,
            _ => BLOCKED,
        };
        let mut grey: std::vec::Vec<u16> = (0..window.pixels()).map(levels).collect();
        let pixels = || std::vec![0; window.pixels()];
        let mut memory = OneClickMemory {
            grey: &mut grey,
            reached: &mut [],
            distance: &mut pixels(),
            marks: &mut std::vec![0; window.pixels()],
            links: &mut std::vec![0; window.pixels()],
            statistics: &mut [0; LEVELS],
            words: &mut [],
            workspace: Workspace {
                canonical: &mut [],
                rotated: &mut [],
                scores: &mut [],
                bytes: &mut [],
                kernels: Kernels::PORTABLE,
            },
            refine: RefineMemory {
                projected: &mut [],
                drawn: &mut [],
                places: &mut [],
                border: &mut [],
                film: LineMemory {
                    lines: &mut [],
                    heads: &mut [],
                    groups: &mut [],
                },
            },
        };
        let seeds = thickest(&window, &mut memory);
        let in_block = |seed: &usize| levels(*seed) == 100;
        assert!(seeds.first().is_some_and(in_block), "{seeds:?}");
        assert!(!seeds.iter().any(|&seed| levels(seed) == 0), "{seeds:?}");
    }

    #[test]
    fn a_click_begins_at_the_darkest_pixel_near_it() {
        let window = Window {
            left: 10,
            top: 20,
            width: 30,
            height: 30,
        };
        let around = usize::try_from(AROUND).expect("a few pixels");
        let begun = |dark: (usize, usize)| {
            let mut grey = std::vec![100; window.pixels()];
            grey[dark.1 * window.width + dark.0] = 50;
            darkest_near(Point::new(25.5, 35.5), &window, &grey)
        };
        let at = |column: usize, row: usize| row * window.width + column;
        for near in [
            (15 + around, 15),
            (15 - around, 15 + around),
            (15, 15 - around),
        ] {
            assert_eq!(begun(near), at(near.0, near.1), "{near:?}");
        }
        for far in [(16 + around, 15), (15, 14 - around)] {
            assert_eq!(begun(far), at(15, 15), "{far:?}");
        }
    }
}
