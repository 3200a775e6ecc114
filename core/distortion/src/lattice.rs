//! Which bead of a square lattice each mark is.
//!
//! Numbers spread from a bead to its neighbours. Each bead predicts the places of the next ones from the steps that led to
//! it, so that a lattice with pin-cushion distortion is followed. A missing bead is bypassed, and islands behind a row of
//! missing ones are joined by a cubic through the beads that are numbered already. Marks that fit nowhere get no number.

use crate::discs::Disc;
use crate::error::DistortionError;
use crate::polynomial::Fit;
use fluoropose::math::{atan2, floor, round, sin_cos, sqrt};
use fluoropose::memory::first;

/// A mark and its place in the lattice.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bead {
    /// Column and row of its centre, px.
    pub at: [f64; 2],
    /// Its number: columns to the right and rows down in the lattice, from an arbitrary bead. `None` for a mark that is no
    /// bead of the lattice.
    pub index: Option<[i32; 2]>,
    /// Step to the next bead in its row, px; the step to the next row is this step rotated by a right angle.
    step: [f64; 2],
    /// The patch that it was numbered in.
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

/// The least number of beads of a lattice.
pub const FEWEST: usize = 20;

/// The greatest distance of a bead from its predicted place, in steps.
const REACH: f64 = 0.3;

/// Numbers the beads of the largest lattice among the marks, and returns its step, px. `queue` has at least one place for
/// each mark.
///
/// # Errors
/// [`DistortionError::FewBeads`] below [`FEWEST`] beads, and [`DistortionError::Memory`] for a short queue.
pub fn number(beads: &mut [Bead], queue: &mut [usize]) -> Result<f64, DistortionError> {
    let queue = first("places in the queue", beads.len(), queue)?;
    for bead in beads.iter_mut() {
        *bead = Bead {
            at: bead.at,
            ..Bead::default()
        };
    }
    let step = common_step(beads, queue).ok_or(DistortionError::FewBeads {
        found: beads.len().min(1),
        needed: FEWEST,
    })?;
    let (sine, cosine) = sin_cos(direction(beads, step));
    let along_row = [step * cosine, step * sine];
    let (mut largest, mut best) = (0, 0);
    for (patch, seed) in (1u32..).zip(0..beads.len()) {
        if beads[seed].index.is_some() || !has_cross(beads, seed, along_row) {
            continue;
        }
        let count = spread(beads, queue, seed, along_row, patch);
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
        true => Err(DistortionError::FewBeads {
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

/// The median distance of a mark from its nearest neighbour, px. `scratch` has a place for each mark.
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
    // In 1024ths of a pixel, which can be sorted as integers.
    for (index, slot) in order.iter_mut().enumerate() {
        *slot = round(nearest(index).min(1e6) * 1024.0) as usize;
    }
    order.sort_unstable();
    Some(order[count / 2] as f64 / 1024.0).filter(|&step| step > 0.0)
}

/// Direction of the lattice, radians from -45 to 45 degrees. Four times the angle of a step is the same angle for all four
/// directions.
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

/// The four ways from a bead: the change of the number, and the step in px, given the step along a row.
fn ways([right, down]: [f64; 2]) -> [([i32; 2], [f64; 2]); 4] {
    [
        ([1, 0], [right, down]),
        ([0, 1], [-down, right]),
        ([-1, 0], [-right, -down]),
        ([0, -1], [down, -right]),
    ]
}

/// Whether a mark has a neighbour on each of its four sides, where a lattice of this step would have one.
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

/// Numbers the beads that are connected with a seed, and returns their number.
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
            let actual = [bead.at[0] - from.at[0], bead.at[1] - from.at[1]];
            *bead = Bead {
                index: Some(number),
                step: followed(from.step, change, actual),
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

/// The step along a row, half way between the expected step and the actual one.
fn followed(step: [f64; 2], change: [i32; 2], [right, down]: [f64; 2]) -> [f64; 2] {
    let actual = match change {
        [1, _] => [right, down],
        [-1, _] => [-right, -down],
        [_, 1] => [down, -right],
        _ => [-down, right],
    };
    [(step[0] + actual[0]) / 2.0, (step[1] + actual[1]) / 2.0]
}

/// Numbers marks that lie where a cubic through the numbered ones expects a bead, and returns their number.
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
        // A cubic is trusted a little beyond the beads that it was fitted to.
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

pub(crate) fn mean(points: impl Iterator<Item = [f64; 2]>) -> [f64; 2] {
    let (sum, count) = points.fold(([0.0; 2], 0usize), |(sum, count), at| {
        ([sum[0] + at[0], sum[1] + at[1]], count + 1)
    });
    sum.map(|value| value / count.max(1) as f64)
}

#[cfg(test)]
pub(crate) mod tests;
