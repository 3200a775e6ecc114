//! Masks and outlines, one made from the other.

use std::collections::{BTreeMap, BTreeSet};

use fluoropose::image::border::follow_border;
use fluoropose::image::contour::{Contour, Outline, Point};
use fluoropose::image::frame::Pixel;
use fluoropose::image::mask::{Mask, MaskMut, Word, words_needed};
use fluoropose::image::region::largest_region;
use fluoropose_tracing::simplify::{Simplify, simplify};
use fluoropose_tracing::{List, Vertex};
use js_sys::Float64Array;
use wasm_bindgen::prelude::*;

use fluoropose_page::error::sentence;
use fluoropose_page::frame_image::{FrameImage, Pixels};

/// Corners of a border that a mask may have.
const BORDER_CORNERS: usize = 65_536;

/// The outline of a mask's largest region, and what of the mask it leaves out.
#[wasm_bindgen]
pub struct MaskOutline {
    exact: Vec<f64>,
    points: Vec<f64>,
    specks: u32,
    holes: u32,
    area: u32,
    differing: u32,
}

#[wasm_bindgen]
impl MaskOutline {
    /// Columns and rows by turns, along the cracks between pixels: filled again it gives the region exactly, its holes
    /// filled.
    #[wasm_bindgen(getter)]
    pub fn exact(&self) -> Float64Array {
        Float64Array::from(&self.exact[..])
    }

    /// The same with few points: through the middles of the cracks, which leave a staircase to neither side, simplified.
    #[wasm_bindgen(getter)]
    pub fn points(&self) -> Float64Array {
        Float64Array::from(&self.points[..])
    }

    /// Pixels apart from the largest region, which are left out.
    #[wasm_bindgen(getter)]
    pub fn specks(&self) -> u32 {
        self.specks
    }

    /// Pixels of holes, which are filled.
    #[wasm_bindgen(getter)]
    pub fn holes(&self) -> u32 {
        self.holes
    }

    /// Pixels inside the outline.
    #[wasm_bindgen(getter)]
    pub fn area(&self) -> u32 {
        self.area
    }

    /// Pixels that are inside one of both outlines and not inside the other.
    #[wasm_bindgen(getter)]
    pub fn differing(&self) -> u32 {
        self.differing
    }
}

/// Grey values besides 0 of a film, rising; nothing where there are more than `most`, or where no pixel is 0: then it is
/// no mask.
#[wasm_bindgen(js_name = labelsOfMask)]
#[must_use]
pub fn labels_of_mask(film: &FrameImage, most: usize) -> Option<Vec<u32>> {
    match film.pixels() {
        Pixels::Eight(pixels) => labels(pixels, most),
        Pixels::Sixteen(pixels) => labels(pixels, most),
    }
}

fn labels<P: Pixel>(pixels: &[P], most: usize) -> Option<Vec<u32>> {
    let mut seen = BTreeSet::new();
    let mut before = None;
    for &pixel in pixels {
        let grey: u32 = pixel.into();
        if before.replace(grey) != Some(grey) && seen.insert(grey) && seen.len() > most + 1 {
            return None;
        }
    }
    seen.remove(&0).then(|| seen.into_iter().collect())
}

/// The outline of a film's pixels that are `value`, simplified to `tolerance` pixels.
///
/// # Errors
/// A sentence for an empty mask or a border with too many corners.
#[wasm_bindgen(js_name = outlineOfMask)]
pub fn outline_of_mask(
    film: &FrameImage,
    value: u32,
    tolerance: f64,
) -> Result<MaskOutline, JsError> {
    let (width, height) = film.size();
    let mut memory: [Vec<Word>; 3] = std::array::from_fn(|_| vec![0; words_needed(width, height)]);
    let [given, rest, largest] = &mut memory;
    let mut mask = MaskMut::new(given, width, height).map_err(sentence)?;
    match film.pixels() {
        Pixels::Eight(pixels) => select(pixels, value, &mut mask),
        Pixels::Sixteen(pixels) => select(pixels, value, &mut mask),
    }
    let mut rest = MaskMut::new(rest, width, height).map_err(sentence)?;
    let mut largest = MaskMut::new(largest, width, height).map_err(sentence)?;
    let specks = largest_region(&mask.as_mask(), &mut rest, &mut largest).map_err(sentence)?;
    traced(&largest.as_mask(), specks, tolerance)
}

