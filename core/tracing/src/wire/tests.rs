use super::*;
use crate::costs::tests::edges_of;
use crate::polyline::{distance, squared_distance};
use crate::side::Inside;
use crate::synthetic::{Random, SyntheticFrame, circle};
use std::vec::Vec;

struct Memory {
    nodes: Vec<Node>,
    waiting: Vec<Waiting>,
}

impl Memory {
    fn new(pixels: usize) -> Self {
        Self {
            nodes: std::vec![Node::default(); pixels],
            waiting: std::vec![Waiting::default(); pixels],
        }
    }

    fn borrow(&mut self) -> WireMemory<'_> {
        WireMemory {
            nodes: &mut self.nodes,
            waiting: &mut self.waiting,
        }
    }
}

fn random_edges(count: usize, seed: u32) -> Vec<Edge> {
    let mut random = Random(seed);
    let mut byte = || (256.0 * random.uniform()) as u8;
    let edge = |_| Edge {
        strength: byte(),
        outwards: byte(),
    };
    (0..count).map(edge).collect()
}

/// Oracle: costs relaxed until nothing changes (Bellman and Ford).
fn naive(costs: &Costs<'_>, seed: usize, hand: Hand) -> Vec<u32> {
    let prices = Prices::new(hand);
    let (width, height) = (costs.width(), costs.height());
    let mut least = std::vec![u32::MAX; width * height];
    least[seed] = 0;
    let mut changed = true;
    while changed {
        changed = false;
        for from in 0..least.len() {
            for (heading, (right, down)) in STEPS.iter().enumerate() {
                let (Some(column), Some(row)) = (
                    (from % width)
                        .checked_add_signed(*right)
                        .filter(|&c| c < width),
                    (from / width)
                        .checked_add_signed(*down)
                        .filter(|&r| r < height),
                ) else {
                    continue;
                };
                let to = row * width + column;
                let cost = least[from].saturating_add(prices.of(heading, costs.number(to)));
                if cost < least[to] {
                    least[to] = cost;
                    changed = true;
                }
            }
        }
    }
    least
}

#[test]
fn every_pixel_has_the_cost_of_the_definition() {
    for (number, hand) in [Hand::Left, Hand::Either, Hand::Right]
        .into_iter()
        .enumerate()
    {
        let (width, height) = (23, 17);
        let edges = random_edges(width * height, 5 + number as u32);
        let costs = Costs::new(&edges, width, height).expect("fits");
        let mut memory = Memory::new(width * height);
        let seed = Point::new(11.5, 3.5);
        let mut wire = Wire::start(&costs, seed, hand, &mut memory.borrow()).expect("fits");
        // In slices, and with the places put in order between them: neither may change anything.
        while !wire
            .expand(&costs, &mut memory.borrow(), 9, None)
            .expect("fits")
        {
            wire.sweep(&mut memory.borrow());
        }
        assert_eq!(wire.settled(), width * height);
        let wanted = naive(&costs, 3 * width + 11, hand);
        for (pixel, &cost) in wanted.iter().enumerate() {
            assert_eq!(wire.cost_of(&memory.nodes, pixel), cost);
        }
        check_paths(&wire, &costs, &memory.nodes, &wanted);
    }
}

#[test]
fn longer_memory_gives_the_same_paths() {
    let (width, height) = (60, 50);
    // Edges of no strength everywhere: many paths of the same cost.
    let edges = std::vec![Edge::default(); width * height];
    let costs = Costs::new(&edges, width, height).expect("fits");
    let states = [1, 4].map(|times| {
        let mut memory = Memory::new(times * width * height);
        let seed = Point::new(30.5, 25.5);
        let mut wire = Wire::start(&costs, seed, Hand::Either, &mut memory.borrow()).expect("fits");
        let all = usize::MAX;
        let expanded = wire.expand(&costs, &mut memory.borrow(), all, None);
        assert_eq!(expanded, Ok(true));
        memory.nodes[..width * height]
            .iter()
            .map(|node| node.0)
            .collect::<Vec<u32>>()
    });
    assert_eq!(states[0], states[1]);
}

/// Each path begins at the seed, takes single steps, and costs what is said.
fn check_paths(wire: &Wire, costs: &Costs<'_>, nodes: &[Node], wanted: &[u32]) {
    let mut places = std::vec![0; wanted.len()];
    for (pixel, &cost) in wanted.iter().enumerate() {
        let mut path = List::new(&mut places);
        wire.path_to(nodes, pixel, &mut path).expect("fits");
        let path = path.as_slice();
        assert_eq!(
            (wanted[path[0] as usize], path[path.len() - 1] as usize),
            (0, pixel)
        );
        let steps = path.windows(2);
        let sum: u32 = steps
            .map(|pair| wire.straight(costs, pair[0] as usize, pair[1] as usize, |_| ()))
            .sum();
        assert_eq!(sum, cost);
    }
}

