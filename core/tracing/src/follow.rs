//! The end of a live-wire under the cursor, held so that the path does not jump while the hand is still.
//!
//! Two things make paths jump:
//! - The cursor is never exactly on the edge, and the strongest pixel near it changes with every pixel that it moves.
//!   Therefore the edge that was held stays until another edge near the cursor is clearly stronger, and the path ends
//!   on the held edge as near to the cursor as it goes.
//! - Two ways of nearly the same cost lie side by side in the tree of cheapest paths. Therefore the way that was held is
//!   prolonged until it costs more than the other by the price of a pixel without an edge.

use crate::costs::{Costs, Edge};
use crate::error::TracingError;
use crate::list::List;
use crate::polyline::distance;
use crate::wire::{Node, Wire, WireMemory};
use fluoropose::image::contour::Point;
use fluoropose::math::{sin_cos, sqrt};

/// Edges of less strength do not attract the cursor, unless they are held.
const LEAST_STRENGTH: f64 = 72.0;
const LEAST_HELD: f64 = 48.0;
/// How many times as attractive another edge must be than that which is held.
const CLEARLY: f64 = 1.4;
/// Attraction at the end of the radius, as a fraction of that in the middle.
const AT_RADIUS: f64 = 0.4;
/// A path has not jumped if it gives up at most this many steps of the path before it.
const BRANCH: usize = 24;
/// How much more the held way may cost: the price of a pixel without an edge.
const MARGIN: u32 = 256;

/// What is held from one position of the cursor to the next. A new one holds nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Follower {
    held: Option<Held>,
}

#[derive(Clone, Copy, Debug)]
struct Held {
    /// The pixel on the edge near the cursor.
    target: usize,
    /// Where the path leaves the tree of cheapest paths: the target itself unless a way is held.
    anchor: usize,
}

/// What lies under the cursor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cursor {
    /// Where it is.
    pub at: Point,
    /// The distance within which edges attract it, pixels, at most 64. At 0 the path ends exactly under the cursor, and
    /// nothing is held.
    pub radius: f64,
}

impl Follower {
    /// Holds nothing any more: for a new seed.
    pub fn release(&mut self) {
        self.held = None;
    }

    /// Writes the path from the seed to the edge near the cursor to `path`, as pixel numbers row by row.
    ///
    /// Where the search has not reached that edge yet, it is expanded by up to `budget` more pixels; `path` stays empty
    /// where that does not suffice.
    ///
    /// # Errors
    /// [`TracingError::TooLong`], and those of [`Wire::expand`].
    pub fn follow(
        &mut self,
        wire: &mut Wire,
        costs: &Costs<'_>,
        memory: &mut WireMemory<'_>,
        (cursor, budget): (Cursor, usize),
        path: &mut List<'_, u32>,
    ) -> Result<(), TracingError> {
        path.clear();
        if cursor.radius <= 0.0 {
            self.release();
        }
        let target = wire.pixel_at(self.attracted(costs, &cursor));
        wire.expand(costs, memory, budget, Some(wire.centre(target as u32)))?;
        let nodes = &*memory.nodes;
        if !wire.is_settled(nodes, target) {
            return Ok(());
        }
        let anchor = self.anchor(wire, costs, nodes, target);
        self.held = Some(Held { target, anchor });
        wire.path_to(nodes, anchor, path)?;
        let mut pushed = Ok(());
        wire.straight(costs, anchor, target, |pixel| {
            if pushed.is_ok() {
                pushed = path.push(pixel as u32);
            }
        });
        pushed
    }

    /// Where the path to a target leaves the tree.
    fn anchor(&self, wire: &Wire, costs: &Costs<'_>, nodes: &[Node], target: usize) -> usize {
        let Some(Held { anchor, .. }) = self.held else {
            return target;
        };
        if given_up(wire, nodes, anchor, target) <= BRANCH {
            return target;
        }
        let prolonged = wire.straight(costs, anchor, target, |_| ());
        let stay = wire.cost_of(nodes, anchor).saturating_add(prolonged);
        let leave = wire.cost_of(nodes, target).saturating_add(MARGIN);
        if stay <= leave { anchor } else { target }
    }

