//! Poses of a component, their uncertainty, files of poses, and the kinematics of the joint between two components.

pub mod covariance;
pub mod jts;
pub mod kinematics;
mod rigid;

pub use rigid::*;
