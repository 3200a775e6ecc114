//! A correction of distortion from the numbered beads of a grid.
//!
//! The straight lattice is the one that lies nearest to the beads: on the whole the picture keeps its place, size and
//! direction, and pixels stay square. Order 3 to 5 is chosen by cross-validation: each bead's residual is that of a fit
//! without it.

use super::GridError;
use super::distortion::Distortion;
use super::lattice::{Bead, FEWEST, mean};
use super::polynomial::{Fit, Solved, root_mean_square, terms_of};
use fluoropose::math::sqrt;

/// The orders that are tried.
pub const ORDERS: [u8; 3] = [3, 4, 5];

/// A straight lattice: the place of number (0, 0), and the step along a row; down a row is that turned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Straight {
    origin: [f64; 2],
    step: [f64; 2],
}

impl Straight {
    /// The one that lies nearest to the numbered beads.
    #[must_use]
    pub fn nearest_to(beads: &[Bead]) -> Self {
        let pairs = || {
            beads
                .iter()
                .filter_map(|bead| Some((bead.index?.map(f64::from), bead.at)))
        };
        let number = mean(pairs().map(|(index, _)| index));
        let place = mean(pairs().map(|(_, at)| at));
        let (mut along, mut across, mut square) = (0.0, 0.0, 0.0);
        for (index, at) in pairs() {
            let [i, j] = [index[0] - number[0], index[1] - number[1]];
            let [right, down] = [at[0] - place[0], at[1] - place[1]];
            along += i * right + j * down;
            across += i * down - j * right;
            square += i * i + j * j;
        }
        let step = [along / square.max(1.0), across / square.max(1.0)];
        let origin = [
            place[0] - number[0] * step[0] + number[1] * step[1],
            place[1] - number[0] * step[1] - number[1] * step[0],
        ];
        Self { origin, step }
    }

    /// The place of a bead by its number, px.
    #[must_use]
    pub fn place(&self, [i, j]: [i32; 2]) -> [f64; 2] {
        let [i, j] = [f64::from(i), f64::from(j)];
        let [right, down] = self.step;
        [
            self.origin[0] + i * right - j * down,
            self.origin[1] + i * down + j * right,
        ]
    }

    /// Between neighbours, px.
    #[must_use]
    pub fn spacing_px(&self) -> f64 {
        sqrt(self.step[0] * self.step[0] + self.step[1] * self.step[1])
    }

    /// How far a numbered bead lies from its place: right and down, px.
    #[must_use]
    pub fn residual(&self, bead: &Bead) -> Option<[f64; 2]> {
        let [column, row] = self.place(bead.index?);
        Some([bead.at[0] - column, bead.at[1] - row])
    }
}

/// A correction with what tells how good it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corrected {
    /// The correction.
    pub distortion: Distortion,
    /// The lattice that the beads lie on once they are straight.
    pub straight: Straight,
    /// Beads that it rests on.
    pub used: usize,
    /// Beads whose numbers were taken away because they lie far off all others' polynomial.
    pub dropped: usize,
    /// Root mean square distance of the beads from the straight lattice, px, as taken.
    pub before_px: f64,
    /// The same once corrected.
    pub after_px: f64,
    /// The same with each bead left out of its own fit, for orders 3, 4 and 5; none for an order with too few beads.
    pub left_out_px: [Option<f64>; 3],
}

/// An order is taken over the one below only where it lowers the cross-validated residual by this factor.
const WORTH: f64 = 0.98;
/// A bead farther off than so many root mean squares is dropped,
const FAR: f64 = 5.0;
/// unless it is nearer than this, px: towards the corners the polynomial itself may be that far off.
const NEAR_PX: f64 = 0.5;

