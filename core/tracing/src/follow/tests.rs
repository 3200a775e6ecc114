use super::*;
use crate::costs::tests::edges_of;
use crate::polyline::distance;
use crate::side::{Hand, Inside};
use crate::synthetic::{Random, SyntheticFrame};
use crate::wire::Waiting;
use std::vec::Vec;

/// A live-wire with its memory.
struct Session {
    edges: Vec<Edge>,
    width: usize,
    nodes: Vec<Node>,
    waiting: Vec<Waiting>,
    wire: Wire,
    follower: Follower,
}

impl Session {
    fn new(frame: &SyntheticFrame, seed: [f64; 2], hand: Hand) -> Self {
        let edges = edges_of(frame, Inside::Dark, 64);
        let mut nodes = std::vec![Node::default(); edges.len()];
        let mut waiting = std::vec![Waiting::default(); edges.len()];
        let mut memory = WireMemory {
            nodes: &mut nodes,
            waiting: &mut waiting,
        };
        let costs = Costs::new(&edges, frame.width, frame.height).expect("fits");
        let seed = Point::new(seed[0], seed[1]);
        let wire = Wire::start(&costs, seed, hand, &mut memory).expect("fits");
        Self {
            wire,
            nodes,
            waiting,
            width: frame.width,
            edges,
            follower: Follower::default(),
        }
    }

    fn follow(&mut self, column: f64, row: f64, radius: f64, budget: usize) -> Vec<u32> {
        let height = self.edges.len() / self.width;
        let costs = Costs::new(&self.edges, self.width, height).expect("fits");
        let mut memory = WireMemory {
            nodes: &mut self.nodes,
            waiting: &mut self.waiting,
        };
        let mut places = std::vec![0; 4000];
        let mut path = List::new(&mut places);
        let at = Point::new(column, row);
        let cursor = Cursor { at, radius };
        let work = (cursor, budget);
        let follower = &mut self.follower;
        follower
            .follow(&mut self.wire, &costs, &mut memory, work, &mut path)
            .expect("fits");
        path.as_slice().to_vec()
    }

    fn end(&self, path: &[u32]) -> Point {
        self.wire.centre(path[path.len() - 1])
    }
}

const ALL: usize = usize::MAX;

fn disc(noise: f64) -> SyntheticFrame {
    let mut frame = SyntheticFrame::new(160, 150, 190.0);
    frame.disc([80.0, 75.0], 50.0, 90.0);
    frame.add_noise(noise, 6);
    frame
}

#[test]
fn the_path_ends_on_the_edge_and_follows_the_hand_along_it() {
    let mut session = Session::new(&disc(8.0), [30.0, 75.0], Hand::Right);
    let mut random = Random(4);
    let mut before: Vec<u32> = Vec::new();
    for step in 0..150 {
        let turn = core::f64::consts::PI * (1.0 + f64::from(step) / 150.0);
        let away = 50.0 + 8.0 * (random.uniform() - 0.5);
        let at = Point::new(80.0 + away * turn.cos(), 75.0 + away * turn.sin());
        let path = session.follow(at.column, at.row, 6.0, ALL);
        let end = session.end(&path);
        assert!(
            (distance(end, Point::new(80.0, 75.0)) - 50.0).abs() < 1.6,
            "{end:?}"
        );
        assert!(distance(end, at) < 6.01);
        // Nothing jumps: of the path before, only what is near the cursor is given up.
        assert!(
            common_length(&before, &path) + 16 >= before.len(),
            "step {step}"
        );
        before = path;
    }
}

#[test]
fn a_hand_that_trembles_leaves_the_path_alone() {
    let mut session = Session::new(&disc(12.0), [30.0, 75.0], Hand::Right);
    let mut random = Random(12);
    let mut before = session.follow(80.0, 26.0, 6.0, ALL);
    for _ in 0..200 {
        let mut shift = || 3.0 * (random.uniform() - 0.5);
        let path = session.follow(80.0 + shift(), 26.0 + shift(), 6.0, ALL);
        assert!(common_length(&before, &path) + 6 >= before.len());
        before = path;
    }
}

