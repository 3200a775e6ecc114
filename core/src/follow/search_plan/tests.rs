//! The order of work against plain loops, in worlds that answer at random.

use std::cell::Cell;
use std::vec::Vec;

use super::*;
use crate::mesh::anatomy::KneeComponent;

/// Whether a search finds something, and how good that is: told by nothing but what is asked.
struct World(u64);

impl World {
    fn random(&self, numbers: &[usize]) -> u64 {
        let mix = |hash: u64, number: &usize| {
            (hash ^ *number as u64)
                .wrapping_mul(0x9E37_79B9_7F4A_7C15)
                .rotate_left(29)
        };
        numbers
            .iter()
            .fold(self.0.wrapping_mul(0xD6E8_FEB8_6659_FD93), mix)
            >> 16
    }

    fn search(&self, kind: usize, way: usize, part: usize, frame: usize) -> Option<(Pose, f64)> {
        let random = self.random(&[1, kind, way, part, frame]);
        let score = 0.38 + 0.01 * (random / 8 % 30) as f64;
        let likely = [1, 3, 2, 1][kind];
        (random % 8 < likely).then(|| (pose(way, part, frame), score))
    }

    fn ends(&self, way: usize, part: usize, frame: usize, last: usize) -> Ends {
        let end = |side: usize| {
            let random = self.random(&[2, way, part, frame, side]);
            let at = [frame.saturating_sub(FAR), (frame + FAR).min(last)][side];
            (at != frame && !random.is_multiple_of(4)).then(|| (at, pose(way, part, at)))
        };
        [end(0), end(1)]
    }
}

/// Number of a search of a whole frame.
fn kind_of(places: Places) -> usize {
    match places {
        Places::Shaped => 0,
        Places::Dark => 3,
        Places::All => unreachable!("it has no use of both"),
    }
}

fn pose(way: usize, part: usize, frame: usize) -> Pose {
    let translation = [way as f64, part as f64, -1000.0 - frame as f64];
    Pose {
        translation,
        ..Pose::IDENTITY
    }
}

/// What was asked: kind of the search, way, component, frame, and about how far away.
type Asked = (usize, usize, usize, usize, Option<f64>);

/// Femur and tray, the tray first where `turned`; each perhaps known in some frame before.
fn parts(world: &World, ways: usize, turned: bool, frames: usize) -> Vec<Sought> {
    use KneeComponent::{Femur, Tibia};
    let roles = if turned {
        [Tibia, Femur]
    } else {
        [Femur, Tibia]
    };
    let limbs = !world.random(&[3]).is_multiple_of(6);
    let given = world.random(&[4]) % 8;
    let all = (0..ways).flat_map(|way| {
        roles.into_iter().enumerate().map(move |(part, role)| {
            let mut sought = Sought::new(Some(role), limbs, [0.0; 3]);
            if given == part as u64 {
                let frame = frames / 3;
                sought.know(KnownFrame::new(frame, pose(way, part, frame), 0.5));
            }
            sought
        })
    });
    all.collect()
}

/// As it was before it was a plan: loops.
struct Plain<'w> {
    world: &'w World,
    parts: Vec<Sought>,
    way: usize,
    last: usize,
    seen: Vec<(usize, Places)>,
    led: usize,
    /// Long searches in vain, of all ways.
    vain: &'w Cell<usize>,
    asked: Vec<Asked>,
}

