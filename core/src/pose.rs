//! Where a component is: poses, how sure they are, files of them, and the joint between two.

pub mod covariance;
pub mod jts;
pub mod kinematics;
mod rigid;

pub use rigid::*;