#[test]
fn a_straight_way_takes_single_steps_to_its_end() {
    let edges = random_edges(40 * 30, 1);
    let costs = Costs::new(&edges, 40, 30).expect("fits");
    let wire = Wire::start(
        &costs,
        Point::new(0.0, 0.0),
        Hand::Either,
        &mut Memory::new(1200).borrow(),
    );
    let wire = wire.expect("fits");
    for (from, to) in [
        (0, 1199),
        (1199, 0),
        (39, 1160),
        (45, 45),
        (50, 58),
        (600, 1),
        (803, 40),
    ] {
        let mut way = std::vec![from];
        wire.straight(&costs, from, to, |pixel| way.push(pixel));
        assert_eq!(way[way.len() - 1], to);
        for pair in way.windows(2) {
            let [a, b] = [pair[0], pair[1]].map(|pixel| wire.centre(pixel as u32));
            assert!(distance(a, b) > 0.9 && distance(a, b) < 1.5);
        }
        let [a, b] = [from, to].map(|pixel| wire.centre(pixel as u32));
        let off = |&pixel: &usize| {
            let at = wire.centre(pixel as u32);
            squared_distance(at, (a, b)).sqrt()
        };
        assert!(way.iter().map(off).fold(0.0, f64::max) < 0.75);
    }
}

fn path(costs: &Costs<'_>, from: Point, to: Point, hand: Hand) -> Vec<Point> {
    let mut memory = Memory::new(costs.width() * costs.height());
    let mut wire = Wire::start(costs, from, hand, &mut memory.borrow()).expect("fits");
    assert!(
        wire.expand(costs, &mut memory.borrow(), usize::MAX, Some(to))
            .expect("fits")
    );
    let mut places = std::vec![0; 5000];
    let mut path = List::new(&mut places);
    wire.path(&memory.nodes, to, &mut path).expect("fits");
    path.as_slice()
        .iter()
        .map(|&pixel| wire.centre(pixel))
        .collect()
}

#[test]
fn a_path_goes_round_with_the_implant_on_its_hand() {
    let mut drawn = SyntheticFrame::new(120, 110, 190.0);
    drawn.disc([60.0, 55.0], 35.0, 80.0);
    drawn.add_noise(8.0, 6);
    let edges = edges_of(&drawn, Inside::Dark, 64);
    let costs = Costs::new(&edges, 120, 110).expect("fits");
    let (left, right) = (Point::new(25.0, 55.0), Point::new(95.0, 55.0));
    for (hand, above, sign) in [(Hand::Right, true, 1.0), (Hand::Left, false, -1.0)] {
        let path = path(&costs, left, right, hand);
        assert!(
            path.iter()
                .all(|p| (p.row < 57.0) == above || (p.row > 53.0) != above)
        );
        let off = |p: &Point| ((p.column - 60.0).hypot(p.row - 55.0) - 35.0).abs();
        let mean = path.iter().map(off).sum::<f64>() / path.len() as f64;
        assert!(mean < 0.7, "{mean}");
        assert!(sign * hand_of(&costs, &path) > 0.9);
    }
    let clockwise = circle([60.0, 55.0], 35.0, 40);
    assert!(hand_of(&costs, &clockwise) > 0.95);
    assert_eq!(hand_of(&costs, &clockwise[..1]), 0.0);
}

#[test]
fn on_a_thin_plate_a_path_keeps_to_its_own_edge() {
    let mut drawn = SyntheticFrame::new(160, 60, 150.0);
    // Below it is brighter: the lower edge is much the stronger.
    drawn.draw(230.0, |_, row| 30.0 - row);
    drawn.plate([80.0, 30.0], [60.0, 3.5], 0.0, 90.0);
    drawn.add_noise(4.0, 2);
    let edges = edges_of(&drawn, Inside::Dark, 64);
    let costs = Costs::new(&edges, 160, 60).expect("fits");
    // To the right along the upper edge: the plate is on the right hand.
    let path = path(
        &costs,
        Point::new(25.0, 26.5),
        Point::new(135.0, 26.5),
        Hand::Right,
    );
    assert!(path.iter().all(|p| (p.row - 26.5).abs() <= 1.5), "{path:?}");
}

