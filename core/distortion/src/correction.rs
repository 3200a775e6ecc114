//! A correction of distortion from the numbered beads of a distortion grid.
//!
//! The undistorted lattice is the one that lies nearest to the beads: on the whole the frame keeps its place, size and
//! direction, and pixels stay square. The order, 3 to 5, is chosen by cross-validation: the residual of each bead is that
//! of a fit without it.

use crate::distortion::Distortion;
use crate::error::DistortionError;
use crate::lattice::{Bead, FEWEST, mean};
use crate::polynomial::{Fit, Solved, root_mean_square, terms_of};
use fluoropose::math::sqrt;

/// The orders that are tried.
pub const ORDERS: [u8; 3] = [3, 4, 5];

/// A square lattice without distortion: the place of number (0, 0) and the step along a row. The step to the next row is
/// that step rotated by a right angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UndistortedLattice {
    origin: [f64; 2],
    step: [f64; 2],
}

impl UndistortedLattice {
    /// The lattice nearest to the numbered beads in the sense of least squares.
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

    /// The place (column, row) of the bead with a number, px.
    #[must_use]
    pub fn place(&self, [i, j]: [i32; 2]) -> [f64; 2] {
        let [i, j] = [f64::from(i), f64::from(j)];
        let [right, down] = self.step;
        [
            self.origin[0] + i * right - j * down,
            self.origin[1] + i * down + j * right,
        ]
    }

    /// Distance between neighbours, px.
    #[must_use]
    pub fn spacing_px(&self) -> f64 {
        sqrt(self.step[0] * self.step[0] + self.step[1] * self.step[1])
    }

    /// How far to the right and down a numbered bead lies from its place, px; `None` for a bead without number.
    #[must_use]
    pub fn residual(&self, bead: &Bead) -> Option<[f64; 2]> {
        let [column, row] = self.place(bead.index?);
        Some([bead.at[0] - column, bead.at[1] - row])
    }
}

/// A correction, and how good it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corrected {
    /// The correction.
    pub distortion: Distortion,
    /// The lattice of the corrected beads.
    pub lattice: UndistortedLattice,
    /// Number of beads that it was fitted to.
    pub used: usize,
    /// Number of beads that lost their number because they lie far off the polynomial of the others.
    pub dropped: usize,
    /// Root mean square distance of the beads from the lattice before the correction, px.
    pub before_px: f64,
    /// The same after the correction, px.
    pub after_px: f64,
    /// The same with each bead left out of its own fit, px, for orders 3, 4 and 5; `None` for an order that the beads do
    /// not determine.
    pub left_out_px: [Option<f64>; 3],
}

/// A higher order is chosen only where it multiplies the cross-validated residual by less than this.
const WORTH: f64 = 0.98;
/// A bead farther off than this multiple of the root mean square loses its number,
const FAR: f64 = 5.0;
/// unless it is nearer than this, px: towards the corners the polynomial itself may be that far off.
const NEAR_PX: f64 = 0.5;

/// A corrected lattice may lie so far off, of the step from bead to bead: what is numbered wrongly lies half a step off and more.
const IRREGULAR: f64 = 0.1;

