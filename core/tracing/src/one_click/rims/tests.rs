//! Edges drawn where a rim would have them, one behind the other.

use super::super::prompt::Prompt;
use super::super::tests::{SIDE, camera, seen};
use super::*;
use fluoropose::image::contour::Point;
use fluoropose::image::frame::Frame;
use fluoropose::refine::Polarity;
use std::vec::Vec;

/// Where the outline lies.
const AT: f64 = 100.0;
/// How far its second edge is looked for.
const REACH: f64 = 30.0;

/// Grey values that rise at columns, each by so much within four pixels.
fn rising(edges: &[(f64, f64)]) -> Vec<u16> {
    let grey = |column: f64| {
        let rise = |&(at, by): &(f64, f64)| by * ((column - at) / 4.0 + 0.5).clamp(0.0, 1.0);
        20_000.0 + edges.iter().map(rise).sum::<f64>()
    };
    (0..SIDE * SIDE)
        .map(|k| grey((k % SIDE) as f64 + 0.5) as u16)
        .collect()
}

fn sample(column: f64) -> OutlineSample {
    OutlineSample {
        column,
        row: 50.0,
        normal: [1.0, 0.0],
        length: 1.0,
        jacobian: [0.0; 6],
    }
}

/// Asks a work that expects edges of 250 grey values a pixel.
fn asked<T>(
    pixels: &[u16],
    polarity: Polarity,
    ask: impl Fn(&OneClick, &Observation<'_>) -> T,
) -> T {
    let (frame, camera) = (
        Frame::new(pixels, SIDE, SIDE, SIDE).expect("fits"),
        camera(),
    );
    let observation = seen(&frame, &camera, polarity);
    let mut work =
        OneClick::new(Prompt::Click(Point::new(50.0, 50.0)), &camera, None).expect("inside");
    work.slope = 250.0;
    ask(&work, &observation)
}

fn second(edges: &[(f64, f64)]) -> Option<f64> {
    let find = |work: &OneClick, seen: &Observation<'_>| work.second_edge(seen, &sample(AT), REACH);
    let dark = rising(edges);
    let found = asked(&dark, Polarity::DarkImplant, find);
    // Inverted greys are the same of a bright implant, and of a dark one edges of the wrong sign.
    let inverted: Vec<u16> = dark.iter().map(|grey| u16::MAX - grey).collect();
    assert_eq!(asked(&inverted, Polarity::BrightImplant, find), found);
    assert_eq!(asked(&inverted, Polarity::DarkImplant, find), None);
    found
}

#[test]
fn an_edge_behind_the_first_is_found_where_it_is() {
    for beyond in [6.0, 8.5, 12.0, 25.0] {
        let found = second(&[(AT, 1000.0), (AT + beyond, 600.0)]).expect("an edge");
        assert!((found - beyond).abs() <= 1.5, "{found} for {beyond}");
    }
}

#[test]
fn of_several_the_strongest_counts_wherever_it_lies() {
    let (weak, strong) = (400.0, 900.0);
    for (near, far) in [(weak, strong), (strong, weak)] {
        let edges = [(AT, 1000.0), (AT + 10.0, near), (AT + 20.0, far)];
        let found = second(&edges).expect("an edge");
        let right = if near > far { 10.0 } else { 20.0 };
        assert!((found - right).abs() <= 1.5, "{found} for {right}");
    }
}

#[test]
fn what_is_too_near_too_far_too_faint_or_no_valley_behind_is_no_second_edge() {
    assert_eq!(second(&[(AT, 1000.0)]), None);
    // Still a part of the first edge, which falls off nowhere between them.
    assert_eq!(second(&[(AT, 1000.0), (AT + 3.0, 800.0)]), None);
    assert_eq!(second(&[(AT, 1000.0), (AT + REACH + 4.0, 800.0)]), None);
    // A slope of 25 where 250 is expected, and one of 37.
    assert_eq!(second(&[(AT, 1000.0), (AT + 12.0, 100.0)]), None);
    assert!(second(&[(AT, 1000.0), (AT + 12.0, 150.0)]).is_some());
}

/// Along a normal to the right and down, since both lead to what is excluded.
#[test]
fn behind_what_is_excluded_nothing_is_looked_for() {
    let half = core::f64::consts::FRAC_1_SQRT_2;
    let pixels = rising(&[(AT, 1000.0), (AT + 12.0, 900.0)]);
    let found = |excluded: Option<(usize, usize)>| {
        let mut words = std::vec![0; words_needed(SIDE, SIDE)];
        let mut mask = MaskMut::new(&mut words, SIDE, SIDE).expect("fits");
        if let Some((column, row)) = excluded {
            mask.set(column, row, true);
        }
        let mask = mask.into_mask();
        asked(&pixels, Polarity::DarkImplant, |work, seen| {
            let seen = Observation {
                frame: seen.frame,
                excluded: Some(&mask),
                ..*seen
            };
            let sample = OutlineSample {
                normal: [half, half],
                ..sample(AT)
            };
            work.second_edge(&seen, &sample, REACH)
        })
    };
    let there = found(None).expect("an edge");
    assert!((there - 12.0 / half).abs() <= 2.0, "{there}");
    assert_eq!(found(Some((104, 54))), None);
    assert_eq!(found(Some((104, 46))), Some(there));
    assert_eq!(found(Some((96, 46))), Some(there));
}

#[test]
fn a_sample_is_on_an_edge_of_its_own_within_a_pixel_and_a_half() {
    let pixels = rising(&[(AT, 1000.0)]);
    for (beside, right) in [
        (-6.0, false),
        (-1.0, true),
        (0.0, true),
        (1.0, true),
        // On its foot, whose slope grows inwards to the end of what is looked at.
        (3.0, false),
        (6.0, false),
    ] {
        let is_on = asked(&pixels, Polarity::DarkImplant, |work, seen| {
            work.is_on_edge(seen, &sample(AT + beside))
        });
        assert_eq!(is_on, right, "{beside} px beside");
    }
}

#[test]
fn an_outline_moved_out_covers_what_lies_between() {
    let set = |column: f64, row: f64, normal: [f64; 2], length: f64| {
        let mut words = std::vec![0; words_needed(SIDE, SIDE)];
        let mut mask = MaskMut::new(&mut words, SIDE, SIDE).expect("fits");
        let sample = OutlineSample {
            row,
            normal,
            ..sample(column)
        };
        fill_along(&mut mask, &sample, length);
        let mask = mask.into_mask();
        let all = (0..SIDE * SIDE).map(|k| (k % SIDE, k / SIDE));
        all.filter(|&(column, row)| mask.get(column, row))
            .collect::<Vec<_>>()
    };
    let row = |row| (10..15).map(move |column| (column, row));
    let right: Vec<_> = row(9).chain(row(10)).collect();
    assert_eq!(set(10.0, 10.0, [1.0, 0.0], 5.0), right);
    let mut down: Vec<_> = right.iter().map(|&(column, row)| (row, column)).collect();
    down.sort_by_key(|&(column, row)| (row, column));
    assert_eq!(set(10.0, 10.0, [0.0, 1.0], 5.0), down);
    // Along the diagonal, from the corner outwards, and beyond the frame.
    let half = core::f64::consts::FRAC_1_SQRT_2;
    let diagonal = set(20.0, 20.0, [half, half], 8.0);
    assert!((20..25).all(|k| diagonal.contains(&(k, k))), "{diagonal:?}");
    assert!(
        diagonal.iter().all(|&(c, r)| c.abs_diff(r) <= 1),
        "{diagonal:?}"
    );
    assert_eq!(set(0.4, 0.4, [-1.0, 0.0], 5.0), [(0, 0)]);
    // Past a corner of the frame nothing is drawn along its sides.
    for normal in [[-half, half], [half, -half]] {
        let across = set(
            0.4 + 5.0 * normal[1].max(0.0),
            0.4 + 5.0 * normal[0].max(0.0),
            normal,
            20.0,
        );
        assert!(across.iter().all(|&(c, r)| c + r < 6), "{across:?}");
    }
    let edge = SIDE as f64 - 0.5;
    assert_eq!(
        set(edge, 3.5, [1.0, 0.0], 9.0),
        [(SIDE - 1, 3), (SIDE - 1, 4)]
    );
}

/// Slopes that rise to one place and fall behind it: an edge is found there to half the distance of two readings, and no farther.
#[test]
fn a_second_edge_lies_where_it_is_steepest() {
    let find = |work: &OneClick, seen: &Observation<'_>| work.second_edge(seen, &sample(AT), REACH);
    for beyond in [8.0, 10.5, 13.0, 20.0] {
        let pixels: Vec<u16> = (0..SIDE * SIDE)
            .map(|k| {
                let column = (k % SIDE) as f64 + 0.5;
                let rise = |at: f64, by: f64| by / (1.0 + libm::exp(at - column));
                (20_000.0 + rise(AT, 2000.0) + rise(AT + beyond, 1200.0)) as u16
            })
            .collect();
        let found = asked(&pixels, Polarity::DarkImplant, find).expect("an edge");
        assert!((found - beyond).abs() <= STEP, "{found} for {beyond}");
    }
}

#[test]
fn a_sample_on_a_faint_edge_is_on_none() {
    // A slope of 25 where 250 is expected, and one of 37.
    for (rise, right) in [(100.0, false), (150.0, true)] {
        let pixels = rising(&[(AT, rise)]);
        let is_on = asked(&pixels, Polarity::DarkImplant, |work, seen| {
            work.is_on_edge(seen, &sample(AT))
        });
        assert_eq!(is_on, right, "{rise}");
    }
}
