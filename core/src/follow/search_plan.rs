//! In which order components are looked for that nobody pointed at: in which frame, which of them, by which search, and when it is enough.
//!
//! Femurs and others first, in whole frames; a tray where its joint leaves it beside a femur that is known, which is sooner and surer than
//! alone, then in whole frames too. What is still missing is looked for once more in whole frames beside what is known. Where nobody says
//! how a film shows metal, it is looked for in two ways, dark and bright, frame by frame by turns: whichever shows all components first, each
//! better than the other way, is gone on with; else what is found better counts, for a bright thing beside dark ones may be taken for a component.
//!
//! Things of the right shape come first, in all frames and ways: that takes moments. Then come dark places, which are many, in the way that
//! shows more first; of such searches no more than [`VAIN`] are done in vain, and none in a way while another one shows something.
//!
//! Whoever drives it asks for the [`SearchPlan::next`] step, does it, and gives its answer.

mod pairs;
mod sought;
mod step;

use heapless::Vec;

use super::search_order::{TRIES, frames_to_search};
use crate::pose::Pose;
use pairs::Pairs;

pub use sought::{Ends, KnownFrame, LED, Sought};
pub use step::{Other, Places, Search, SearchStep};

/// Ways in which a film may show metal: dark, then bright.
pub const WAYS: usize = 2;
/// Frames that are searched beside another component's lie so far from that at most.
pub const FAR: usize = 6;
/// What is to be said of a component that was looked for in vain.
pub const NOWHERE: &str =
    "in no frame that was searched are edges all along its outline from any side";
/// So many searches of whole frames at dark places, or beside what is known, are done in vain at most: each takes as long as following some
/// frames does, and where the first few find nothing there is hardly anything to be found.
pub const VAIN: usize = 6;
/// Where a pose that a joint leaves has such a score others are not looked for.
const ENOUGH: f64 = 0.55;
/// Each frame that is searched is visited twice at most.
const VISITS: usize = 2 * TRIES;
/// Number of the last pass of a visit of a frame; the one after it looks beside what was found.
const LAST_PASS: usize = 4;

/// How far the search is; see the module.
#[derive(Clone, Debug)]
pub struct SearchPlan {
    visits: Vec<(usize, Places), VISITS>,
    ways: usize,
    /// The way that is searched alone, once frames were gone through by turns: the first of them, and how many of them are done.
    alone: Option<[usize; WAYS]>,
    /// Number of the visit of a frame, and of the pass in it.
    visit: usize,
    pass: usize,
    /// In the pass: whether it has begun, whether it is left out,
    /// the component, the place beside others, the best so far, and about how far away others are.
    in_pass: bool,
    is_left_out: bool,
    part: usize,
    pairs: Pairs,
    best: Option<KnownFrame>,
    depth_mm: Option<f64>,
    /// Of each way: visits that were made, by their place in the list, and the known frames beside which joints were looked for.
    seen: [[bool; VISITS]; WAYS],
    led: [usize; WAYS],
    /// Of the searches that are long those that found nothing.
    vain: usize,
    asked: Option<SearchStep>,
    done: Option<usize>,
}

impl SearchPlan {
    /// Begins for a film of so many frames: in one way where it was told how it shows metal, else in [`WAYS`].
    #[must_use]
    pub fn new(frames: usize, is_told: bool) -> Self {
        Self {
            visits: visits(frames),
            ways: if is_told { 1 } else { WAYS },
            alone: None,
            visit: 0,
            pass: 0,
            in_pass: false,
            is_left_out: false,
            part: 0,
            pairs: Pairs::default(),
            best: None,
            depth_mm: None,
            seen: [[false; VISITS]; WAYS],
            led: [0; WAYS],
            vain: 0,
            asked: None,
            done: None,
        }
    }

    /// Number of ways, each of which has its own components in `parts` below: way after way, in the same order.
    #[must_use]
    pub fn ways(&self) -> usize {
        self.ways
    }

    /// What is to be done next, the same until it is answered; `None` where nothing is left.
    pub fn next(&mut self, parts: &mut [Sought]) -> Option<SearchStep> {
        while self.asked.is_none() && self.done.is_none() {
            let Some((way, frame)) = self.visited(parts) else {
                self.done = Some(self.best_way(parts));
                break;
            };
            let own = way_of_mut(parts, self.ways, way);
            self.asked = self.step_of_pass(way, frame, own);
            if self.asked.is_none() {
                self.after_pass(way, parts);
            }
        }
        self.asked
    }