impl Plain<'_> {
    /// Whether long searches are done no more.
    fn is_given_up(&self) -> bool {
        self.vain.get() >= VAIN
    }

    /// Counts a long search that found nothing.
    fn count(&self, found: Option<(Pose, f64)>) {
        self.vain
            .set(self.vain.get() + usize::from(found.is_none()));
    }

    fn alone(&mut self, (frame, places): (usize, Places)) -> bool {
        self.in_joint();
        if !self.seen.contains(&(frame, places)) {
            self.seen.push((frame, places));
            let (kind, is_long) = (kind_of(places), places == Places::Dark);
            for trays in [false, true] {
                let depth = self
                    .parts
                    .iter()
                    .find_map(|part| Some(part.depth_mm(&part.known.first()?.pose)));
                for part in 0..self.parts.len() {
                    let is_wanted =
                        self.parts[part].is_missing() && self.parts[part].is_tray() == trays;
                    if is_wanted && !(is_long && self.is_given_up()) {
                        self.asked.push((kind, self.way, part, frame, depth));
                        let found = self.world.search(kind, self.way, part, frame);
                        if is_long {
                            self.count(found);
                        }
                        self.take(part, frame, found);
                    }
                }
                self.in_joint();
            }
        }
        is_whole(&self.parts)
    }

    fn take(&mut self, part: usize, frame: usize, found: Option<(Pose, f64)>) {
        if let Some((pose, score)) = found {
            self.parts[part].know(KnownFrame::new(frame, pose, score));
        }
    }

    /// Frames beside those in which the other one is known.
    fn beside_known(&self, part: usize) -> Vec<(usize, usize, Pose)> {
        let mut all = Vec::new();
        for other in (0..self.parts.len()).filter(|&other| other != part) {
            for from in &self.parts[other].known {
                all.push((other, from.frame, from.pose));
                let ends = self.world.ends(self.way, other, from.frame, self.last);
                all.extend(
                    ends.into_iter()
                        .flatten()
                        .map(|(frame, pose)| (other, frame, pose)),
                );
            }
        }
        all
    }

    fn in_joint(&mut self) {
        let led = self.parts.iter().map(|part| part.known.len()).sum();
        if led == self.led {
            return;
        }
        self.led = led;
        for part in 0..self.parts.len() {
            if !self.parts[part].is_missing() || !self.parts[part].is_limb {
                continue;
            }
            let mut best: Option<(usize, (Pose, f64))> = None;
            for (_, frame, _) in self.beside_known(part) {
                if best.is_some_and(|(_, (_, score))| score >= ENOUGH) {
                    break;
                }
                self.asked.push((1, self.way, part, frame, None));
                if let Some(found) = self.world.search(1, self.way, part, frame)
                    && best.is_none_or(|(_, (_, score))| found.1 > score)
                {
                    best = Some((frame, found));
                }
            }
            if let Some((frame, found)) = best {
                self.take(part, frame, Some(found));
            }
        }
    }

    fn beside(&mut self) -> bool {
        for part in 0..self.parts.len() {
            for (other, frame, pose) in self.beside_known(part) {
                if self.parts[part].is_missing() && !self.is_given_up() {
                    let depth = self.parts[other].depth_mm(&pose);
                    self.asked.push((2, self.way, part, frame, Some(depth)));
                    let found = self.world.search(2, self.way, part, frame);
                    self.count(found);
                    self.take(part, frame, found);
                }
            }
        }
        is_whole(&self.parts)
    }
}

/// All that is asked in one way after the other, the way that counts, and the frames in which components are known in it.
type Outcome = (Vec<Vec<Asked>>, usize, Vec<Vec<(usize, f64)>>);

fn known(parts: &[Sought]) -> Vec<Vec<(usize, f64)>> {
    let frames = |part: &Sought| {
        part.known
            .iter()
            .map(|one| (one.frame, one.score))
            .collect()
    };
    parts.iter().map(frames).collect()
}

