//! Which bead of a square lattice each mark is.
//!
//! Numbers spread from bead to neighbour: each bead predicts where the next ones are from the steps that led to it, so
//! that a lattice bent by pin-cushion distortion is followed. A missing bead is gone round; islands behind a row of
//! missing ones are joined by a quadratic through what is numbered already. Marks that fit nowhere stay without number.

use super::GridError;
use super::discs::Disc;
use super::polynomial::Fit;
use fluoropose::math::{atan2, floor, round, sin_cos, sqrt};

/// A mark and its place in the lattice.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bead {
    /// Column and row of its centre, px.
    pub at: [f64; 2],
    /// Columns to the right and rows down in the lattice, from an arbitrary bead; none for a mark that is no bead of it.
    pub index: Option<[i32; 2]>,
    /// Step to the next bead in a row of the lattice as seen here; the step down is this turned by a right angle.
    step: [f64; 2],
    /// Which patch numbered it.
    patch: u32,
}

impl Bead {
    /// A mark at a place (column, row), with its number in the lattice where that is known.
    #[must_use]
    pub fn new(at: [f64; 2], index: Option<[i32; 2]>) -> Self {
        Self {
            at,
            index,
            ..Self::default()
        }
    }
}

impl From<Disc> for Bead {
    fn from(disc: Disc) -> Self {
        Self {
            at: [disc.column, disc.row],
            ..Self::default()
        }
    }
}

/// Fewest beads of a lattice that is worth anything.
pub const FEWEST: usize = 20;

/// How far from its predicted place a bead may lie, in steps.
const REACH: f64 = 0.3;

/// Numbers the beads of the largest lattice among the marks; returns its step in px. `queue` holds as many places as
/// there are marks.
///
/// # Errors
/// [`GridError::FewBeads`] below [`FEWEST`], [`GridError::Memory`] for a short queue.
pub fn number(beads: &mut [Bead], queue: &mut [usize]) -> Result<f64, GridError> {
    let needed = beads.len();
    if queue.len() < needed {
        return Err(GridError::Memory {
            needed,
            given: queue.len(),
        });
    }
    for bead in beads.iter_mut() {
        *bead = Bead {
            at: bead.at,
            ..Bead::default()
        };
    }
    let step = common_step(beads, queue).ok_or(GridError::FewBeads {
        found: needed.min(1),
        needed: FEWEST,
    })?;
    let (sine, cosine) = sin_cos(direction(beads, step));
    let first = [step * cosine, step * sine];
    let (mut largest, mut best) = (0, 0);
    for (patch, seed) in (1u32..).zip(0..beads.len()) {
        if beads[seed].index.is_some() || !has_cross(beads, seed, first) {
            continue;
        }
        let count = spread(beads, queue, seed, first, patch);
        if count > largest {
            (largest, best) = (count, patch);
        }
        if 2 * largest > beads.len() {
            break;
        }
    }
    for bead in beads.iter_mut().filter(|bead| bead.patch != best) {
        *bead = Bead {
            at: bead.at,
            ..Bead::default()
        };
    }
    while join(beads) > 0 {}
    let found = beads.iter().filter(|bead| bead.index.is_some()).count();
    match found < FEWEST {
        true => Err(GridError::FewBeads {
            found,
            needed: FEWEST,
        }),
        false => Ok(step),
    }
}

fn square_between(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1])
}

fn between(a: [f64; 2], b: [f64; 2]) -> f64 {
    sqrt(square_between(a, b))
}

/// The median distance from a mark to its nearest other. The order of `scratch` is by that distance afterwards.
fn common_step(beads: &[Bead], scratch: &mut [usize]) -> Option<f64> {
    let nearest = |index: usize| {
        let others = beads
            .iter()
            .enumerate()
            .filter(|(other, _)| *other != index);
        let away = others.map(|(_, other)| square_between(other.at, beads[index].at));
        sqrt(away.fold(f64::INFINITY, f64::min))
    };
    let count = beads.len();
    let order = scratch.get_mut(..count).filter(|_| count > 1)?;
    // Bits of positive floating point numbers rise with them.
    for (index, slot) in order.iter_mut().enumerate() {
        *slot = round(nearest(index).min(1e6) * 1024.0) as usize;
    }
    order.sort_unstable();
    Some(order[count / 2] as f64 / 1024.0).filter(|&step| step > 0.0)
}

/// Direction of the lattice, radians, -45 to 45 degrees: four times the angle of a step is one for all four.
fn direction(beads: &[Bead], step: f64) -> f64 {
    let (mut sine, mut cosine) = (0.0, 0.0);
    for (index, a) in beads.iter().enumerate() {
        for b in &beads[..index] {
            let away = square_between(a.at, b.at) / (step * step);
            if (0.64..1.44).contains(&away) {
                let angle = atan2(b.at[1] - a.at[1], b.at[0] - a.at[0]);
                let (s, c) = sin_cos(4.0 * angle);
                sine += s;
                cosine += c;
            }
        }
    }
    atan2(sine, cosine) / 4.0
}

