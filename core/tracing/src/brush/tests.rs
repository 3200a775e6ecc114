use super::*;
use crate::polyline::{squared_distance, twice_area};
use crate::synthetic::{Random, circle};
use fluoropose::image::contour::Outline;
use fluoropose::image::mask::{Mask, MaskMut, words_needed};
use std::vec::Vec;

fn brushed(points: &[Point], stroke: &[Point], radius: f64, what: Brush) -> (Vec<Vertex>, f64) {
    let needed = brush_needed(points.len(), stroke.len());
    let mut places = std::vec![Vertex::default(); needed];
    let mut out = List::new(&mut places);
    let memory = BrushMemory {
        before: &mut std::vec![Vertex::default(); needed],
        after: &mut std::vec![Vertex::default(); needed],
        cuts: &mut std::vec![Cut::default(); needed],
        marks: &mut std::vec![false; needed],
    };
    let left_out = brush(points, stroke, radius, what, memory, &mut out).expect("valid");
    (out.as_slice().to_vec(), left_out)
}

fn points_of(line: &[Vertex]) -> Vec<Point> {
    line.iter().map(|vertex| vertex.at).collect()
}

fn place(column: f64, row: f64) -> Point {
    Point::new(column, row)
}

const SIDE: usize = 128;

fn filled(points: &[Point]) -> Vec<u32> {
    let outline = Outline::new(points, SIDE, SIDE).expect("simple");
    let mut words = std::vec![0; words_needed(SIDE, SIDE)];
    MaskMut::new(&mut words, SIDE, SIDE)
        .expect("fits")
        .fill_outline(&outline);
    words
}

/// Distance of a place from a stroke's middle line.
fn away(stroke: &[Point], at: Point) -> f64 {
    let single = [(stroke[0], stroke[0])];
    let sides = stroke.windows(2).map(|pair| (pair[0], pair[1]));
    let squares = single
        .into_iter()
        .chain(sides)
        .map(|ends| squared_distance(at, ends));
    squares.fold(f64::INFINITY, f64::min).sqrt()
}

/// Compares with pixels: the union or the difference, its largest region, holes filled. Gives how many pixels away from
/// the stroke's border differ.
fn differing(points: &[Point], stroke: &[Point], radius: f64, what: Brush) -> usize {
    let (line, _) = brushed(points, stroke, radius, what);
    let before = filled(points);
    let before = Mask::new(&before, SIDE, SIDE).expect("valid");
    let mut words = std::vec![0; words_needed(SIDE, SIDE)];
    let mut wanted = MaskMut::new(&mut words, SIDE, SIDE).expect("fits");
    for (column, row) in (0..SIDE).flat_map(|c| (0..SIDE).map(move |r| (c, r))) {
        let centre = place(column as f64 + 0.5, row as f64 + 0.5);
        let painted = away(stroke, centre) < radius;
        let inside = before.get(column, row);
        let value = if what == Brush::Add {
            inside || painted
        } else {
            inside && !painted
        };
        wanted.set(column, row, value);
    }
    let wanted = whole_region(&wanted.into_mask());
    let got = if line.is_empty() {
        std::vec![0; words_needed(SIDE, SIDE)]
    } else {
        filled(&points_of(&line))
    };
    let got = Mask::new(&got, SIDE, SIDE).expect("valid");
    let pixels = (0..SIDE).flat_map(|c| (0..SIDE).map(move |r| (c, r)));
    let differ = |&(column, row): &(usize, usize)| {
        let centre = place(column as f64 + 0.5, row as f64 + 0.5);
        // The disc is a polygon, and its new corners are thinned out.
        let on_border = (away(stroke, centre) - radius).abs() < 0.25;
        !on_border && got.get(column, row) != wanted[row * SIDE + column]
    };
    pixels.filter(differ).count()
}

/// The largest region with its holes filled: what a flood from outside does not reach.
fn whole_region(mask: &Mask<'_>) -> Vec<bool> {
    let mut words = [(); 2].map(|()| std::vec![0; words_needed(SIDE, SIDE)]);
    let [a, b] = &mut words;
    let mut masks = [a, b].map(|words| MaskMut::new(words, SIDE, SIDE).expect("fits"));
    let [rest, out] = &mut masks;
    fluoropose::image::region::largest_region(mask, rest, out).expect("one shape");
    let region = out.as_mask();
    let mut outside = std::vec![false; SIDE * SIDE];
    let mut waiting = std::vec![(0usize, 0usize)];
    while let Some((column, row)) = waiting.pop() {
        if column >= SIDE || row >= SIDE || outside[row * SIDE + column] || region.get(column, row)
        {
            continue;
        }
        outside[row * SIDE + column] = true;
        let before = |at: usize| at.wrapping_sub(1);
        let next = [
            (column + 1, row),
            (before(column), row),
            (column, row + 1),
            (column, before(row)),
        ];
        waiting.extend(next);
    }
    outside.iter().map(|outside| !outside).collect()
}