fn by_loops(world: &World, ways: usize, turned: bool, frames: usize) -> Outcome {
    let (all, vain) = (parts(world, ways, turned, frames), Cell::new(0));
    let plain = |(way, parts): (usize, &[Sought])| Plain {
        world,
        parts: parts.to_vec(),
        way,
        last: frames - 1,
        seen: Vec::new(),
        led: 0,
        vain: &vain,
        asked: Vec::new(),
    };
    let mut plain: Vec<Plain<'_>> = all.chunks(2).enumerate().map(plain).collect();
    let end = |plain: &[Plain<'_>], way: usize| {
        let asked = plain.iter().map(|one| one.asked.clone()).collect();
        (asked, way, known(&plain[way].parts))
    };
    let frames = frames_to_search(&(0..frames));
    let of = |places| frames.iter().map(move |&frame| (frame, places));
    let list: Vec<(usize, Places)> = of(Places::Shaped).chain(of(Places::Dark)).collect();
    let best = |sought: &Sought| sought.best_score();
    for &visit in &list[..frames.len()] {
        for way in 0..ways {
            let is_whole = plain[way].alone(visit);
            let is_better = (0..ways).filter(|&other| other != way).all(|other| {
                let mut both = plain[way].parts.iter().zip(&plain[other].parts);
                both.all(|(own, other)| other.is_missing() || best(own) > best(other))
            });
            if is_whole && is_better {
                return end(&plain, way);
            }
        }
    }
    let mut order: Vec<usize> = (0..ways).collect();
    let of = |way: &usize| score(&plain[*way].parts);
    order.sort_by(|one, other| of(other).total_cmp(&of(one)));
    for &way in &order {
        let is_led = way != order[0] && !is_empty(&plain[order[0]].parts);
        for &visit in list
            .iter()
            .filter(|visit| !is_led || visit.1 != Places::Dark)
        {
            plain[way].alone(visit);
        }
        if plain[way].beside() {
            break;
        }
    }
    let of = |way: &usize| score(&plain[*way].parts);
    order.sort_unstable();
    let best = order
        .iter()
        .rev()
        .max_by(|one, other| of(one).total_cmp(&of(other)));
    let best = *best.expect("a way");
    end(&plain, best)
}

fn by_plan(world: &World, ways: usize, turned: bool, frames: usize) -> Outcome {
    let mut all = parts(world, ways, turned, frames);
    let mut plan = SearchPlan::new(frames, ways == 1);
    assert_eq!(plan.ways(), ways);
    let mut asked: Vec<Vec<Asked>> = std::vec![Vec::new(); ways];
    while let Some(step) = plan.next(&mut all) {
        assert_eq!(
            plan.next(&mut all),
            Some(step),
            "the same until it is answered"
        );
        let (way, part, frame) = (step.way, step.part, step.frame);
        let (kind, depth) = match step.search {
            Search::Whole { depth_mm, places } => (kind_of(places), depth_mm),
            Search::Joint(_) => (1, None),
            Search::Beside { depth_mm, .. } => (2, Some(depth_mm)),
            Search::Follow { from } => {
                assert_eq!(all[2 * way + part].known[from].frame, frame);
                plan.followed(world.ends(way, part, frame, frames - 1), &mut all);
                continue;
            }
        };
        if let Search::Joint(other) | Search::Beside { other, .. } = step.search {
            assert_eq!(other.pose, pose(way, other.part, frame));
            assert_ne!(other.part, part);
        }
        asked[way].push((kind, way, part, frame, depth));
        plan.found(world.search(kind, way, part, frame), &mut all);
    }
    let way = plan.way().expect("it has ended");
    (asked, way, known(&all[2 * way..2 * way + 2]))
}

#[test]
fn what_is_asked_and_found_is_what_plain_loops_ask_and_find() {
    let mut found = [0; 3];
    for seed in 0..3000 {
        let world = World(seed);
        for (ways, turned, frames) in [(1, false, 60), (2, false, 16), (2, true, 120), (1, true, 3)]
        {
            let plan = by_plan(&world, ways, turned, frames);
            assert_eq!(plan, by_loops(&world, ways, turned, frames), "seed {seed}");
            found[plan.2.iter().filter(|known| !known.is_empty()).count()] += 1;
        }
    }
    assert!(found.iter().all(|&count| count > 300), "{found:?}");
}

#[test]
fn where_all_is_given_nothing_is_asked() {
    let mut all: Vec<Sought> = parts(&World(0), 1, false, 60);
    for (part, sought) in all.iter_mut().enumerate() {
        if sought.is_missing() {
            sought.know(KnownFrame::new(5, pose(0, part, 5), 1.0));
        }
    }
    let mut plan = SearchPlan::new(60, true);
    assert_eq!((plan.next(&mut all), plan.way()), (None, Some(0)));
}