#[test]
fn a_target_stops_the_search_and_what_is_not_reached_has_no_path() {
    let edges = std::vec![Edge::default(); 10_000];
    let costs = Costs::new(&edges, 100, 100).expect("fits");
    let mut memory = Memory::new(10_000);
    let seed = Point::new(50.0, 50.0);
    let mut wire = Wire::start(&costs, seed, Hand::Either, &mut memory.borrow()).expect("fits");
    let near = Point::new(53.0, 50.0);
    assert!(
        !wire
            .expand(&costs, &mut memory.borrow(), 3, Some(near))
            .expect("fits")
    );
    assert!(
        wire.expand(&costs, &mut memory.borrow(), 9999, Some(near))
            .expect("fits")
    );
    assert!(wire.settled() < 100 && wire.is_reached(&memory.nodes, near));
    let far = Point::new(99.0, f64::INFINITY);
    assert!(!wire.is_reached(&memory.nodes, far));
    let mut places = [0; 200];
    let mut path = List::new(&mut places);
    wire.path(&memory.nodes, far, &mut path).expect("fits");
    assert!(path.is_empty());
    assert!(
        wire.expand(&costs, &mut memory.borrow(), 9999, None)
            .expect("fits")
    );
    wire.path(&memory.nodes, far, &mut path).expect("fits");
    assert_eq!(path.len(), 50);
    let mut short = [0; 20];
    let long = wire.path(&memory.nodes, far, &mut List::new(&mut short));
    assert_eq!(long, Err(TracingError::TooLong(20)));
    let other = Costs::new(&edges, 50, 100).expect("fits");
    assert_eq!(
        wire.expand(&other, &mut memory.borrow(), 1, None),
        Err(TracingError::OtherFrame)
    );
}

/// Of edges as strong as can be and of none a step costs what is said, of others what lies between, the faint ones nearly all.
#[test]
fn a_step_costs_less_along_a_stronger_edge_and_more_across_a_corner() {
    let prices = Prices::new(Hand::Either);
    let [side, corner] = &prices.by_strength;
    assert_eq!((side[0], side[255], corner[0]), (256, 6, 362));
    assert!(side.is_sorted_by(|a, b| a >= b) && corner.is_sorted_by(|a, b| a >= b));
    for strength in 0..=255 {
        let longer = f64::from(side[strength]) * sqrt(2.0);
        assert!((f64::from(corner[strength]) - longer).abs() < 1.3);
        // Where twice as much is lacking four times as much is paid beside the least.
        let above = |strength: usize| f64::from(side[strength]) - 6.0;
        let (lacking, twice) = (255 - strength, 255usize.checked_sub(2 * (255 - strength)));
        if let Some(twice) = twice {
            assert!((above(twice) - 4.0 * above(255 - lacking)).abs() <= 2.5);
        }
    }
}

#[test]
fn an_edge_counts_by_the_side_that_it_has_the_implant_on() {
    let [left, either, right] =
        [Hand::Left, Hand::Either, Hand::Right].map(|hand| Prices::new(hand).alignment);
    assert_eq!(
        (right[0], right[64], right[128], right[192]),
        (256, 0, 0, 0)
    );
    for angle in 0..256 {
        let opposite = (angle + 128) % 256;
        // A cosine is cut down to a whole number, and that of the opposite angle may be rounded otherwise.
        assert!(left[angle].abs_diff(right[opposite]) <= 1);
        assert_eq!(either[angle], left[angle].max(right[angle]));
    }
}

/// A line is the same whichever of its places are named as its points, and the other way round it has the implant on the other hand.
#[test]
fn the_hand_of_a_line_does_not_depend_on_its_points() {
    let edges = random_edges(60 * 50, 3);
    let costs = Costs::new(&edges, 60, 50).expect("fits");
    let line = [(3i32, 4i32), (45, 4), (45, 11), (20, 11), (20, 44)];
    let place = |(column, row): (i32, i32)| Point::new(column.into(), row.into());
    let mut more = Vec::new();
    for pair in line.windows(2) {
        let [(column, row), to] = [pair[0], pair[1]];
        let (right, down) = ((to.0 - column).signum(), (to.1 - row).signum());
        // Whole pixels, of which each is looked at once whatever it is a part of.
        more.extend([0, 2, 3, 5].map(|away| place((column + away * right, row + away * down))));
    }
    more.push(place(line[4]));
    let line = line.map(place);
    let hand = hand_of(&costs, &line);
    assert!(hand.abs() > 0.01 && (hand_of(&costs, &more) - hand).abs() < 1e-9);
    more.reverse();
    assert!((hand_of(&costs, &more) + hand).abs() < 1e-9);
    assert_eq!(hand_of(&costs, &line[..1]), 0.0);
}
