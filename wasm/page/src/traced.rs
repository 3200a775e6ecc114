//! What was traced on a frame: the filled outline, and the pixels round those of its sides that were marked unknown.

use fluoropose::camera::Camera;
use fluoropose::image::contour::{Outline, Point};
use fluoropose::image::mask::{Mask, MaskMut, Word, words_needed};
use fluoropose::image::silhouette::{OutlineOrigin, Silhouette};
use fluoropose_tracing::squared_distance;
use wasm_bindgen::prelude::*;

use crate::calibration::camera;
use crate::error::sentence;

/// Pixels nearer than this to a side that is marked unknown, and not nearer to a known one, are unknown. Who guesses
/// where a hidden edge runs errs by some pixels; the opposite edge of a thin part must not be taken along.
const REACH: f64 = 12.0;

/// How far a side that is marked unknown reaches, pixels.
#[wasm_bindgen(js_name = unknownReach)]
#[must_use]
pub fn unknown_reach() -> f64 {
    REACH
}

/// An outline on a frame, filled, with what is not known of it.
#[wasm_bindgen]
pub struct Traced {
    camera: Camera,
    mask: Vec<Word>,
    /// Nothing where every side is known.
    unknown: Option<Vec<Word>>,
    origin: OutlineOrigin,
}

#[wasm_bindgen]
impl Traced {
    /// Fills an outline (columns and rows by turns) on a frame of `width` x `height` pixels, seen by the camera of a
    /// calibration text. `unknown` numbers the sides that are not to be trusted, from 0: side `i` runs from point `i` to
    /// the next.
    ///
    /// # Errors
    /// The core's sentence about the outline or the calibration, or a sentence about a side that does not exist.
    #[wasm_bindgen(constructor)]
    pub fn new(
        outline: &[f64],
        unknown: &[u32],
        calibration: &str,
        width: u32,
        height: u32,
    ) -> Result<Traced, JsError> {
        let camera = camera(calibration, width, height)?;
        let (width, height) = (camera.width(), camera.height());
        let points = points_of(outline);
        let words = filled(&points, width, height)?;
        let unknown = match unknown {
            [] => None,
            numbers => Some(band(&points, numbers, width, height)?),
        };
        Ok(Self {
            camera,
            mask: words,
            unknown,
            origin: OutlineOrigin::Hand,
        })
    }

    /// Says who laid the outline on the frame: a `hand`, a `tool` that follows edges, or both (`mixed`); or a program `drawn` it from
    /// the model itself. All but the last lie off the implant's outline by a distance that nobody knows, and poses from it say so.
    ///
    /// # Errors
    /// A sentence about another word.
    #[wasm_bindgen(js_name = laidBy)]
    pub fn laid_by(&mut self, word: &str) -> Result<(), JsError> {
        self.origin = OutlineOrigin::of_word(word).ok_or_else(|| {
            JsError::new(&format!(
                "An outline is laid by a hand, drawn, laid by a tool, or mixed, not '{word}'"
            ))
        })?;
        Ok(())
    }
}

/// Points of an outline; columns and rows by turns.
pub fn points_of(outline: &[f64]) -> Vec<Point> {
    let pairs = outline.as_chunks().0.iter();
    pairs
        .map(|&[column, row]| Point::new(column, row))
        .collect()
}

/// A mask of the pixels of a frame inside an outline.
///
/// # Errors
/// The core's sentence about the outline.
pub fn filled(points: &[Point], width: usize, height: usize) -> Result<Vec<Word>, JsError> {
    let outline = Outline::new(points, width, height).map_err(sentence)?;
    let mut words = vec![0; words_needed(width, height)];
    let mut mask = MaskMut::new(&mut words, width, height).map_err(sentence)?;
    mask.fill_outline(&outline);
    Ok(words)
}

impl Traced {
    /// The camera that the outline is seen by.
    pub fn camera(&self) -> Camera {
        self.camera
    }

    /// Whether sides were marked unknown.
    pub fn is_marked(&self) -> bool {
        self.unknown.is_some()
    }

    /// Words of the mask of unknown pixels, where sides were marked unknown.
    pub fn unknown(&self) -> Option<&[Word]> {
        self.unknown.as_deref()
    }