#[test]
fn strokes_do_to_outlines_what_they_do_to_pixels() {
    let mut random = Random(21);
    let mut shapes = std::vec![circle([64.0, 64.0], 34.0, 40)];
    let wavy = circle([0.0, 0.0], 1.0, 90)
        .into_iter()
        .enumerate()
        .map(|(k, p)| {
            let radius = 38.0 + 9.0 * (k as f64 / 4.0).sin();
            place(64.0 + radius * p.column, 64.0 + radius * p.row)
        });
    shapes.push(wavy.collect());
    shapes.push(
        [(30.0, 30.0), (98.0, 30.0), (98.0, 98.0), (30.0, 98.0)]
            .map(|(c, r)| place(c, r))
            .to_vec(),
    );
    let (mut checked, mut different) = (0, 0);
    for case in 0..60 {
        let mut points = shapes[case % 3].clone();
        if case % 2 == 1 {
            points.reverse();
        }
        let count = 1 + case % 6;
        let mut at = place(
            30.0 + 68.0 * random.uniform(),
            30.0 + 68.0 * random.uniform(),
        );
        let mut stroke = std::vec![at];
        for _ in 1..count {
            let mut step = || 16.0 * (random.uniform() - 0.5);
            at = place(
                (at.column + step()).clamp(25.0, 103.0),
                (at.row + step()).clamp(25.0, 103.0),
            );
            stroke.push(at);
        }
        let radius = 3.0 + 12.0 * random.uniform();
        // A ring or a gap thinner than a pixel is none to pixels.
        let nearest = sides_away(&points, &stroke);
        if (nearest - radius).abs() < 2.0 {
            continue;
        }
        for what in [Brush::Add, Brush::Erase] {
            checked += 1;
            different += usize::from(differing(&points, &stroke, radius, what) > 0);
        }
    }
    // Necks thinner than a pixel part for pixels what they join, in a few of the cases.
    assert!(checked > 80 && different <= 3, "{different} of {checked}");
}

/// The least distance of an outline from a stroke's middle line.
fn sides_away(points: &[Point], stroke: &[Point]) -> f64 {
    let places = (0..points.len()).flat_map(|k| {
        let ends = crate::polyline::side(points, k);
        (0..100).map(move |part| crate::polyline::between(ends, f64::from(part) / 100.0))
    });
    places
        .map(|at| away(stroke, at))
        .fold(f64::INFINITY, f64::min)
}

#[test]
fn points_outside_the_stroke_are_untouched_and_in_their_order() {
    let points = circle([64.0, 64.0], 40.0, 60);
    let stroke = [place(104.0, 60.0), place(106.0, 66.0)];
    for what in [Brush::Add, Brush::Erase] {
        let (line, left_out) = brushed(&points, &stroke, 7.0, what);
        assert_eq!(left_out, 0.0);
        let kept: Vec<usize> = line.iter().filter_map(Vertex::kept_number).collect();
        let outside: Vec<usize> = (0..60)
            .filter(|&k| away(&stroke, points[k]) > 7.0)
            .collect();
        let mut sorted = kept.clone();
        sorted.sort_unstable();
        assert_eq!(sorted, outside);
        for vertex in &line {
            if let Some(number) = vertex.kept_number() {
                assert_eq!(vertex.at, points[number]);
            } else if vertex.from != NEW {
                let ends = crate::polyline::side(&points, vertex.from as usize);
                assert!(squared_distance(vertex.at, ends) < 1e-12);
            }
        }
        // Two points where the stroke's border is met, and new ones between them.
        let on_sides = line
            .iter()
            .filter(|v| v.from != NEW && v.kept_number().is_none());
        assert_eq!(on_sides.count(), 2);
        assert!(line.iter().any(|v| v.from == NEW));
        // The new points' side of the outline is that of the disc.
        let new = line.iter().filter(|v| v.from == NEW);
        assert!(
            new.map(|v| (away(&stroke, v.at) - 7.0).abs())
                .fold(0.0, f64::max)
                < 0.2
        );
    }
}