    /// The middle of the pixel whose edge attracts the cursor most; the cursor itself where none does.
    #[must_use]
    pub fn attracted(&self, costs: &Costs<'_>, cursor: &Cursor) -> Point {
        let mut best = (0.0, cursor.at);
        let mut best_held = (0.0, cursor.at);
        for (edge, middle) in near(costs, cursor) {
            let away = distance(middle, cursor.at) / cursor.radius.max(1.0);
            let attraction = f64::from(edge.strength) * (1.0 - (1.0 - AT_RADIUS) * away * away);
            if attraction > best.0 {
                best = (attraction, middle);
            }
            if attraction > best_held.0 && self.is_held(costs, edge, middle) {
                best_held = (attraction, middle);
            }
        }
        if best_held.0 >= LEAST_HELD && best.0 < CLEARLY * best_held.0 {
            return best_held.1;
        }
        if best.0 >= LEAST_STRENGTH {
            best.1
        } else {
            cursor.at
        }
    }

    /// Whether a pixel lies on the edge that is held: in line with it, and with the same side bright.
    fn is_held(&self, costs: &Costs<'_>, edge: Edge, middle: Point) -> bool {
        let Some(Held { target, .. }) = self.held else {
            return false;
        };
        let (column, row) = (target % costs.width(), target / costs.width());
        let held = costs.at(column, row);
        let rotated = edge.outwards.wrapping_sub(held.outwards) as i8;
        let (sin, cos) = sin_cos(f64::from(held.outwards) * (core::f64::consts::TAU / 256.0));
        let (right, down) = (
            middle.column - (column as f64 + 0.5),
            middle.row - (row as f64 + 0.5),
        );
        let across = (right * cos + down * sin).abs();
        let along = sqrt((right * right + down * down - across * across).max(0.0));
        rotated.unsigned_abs() <= 40 && across <= 1.0 + 0.4 * along
    }
}

/// The edges within the cursor's radius, and the middles of their pixels.
fn near<'a>(
    costs: &'a Costs<'a>,
    cursor: &Cursor,
) -> impl Iterator<Item = (Edge, Point)> + use<'a> {
    let radius = cursor.radius.clamp(0.0, 64.0);
    let at = cursor.at;
    let span = move |middle: f64, size: usize| {
        let first = (middle - radius).max(0.0) as usize;
        let last = (middle + radius).max(0.0) as usize;
        first..(last + 1).min(size)
    };
    let columns = span(at.column, costs.width());
    let pixels =
        span(at.row, costs.height()).flat_map(move |row| columns.clone().map(move |c| (c, row)));
    pixels.filter_map(move |(column, row)| {
        let middle = Point::new(column as f64 + 0.5, row as f64 + 0.5);
        let within = distance(middle, at) <= radius;
        within.then(|| (costs.at(column, row), middle))
    })
}

/// How many steps of the path to one pixel are not on the path to another.
fn given_up(wire: &Wire, nodes: &[Node], old: usize, new: usize) -> usize {
    let (mut a, mut b, mut steps) = (old, new, 0);
    // Costs fall towards the seed, so the two meet where the paths do.
    while a != b {
        if wire.cost_of(nodes, a) > wire.cost_of(nodes, b) {
            steps += 1;
            let Some(parent) = wire.parent(nodes, a) else {
                return steps;
            };
            a = parent;
        } else if let Some(parent) = wire.parent(nodes, b) {
            b = parent;
        } else {
            return steps;
        }
    }
    steps
}

/// How many points two paths from one seed have in common, from the seed on.
#[must_use]
pub fn common_length(before: &[u32], now: &[u32]) -> usize {
    before.iter().zip(now).take_while(|(a, b)| a == b).count()
}

#[cfg(test)]
mod tests;
