use super::*;
use crate::polyline::{between, distance};
use crate::synthetic::{Random, SyntheticFrame, circle};
use fluoropose::memory::TooLittleMemory;
use std::vec::Vec;

fn snapped(drawn: &SyntheticFrame, points: &[Point], settings: &Snap) -> (Vec<Vertex>, ShapeError) {
    let pixels = drawn.eight_bit();
    let frame = Frame::new(&pixels, drawn.width, drawn.height, drawn.width).expect("fits");
    let (samples, slopes) = snap_needed(points, settings.closed);
    let mut places = std::vec![Vertex::default(); samples];
    let mut out = List::new(&mut places);
    let memory = SnapMemory {
        samples: &mut std::vec![Sample::default(); samples],
        slopes: &mut std::vec![0.0; slopes],
        ways: &mut std::vec![0; slopes],
        line: &mut std::vec![Vertex::default(); samples],
        marks: &mut std::vec![false; samples],
    };
    let error = snap(&frame, points, settings, memory, &mut out).expect("valid");
    (out.as_slice().to_vec(), error)
}

const RING: Snap = Snap {
    closed: true,
    hand: Hand::Either,
    inside: Inside::Dark,
    reach: 6.0,
    tolerance: 0.2,
};

const MIDDLE: [f64; 2] = [80.3, 75.6];

fn disc(noise: f64) -> SyntheticFrame {
    let mut drawn = SyntheticFrame::new(160, 150, 190.0);
    drawn.disc(MIDDLE, 50.0, 90.0);
    drawn.add_noise(noise, 6);
    drawn
}

/// A ring that is up to four pixels off the disc's edge.
fn rough(count: usize) -> Vec<Point> {
    let off =
        |k: usize| 50.0 + 4.0 * (k as f64 * 5.0 * core::f64::consts::TAU / count as f64).sin();
    let points = circle([0.0, 0.0], 1.0, count).into_iter().enumerate();
    points
        .map(|(k, p)| Point::new(MIDDLE[0] + off(k) * p.column, MIDDLE[1] + off(k) * p.row))
        .collect()
}

fn from_edge(vertex: &Vertex) -> f64 {
    distance(vertex.at, Point::new(MIDDLE[0], MIDDLE[1])) - 50.0
}

/// Root mean square distance of a closed line from the disc's edge, along its sides.
fn off_edge(ring: &[Vertex]) -> f64 {
    let parts = (0..ring.len()).flat_map(|k| {
        let ends = (ring[k].at, ring[(k + 1) % ring.len()].at);
        (0..8).map(move |part| between(ends, f64::from(part) / 8.0))
    });
    let middle = Point::new(MIDDLE[0], MIDDLE[1]);
    let off: Vec<f64> = parts.map(|p| distance(p, middle) - 50.0).collect();
    rms(off.iter().copied())
}

fn rms(values: impl Iterator<Item = f64> + Clone) -> f64 {
    let count = values.clone().count() as f64;
    (values.map(|v| v * v).sum::<f64>() / count).sqrt()
}

#[test]
fn a_rough_ring_comes_onto_the_edge_to_a_part_of_a_pixel() {
    for (noise, most) in [(0.0, 0.12), (8.0, 0.25)] {
        for mut points in [rough(60), rough(400)] {
            let (ring, error) = snapped(&disc(noise), &points, &RING);
            assert!(off_edge(&ring) < most, "{}", off_edge(&ring));
            assert!(error.max > 3.0 && error.max < 7.0 && ring.len() < 150);
            // In the other direction the result is the same.
            points.reverse();
            let (back, _) = snapped(&disc(noise), &points, &RING);
            assert!(off_edge(&back) < most);
        }
    }
}

#[test]
fn where_there_is_no_edge_nothing_moves() {
    let mut drawn = SyntheticFrame::new(160, 150, 140.0);
    drawn.add_noise(7.0, 3);
    let points = rough(24);
    let (ring, error) = snapped(&drawn, &points, &RING);
    let kept: Vec<Point> = ring.iter().map(|vertex| vertex.at).collect();
    assert_eq!(kept, points);
    assert!(error.max < 1e-9);
    assert!(ring.iter().enumerate().all(|(k, v)| v.from == k as f64));
    // On the right half there is none, on the left half there is.
    let mut drawn = disc(0.0);
    for row in drawn.grey.chunks_exact_mut(160) {
        row[80..].fill(140.0);
    }
    drawn.add_noise(4.0, 9);
    let (ring, _) = snapped(&drawn, &points, &RING);
    for point in points.iter().filter(|p| p.column > 95.0) {
        assert!(ring.iter().any(|vertex| vertex.at == *point), "{point:?}");
    }
    let left = ring.iter().filter(|vertex| vertex.at.column < 70.0);
    assert!(rms(left.map(from_edge)) < 0.3);
}