    /// Takes what came of a search: the pose and its score, where it was found.
    pub fn found(&mut self, found: Option<(Pose, f64)>, parts: &mut [Sought]) {
        let Some(step) = self.asked.take() else {
            return;
        };
        let found = found.map(|(pose, score)| KnownFrame::new(step.frame, pose, score));
        self.vain += usize::from(found.is_none() && is_long(&step.search));
        let part = &mut way_of_mut(parts, self.ways, step.way)[step.part];
        match step.search {
            Search::Whole { .. } => {
                found.into_iter().for_each(|found| part.know(found));
                self.part += 1;
            }
            Search::Joint(_) => {
                self.pairs.place += 1;
                let is_better =
                    |one: &KnownFrame| self.best.is_none_or(|best| one.score > best.score);
                self.best = found.filter(is_better).or(self.best);
            }
            Search::Beside { .. } => {
                self.pairs.place += 1;
                found.into_iter().for_each(|found| part.know(found));
            }
            Search::Follow { .. } => self.asked = Some(step),
        }
    }

    /// Takes the first and the last frame in which a known component was followed; its own frame need not be one of them.
    pub fn followed(&mut self, ends: Ends, parts: &mut [Sought]) {
        if let Some(step) = self.asked.take()
            && let Search::Follow { from } = step.search
        {
            way_of_mut(parts, self.ways, step.way)[step.part].known[from].ends = Some(ends);
        }
    }

    /// The way that counts, once nothing is left to do; components that are known nowhere in it were not found.
    #[must_use]
    pub fn way(&self) -> Option<usize> {
        self.done
    }

    /// Whether what is missing is looked for no more, because so much was done in vain ([`VAIN`]).
    #[must_use]
    pub fn is_given_up(&self) -> bool {
        self.vain >= VAIN
    }

    /// The way and the visit (its place in the list) that are due; `None` where all was visited, or is found.
    fn visited(&mut self, parts: &[Sought]) -> Option<(usize, usize)> {
        if self.alone.is_none() {
            let shaped = self.visits.len() / 2;
            if self.visit < shaped * self.ways {
                return Some((self.visit % self.ways, self.visit / self.ways));
            }
            self.alone = Some(self.order(parts));
            self.visit = 0;
        }
        // One more visit of each looks beside what was found.
        let (each, order) = (self.visits.len() + 1, self.alone?);
        let leads = !is_empty(way_of(parts, self.ways, order[0]));
        while self.visit < each * self.ways {
            let (turn, visit) = (self.visit / each, self.visit % each);
            let is_dark = self
                .visits
                .get(visit)
                .is_some_and(|visit| visit.1 == Places::Dark);
            // What another way shows of a film in which one shows something has its shape, or is hardly there.
            if turn == 0 || !leads || !is_dark {
                return Some((order[turn], visit));
            }
            self.visit += 1;
        }
        None
    }

    /// The next step of a pass of a visit.
    fn step_of_pass(
        &mut self,
        way: usize,
        frame: usize,
        parts: &mut [Sought],
    ) -> Option<SearchStep> {
        let number = self.visits.get(frame).copied();
        let Some(visit) = number else {
            return self.beside_step(way, parts);
        };
        match self.pass {
            0 | 2 | 4 => self.joint_step(way, parts),
            1 | 3 => self.whole_step(way, visit, self.pass == 3, parts),
            _ => None,
        }
    }

    fn after_pass(&mut self, way: usize, all: &[Sought]) {
        let parts = way_of(all, self.ways, way);
        (self.part, self.pairs, self.in_pass) = (0, Pairs::default(), false);
        let each = self.visits.len() + 1;
        let frame = match self.alone {
            None => self.visit / self.ways,
            Some(_) => self.visit % each,
        };
        let is_beside = frame == self.visits.len();
        let is_seen = self.pass == 0 && !is_beside && self.seen[way][frame];
        if !is_beside && !is_seen && self.pass < LAST_PASS {
            self.pass += 1;
            self.seen[way][frame] = true;
            let known = parts
                .iter()
                .find_map(|part| Some((part, part.known.first()?)));
            self.depth_mm = known.map(|(part, known)| part.depth_mm(&known.pose));
            return;
        }
        self.pass = 0;
        self.visit += 1;
        // A way is given up for none but the one that shows all.
        match self.alone {
            None if is_whole(parts) && self.shows_better(way, all) => self.done = Some(way),
            Some(_) if is_whole(parts) && is_beside => self.visit = each * self.ways,
            _ => {}
        }
    }

    /// Whether a way shows each component better than the other one.
    fn shows_better(&self, way: usize, all: &[Sought]) -> bool {
        let own = way_of(all, self.ways, way);
        let others = (0..self.ways).filter(|&other| other != way);
        let mut both = others.flat_map(|other| own.iter().zip(way_of(all, self.ways, other)));
        both.all(|(own, other)| other.is_missing() || own.best_score() > other.best_score())
    }