#[test]
fn between_two_edges_the_one_that_is_held_stays() {
    let mut frame = SyntheticFrame::new(160, 60, 190.0);
    frame.plate([80.0, 30.0], [70.0, 2.5], 0.0, 90.0);
    frame.add_noise(5.0, 3);
    let mut session = Session::new(&frame, [20.0, 27.5], Hand::Right);
    let mut random = Random(2);
    let begin = session.follow(100.0, 27.0, 6.0, ALL);
    assert!((session.end(&begin).row - 27.5).abs() < 1.1);
    for _ in 0..100 {
        // Around the middle of the plate, nearer to one edge or the other.
        let row = 30.0 + 2.0 * (random.uniform() - 0.5);
        let path = session.follow(100.0 + 4.0 * random.uniform(), row, 6.0, ALL);
        assert!(
            (session.end(&path).row - 27.5).abs() < 1.1,
            "{:?}",
            session.end(&path)
        );
    }
    // But who goes to the other edge gets it.
    let path = session.follow(102.0, 35.5, 6.0, ALL);
    assert!((session.end(&path).row - 32.5).abs() < 1.1);
}

#[test]
fn two_ways_of_one_cost_do_not_take_turns() {
    let mut session = Session::new(&disc(6.0), [30.0, 75.0], Hand::Either);
    // Opposite to the seed, where both ways around cost nearly the same; find where they change.
    let ways: Vec<bool> = (-20..=20)
        .map(|k| {
            session.follower.release();
            let path = session.follow(129.0, 75.0 + f64::from(k), 6.0, ALL);
            path.iter()
                .any(|&pixel| session.wire.centre(pixel).row < 40.0)
        })
        .collect();
    let change = ways.windows(2).position(|pair| pair[0] != pair[1]);
    let row = 75.0 + change.expect("both ways are taken") as f64 - 20.0;
    let mut random = Random(7);
    let (mut before, mut jumps) = (Vec::new(), 0);
    for _ in 0..200 {
        let row = row + 4.0 * (random.uniform() - 0.5);
        let path = session.follow(129.0, row, 6.0, ALL);
        jumps += usize::from(common_length(&before, &path) + 60 < before.len());
        before = path;
    }
    assert_eq!(jumps, 0);
    // Far enough away the other way is taken after all.
    let above = |path: &[u32]| {
        path.iter()
            .any(|&pixel| session.wire.centre(pixel).row < 40.0)
    };
    let was_above = above(&before);
    let far = if was_above { 110.0 } else { 40.0 };
    let side = 80.0 + (2500.0f64 - (far - 75.0) * (far - 75.0)).sqrt();
    let path = session.follow(side, far, 6.0, ALL);
    let now_above = path
        .iter()
        .any(|&pixel| session.wire.centre(pixel).row < 40.0);
    assert_ne!(now_above, was_above);
}

#[test]
fn without_a_radius_the_path_ends_under_the_cursor() {
    let mut session = Session::new(&disc(6.0), [30.0, 75.0], Hand::Right);
    for at in [[90.4, 31.7], [3.2, 140.9], [80.5, 75.5]] {
        let path = session.follow(at[0], at[1], 0.0, ALL);
        let end = session.end(&path);
        assert_eq!(
            (end.column, end.row),
            (at[0].floor() + 0.5, at[1].floor() + 0.5)
        );
    }
}

#[test]
fn what_the_budget_does_not_reach_comes_later() {
    let mut session = Session::new(&disc(6.0), [30.0, 75.0], Hand::Right);
    let mut calls = 1;
    while session.follow(130.0, 75.0, 5.0, 100).is_empty() {
        calls += 1;
    }
    assert!(calls > 2);
    assert!(!session.follow(130.0, 75.0, 5.0, 0).is_empty());
}

