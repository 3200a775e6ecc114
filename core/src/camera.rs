//! Perspective projection, and the calibration files that describe it.

pub mod calibration;
mod doubt;
mod projection;

pub use doubt::CameraDoubt;
pub use projection::*;
