//! Calibration from pictures of a bead grid or of a ruler: where the beads are, which bead of the lattice each is, how
//! the picture is distorted, and what camera took it.
//!
//! The order of use: [`discs`] finds dark discs, [`lattice`] numbers them ([`automatic`] does both), [`correction`] fits the polynomial of a
//! [`distortion`] that makes their rows straight, [`resample`] applies it to frames, [`plate`] finds pixel pitch and principal point from
//! the straightened beads. A [`ruler`] of known length is the short way to the pitch alone.
//!
//! Image coordinates are those of the whole crate: continuous, a pixel's centre at its index + 0.5.

#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

pub mod automatic;
pub mod correction;
pub mod discs;
pub mod distortion;
pub mod lattice;
pub mod plate;
pub mod polynomial;
pub mod resample;
pub mod ruler;

use thiserror::Error;

/// Why a picture of a grid or a ruler says nothing.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum GridError {
    /// Lent memory is too short.
    #[error("{needed} numbers of working memory are needed and {given} were lent")]
    Memory {
        /// How many are needed.
        needed: usize,
        /// How many were lent.
        given: usize,
    },
    /// The bead radius to look for is not usable.
    #[error("beads of {0} px radius cannot be found; 1 to 64 px can")]
    Radius(f64),
    /// Too few beads form a lattice.
    #[error(
        "{found} beads in a square lattice were found and at least {needed} are needed; choose a frame in which the plate fills the picture, or say whether its beads are bright"
    )]
    FewBeads {
        /// Beads in a lattice.
        found: usize,
        /// How many are needed.
        needed: usize,
    },
    /// The beads do not determine the polynomial.
    #[error(
        "the beads lie too close to one line for a correction of order {order}; they must be spread over the picture"
    )]
    Degenerate {
        /// Order of the polynomial.
        order: u8,
    },
    /// A length or distance is not above zero, or not finite.
    #[error("the {name} is {value}; it must be above zero")]
    Length {
        /// Which length.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// The object would lie behind the detector.
    #[error(
        "the object is {object} mm from the source and the detector {detector} mm; the object must lie between them"
    )]
    Order {
        /// Source to object, mm.
        object: f64,
        /// Source to detector, mm.
        detector: f64,
    },
    /// The two marks of a ruler lie on one spot.
    #[error("the two marks are {0} px apart; they must be at least 2 px apart")]
    Marks(f64),
    /// A stored correction is not one.
    #[error("these numbers are no correction of distortion: {0}")]
    Correction(&'static str),
}

/// Refuses what is not above zero and finite.
fn above_zero(name: &'static str, value: f64) -> Result<f64, GridError> {
    match value.is_finite() && value > 0.0 {
        true => Ok(value),
        false => Err(GridError::Length { name, value }),
    }
}
