//! The laboratory: poses of whole studies, measured. The rooms stand in the order in which data goes through them.
#![cfg_attr(test, allow(clippy::unwrap_used, reason = "it fails the test"))]

pub mod exit;
pub mod options;
pub mod progress;
pub mod signals;

pub mod files;

pub use fluoropose_noise as noise;

pub mod sequence;

pub mod finding;

pub mod choice;

pub mod measure;

pub mod verbs;

pub mod cli;
