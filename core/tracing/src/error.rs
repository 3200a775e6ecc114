//! Why a tracing tool made nothing.

use thiserror::Error;

use fluoropose::memory::TooLittleMemory;

/// Why a tracing tool made nothing. Fields count points from 0, sentences count them from 1.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum TracingError {
    /// A borrowed slice is too short.
    #[error(transparent)]
    Memory(#[from] TooLittleMemory),
    /// The result has more points than the list for it has room for; the number is that of its places.
    #[error("the outline would have more than {0} points")]
    TooLong(usize),
    /// The line has fewer points than a line of its kind needs.
    #[error("the line has {given} points; it needs at least {needed}")]
    TooFewPoints {
        /// Points that were given.
        given: usize,
        /// Points that are needed.
        needed: usize,
    },
    /// A coordinate is NaN, infinite or far beyond any frame; the number is that of its point.
    #[error("point {} of the line has a coordinate that is not a place on a frame", .0 + 1)]
    NotAPlace(usize),
    /// A setting is out of its range.
    #[error("{what} is {value}; it must be from {least} to {most}")]
    Setting {
        /// Which setting.
        what: &'static str,
        /// Its value.
        value: f64,
        /// The least value that is possible.
        least: f64,
        /// The greatest value that is possible.
        most: f64,
    },
    /// The frame or the costs have another size than those that the memory was prepared for.
    #[error("the tracing tool was prepared for another frame")]
    OtherFrame,
    /// The costs of the frame's pixels have not been computed to the end.
    #[error("the frame's edges have not been computed yet")]
    NotPrepared,
}

/// Refuses a setting outside `least..=most`; a NaN is outside.
pub(crate) fn check_setting(
    what: &'static str,
    value: f64,
    least: f64,
    most: f64,
) -> Result<(), TracingError> {
    if (least..=most).contains(&value) {
        return Ok(());
    }
    Err(TracingError::Setting {
        what,
        value,
        least,
        most,
    })
}
