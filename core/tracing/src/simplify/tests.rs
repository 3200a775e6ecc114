use super::*;
use crate::polyline::side;
use crate::synthetic::{Random, circle};
use fluoropose::memory::TooLittleMemory;
use std::vec::Vec;

fn vertices(points: &[Point]) -> Vec<Vertex> {
    let numbered = points.iter().enumerate();
    numbered
        .map(|(number, &at)| Vertex::kept(number, at))
        .collect()
}

fn simple(points: &[Point], closed: bool, tolerance: f64) -> (Vec<Vertex>, ShapeError) {
    let mut marks = std::vec![false; points.len()];
    let mut places = std::vec![Vertex::default(); points.len()];
    let mut out = List::new(&mut places);
    let line = vertices(points);
    let settings = Simplify {
        closed,
        tolerance,
        balanced: false,
    };
    let error = simplify(&line, &settings, |_| false, &mut marks, &mut out).expect("valid");
    (out.as_slice().to_vec(), error)
}

fn ring(tolerance: f64) -> Simplify {
    Simplify {
        closed: true,
        tolerance,
        balanced: false,
    }
}

/// A circle that wobbles.
fn wobbly(count: usize) -> Vec<Point> {
    let mut random = Random(3);
    let radius = |k: usize| 40.0 + 4.0 * (k as f64 / 9.0).sin();
    let points = circle([0.0, 0.0], 1.0, count).into_iter().enumerate();
    points
        .map(|(k, p)| {
            let radius = radius(k) + 0.4 * random.uniform();
            Point::new(60.0 + radius * p.column, 60.0 + radius * p.row)
        })
        .collect()
}

/// Oracle: the definition, by recursion.
fn naive(line: &[Point], tolerance: f64) -> Vec<Point> {
    let chord = (line[0], line[line.len() - 1]);
    let away: Vec<f64> = line
        .iter()
        .map(|&p| squared_distance(p, chord).sqrt())
        .collect();
    let inner = 1..line.len() - 1;
    let greatest = inner.clone().map(|k| away[k]).fold(0.0, f64::max);
    if greatest <= tolerance {
        return std::vec![chord.0, chord.1];
    }
    let at = inner
        .into_iter()
        .find(|&k| away[k] == greatest)
        .expect("one is");
    let mut both = naive(&line[..=at], tolerance);
    both.pop();
    both.extend(naive(&line[at..], tolerance));
    both
}

#[test]
fn an_open_line_is_that_of_the_definition() {
    let points = wobbly(180);
    for tolerance in [0.05, 0.3, 1.0, 5.0] {
        let (line, _) = simple(&points, false, tolerance);
        let got: Vec<Point> = line.iter().map(|vertex| vertex.at).collect();
        assert_eq!(got, naive(&points, tolerance));
    }
}

#[test]
fn the_error_is_that_of_the_shape_and_within_the_tolerance() {
    let points = wobbly(200);
    for tolerance in [0.1, 0.5, 2.0] {
        let (line, error) = simple(&points, true, tolerance);
        assert!(line.len() < 150, "{}", line.len());
        let simple: Vec<Point> = line.iter().map(|vertex| vertex.at).collect();
        // Every point of the given line is at least as near to the simplified one as the error says.
        let mut greatest = 0.0f64;
        let (mut sum, mut count) = (0.0, 0.0);
        for number in 0..points.len() {
            for part in 0..10 {
                let at = crate::polyline::between(side(&points, number), f64::from(part) / 10.0);
                let sides = (0..simple.len()).map(|number| side(&simple, number));
                let nearest = sides
                    .map(|s| squared_distance(at, s))
                    .fold(f64::MAX, f64::min);
                greatest = greatest.max(nearest.sqrt());
                sum += nearest;
                count += 1.0;
            }
        }
        assert!(greatest <= error.max + 1e-9 && error.max <= tolerance + 1e-9);
        assert!((error.rms / (sum / count).sqrt() - 1.0).abs() < 0.05);
    }
}

#[test]
fn a_closed_line_does_not_depend_on_its_first_point() {
    let points = wobbly(120);
    let (line, error) = simple(&points, true, 0.6);
    let key = |vertex: &Vertex| (vertex.at.column.to_bits(), vertex.at.row.to_bits());
    let mut wanted: Vec<_> = line.iter().map(key).collect();
    wanted.sort_unstable();
    for first in [1, 37, 100] {
        let mut rotated = points.clone();
        rotated.rotate_left(first);
        let (line, other) = simple(&rotated, true, 0.6);
        let mut got: Vec<_> = line.iter().map(key).collect();
        got.sort_unstable();
        assert_eq!(got, wanted);
        assert!((other.rms - error.rms).abs() < 1e-9);
    }
}

#[test]
fn a_balanced_outline_keeps_its_area() {
    let points = circle([100.0, 100.0], 60.0, 400);
    let made: Vec<Vertex> = points.iter().map(|&at| Vertex::new(at)).collect();
    let area = |line: &[Vertex]| {
        let points: Vec<Point> = line.iter().map(|vertex| vertex.at).collect();
        twice_area(&points) / 2.0
    };
    let mut marks = std::vec![false; points.len()];
    let mut places = std::vec![Vertex::default(); points.len()];
    let mut out = List::new(&mut places);
    let mut lost = |balanced: bool| {
        let settings = Simplify {
            balanced,
            ..ring(0.5)
        };
        let error = simplify(&made, &settings, |_| false, &mut marks, &mut out).expect("valid");
        assert!(out.len() < 40 && error.max < 0.5);
        // As a distance all around.
        (area(&made) - area(out.as_slice())) / (120.0 * core::f64::consts::PI)
    };
    assert!(lost(false) > 0.15);
    assert!(lost(true).abs() < 0.005, "{}", lost(true));
}