    /// Calls `with` with the silhouette.
    ///
    /// # Errors
    /// That of `with`.
    pub fn look<T>(
        &self,
        with: impl FnOnce(&Silhouette<'_>) -> Result<T, JsError>,
    ) -> Result<T, JsError> {
        let (width, height) = (self.camera.width(), self.camera.height());
        let mask = Mask::new(&self.mask, width, height).map_err(sentence)?;
        let Some(words) = &self.unknown else {
            return with(&Silhouette::from(&mask).laid_by(self.origin));
        };
        let unknown = Mask::new(words, width, height).map_err(sentence)?;
        let silhouette = Silhouette::new(&mask, &unknown).map_err(sentence)?;
        with(&silhouette.laid_by(self.origin))
    }
}

/// The words of the mask of unknown pixels.
fn band(
    points: &[Point],
    numbers: &[u32],
    width: usize,
    height: usize,
) -> Result<Vec<Word>, JsError> {
    if let Some(number) = numbers.iter().find(|&&side| side as usize >= points.len()) {
        return Err(JsError::new(&format!(
            "Side {number} is marked unknown, but the outline has {} sides",
            points.len()
        )));
    }
    let sides: Vec<Side> = sides(points).collect();
    let known = |number: &usize| !numbers.contains(&(*number as u32));
    let known: Vec<Side> = (0..sides.len()).filter(known).map(|at| sides[at]).collect();
    let mut words = vec![0; words_needed(width, height)];
    let mut unknown = MaskMut::new(&mut words, width, height).map_err(sentence)?;
    for &number in numbers {
        sides[number as usize].mark(&known, &mut unknown);
    }
    Ok(words)
}

/// A side of an outline, from one point to the next.
#[derive(Clone, Copy)]
struct Side(Point, Point);

fn sides(points: &[Point]) -> impl Iterator<Item = Side> + '_ {
    let next = points.iter().cycle().skip(1);
    points.iter().zip(next).map(|(&from, &to)| Side(from, to))
}

impl Side {
    /// Marks the pixels within [`REACH`] that are not nearer to one of the `known` sides.
    fn mark(&self, known: &[Side], unknown: &mut MaskMut<'_>) {
        let near: Vec<Side> = known.iter().copied().filter(|s| s.is_near(self)).collect();
        let within = |least: f64, most: f64, size: usize| {
            let first = (least - REACH).max(0.0) as usize;
            first..((most + REACH).max(0.0) as usize + 1).min(size)
        };
        let [(left, right), (top, bottom)] = self.bounds();
        for row in within(top, bottom, unknown.height()) {
            for column in within(left, right, unknown.width()) {
                let centre = Point::new(column as f64 + 0.5, row as f64 + 0.5);
                let away = self.squared_from(centre);
                let nearer = |side: &Side| side.squared_from(centre) < away;
                if away <= REACH * REACH && !near.iter().any(nearer) {
                    unknown.set(column, row, true);
                }
            }
        }
    }

    /// Least and greatest column, least and greatest row.
    fn bounds(&self) -> [(f64, f64); 2] {
        let Self(a, b) = self;
        let both = |x: f64, y: f64| (x.min(y), x.max(y));
        [both(a.column, b.column), both(a.row, b.row)]
    }

    fn squared_from(&self, point: Point) -> f64 {
        squared_distance(point, (self.0, self.1))
    }

    /// Whether a pixel within [`REACH`] of the other side may be nearer to this one.
    fn is_near(&self, other: &Side) -> bool {
        let mut pairs = self.bounds().into_iter().zip(other.bounds());
        pairs.all(|((a, b), (c, d))| a <= d + 2.0 * REACH && b >= c - 2.0 * REACH)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIDE: usize = 200;

    /// A plate of 100 x 16 px: its long edges are 16 px apart.
    fn plate() -> [Point; 4] {
        [(40.0, 80.0), (140.0, 80.0), (140.0, 96.0), (40.0, 96.0)].map(|(c, r)| Point::new(c, r))
    }

    fn marked(numbers: &[u32]) -> Vec<Word> {
        band(&plate(), numbers, SIDE, SIDE).ok().unwrap()
    }

    #[test]
    fn the_band_reaches_twelve_pixels_and_leaves_what_is_nearer_to_a_known_side() {
        let words = marked(&[0]);
        let unknown = Mask::new(&words, SIDE, SIDE).unwrap();
        let column = 90;
        let rows: Vec<usize> = (0..SIDE).filter(|&row| unknown.get(column, row)).collect();
        // Outwards as far as it reaches, inwards to the middle of the plate.
        assert_eq!((rows[0], *rows.last().unwrap()), (68, 87));
        assert_eq!(rows.len(), 20);
        assert!(unknown.get(136, 79) && !unknown.get(147, 95));
    }

    #[test]
    fn where_everything_is_marked_all_round_is_unknown() {
        let words = marked(&[0, 1, 2, 3]);
        let unknown = Mask::new(&words, SIDE, SIDE).unwrap();
        for point in plate() {
            assert!(unknown.get(point.column as usize, point.row as usize));
        }
        assert!(unknown.get(90, 88) && !unknown.get(90, 109));
    }

    #[test]
    fn distances_are_those_to_the_nearest_point_of_a_side() {
        let side = Side(Point::new(0.0, 0.0), Point::new(10.0, 0.0));
        for (column, row, squared) in [(5.0, 3.0, 9.0), (-3.0, 4.0, 25.0), (13.0, 4.0, 25.0)] {
            assert_eq!(side.squared_from(Point::new(column, row)), squared);
        }
    }
}
