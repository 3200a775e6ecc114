//! Live-wire: cheapest paths along edges from a seed to every pixel (Mortensen and Barrett, *Interactive segmentation
//! with intelligent scissors*, GMIP 60, 1998).
//!
//! Dijkstra's search with integer costs and a ring of buckets (Dial, CACM 12, 1969), which can be expanded a few pixels at
//! a time. The buckets are lists that are linked through borrowed memory, so the memory is bounded: one [`Node`] and one
//! [`Waiting`] for each pixel.

use crate::costs::{Costs, Edge};
use crate::error::TracingError;
use crate::list::List;
use crate::polyline::between;
use crate::side::Hand;
use fluoropose::image::contour::Point;
use fluoropose::math::{sin_cos, sqrt};
use fluoropose::memory::{TooLittleMemory, check_length};

/// What the search knows of a pixel: the cost of the path to it, the heading of its last step, and whether both are
/// final. Opaque: callers only provide the memory for it.
#[derive(Clone, Copy, Debug)]
pub struct Node(u32);

impl Default for Node {
    fn default() -> Self {
        Self(UNSEEN)
    }
}

/// A pixel that waits in a bucket. Opaque: callers only provide the memory for it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Waiting {
    pixel: u32,
    /// The next one in the same bucket, or in the list of free places.
    next: u32,
}

/// Working memory of a [`Wire`], the same from [`Wire::start`] on: at least one node and one waiting place for each pixel.
#[derive(Debug)]
pub struct WireMemory<'a> {
    /// What is known of each pixel.
    pub nodes: &'a mut [Node],
    /// The pixels that wait in buckets. Seldom more than some ten thousand wait at once, and never more than there are
    /// pixels.
    pub waiting: &'a mut [Waiting],
}

impl WireMemory<'_> {
    fn check(&self, pixels: usize) -> Result<(), TooLittleMemory> {
        check_length("nodes", pixels, self.nodes.len())?;
        check_length("waiting places", pixels, self.waiting.len())
    }
}

/// No waiting place.
const NONE: u32 = u32::MAX;
/// A node to which no path is known.
const UNSEEN: u32 = u32::MAX;
/// The lower bits of a node: one that says final, three for the heading.
const FINAL: u32 = 1;
const LOW_BITS: u32 = 4;

/// Cost of a step of one pixel along the strongest edge, and where there is no edge.
const LEAST: f64 = 6.0;
const MOST: f64 = 256.0;
/// Buckets: more than the cost of any step, and a power of two.
const BUCKETS: usize = 512;

/// Steps to the eight neighbours, clockwise on the screen from the right.
const STEPS: [(isize, isize); 8] = [
    (1, 0),
    (1, 1),
    (0, 1),
    (-1, 1),
    (-1, 0),
    (-1, -1),
    (0, -1),
    (1, -1),
];

impl Node {
    fn open(cost: u32, heading: usize) -> Self {
        Self(cost << LOW_BITS | (heading as u32) << 1)
    }

    /// The cost of the path; more than that of any path where none is known.
    fn cost(self) -> u32 {
        self.0 >> LOW_BITS
    }

    fn is_seen(self) -> bool {
        self.0 != UNSEEN
    }

    fn is_final(self) -> bool {
        self.0 & FINAL != 0 && self.is_seen()
    }

    fn heading(self) -> usize {
        (self.0 >> 1 & 7) as usize
    }
}

/// What steps cost.
#[derive(Clone, Debug)]
struct Prices {
    /// Cost by the strength of the edge along the step: for steps to the side, then for steps across a corner.
    by_strength: [[u16; 256]; 2],
    /// How well an edge lies along a step, 0 to 256, by the angle from the step's left to the edge's outward direction.
    alignment: [u16; 256],
}

