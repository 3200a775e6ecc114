//! Aids for tracing an outline: a threshold at the cursor ([`threshold`]), a path that follows edges ([`wire`]),
//! a rough outline pulled to edges ([`snap`]), [`simplify`], [`soften`] and a [`brush`].
//!
//! What changes an outline tells for each point where on the old outline it comes from ([`Vertex::from`]), so that
//! marks on its sides can follow, and how far the shape has moved ([`ShapeError`]).

#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

pub mod brush;
pub mod cooling;
pub mod costs;
pub mod follow;
pub mod list;
pub mod morphology;
mod noise;
pub mod one_click;
mod polyline;
pub mod simplify;
pub mod smoothed;
pub mod snap;
pub mod soften;
pub mod threshold;
pub mod wire;

use thiserror::Error;

use fluoropose::image::contour::Point;

/// A point that an aid has made or kept.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Vertex {
    /// Where it is.
    pub at: Point,
    /// Where on the outline that was given: `k` for its point number `k`, untouched to the last bit; `k + t` for a
    /// point that lies on its side `k` (from point `k` to the next) at the share `t`, or was moved from there, `t`
    /// strictly between 0 and 1; [`NEW`] for a point that has no such place.
    pub from: f64,
}

/// [`Vertex::from`] of a point that lies nowhere on the outline that was given.
pub const NEW: f64 = -1.0;

impl Vertex {
    /// Point `number` of an outline, untouched.
    #[must_use]
    pub fn kept(number: usize, at: Point) -> Self {
        Self {
            at,
            from: number as f64,
        }
    }

    /// A point from side `number` at the share `t`, which is brought strictly between 0 and 1.
    #[must_use]
    pub fn from_side(number: usize, t: f64, at: Point) -> Self {
        let least = 1e-9;
        Self {
            at,
            from: number as f64 + t.clamp(least, 1.0 - least),
        }
    }

    /// A point that lies nowhere on the outline that was given.
    #[must_use]
    pub fn new(at: Point) -> Self {
        Self { at, from: NEW }
    }

    /// The point of the given outline that this one is, if it is one.
    #[must_use]
    pub fn kept_number(&self) -> Option<usize> {
        let whole = self.from >= 0.0 && fluoropose::math::floor(self.from) == self.from;
        whole.then_some(self.from as usize)
    }
}

/// How far the shape that was given lies from the one that was made, pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ShapeError {
    /// The greatest distance of a point of the given line from the line that was made.
    pub max: f64,
    /// Root mean square distance along the given line.
    pub rms: f64,
}

/// Why an aid made nothing. Fields count points from 0, sentences from 1.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum AidError {
    /// A lent slice is too short.
    #[error("the aid needs {needed} {what} to work with but {given} were lent")]
    Memory {
        /// Which slice.
        what: &'static str,
        /// Its least length.
        needed: usize,
        /// The length that was lent.
        given: usize,
    },
    /// The result has more points than were lent.
    #[error("the outline would have more than {0} points")]
    TooLong(usize),
    /// Fewer points than a line of this kind has.
    #[error("the line has {given} points; it needs at least {needed}")]
    TooFewPoints {
        /// Points that were given.
        given: usize,
        /// Points that are needed.
        needed: usize,
    },
    /// A coordinate is NaN, infinite or far beyond any frame.
    #[error("point {} of the line has a coordinate that is not a place on a frame", .0 + 1)]
    NotAPlace(usize),
    /// A setting is not possible.
    #[error("{what} is {value}; it must be from {least} to {most}")]
    Setting {
        /// Which setting.
        what: &'static str,
        /// Its value.
        value: f64,
        /// The least that is possible.
        least: f64,
        /// The greatest that is possible.
        most: f64,
    },
    /// The frame is not the one that memory was prepared for.
    #[error("the aid was prepared for another frame")]
    OtherFrame,
    /// The costs of the frame have not been worked out to the end.
    #[error("the frame's edges have not been worked out yet")]
    NotPrepared,
}

/// Refuses a setting outside `least..=most`; a NaN is outside.
fn check_setting(what: &'static str, value: f64, least: f64, most: f64) -> Result<(), AidError> {
    if (least..=most).contains(&value) {
        return Ok(());
    }
    Err(AidError::Setting {
        what,
        value,
        least,
        most,
    })
}

/// Refuses a slice that is too short.
fn check_length(what: &'static str, needed: usize, given: usize) -> Result<(), AidError> {
    if given >= needed {
        return Ok(());
    }
    Err(AidError::Memory {
        what,
        needed,
        given,
    })
}

#[cfg(test)]
pub(crate) mod films;
