//! One file a verb.

pub mod batch;
pub mod bench;
pub mod biplane;
pub mod bound;
pub mod calibrate;
pub mod collect;
pub mod compare;
pub mod disguise;
pub mod evaluate;
pub mod identify;
pub mod kinematics;
pub mod library;
mod measured_film;
pub mod outline;
pub mod pose;
pub mod report;
pub mod synthetic;
pub mod track;
pub mod undistort;