impl Prices {
    fn new(hand: Hand) -> Self {
        let price = |strength: usize, length: f64| {
            let lacking = 1.0 - strength as f64 / 255.0;
            fluoropose::math::round(length * (LEAST + (MOST - LEAST) * lacking * lacking)) as u16
        };
        let alignment = |angle: usize| {
            let (_, cos) = sin_cos(angle as f64 * (core::f64::consts::TAU / 256.0));
            let along = match hand {
                Hand::Right => cos.max(0.0),
                Hand::Left => (-cos).max(0.0),
                Hand::Either => cos.max(-cos),
            };
            (256.0 * along) as u16
        };
        Self {
            by_strength: [1.0, sqrt(2.0)]
                .map(|length| core::array::from_fn(|strength| price(strength, length))),
            alignment: core::array::from_fn(alignment),
        }
    }

    /// The cost of a step in one of the eight directions onto a pixel with an edge.
    fn of(&self, heading: usize, edge: Edge) -> u32 {
        // The left of a heading is a quarter turn back.
        let left = (heading as u8).wrapping_mul(32).wrapping_sub(64);
        let alignment = self.alignment[usize::from(edge.outwards.wrapping_sub(left))];
        let strength = (u32::from(edge.strength) * u32::from(alignment)) >> 8;
        u32::from(self.by_strength[heading & 1][strength as usize & 255])
    }
}

/// A search for cheapest paths from one seed.
#[derive(Clone, Debug)]
pub struct Wire {
    width: usize,
    height: usize,
    prices: Prices,
    /// The first place of each bucket.
    heads: [u32; BUCKETS],
    /// The first of the places that were used before and are free.
    free: u32,
    /// Waiting places used so far.
    used: usize,
    /// Number of places in buckets.
    waiting: usize,
    /// The cost of the pixels that are settled now.
    cost: u32,
    settled: usize,
}

impl Wire {
    /// Begins at the pixel under `seed`, or the frame's pixel nearest to it, with the implant on one hand of the path.
    ///
    /// # Errors
    /// [`TooLittleMemory`] where there are fewer nodes or waiting places than pixels.
    pub fn start(
        costs: &Costs<'_>,
        seed: Point,
        hand: Hand,
        memory: &mut WireMemory<'_>,
    ) -> Result<Self, TooLittleMemory> {
        let (width, height) = (costs.width(), costs.height());
        memory.check(width * height)?;
        memory.nodes.fill(Node::default());
        let mut wire = Self {
            width,
            height,
            prices: Prices::new(hand),
            heads: [NONE; BUCKETS],
            free: NONE,
            used: 0,
            waiting: 0,
            cost: 0,
            settled: 0,
        };
        let seed = wire.pixel_at(seed);
        wire.enter(memory, seed, Node::open(0, 0));
        Ok(wire)
    }

    /// The number of the pixel under a point, or of the frame's pixel nearest to it.
    pub(super) fn pixel_at(&self, point: Point) -> usize {
        // A cast takes negative numbers and NaN to 0.
        let column = (point.column as usize).min(self.width - 1);
        let row = (point.row as usize).min(self.height - 1);
        row * self.width + column
    }

    /// The centre of the pixel with a number (row by row from the top).
    #[must_use]
    pub fn centre(&self, pixel: u32) -> Point {
        let (column, row) = (pixel as usize % self.width, pixel as usize / self.width);
        Point::new(column as f64 + 0.5, row as f64 + 0.5)
    }

    /// Number of pixels to which the cheapest path is known.
    #[must_use]
    pub fn settled(&self) -> usize {
        self.settled
    }

    /// Whether the cheapest path to a pixel's number is known.
    pub(super) fn is_settled(&self, nodes: &[Node], pixel: usize) -> bool {
        nodes.get(pixel).is_some_and(|node| node.is_final())
    }

    /// Whether the cheapest path to the pixel under a point is known.
    #[must_use]
    pub fn is_reached(&self, nodes: &[Node], point: Point) -> bool {
        self.is_settled(nodes, self.pixel_at(point))
    }