#[test]
fn holes_are_not_made_and_the_larger_piece_stays() {
    let points =
        [(20.0, 40.0), (100.0, 40.0), (100.0, 60.0), (20.0, 60.0)].map(|(c, r)| place(c, r));
    let (line, _) = brushed(&points, &[place(60.0, 50.0)], 6.0, Brush::Erase);
    assert_eq!(points_of(&line), points);
    let (line, _) = brushed(&points, &[place(60.0, 90.0)], 6.0, Brush::Add);
    assert_eq!(points_of(&line), points);
    // Right through: 80 % of the plate stay.
    let (line, left_out) = brushed(
        &points,
        &[place(80.0, 20.0), place(80.0, 80.0)],
        4.0,
        Brush::Erase,
    );
    assert!((left_out - 16.0 * 20.0).abs() < 1.0, "{left_out}");
    let area = twice_area(&points_of(&line)) / 2.0;
    assert!((area - 56.0 * 20.0).abs() < 1.0, "{area}");
    // All of it, and more than all.
    let (line, _) = brushed(
        &points,
        &[place(10.0, 50.0), place(110.0, 50.0)],
        30.0,
        Brush::Erase,
    );
    assert!(line.is_empty());
    let (line, _) = brushed(&points, &[place(60.0, 50.0)], 80.0, Brush::Add);
    let area = twice_area(&points_of(&line)) / 2.0;
    assert!((area / (core::f64::consts::PI * 6400.0) - 1.0).abs() < 0.003);
}

#[test]
fn without_an_outline_the_stroke_becomes_one() {
    let stroke = [place(40.0, 40.0), place(60.0, 50.0), place(80.0, 40.0)];
    let (line, _) = brushed(&[], &stroke, 9.0, Brush::Add);
    assert!(line.iter().all(|vertex| vertex.from == NEW));
    let off = line
        .iter()
        .map(|v| (away(&stroke, v.at) - 9.0).abs())
        .fold(0.0, f64::max);
    assert!(off < 0.2, "{off}");
    assert!(brushed(&[], &stroke, 9.0, Brush::Erase).0.is_empty());
}

#[test]
fn a_stroke_along_a_side_and_through_corners_is_no_trouble() {
    let points = [(30.0, 30.0), (98.0, 30.0), (98.0, 98.0), (30.0, 98.0)].map(|(c, r)| place(c, r));
    // The discs' borders run along sides and through corners exactly.
    for (stroke, radius) in [
        (std::vec![place(40.0, 40.0), place(90.0, 40.0)], 10.0),
        (
            std::vec![place(30.0, 30.0), place(98.0, 30.0), place(98.0, 98.0)],
            10.0,
        ),
        (std::vec![place(30.0, 20.0)], 10.0),
        (std::vec![place(64.0, 98.0), place(64.0, 98.0)], 8.0),
    ] {
        for what in [Brush::Add, Brush::Erase] {
            assert_eq!(differing(&points, &stroke, radius, what), 0);
        }
    }
}

#[test]
fn wrong_settings_are_said() {
    let points = circle([64.0, 64.0], 40.0, 60);
    let memory = || BrushMemory {
        before: &mut [],
        after: &mut [],
        cuts: &mut [],
        marks: &mut [],
    };
    let mut out = List::new(&mut []);
    let mut wrong =
        |stroke: &[Point], radius| brush(&points, stroke, radius, Brush::Add, memory(), &mut out);
    assert!(matches!(
        wrong(&points[..1], f64::NAN),
        Err(TracingError::Setting { .. })
    ));
    assert!(matches!(
        wrong(&[], 5.0),
        Err(TracingError::TooFewPoints { .. })
    ));
    assert!(matches!(
        wrong(&points[..1], 5.0),
        Err(TracingError::Memory(_))
    ));
}

/// An outline is the same whichever of its points is the first, and what is made of it remembers the same places.
#[test]
fn the_first_point_of_an_outline_does_not_matter() {
    let points = circle([64.0, 64.0], 40.0, 60);
    let stroke = [place(104.0, 58.0), place(106.0, 66.0), place(99.0, 73.0)];
    for what in [Brush::Add, Brush::Erase] {
        let from_first = |first: usize| {
            let mut rotated = points.clone();
            rotated.rotate_left(first);
            let (line, _) = brushed(&rotated, &stroke, 6.0, what);
            let known = line.iter().filter(|vertex| vertex.from != NEW);
            let mut known: Vec<(f64, Point)> = known
                .map(|vertex| ((vertex.from + first as f64) % 60.0, vertex.at))
                .collect();
            known.sort_by(|a, b| a.0.total_cmp(&b.0));
            known
        };
        let own = from_first(0);
        for first in [1, 2, 3, 30, 57, 58, 59] {
            let other = from_first(first);
            assert_eq!(other.len(), own.len(), "{first}");
            for ((from, at), (other_from, other_at)) in own.iter().zip(&other) {
                assert!(
                    (from - other_from).abs() < 1e-6,
                    "{first}: {from} {other_from}"
                );
                assert!(squared_distance(*at, (*other_at, *other_at)) < 1e-12);
            }
        }
    }
}