#[test]
fn a_thin_plate_keeps_its_two_edges_apart() {
    let mut drawn = SyntheticFrame::new(160, 60, 170.0);
    drawn.plate([80.0, 30.0], [60.0, 3.0], 0.0, 90.0);
    drawn.add_noise(4.0, 2);
    // Two pixels inside of the one edge, two outside of the other.
    let points = [(22.0, 29.0), (138.0, 29.0), (138.0, 35.0), (22.0, 35.0)];
    let points = points.map(|(column, row)| Point::new(column, row));
    let (ring, _) = snapped(&drawn, &points, &RING);
    let long = ring.iter().filter(|v| (30.0..130.0).contains(&v.at.column));
    for vertex in long.clone() {
        let edge = if vertex.at.row < 30.0 { 27.0 } else { 33.0 };
        assert!((vertex.at.row - edge).abs() < 0.4, "{vertex:?}");
    }
    assert!(long.clone().any(|v| v.at.row < 30.0) && long.clone().any(|v| v.at.row > 30.0));
}

#[test]
fn a_speck_draws_no_point_away() {
    let mut drawn = disc(3.0);
    // Dark specks outside of the edge, of more contrast than the edge has.
    let mut random = Random(5);
    for k in 0..12 {
        let turn = core::f64::consts::TAU * f64::from(k) / 12.0;
        let away = 54.0 + random.uniform();
        drawn.disc(
            [MIDDLE[0] + away * turn.cos(), MIDDLE[1] + away * turn.sin()],
            1.2,
            20.0,
        );
    }
    let (ring, _) = snapped(&drawn, &circle(MIDDLE, 51.5, 80), &RING);
    let farthest = ring.iter().map(|v| from_edge(v).abs()).fold(0.0, f64::max);
    assert!(farthest < 1.2, "{farthest}");
}

#[test]
fn the_ends_of_a_path_stay_and_its_hand_is_minded() {
    let drawn = disc(4.0);
    // Over the top from left to right: the disc is on the right hand.
    let path: Vec<Point> = circle(MIDDLE, 52.0, 120)[70..111].to_vec();
    let open = |hand| Snap {
        closed: false,
        hand,
        ..RING
    };
    for hand in [Hand::Right, Hand::Either] {
        let (line, _) = snapped(&drawn, &path, &open(hand));
        assert_eq!((line[0].at, line[line.len() - 1].at), (path[0], path[40]));
        let inner = line.iter().filter(|v| v.from > 5.0 && v.from < 35.0);
        assert!(rms(inner.map(from_edge)) < 0.25);
    }
    let (line, error) = snapped(&drawn, &path, &open(Hand::Left));
    // Only thinned out: nothing was pulled in.
    assert!(error.max <= RING.tolerance && line.iter().all(|v| from_edge(v) > 1.7));
    let bright = Snap {
        inside: Inside::Bright,
        ..open(Hand::Left)
    };
    let (line, _) = snapped(&drawn, &path, &bright);
    assert!(
        line.iter()
            .filter(|v| v.from > 5.0 && v.from < 35.0)
            .all(|v| from_edge(v) < 1.0)
    );
}

#[test]
fn wrong_settings_and_lines_are_said() {
    let drawn = disc(0.0);
    let pixels = drawn.eight_bit();
    let frame = Frame::new(&pixels, drawn.width, drawn.height, drawn.width).expect("fits");
    let memory = || SnapMemory {
        samples: &mut [],
        slopes: &mut [],
        ways: &mut [],
        line: &mut [],
        marks: &mut [],
    };
    let points = rough(12);
    let mut out = List::new(&mut []);
    let far = Snap {
        reach: 40.0,
        ..RING
    };
    let wrong = snap(&frame, &points, &far, memory(), &mut out);
    assert!(matches!(wrong, Err(TracingError::Setting { .. })));
    let short = snap(&frame, &points, &RING, memory(), &mut out);
    assert!(matches!(
        short,
        Err(TracingError::Memory(TooLittleMemory {
            what: "samples",
            ..
        }))
    ));
    let few = snap(&frame, &points[..2], &RING, memory(), &mut out);
    assert!(matches!(few, Err(TracingError::TooFewPoints { .. })));
}