    /// Reaches up to `budget` more pixels in the order of their cost, and stops early once `target` is reached. Returns
    /// whether nothing is left to do.
    ///
    /// # Errors
    /// [`TracingError::OtherFrame`] where the costs are those of a frame of another size, and [`TracingError::Memory`].
    pub fn expand(
        &mut self,
        costs: &Costs<'_>,
        memory: &mut WireMemory<'_>,
        budget: usize,
        target: Option<Point>,
    ) -> Result<bool, TracingError> {
        if (costs.width(), costs.height()) != (self.width, self.height) {
            return Err(TracingError::OtherFrame);
        }
        memory.check(self.width * self.height)?;
        let target = target.map_or(usize::MAX, |target| self.pixel_at(target));
        let end = self.settled.saturating_add(budget);
        while self.settled < end && !self.is_settled(memory.nodes, target) {
            let Some(pixel) = self.cheapest(memory) else {
                return Ok(true);
            };
            self.settle(costs, memory, pixel);
        }
        Ok(self.waiting == 0 || self.is_settled(memory.nodes, target))
    }

    /// Takes one of the cheapest pixels that are not final out of its bucket.
    fn cheapest(&mut self, memory: &mut WireMemory<'_>) -> Option<usize> {
        while self.waiting > 0 {
            let head = &mut self.heads[self.cost as usize % BUCKETS];
            let Some(place) = memory.waiting.get_mut(*head as usize) else {
                // At most once for each bucket: what waits costs less than the number of buckets more.
                self.cost += 1;
                continue;
            };
            let pixel = place.pixel as usize;
            let taken = core::mem::replace(head, place.next);
            place.next = core::mem::replace(&mut self.free, taken);
            self.waiting -= 1;
            // A cheaper way was found since it was put here.
            if !self.is_settled(memory.nodes, pixel) {
                return Some(pixel);
            }
        }
        None
    }

    fn settle(&mut self, costs: &Costs<'_>, memory: &mut WireMemory<'_>, pixel: usize) {
        memory.nodes[pixel].0 |= FINAL;
        self.settled += 1;
        let (column, row) = (pixel % self.width, pixel / self.width);
        let inner = column > 0 && row > 0 && column + 1 < self.width && row + 1 < self.height;
        for (heading, &(right, down)) in STEPS.iter().enumerate() {
            if !inner
                && !self.holds(
                    column.wrapping_add_signed(right),
                    row.wrapping_add_signed(down),
                )
            {
                continue;
            }
            let neighbour = pixel.wrapping_add_signed(down * self.width as isize + right);
            let Some(&known) = memory.nodes.get(neighbour) else {
                continue;
            };
            // What is final costs no more than `self.cost`.
            if known.cost() <= self.cost {
                continue;
            }
            let cost = self.cost + self.prices.of(heading, costs.number(neighbour));
            if cost < known.cost() {
                self.enter(memory, neighbour, Node::open(cost, heading));
            }
        }
    }

    fn holds(&self, column: usize, row: usize) -> bool {
        column < self.width && row < self.height
    }

    /// Puts a pixel into the bucket of its cost.
    fn enter(&mut self, memory: &mut WireMemory<'_>, pixel: usize, node: Node) {
        memory.nodes[pixel] = node;
        if self.free == NONE && self.used == self.width * self.height {
            self.sweep(memory);
        }
        let place = if self.free == NONE {
            self.used += 1;
            self.used as u32 - 1
        } else {
            self.free
        };
        let head = &mut self.heads[node.cost() as usize % BUCKETS];
        if let Some(waiting) = memory.waiting.get_mut(place as usize) {
            if place == self.free {
                self.free = waiting.next;
            }
            *waiting = Waiting {
                pixel: pixel as u32,
                next: *head,
            };
            *head = place;
            self.waiting += 1;
        }
    }

    /// Frees the places of pixels that are final or wait in the bucket of a lower cost, so that at most one place for each
    /// pixel is left.
    fn sweep(&mut self, memory: &mut WireMemory<'_>) {
        for bucket in 0..BUCKETS {
            let mut at = core::mem::replace(&mut self.heads[bucket], NONE);
            while let Some(place) = memory.waiting.get_mut(at as usize) {
                let node = memory.nodes[place.pixel as usize];
                let next = place.next;
                let list = if !node.is_final() && node.cost() as usize % BUCKETS == bucket {
                    &mut self.heads[bucket]
                } else {
                    self.waiting -= 1;
                    &mut self.free
                };
                place.next = core::mem::replace(list, at);
                at = next;
            }
        }
    }

