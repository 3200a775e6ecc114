//! Poses of a component, their uncertainty, and files of poses.

pub mod covariance;
pub mod jts;
mod rigid;

pub use rigid::*;