/// Fits a correction to numbered beads of frames of `size` (columns, rows). Beads that are far off lose their number.
///
/// # Errors
/// [`GridError::FewBeads`] and [`GridError::Degenerate`].
pub fn fit(beads: &mut [Bead], size: (usize, usize)) -> Result<Corrected, GridError> {
    let whole = numbered(beads).count();
    if whole < FEWEST {
        return Err(GridError::FewBeads {
            found: whole,
            needed: FEWEST,
        });
    }
    let mut frame = Frame::of(beads);
    while drop_far(beads, &frame)? > 0 {
        frame = Frame::of(beads);
    }
    let used = numbered(beads).count();
    let mut left_out_px = [None; 3];
    let mut best: Option<(f64, Solved, u8)> = None;
    for (slot, order) in left_out_px.iter_mut().zip(ORDERS) {
        if used < 2 * terms_of(order) {
            continue;
        }
        let Some(solved) = frame.solve(beads, order) else {
            continue;
        };
        let residual =
            root_mean_square(numbered(beads).map(|bead| frame.left_out_square(&solved, bead)));
        *slot = Some(residual);
        if best
            .as_ref()
            .is_none_or(|(least, ..)| residual < WORTH * least)
        {
            best = Some((residual, solved, order));
        }
    }
    let (_, solved, order) = best.ok_or(GridError::Degenerate { order: ORDERS[0] })?;
    let distortion = Distortion {
        order,
        size,
        centre: frame.centre,
        scale: frame.scale,
        coefficients: solved.coefficients,
    };
    Ok(Corrected {
        distortion,
        straight: frame.straight,
        used,
        dropped: whole - used,
        before_px: root_mean_square(
            numbered(beads).map(|bead| square(frame.straight.residual(bead))),
        ),
        after_px: root_mean_square(numbered(beads).map(|bead| frame.square(&solved, bead))),
        left_out_px,
    })
}

fn numbered(beads: &[Bead]) -> impl Iterator<Item = &Bead> {
    beads.iter().filter(|bead| bead.index.is_some())
}

fn square(residual: Option<[f64; 2]>) -> f64 {
    residual.map_or(0.0, |[right, down]| right * right + down * down)
}

/// What the polynomials are fitted in: places in radii of the plate about its middle.
struct Frame {
    straight: Straight,
    centre: [f64; 2],
    scale: f64,
}

impl Frame {
    fn of(beads: &[Bead]) -> Self {
        let centre = mean(numbered(beads).map(|bead| bead.at));
        let radius = numbered(beads)
            .map(|bead| square(Some([bead.at[0] - centre[0], bead.at[1] - centre[1]])));
        Self {
            straight: Straight::nearest_to(beads),
            centre,
            scale: sqrt(radius.fold(1.0, f64::max)),
        }
    }

    fn normalised(&self, at: [f64; 2]) -> [f64; 2] {
        [
            (at[0] - self.centre[0]) / self.scale,
            (at[1] - self.centre[1]) / self.scale,
        ]
    }

    fn solve(&self, beads: &[Bead], order: u8) -> Option<Solved> {
        let mut fit = Fit::new(order);
        for bead in beads {
            let Some(index) = bead.index else { continue };
            let [x, y] = self.normalised(bead.at);
            fit.add(x, y, self.normalised(self.straight.place(index)));
        }
        fit.solve()
    }

    /// Square of a bead's residual, square px.
    fn square(&self, solved: &Solved, bead: &Bead) -> f64 {
        let Some(index) = bead.index else { return 0.0 };
        let [x, y] = self.normalised(bead.at);
        let (found, wanted) = (solved.at(x, y), self.normalised(self.straight.place(index)));
        self.scale * self.scale * square(Some([found[0] - wanted[0], found[1] - wanted[1]]))
    }

    fn left_out_square(&self, solved: &Solved, bead: &Bead) -> f64 {
        let [x, y] = self.normalised(bead.at);
        let share = solved.share_left(x, y);
        self.square(solved, bead) / (share * share)
    }
}

/// Takes the numbers away from beads that lie far off; returns how many.
fn drop_far(beads: &mut [Bead], frame: &Frame) -> Result<usize, GridError> {
    let used = numbered(beads).count();
    let order = ORDERS
        .into_iter()
        .rev()
        .find(|&order| used >= 2 * terms_of(order))
        .unwrap_or(ORDERS[0]);
    let solved = frame
        .solve(beads, order)
        .ok_or(GridError::Degenerate { order })?;
    let residual = root_mean_square(numbered(beads).map(|bead| frame.square(&solved, bead)));
    let limit = (FAR * residual).max(NEAR_PX);
    let mut dropped = 0;
    for bead in beads.iter_mut() {
        if bead.index.is_some()
            && frame.square(&solved, bead) > limit * limit
            && used - dropped > FEWEST
        {
            bead.index = None;
            dropped += 1;
        }
    }
    Ok(dropped)
}

#[cfg(test)]
mod tests;