/// The four ways from a bead: change of number, and step in px for a step along a row.
fn ways([right, down]: [f64; 2]) -> [([i32; 2], [f64; 2]); 4] {
    [
        ([1, 0], [right, down]),
        ([0, 1], [-down, right]),
        ([-1, 0], [-right, -down]),
        ([0, -1], [down, -right]),
    ]
}

/// Has a mark a bead on each of its four sides, where a lattice of this step would have them?
fn has_cross(beads: &[Bead], seed: usize, step: [f64; 2]) -> bool {
    let at = beads[seed].at;
    ways(step).iter().all(|(_, [right, down])| {
        closest(
            beads,
            [at[0] + right, at[1] + down],
            between(step, [0.0; 2]),
        )
        .is_some()
    })
}

/// The mark nearest to a place, within reach.
fn closest(beads: &[Bead], place: [f64; 2], step: f64) -> Option<usize> {
    let mut best = (REACH * step * REACH * step, None);
    for (index, bead) in beads.iter().enumerate() {
        let away = square_between(bead.at, place);
        if away < best.0 {
            best = (away, Some(index));
        }
    }
    best.1
}

/// Numbers what hangs together with a seed; returns how many beads.
fn spread(
    beads: &mut [Bead],
    queue: &mut [usize],
    seed: usize,
    step: [f64; 2],
    patch: u32,
) -> usize {
    beads[seed] = Bead {
        index: Some([0, 0]),
        step,
        patch,
        ..beads[seed]
    };
    queue[0] = seed;
    let (mut next, mut end) = (0, 1);
    while next < end {
        let from = beads[queue[next]];
        next += 1;
        let Some(index) = from.index else { continue };
        for (change, [right, down]) in ways(from.step) {
            let place = [from.at[0] + right, from.at[1] + down];
            let Some(found) = closest(beads, place, between(from.step, [0.0; 2])) else {
                continue;
            };
            let number = [index[0] + change[0], index[1] + change[1]];
            if beads[found].index.is_some() || is_taken(beads, number, patch) {
                continue;
            }
            let bead = &mut beads[found];
            let gone = [bead.at[0] - from.at[0], bead.at[1] - from.at[1]];
            *bead = Bead {
                index: Some(number),
                step: followed(from.step, change, gone),
                patch,
                ..*bead
            };
            queue[end] = found;
            end += 1;
        }
    }
    end
}

fn is_taken(beads: &[Bead], number: [i32; 2], patch: u32) -> bool {
    beads
        .iter()
        .any(|bead| bead.patch == patch && bead.index == Some(number))
}

/// The step along a row half way between what was expected and what was gone.
fn followed(step: [f64; 2], change: [i32; 2], [right, down]: [f64; 2]) -> [f64; 2] {
    let gone = match change {
        [1, _] => [right, down],
        [-1, _] => [-right, -down],
        [_, 1] => [down, -right],
        _ => [-down, right],
    };
    [(step[0] + gone[0]) / 2.0, (step[1] + gone[1]) / 2.0]
}

/// Numbers marks that lie where a quadratic through the numbered ones expects a bead; returns how many.
fn join(beads: &mut [Bead]) -> usize {
    let numbered = || beads.iter().filter(|bead| bead.index.is_some());
    let count = numbered().count();
    if count < FEWEST {
        return 0;
    }
    let centre = mean(numbered().map(|bead| bead.at));
    let scale = numbered()
        .map(|bead| between(bead.at, centre))
        .fold(1.0, f64::max);
    let normalised = |at: [f64; 2]| [(at[0] - centre[0]) / scale, (at[1] - centre[1]) / scale];
    let mut fit = Fit::new(3);
    for bead in numbered() {
        let [x, y] = normalised(bead.at);
        if let Some(index) = bead.index {
            fit.add(x, y, index.map(f64::from));
        }
    }
    let Some(solved) = fit.solve() else { return 0 };
    let patch = numbered().map(|bead| bead.patch).next().unwrap_or(0);
    let mut joined = 0;
    for index in 0..beads.len() {
        let [x, y] = normalised(beads[index].at);
        // A cubic is trusted a little beyond what it was fitted to.
        if beads[index].index.is_some() || x * x + y * y > 1.3 {
            continue;
        }
        let guess = solved.at(x, y);
        let number = guess.map(|value| floor(value + 0.5) as i32);
        let near = (0..2).all(|axis| (guess[axis] - f64::from(number[axis])).abs() < 0.2);
        if near && !is_taken(beads, number, patch) {
            beads[index] = Bead {
                index: Some(number),
                patch,
                ..beads[index]
            };
            joined += 1;
        }
    }
    joined
}

pub(super) fn mean(points: impl Iterator<Item = [f64; 2]>) -> [f64; 2] {
    let (sum, count) = points.fold(([0.0; 2], 0usize), |(sum, count), at| {
        ([sum[0] + at[0], sum[1] + at[1]], count + 1)
    });
    sum.map(|value| value / count.max(1) as f64)
}

#[cfg(test)]
pub(super) mod tests;
