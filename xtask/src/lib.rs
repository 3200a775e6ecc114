//! Every job of the project, one file a verb; what verbs share stands beside them.
#![cfg_attr(test, allow(clippy::unwrap_used, reason = "it fails the test"))]

pub mod bench;
pub mod biplane;
pub mod bound;
pub mod calibrate;
pub mod ci;
pub mod demo;
pub mod evaluate;
pub mod film;
pub mod firmware;
pub mod identify;
pub mod implant;
pub mod kinematics;
pub mod library;
pub mod models;
pub mod outline;
pub mod package;
pub mod page;
pub mod pipeline;
pub mod pose;
pub mod serve;
pub mod setup;
pub mod static_server;
pub mod stl;
pub mod suite;
pub mod synthetic;
pub mod test;
pub mod tidy;
pub mod undistort;
pub mod workspace;