/// Sets the pixels that are `value`.
fn select<P: Pixel>(pixels: &[P], value: u32, mask: &mut MaskMut<'_>) {
    let (width, height) = (mask.width(), mask.height());
    let rows = pixels.chunks_exact(width).take(height).enumerate();
    for (row, line) in rows {
        let columns = line.iter().enumerate();
        for (column, _) in columns.filter(|&(_, &pixel)| pixel.into() == value) {
            mask.set(column, row, true);
        }
    }
}

fn traced(region: &Mask<'_>, specks: u64, tolerance: f64) -> Result<MaskOutline, JsError> {
    let mut border = Box::<Contour<BORDER_CORNERS>>::default();
    follow_border(region, border.as_mut()).map_err(sentence)?;
    let numbers = |points: &[Point]| points.iter().flat_map(|p| [p.column, p.row]).collect();
    let (width, height) = (region.width(), region.height());
    let few = simplified(&border, tolerance, [width, height])?;
    let area = area_of(&border);
    let apart = apart(&border);
    let [exact, simple] = [filled(&apart, width, height)?, filled(&few, width, height)?];
    let differing: u32 = exact
        .iter()
        .zip(&simple)
        .map(|(exact, simple)| (exact ^ simple).count_ones())
        .sum();
    Ok(MaskOutline {
        exact: numbers(&apart),
        points: numbers(&few),
        specks: specks as u32,
        holes: (area - region.area()) as u32,
        area: area as u32,
        differing,
    })
}

/// The border with fewer points, inside its frame: a region that is cut off there keeps its area by points beyond it.
pub(crate) fn simplified(
    border: &[Point],
    tolerance: f64,
    [width, height]: [usize; 2],
) -> Result<Vec<Point>, JsError> {
    let line: Vec<Vertex> = crack_middles(border).map(Vertex::new).collect();
    let mut marks = vec![false; line.len()];
    let mut memory = vec![Vertex::default(); line.len()];
    let mut few = List::new(&mut memory);
    let settings = Simplify {
        closed: true,
        tolerance,
        balanced: true,
    };
    simplify(&line, &settings, |_| false, &mut marks, &mut few).map_err(sentence)?;
    let inside = |at: Point| {
        Point::new(
            at.column.clamp(0.0, width as f64),
            at.row.clamp(0.0, height as f64),
        )
    };
    let points = few.as_slice().iter().map(|vertex| inside(vertex.at));
    Ok(points.collect())
}

/// How far the corners of a border move apart where it comes to one place twice, pixels: no pixel's centre comes to lie on the other side.
const APART: f64 = 0.25;

/// The border without the places to which it comes twice, as where a hole meets what is outside at the corner of a pixel: each of both corners is cut off
/// a little. An outline that meets itself is none.
fn apart(border: &[Point]) -> Vec<Point> {
    let place = |at: &Point| [at.column as i64, at.row as i64];
    let mut visits = BTreeMap::new();
    for at in border {
        *visits.entry(place(at)).or_insert(0) += 1;
    }
    let count = border.len();
    let corner = |(at, here): (usize, &Point)| {
        if visits[&place(here)] == 1 {
            return *here;
        }
        let (before, behind) = (border[(at + count - 1) % count], border[(at + 1) % count]);
        let towards = |from: f64, to: f64| {
            APART * f64::from((to - from).partial_cmp(&0.0).map_or(0, |order| order as i8))
        };
        Point::new(
            here.column + towards(here.column, before.column) + towards(here.column, behind.column),
            here.row + towards(here.row, before.row) + towards(here.row, behind.row),
        )
    };
    border.iter().enumerate().map(corner).collect()
}