    /// A component looked for in a whole frame.
    fn whole_step(
        &mut self,
        way: usize,
        (frame, places): (usize, Places),
        trays: bool,
        parts: &[Sought],
    ) -> Option<SearchStep> {
        if places == Places::Dark && self.is_given_up() {
            return None;
        }
        let is_wanted = |part: &Sought| part.is_missing() && part.is_tray() == trays;
        self.part += parts.get(self.part..)?.iter().position(is_wanted)?;
        Some(SearchStep {
            way,
            part: self.part,
            frame,
            search: Search::Whole {
                depth_mm: self.depth_mm,
                places,
            },
        })
    }

    /// A component looked for where its joint leaves it: in all frames beside those in which the other one is known, where it shows best.
    fn joint_step(&mut self, way: usize, parts: &mut [Sought]) -> Option<SearchStep> {
        if !self.in_pass {
            let led = parts.iter().map(|part| part.known.len()).sum();
            self.is_left_out = led == self.led[way];
            (self.in_pass, self.led[way]) = (true, led);
        }
        while self.part < parts.len() && !self.is_left_out {
            let (own, is_enough) = (
                &parts[self.part],
                self.best.is_some_and(|best| best.score >= ENOUGH),
            );
            if own.is_missing() && own.is_limb && !is_enough {
                let leads = |other: &Sought| other.leads(own);
                if let Some((frame, search)) = self.pairs.next(self.part, parts, leads) {
                    return Some(self.step_of(way, frame, search));
                }
            }
            if let Some(best) = self.best.take() {
                parts[self.part].know(best);
            }
            (self.part, self.pairs) = (self.part + 1, Pairs::default());
        }
        None
    }

    /// A component looked for in whole frames beside others that are known.
    fn beside_step(&mut self, way: usize, parts: &[Sought]) -> Option<SearchStep> {
        while self.part < parts.len() && !self.is_given_up() {
            if parts[self.part].is_missing()
                && let Some((frame, search)) = self.pairs.next(self.part, parts, |_| true)
            {
                let search = match search {
                    Search::Joint(other) => Search::Beside {
                        depth_mm: parts[other.part].depth_mm(&other.pose),
                        other,
                    },
                    other => other,
                };
                return Some(self.step_of(way, frame, search));
            }
            (self.part, self.pairs) = (self.part + 1, Pairs::default());
        }
        None
    }

    fn step_of(&self, way: usize, frame: usize, search: Search) -> SearchStep {
        let part = match search {
            Search::Follow { .. } => self.pairs.other,
            _ => self.part,
        };
        SearchStep {
            way,
            part,
            frame,
            search,
        }
    }

    /// The ways, the one that shows more first.
    fn order(&self, parts: &[Sought]) -> [usize; WAYS] {
        let of = |way: usize| match way < self.ways {
            true => score(way_of(parts, self.ways, way)),
            false => f64::NEG_INFINITY,
        };
        if of(1) > of(0) { [1, 0] } else { [0, 1] }
    }

    /// Of ways that are as good the first.
    fn best_way(&self, parts: &[Sought]) -> usize {
        self.order(parts)[0]
    }
}

/// Whether a search takes many clicks.
fn is_long(search: &Search) -> bool {
    match search {
        Search::Whole { places, .. } => *places != Places::Shaped,
        Search::Beside { .. } => true,
        Search::Joint(_) | Search::Follow { .. } => false,
    }
}

/// Every frame where something has the right shape, which takes a moment and most often leads to what is sought; then once more where
/// something is dark.
fn visits(frames: usize) -> Vec<(usize, Places), VISITS> {
    let frames = frames_to_search(&(0..frames));
    let of = |places| frames.iter().map(move |&frame| (frame, places));
    of(Places::Shaped).chain(of(Places::Dark)).collect()
}

fn way_of(parts: &[Sought], ways: usize, way: usize) -> &[Sought] {
    let each = parts.len() / ways;
    &parts[way * each..(way + 1) * each]
}

fn way_of_mut(parts: &mut [Sought], ways: usize, way: usize) -> &mut [Sought] {
    let each = parts.len() / ways;
    &mut parts[way * each..(way + 1) * each]
}

fn is_empty(parts: &[Sought]) -> bool {
    parts.iter().all(Sought::is_missing)
}

fn is_whole(parts: &[Sought]) -> bool {
    !parts.iter().any(Sought::is_missing)
}

/// How well components are found in all: the sum of what the best frame of each scores.
fn score(parts: &[Sought]) -> f64 {
    parts.iter().map(Sought::best_score).sum()
}

#[cfg(test)]
mod tests;
