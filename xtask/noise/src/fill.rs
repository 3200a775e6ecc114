//! Polygons that may cross themselves, filled.

use anyhow::Result;
use fluoropose::image::contour::Point;
use fluoropose::image::mask::MaskMut;

use crate::mask_buffer::MaskBuffer;

/// A polygon (clockwise on the screen) and whether what it encloses is taken out of the mask.
pub type Painted<'a> = (&'a [Point], bool);

/// Paints polygons one after the other: the pixels whose centre they wind round at least once,
/// clockwise.
///
/// For a polygon that does not cross itself that is its inside, as
/// [`fluoropose::image::mask::MaskMut::fill_outline`] fills it. Where the sides of a displaced polygon cross at a sharp
/// corner they leave small loops: those on the outer side run anticlockwise and are left out, those on the
/// inner side are wound round twice and stay filled (X. Chen and S. McMains, *Polygon offsetting by
/// computing winding numbers*, ASME DETC 2005). What is beyond the frame is cut off.
///
/// # Errors
/// For a shape that no mask has.
pub fn filled(polygons: &[Painted<'_>], width: usize, height: usize) -> Result<MaskBuffer> {
    let mut buffer = MaskBuffer::new(width, height)?;
    buffer.draw(|mask| {
        for &(points, out) in polygons {
            paint(points, !out, mask);
        }
    });
    Ok(buffer)
}

/// A side that crosses a row's centres, and the change of the winding number to its right.
struct Crossing {
    column: f64,
    turns: i32,
}

fn paint(points: &[Point], value: bool, mask: &mut MaskMut<'_>) {
    let width = mask.width() as f64;
    for (row, crossings) in crossings(points, mask.height()).iter_mut().enumerate() {
        crossings.sort_by(|a, b| a.column.total_cmp(&b.column));
        let mut winding = 0;
        for k in 0..crossings.len() {
            winding += crossings[k].turns;
            let (Some(next), true) = (crossings.get(k + 1), winding > 0) else {
                continue;
            };
            // The first centre at or right of a side.
            let first = |column: f64| (column - 0.5).ceil().clamp(0.0, width) as usize;
            for column in first(crossings[k].column)..first(next.column) {
                mask.set(column, row, value);
            }
        }
    }
}

fn crossings(points: &[Point], height: usize) -> Vec<Vec<Crossing>> {
    let mut rows: Vec<Vec<Crossing>> = Vec::new();
    rows.resize_with(height, Vec::new);
    let cut = |row: f64| (row - 0.5).ceil().clamp(0.0, height as f64) as usize;
    for (k, &a) in points.iter().enumerate() {
        let b = points[(k + 1) % points.len()];
        // On a clockwise way the left side goes up.
        let (upper, lower, turns) = if a.row <= b.row {
            (a, b, -1)
        } else {
            (b, a, 1)
        };
        let slope = (lower.column - upper.column) / (lower.row - upper.row);
        for (offset, crossings) in rows[cut(upper.row)..cut(lower.row)].iter_mut().enumerate() {
            let centre = (cut(upper.row) + offset) as f64 + 0.5;
            crossings.push(Crossing {
                column: upper.column + slope * (centre - upper.row),
                turns,
            });
        }
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;
    use fluoropose::image::contour::Outline;

    const SIDE: usize = 64;

    fn points(pairs: &[(f64, f64)]) -> Vec<Point> {
        pairs.iter().map(|&(c, r)| Point::new(c, r)).collect()
    }

    #[test]
    fn a_simple_polygon_is_filled_as_the_core_fills_it() {
        // A star of 23 points, coordinates in whole 1/4096 of a pixel as the core rounds them.
        let star: Vec<Point> = (0..23)
            .map(|k| {
                let (sine, cosine) = libm::sincos(f64::from(k) * std::f64::consts::TAU / 23.0);
                let radius = if k % 2 == 0 { 29.3 } else { 11.7 };
                let round = |value: f64| (value * 4096.0).round() / 4096.0;
                Point::new(round(31.3 + radius * cosine), round(33.1 + radius * sine))
            })
            .collect();
        let mut words = vec![0; fluoropose::image::mask::words_needed(SIDE, SIDE)];
        let mut oracle = MaskMut::new(&mut words, SIDE, SIDE).unwrap();
        oracle.fill_outline(&Outline::new(&star, SIDE, SIDE).unwrap());
        let found = filled(&[(&star, false)], SIDE, SIDE).unwrap();
        assert_eq!(found.mask().unmatched(&oracle.as_mask()), Some(0));
        assert!(found.mask().area() > 500);
    }

    #[test]
    fn loops_outside_are_left_out_and_loops_inside_stay_filled() {
        // A square of side 20 whose upper right corner is crossed: a loop of side 4 beyond it.
        let beyond = points(&[
            (10.0, 10.0),
            (30.0, 10.0),
            (30.0, 6.0),
            (34.0, 6.0),
            (34.0, 10.0),
            (30.0, 10.0),
            (30.0, 30.0),
            (10.0, 30.0),
        ]);
        let reversed = points(&[
            (10.0, 10.0),
            (34.0, 10.0),
            (34.0, 6.0),
            (30.0, 6.0),
            (30.0, 30.0),
            (10.0, 30.0),
        ]);
        let area = |polygon: &[Point]| {
            let found = filled(&[(polygon, false)], SIDE, SIDE).unwrap();
            found.mask().area()
        };
        assert_eq!(area(&beyond), 400 + 16, "a clockwise loop is a part");
        assert_eq!(area(&reversed), 400, "an anticlockwise loop is a crossing");
        let twice = points(&[
            (10.0, 10.0),
            (30.0, 10.0),
            (30.0, 30.0),
            (10.0, 30.0),
            (10.0, 10.0),
            (20.0, 10.0),
            (20.0, 20.0),
            (10.0, 20.0),
        ]);
        assert_eq!(area(&twice), 400);
    }

    #[test]
    fn holes_are_taken_out_and_what_is_beyond_the_frame_is_cut() {
        let outer = points(&[(-9.0, 10.0), (30.0, 10.0), (30.0, 90.0), (-9.0, 90.0)]);
        let hole = points(&[(10.0, 20.0), (20.0, 20.0), (20.0, 30.0), (10.0, 30.0)]);
        let found = filled(&[(&outer, false), (&hole, true)], SIDE, SIDE).unwrap();
        assert_eq!(found.mask().area(), 30 * 54 - 100);
    }
}