/// The middle of each side of a pixel along a border of whole corners.
fn crack_middles(border: &[Point]) -> impl Iterator<Item = Point> + '_ {
    let next = border.iter().cycle().skip(1);
    border.iter().zip(next).flat_map(|(from, to)| {
        let (right, down) = (to.column - from.column, to.row - from.row);
        let length = right.abs() + down.abs();
        (0..length as usize).map(move |step| {
            let share = (step as f64 + 0.5) / length;
            Point::new(from.column + share * right, from.row + share * down)
        })
    })
}

/// Pixels inside a border along cracks: its corners are whole numbers, so the shoelace formula is exact.
fn area_of(border: &[Point]) -> u64 {
    let next = border.iter().cycle().skip(1);
    let twice: f64 = border
        .iter()
        .zip(next)
        .map(|(a, b)| a.column * b.row - b.column * a.row)
        .sum();
    (twice.abs() / 2.0) as u64
}

/// The mask of a closed outline.
fn filled(points: &[Point], width: usize, height: usize) -> Result<Vec<Word>, JsError> {
    let outline = Outline::new(points, width, height).map_err(sentence)?;
    let mut words = vec![0; words_needed(width, height)];
    let mut mask = MaskMut::new(&mut words, width, height).map_err(sentence)?;
    mask.fill_outline(&outline);
    Ok(words)
}

/// The pixels inside a closed outline (columns and rows by turns), one byte each: 1 inside, 0 outside.
///
/// # Errors
/// The core's sentence about the outline.
#[wasm_bindgen(js_name = maskOfOutline)]
pub fn mask_of_outline(outline: &[f64], width: u32, height: u32) -> Result<Vec<u8>, JsError> {
    let (width, height) = (width as usize, height as usize);
    let pairs = outline.as_chunks().0.iter();
    let points: Vec<Point> = pairs
        .map(|&[column, row]| Point::new(column, row))
        .collect();
    let words = filled(&points, width, height)?;
    let mask = Mask::new(&words, width, height).map_err(sentence)?;
    let mut pixels = vec![0; width * height];
    for (row, line) in pixels.chunks_exact_mut(width).enumerate() {
        for run in mask.runs(row) {
            line[run].fill(1);
        }
    }
    Ok(pixels)
}

#[cfg(test)]
mod tests {
    use super::*;

    const WIDTH: usize = 60;
    const HEIGHT: usize = 40;

    fn draw(inside: impl Fn(usize, usize) -> bool) -> Vec<u16> {
        (0..WIDTH * HEIGHT)
            .map(|at| u16::from(inside(at % WIDTH, at / WIDTH)) * 9)
            .collect()
    }

    fn film(pixels: &[u16]) -> FrameImage {
        FrameImage::from_sixteen_bit(pixels.to_vec(), WIDTH as u32, HEIGHT as u32)
            .ok()
            .unwrap()
    }

    fn outline(pixels: &[u16]) -> MaskOutline {
        outline_of_mask(&film(pixels), 9, 0.4).ok().unwrap()
    }

    /// Also with few points, which keep the area by lying beyond the region: such an outline was refused as one outside of its frame, and so
    /// was a click beside the implant that it is of.
    #[test]
    fn a_region_that_the_frame_cuts_has_its_outline_inside() {
        let mut beyond = 0;
        for (column, row) in [(58, 20), (1, 20), (30, 1), (30, 38), (57, 37), (60, 3)] {
            for radius in 8..=18_i64 {
                let within =
                    |c: usize, r: usize| (c as i64 - column).pow(2) + (r as i64 - row).pow(2);
                let pixels = draw(|c, r| within(c, r) < radius * radius);
                let found = outline_of_mask(&film(&pixels), 9, 0.5).ok();
                let found = found.expect("its outlines are inside");
                let on = |at: f64, most: usize| at == 0.0 || at == most as f64;
                let pairs = found.points.as_chunks::<2>().0.iter();
                beyond += pairs
                    .filter(|[c, r]| on(*c, WIDTH) || on(*r, HEIGHT))
                    .count();
            }
        }
        assert!(beyond > 0, "none of them is at the border");
    }

