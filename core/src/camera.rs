//! Perspective projection, and the calibration files that describe it.

pub mod calibration;
mod projection;

pub use projection::*;