/// Fits a correction to the numbered beads of a frame of `size` (columns, rows). Beads that are far off lose their number.
///
/// # Errors
/// [`DistortionError::FewBeads`], [`DistortionError::Degenerate`] where the beads lie close to one line, and [`DistortionError::Irregular`] where no
/// correction brings them onto a lattice.
pub fn fit(beads: &mut [Bead], size: (usize, usize)) -> Result<Corrected, DistortionError> {
    let whole = numbered(beads).count();
    if whole < FEWEST {
        return Err(DistortionError::FewBeads {
            found: whole,
            needed: FEWEST,
        });
    }
    let mut coordinates = Normalisation::of(beads);
    while drop_far(beads, &coordinates)? > 0 {
        coordinates = Normalisation::of(beads);
    }
    let used = numbered(beads).count();
    let mut left_out_px = [None; 3];
    let mut best: Option<(f64, Solved, u8)> = None;
    for (slot, order) in left_out_px.iter_mut().zip(ORDERS) {
        if used < 2 * terms_of(order) {
            continue;
        }
        let Some(solved) = coordinates.solve(beads, order) else {
            continue;
        };
        let residual = root_mean_square(
            numbered(beads).map(|bead| coordinates.left_out_square(&solved, bead)),
        );
        *slot = Some(residual);
        if best
            .as_ref()
            .is_none_or(|(least, ..)| residual < WORTH * least)
        {
            best = Some((residual, solved, order));
        }
    }
    let (_, solved, order) = best.ok_or(DistortionError::Degenerate { order: ORDERS[0] })?;
    let after_px = root_mean_square(numbered(beads).map(|bead| coordinates.square(&solved, bead)));
    check_regular(after_px, coordinates.lattice.spacing_px())?;
    let distortion = Distortion {
        order,
        size,
        centre: coordinates.centre,
        scale: coordinates.scale,
        coefficients: solved.coefficients,
    };
    Ok(Corrected {
        distortion,
        lattice: coordinates.lattice,
        used,
        dropped: whole - used,
        before_px: root_mean_square(
            numbered(beads).map(|bead| square(coordinates.lattice.residual(bead))),
        ),
        after_px,
        left_out_px,
    })
}

/// # Errors
/// [`DistortionError::Irregular`] for what is no lattice.
fn check_regular(residual_px: f64, step_px: f64) -> Result<(), DistortionError> {
    match residual_px > IRREGULAR * step_px {
        true => Err(DistortionError::Irregular {
            residual_px,
            step_px,
        }),
        false => Ok(()),
    }
}

fn numbered(beads: &[Bead]) -> impl Iterator<Item = &Bead> {
    beads.iter().filter(|bead| bead.index.is_some())
}

fn square(residual: Option<[f64; 2]>) -> f64 {
    residual.map_or(0.0, |[right, down]| right * right + down * down)
}

/// The coordinates in which the polynomials are fitted: from the middle of the plate, in units of its radius.
struct Normalisation {
    lattice: UndistortedLattice,
    centre: [f64; 2],
    scale: f64,
}

impl Normalisation {
    fn of(beads: &[Bead]) -> Self {
        let centre = mean(numbered(beads).map(|bead| bead.at));
        let radius = numbered(beads)
            .map(|bead| square(Some([bead.at[0] - centre[0], bead.at[1] - centre[1]])));
        Self {
            lattice: UndistortedLattice::nearest_to(beads),
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
            fit.add(x, y, self.normalised(self.lattice.place(index)));
        }
        fit.solve()
    }

    /// Square of the residual of a bead, square px.
    fn square(&self, solved: &Solved, bead: &Bead) -> f64 {
        let Some(index) = bead.index else { return 0.0 };
        let [x, y] = self.normalised(bead.at);
        let (found, wanted) = (solved.at(x, y), self.normalised(self.lattice.place(index)));
        self.scale * self.scale * square(Some([found[0] - wanted[0], found[1] - wanted[1]]))
    }

    fn left_out_square(&self, solved: &Solved, bead: &Bead) -> f64 {
        let [x, y] = self.normalised(bead.at);
        let one_minus_leverage = solved.one_minus_leverage(x, y);
        self.square(solved, bead) / (one_minus_leverage * one_minus_leverage)
    }
}

/// Takes the numbers from beads that lie far off, and returns how many those are.
fn drop_far(beads: &mut [Bead], coordinates: &Normalisation) -> Result<usize, DistortionError> {
    let used = numbered(beads).count();
    let order = ORDERS
        .into_iter()
        .rev()
        .find(|&order| used >= 2 * terms_of(order))
        .unwrap_or(ORDERS[0]);
    let solved = coordinates
        .solve(beads, order)
        .ok_or(DistortionError::Degenerate { order })?;
    let residual = root_mean_square(numbered(beads).map(|bead| coordinates.square(&solved, bead)));
    let limit = (FAR * residual).max(NEAR_PX);
    let mut dropped = 0;
    for bead in beads.iter_mut() {
        if bead.index.is_some()
            && coordinates.square(&solved, bead) > limit * limit
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