#[test]
fn the_mean_distance_of_what_was_moved_is_no_more_than_the_largest() {
    for count in [40, 90] {
        let (_, error) = snapped(&disc(0.0), &circle(MIDDLE, 50.4, count), &RING);
        assert!(error.rms > 0.0 && error.rms <= error.max, "{error:?}");
        assert!(error.max < 0.9, "{error:?}");
    }
}

#[test]
fn ends_of_a_line_and_ends_of_long_sides_stay() {
    let at = [0.0, 2.0, 4.0, 4.0 + 2.0 * LONG, 6.0 + 2.0 * LONG];
    let points = at.map(|column| Point::new(column, 0.0));
    let kept = |closed, points: &[Point]| {
        let vertices = points.iter().enumerate();
        let stay = vertices.map(|(k, &at)| stays(points, closed, &Vertex::kept(k, at)));
        stay.collect::<Vec<_>>()
    };
    assert_eq!(kept(false, &points), [true, false, true, true, true]);
    // Closed, the first and the last are ends of the long way back.
    assert_eq!(kept(true, &points[..3]), [true, false, true]);
    assert_eq!(kept(true, &points[..2]), [false; 2]);
    assert_eq!(kept(true, &points), [true, false, true, true, true]);
    assert!(!stays(&points, false, &Vertex::new(points[0])));
}

#[test]
fn the_ends_of_an_open_line_stay_however_short_its_sides_are() {
    let points = [0.0, 0.5, 1.0, 1.5].map(|column| Point::new(column, 0.0));
    let kept = |number: usize| stays(&points, false, &Vertex::kept(number, points[number]));
    assert_eq!([0, 1, 2, 3].map(kept), [true, false, false, true]);
}

/// Edges are looked for across the line, whichever way round it is given, and of a ring at its first point too.
#[test]
fn normals_are_square_to_the_line() {
    for (turned, closed) in [(false, true), (true, true), (false, false)] {
        let mut points = circle(MIDDLE, 40.0, 120);
        if turned {
            points.reverse();
        }
        let settings = Snap { closed, ..RING };
        let count = snap_needed(&points, closed).0;
        let mut samples = std::vec![Sample::default(); count];
        lay_out(&points, &settings, &mut samples).expect("as many");
        for sample in &samples {
            let off = [
                sample.vertex.at.column - MIDDLE[0],
                sample.vertex.at.row - MIDDLE[1],
            ];
            let outwards = (off[0] * sample.normal[0] + off[1] * sample.normal[1]) / 40.0;
            // What lies around a dark disc is brighter. An end of an open line looks to one side alone.
            assert!(outwards > 0.98, "{outwards}");
        }
    }
}

/// A picture shown the other way round, and one that is mirrored, are snapped to the same places.
#[test]
fn a_negative_and_a_mirrored_picture_have_their_edges_where_the_picture_has() {
    for seed in 0..12 {
        let mut drawn = SyntheticFrame::new(160, 150, 190.0);
        drawn.disc(MIDDLE, 50.0, 110.0);
        drawn.disc([130.0, 60.0], 6.0, 150.0);
        drawn.add_noise(14.0, 20 + seed);
        let points = rough(60 + 7 * seed as usize);
        let turned = |of: fn(&SyntheticFrame, usize) -> f64| {
            let grey = (0..160 * 150).map(|k| of(&drawn, k)).collect();
            SyntheticFrame {
                grey,
                ..SyntheticFrame::new(160, 150, 0.0)
            }
        };
        let (own, _) = snapped(&drawn, &points, &RING);
        let bright = Snap {
            inside: Inside::Bright,
            ..RING
        };
        let negative = turned(|drawn, k| 255.0 - drawn.grey[k].round());
        let (other, _) = snapped(&negative, &points, &bright);
        let mirrored = turned(|drawn, k| drawn.grey[k / 160 * 160 + 159 - k % 160]);
        let across = |at: Point| Point::new(160.0 - at.column, at.row);
        let there: Vec<Point> = points.iter().map(|&at| across(at)).collect();
        let (third, _) = snapped(&mirrored, &there, &RING);
        assert_eq!([other.len(), third.len()], [own.len(); 2], "{seed}");
        for (own, (other, third)) in own.iter().zip(other.iter().zip(&third)) {
            let off = distance(own.at, other.at).max(distance(own.at, across(third.at)));
            assert!(off < 1e-6, "{seed}: {own:?} {other:?} {third:?}");
        }
    }
}