    #[test]
    fn a_mask_comes_back_from_its_outline_exactly() {
        let disc = |c: usize, r: usize| (c as i64 - 30).pow(2) + (r as i64 - 20).pow(2) < 200;
        let pixels = draw(disc);
        let found = outline(&pixels);
        assert_eq!((found.specks, found.holes), (0, 0));
        assert_eq!(
            found.area as usize,
            pixels.iter().filter(|&&p| p > 0).count()
        );
        let again = mask_of_outline(&found.exact, WIDTH as u32, HEIGHT as u32)
            .ok()
            .unwrap();
        assert!(
            again
                .iter()
                .zip(&pixels)
                .all(|(&a, &b)| (a != 0) == (b != 0))
        );
    }

    #[test]
    fn few_points_leave_the_border_to_both_sides_alike() {
        let disc = |c: usize, r: usize| (c as i64 - 30).pow(2) + (r as i64 - 20).pow(2) < 300;
        let pixels = draw(disc);
        let found = outline(&pixels);
        assert!(found.points.len() < found.exact.len() / 2);
        let again = mask_of_outline(&found.points, WIDTH as u32, HEIGHT as u32)
            .ok()
            .unwrap();
        let gained = again
            .iter()
            .zip(&pixels)
            .filter(|&(&a, &b)| a != 0 && b == 0);
        let lost = again
            .iter()
            .zip(&pixels)
            .filter(|&(&a, &b)| a == 0 && b != 0);
        let (gained, lost) = (gained.count() as i64, lost.count() as i64);
        assert_eq!(i64::from(found.differing), gained + lost);
        assert!(
            gained + lost < 30,
            "{gained} gained, {lost} lost of {}",
            found.area
        );
        assert!((gained - lost).abs() < 10, "{gained} gained, {lost} lost");
    }

    /// Networks leave ragged borders: holes that touch what is outside at a corner, and parts that touch each other so.
    #[test]
    fn any_mask_has_outlines_that_do_not_cross_and_comes_back() {
        let mut touching = 0;
        for trial in 0..200 {
            let pixels = draw(|c, r| {
                let place = (trial * HEIGHT + r) * WIDTH + c;
                let noise = (place as u32).wrapping_mul(2_654_435_761) >> 16;
                let square = (c as i64 - 30).pow(2) + (r as i64 - 20).pow(2);
                square + i64::from(noise % 400) - 200 < 200
            });
            let found = outline(&pixels);
            touching += usize::from(found.exact.iter().any(|at| at.fract() != 0.0));
            let again = mask_of_outline(&found.exact, WIDTH as u32, HEIGHT as u32)
                .ok()
                .unwrap();
            let area = again.iter().filter(|&&inside| inside != 0).count();
            assert_eq!(area, found.area as usize);
            let given = pixels.iter().filter(|&&pixel| pixel != 0).count();
            assert_eq!(area, given + found.holes as usize - found.specks as usize);
        }
        assert!(touching > 20, "{touching}");
    }

    #[test]
    fn holes_are_filled_and_specks_left_out_and_both_counted() {
        let ring = |c: usize, r: usize| (5..25).contains(&c) && (5..25).contains(&r);
        let hole = |c: usize, r: usize| (10..13).contains(&c) && (10..14).contains(&r);
        let speck = |c: usize, r: usize| c >= 50 && r == 3;
        let found = outline(&draw(|c, r| ring(c, r) && !hole(c, r) || speck(c, r)));
        assert_eq!((found.specks, found.holes, found.area), (10, 12, 400));
        assert_eq!(found.exact.len(), 8);
    }

    #[test]
    fn a_film_of_too_many_greys_or_without_black_is_no_mask() {
        let mut pixels = draw(|c, r| c < 10 && r < 10);
        pixels[0] = 3;
        assert_eq!(labels_of_mask(&film(&pixels), 2), Some(vec![3, 9]));
        assert_eq!(labels_of_mask(&film(&pixels), 1), None);
        assert_eq!(labels_of_mask(&film(&draw(|_, _| true)), 2), None);
    }

    #[test]
    fn only_the_value_asked_for_counts() {
        let mut pixels = draw(|c, r| c < 10 && r < 10);
        pixels[0] = 3;
        assert_eq!(outline(&pixels).area, 99);
    }
}