#[test]
fn the_edges_near_a_cursor_are_those_within_its_radius() {
    let edges = std::vec![Edge::default(); 40 * 30];
    let costs = Costs::new(&edges, 40, 30).expect("fits");
    for (column, row, radius) in [
        (20.2, 14.9, 6.3),
        (1.0, 2.5, 4.0),
        (39.5, 29.5, 3.0),
        (-2.0, 10.0, 3.0),
        (20.0, 15.0, 0.0),
        (20.5, 15.5, 0.0),
    ] {
        let at = Point::new(column, row);
        let places: Vec<Point> = near(&costs, &Cursor { at, radius })
            .map(|(_, middle)| middle)
            .collect();
        let all = (0..40 * 30).map(|k| Point::new((k % 40) as f64 + 0.5, (k / 40) as f64 + 0.5));
        let within: Vec<Point> = all
            .filter(|&middle| distance(middle, at) <= radius)
            .collect();
        assert_eq!(places, within, "{at:?} {radius}");
    }
}

#[test]
fn what_is_held_is_in_line_and_has_the_same_side_bright() {
    let edges = std::vec![
        Edge {
            outwards: 0,
            ..Edge::default()
        };
        40 * 30
    ];
    let costs = Costs::new(&edges, 40, 30).expect("fits");
    let follower = Follower {
        held: Some(Held {
            target: 15 * 40 + 20,
            anchor: 0,
        }),
    };
    let is_held = |outwards: u8, column: f64, row: f64| {
        let edge = Edge {
            outwards,
            ..Edge::default()
        };
        follower.is_held(&costs, edge, Point::new(column, row))
    };
    // The bright side is to the right, so that the edge runs up and down.
    for (row, column) in [(15.5, 21.5), (10.5, 23.5), (20.5, 17.5), (0.5, 26.5)] {
        assert!(is_held(0, column, row), "{column} {row}");
    }
    for (row, column) in [(15.5, 21.6), (10.5, 23.6), (20.5, 17.4), (15.5, 26.5)] {
        assert!(!is_held(0, column, row), "{column} {row}");
    }
    let turned = [40, 216, 41, 215, 128].map(|outwards| is_held(outwards, 20.5, 15.5));
    assert_eq!(turned, [true, true, false, false, false]);
    assert!(!Follower::default().is_held(&costs, edges[0], Point::new(20.5, 15.5)));
}

/// Of edges in any direction: what lies along one is on it, what lies across is beside it, and what has the other side bright is another.
#[test]
fn an_edge_is_held_along_its_line() {
    const WIDTH: usize = 41;
    for eighth in 0..8u8 {
        let outwards = 32 * eighth;
        let edges = std::vec![Edge { strength: 200, outwards }; WIDTH * WIDTH];
        let costs = Costs::new(&edges, WIDTH, WIDTH).expect("fits");
        let target = 20 * WIDTH + 20;
        let held = Follower {
            held: Some(Held {
                target,
                anchor: target,
            }),
        };
        let (sin, cos) = sin_cos(core::f64::consts::TAU * f64::from(eighth) / 8.0);
        let is_held = |along: f64, across: f64, outwards: u8| {
            let middle = Point::new(
                20.5 + across * cos - along * sin,
                20.5 + across * sin + along * cos,
            );
            held.is_held(
                &costs,
                Edge {
                    strength: 200,
                    outwards,
                },
                middle,
            )
        };
        for along in [-9.0, -3.0, 0.0, 5.0] {
            assert!(is_held(along, 0.0, outwards), "{eighth} {along}");
            assert!(is_held(along, 0.9, outwards) && is_held(along, -0.9, outwards));
            assert!(!is_held(along, 6.0, outwards) && !is_held(along, -6.0, outwards));
            for turn in [30u8, 226] {
                assert!(is_held(along, 0.0, outwards.wrapping_add(turn)));
                assert!(!is_held(
                    along,
                    0.0,
                    outwards.wrapping_add(turn).wrapping_add(128)
                ));
            }
        }
        assert!(!Follower::default().is_held(&costs, edges[0], Point::new(20.5, 20.5)));
    }
}
