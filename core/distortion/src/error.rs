//! Why frames of a bead plate or a ruler give no calibration.

use thiserror::Error;

use fluoropose::memory::TooLittleMemory;

/// Why a frame of a bead plate or of a ruler gives no calibration.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum DistortionError {
    /// A borrowed slice is too short.
    #[error(transparent)]
    Memory(#[from] TooLittleMemory),
    /// The radius of the beads to search for, px, is not possible.
    #[error("beads of {0} px radius cannot be found; 1 to 64 px can")]
    Radius(f64),
    /// Too few beads form a lattice.
    #[error(
        "{found} beads in a square lattice were found and at least {needed} are needed; choose a frame in which the plate fills the picture, or say whether its beads are bright"
    )]
    FewBeads {
        /// Beads in a lattice.
        found: usize,
        /// The least number.
        needed: usize,
    },
    /// The marks of the lattice would lie over one another, which no beads do: pixels.
    #[error(
        "marks of {radius_px:.1} px radius, {step_px:.1} px apart, are no beads, which would lie over one another; say whether the beads are brighter or darker than the plate"
    )]
    Overlapping {
        /// Mean radius of the marks.
        radius_px: f64,
        /// Distance between neighbours.
        step_px: f64,
    },
    /// The beads lie on no lattice, corrected or not: pixels.
    #[error(
        "the beads lie {residual_px:.1} px (RMS) off the lattice that fits them best, {step_px:.1} px from bead to bead: these marks are no flat grid; say whether its beads are brighter or darker than the plate, or choose a frame in which the plate fills the picture"
    )]
    Irregular {
        /// Root mean square distance from it after correction.
        residual_px: f64,
        /// Distance between neighbours.
        step_px: f64,
    },
    /// The beads do not determine the polynomial.
    #[error(
        "the beads lie too close to one line for a correction of order {order}; they must be spread over the picture"
    )]
    Degenerate {
        /// Order of the polynomial.
        order: u8,
    },
    /// A length or a distance is not finite or not above zero.
    #[error("the {name} is {value}; it must be above zero")]
    Length {
        /// Which length.
        name: &'static str,
        /// Its value, mm.
        value: f64,
    },
    /// The object would lie behind the detector.
    #[error(
        "the object is {object} mm from the source and the detector {detector} mm; the object must lie between them"
    )]
    Order {
        /// Distance from the source to the object, mm.
        object: f64,
        /// Distance from the source to the detector, mm.
        detector: f64,
    },
    /// The two marks of a ruler are too close together; the number is their distance, px.
    #[error("the two marks are {0} px apart; they must be at least 2 px apart")]
    Marks(f64),
    /// Stored numbers are no correction of distortion; the text says why.
    #[error("these numbers are no correction of distortion: {0}")]
    Correction(&'static str),
}

/// Refuses a length that is not finite or not above zero.
pub(crate) fn above_zero(name: &'static str, value: f64) -> Result<f64, DistortionError> {
    match value.is_finite() && value > 0.0 {
        true => Ok(value),
        false => Err(DistortionError::Length { name, value }),
    }
}