    /// The pixel before one on its path; `None` at the seed and where no path is known.
    pub(super) fn parent(&self, nodes: &[Node], pixel: usize) -> Option<usize> {
        let node = nodes.get(pixel).filter(|node| node.is_seen())?;
        let (right, down) = STEPS[node.heading()];
        (node.cost() > 0).then(|| pixel.wrapping_add_signed(-(down * self.width as isize + right)))
    }

    /// The cost of the path to a settled pixel.
    pub(super) fn cost_of(&self, nodes: &[Node], pixel: usize) -> u32 {
        nodes.get(pixel).map_or(u32::MAX, |node| node.cost())
    }

    /// Writes the numbers of the pixels from the seed to the pixel with a number; nothing where that is not reached.
    ///
    /// # Errors
    /// [`TracingError::TooLong`].
    pub(super) fn path_to(
        &self,
        nodes: &[Node],
        pixel: usize,
        path: &mut List<'_, u32>,
    ) -> Result<(), TracingError> {
        path.clear();
        if !self.is_settled(nodes, pixel) {
            return Ok(());
        }
        let mut at = Some(pixel);
        while let Some(pixel) = at {
            path.push(pixel as u32)?;
            at = self.parent(nodes, pixel);
        }
        path.as_mut_slice().reverse();
        Ok(())
    }

    /// Writes the numbers of the pixels from the seed to the one under a point; nothing where that is not reached.
    ///
    /// # Errors
    /// [`TracingError::TooLong`] where `path` has too few places.
    pub fn path(
        &self,
        nodes: &[Node],
        to: Point,
        path: &mut List<'_, u32>,
    ) -> Result<(), TracingError> {
        self.path_to(nodes, self.pixel_at(to), path)
    }

    /// Calls `emit` for each pixel of the straight way from one pixel to another, without the first, and returns its cost.
    pub(super) fn straight(
        &self,
        costs: &Costs<'_>,
        from: usize,
        to: usize,
        mut emit: impl FnMut(usize),
    ) -> u32 {
        let place = |pixel: usize| [(pixel % self.width) as isize, (pixel / self.width) as isize];
        let (a, b) = (place(from), place(to));
        let steps = (b[0] - a[0]).abs().max((b[1] - a[1]).abs());
        let (mut at, mut cost) = (a, 0u32);
        for step in 1..=steps {
            // Rounded to the nearest pixel.
            let next =
                [0, 1].map(|k| a[k] + ((b[k] - a[k]) * 2 * step + steps).div_euclid(2 * steps));
            let way = (next[0] - at[0], next[1] - at[1]);
            let heading = STEPS
                .iter()
                .position(|&step| step == way)
                .unwrap_or_default();
            let pixel = next[1] as usize * self.width + next[0] as usize;
            cost = cost.saturating_add(self.prices.of(heading, costs.number(pixel)));
            emit(pixel);
            at = next;
        }
        cost
    }
}

/// On which hand of a line the implant lies, by the edges along it weighted by their strength: 1 where all of them have
/// it on the right, -1 where all have it on the left, 0 where there is no edge.
#[must_use]
pub fn hand_of(costs: &Costs<'_>, line: &[Point]) -> f64 {
    let (mut sum, mut all) = (0.0, 0.0);
    for pair in line.windows(2) {
        let (right, down) = (pair[1].column - pair[0].column, pair[1].row - pair[0].row);
        let long = sqrt(right * right + down * down);
        let steps = (long as usize).clamp(1, costs.width() + costs.height());
        for step in 0..steps {
            let at = between((pair[0], pair[1]), (step as f64 + 0.5) / steps as f64);
            let edge = costs.at(at.column as usize, at.row as usize);
            let (sin, cos) = sin_cos(f64::from(edge.outwards) * (core::f64::consts::TAU / 256.0));
            // The left of (right, down) is (down, -right).
            let along = f64::from(edge.strength) * (cos * down - sin * right) / long.max(1e-9);
            sum += along;
            all += along.max(-along);
        }
    }
    if all > 0.0 { sum / all } else { 0.0 }
}

#[cfg(test)]
mod tests;