#[test]
fn what_is_to_stay_stays() {
    let points = circle([50.0, 50.0], 20.0, 64);
    let line = vertices(&points);
    let mut marks = [false; 64];
    let mut places = [Vertex::default(); 64];
    let mut out = List::new(&mut places);
    let keep = |vertex: &Vertex| vertex.from == 5.0 || vertex.from == 6.0;
    simplify(&line, &ring(3.0), keep, &mut marks, &mut out).expect("valid");
    let numbers: Vec<_> = out
        .as_slice()
        .iter()
        .filter_map(Vertex::kept_number)
        .collect();
    assert!(numbers.contains(&5) && numbers.contains(&6) && numbers.len() < 10);
}

#[test]
fn a_thin_plate_does_not_fold_onto_itself() {
    // Two long wavy sides 1 pixel apart, a tolerance of 3.
    let wave = |k: usize| (k as f64 / 3.0).sin() * 2.5;
    let there = (0..100).map(|k| Point::new(k as f64, 50.0 + wave(k)));
    let back = (0..100)
        .rev()
        .map(|k| Point::new(k as f64 + 0.3, 51.0 + wave(k)));
    let points: Vec<Point> = there.chain(back).collect();
    assert_eq!(first_crossing(points.len(), |k| points[k]), None);
    let (line, error) = simple(&points, true, 3.0);
    assert_eq!(first_crossing(line.len(), |k| line[k].at), None);
    assert!(line.len() < points.len() && error.max < 3.0);
}

#[test]
fn what_is_impossible_is_said() {
    let line = vertices(&circle([9.0, 9.0], 5.0, 8));
    let mut places = [Vertex::default(); 8];
    let mut out = List::new(&mut places);
    let short = simplify(&line, &ring(0.1), |_| false, &mut [false; 7], &mut out);
    assert!(matches!(
        short,
        Err(TracingError::Memory(TooLittleMemory { needed: 8, .. }))
    ));
    let wrong = simplify(&line, &ring(f64::NAN), |_| false, &mut [false; 8], &mut out);
    assert!(matches!(wrong, Err(TracingError::Setting { .. })));
    let nothing = simplify(&[], &ring(1.0), |_| false, &mut [], &mut out);
    assert_eq!(nothing, Ok(ShapeError::default()));
}

#[test]
fn given_points_are_vertices_of_their_own_numbers() {
    let points = [(0.0, 1.0), (2.0, 3.0), (4.0, 0.0)].map(|(c, r)| Point::new(c, r));
    let mut places = [Vertex::default(); 3];
    let mut out = List::new(&mut places);
    for closed in [false, true] {
        assert_eq!(as_vertices(&points, closed, &mut out), Ok(()));
        let expected = [0, 1, 2].map(|number| Vertex::kept(number, points[number]));
        assert_eq!(out.as_slice(), expected);
        let few = &points[..if closed { 2 } else { 1 }];
        assert!(matches!(
            as_vertices(few, closed, &mut out),
            Err(TracingError::TooFewPoints { .. })
        ));
    }
    let mut short = [Vertex::default(); 2];
    assert!(as_vertices(&points, true, &mut List::new(&mut short)).is_err());
}

/// A band that winds twice around: chords as far from it as its windings are from each other cut through them.
#[test]
fn a_closed_line_is_thinned_out_until_it_does_not_cross_itself() {
    let along = |side: f64| {
        (0..120).map(move |step| {
            let turn = 0.1 * f64::from(step);
            let (sin, cos) = turn.sin_cos();
            let radius = 6.0 + 1.2 * turn + side;
            Point::new(60.0 + radius * cos, 60.0 + radius * sin)
        })
    };
    let inner: Vec<Point> = along(0.0).collect();
    let points: Vec<Point> = along(2.0).chain(inner.into_iter().rev()).collect();
    let line: Vec<Vertex> = points
        .iter()
        .enumerate()
        .map(|(k, &at)| Vertex::kept(k, at))
        .collect();
    let mut cut_through = 0;
    for tolerance in [2.0, 4.0, 6.0, 8.0, 12.0] {
        let mut marks = std::vec![false; line.len()];
        mark(&line, true, tolerance, &|_: &Vertex| false, &mut marks);
        let kept = line.iter().zip(&marks).filter(|(_, marked)| **marked);
        let at_once: Vec<Vertex> = kept.map(|(vertex, _)| *vertex).collect();
        cut_through += usize::from(crosses(&at_once));
        let settings = Simplify {
            closed: true,
            tolerance,
            balanced: false,
        };
        let mut places = line.clone();
        let mut out = List::new(&mut places);
        simplify(&line, &settings, |_| false, &mut marks, &mut out).expect("valid");
        let made = out.as_slice();
        assert!(!crosses(made) && made.len() < line.len() / 2, "{tolerance}");
        assert_eq!(made.len() > at_once.len(), crosses(&at_once), "{tolerance}");
    }
    assert!(cut_through > 0);
}
