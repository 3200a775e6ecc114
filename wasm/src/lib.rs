//! The core of fluoropose for a page: owns pixels, meshes, libraries and masks, and paints them through web-sys.
//!
//! Every class owns its memory and lends it to the core. Whatever goes wrong is thrown as a JavaScript `Error` whose
//! message is the core's sentence. Nothing here hands out a view of WASM memory: what leaves is copied.
#![cfg_attr(test, allow(clippy::unwrap_used, reason = "it fails the test"))]

mod calibration;
mod choice;
mod error;
mod film;
mod found;
mod jts;
mod lent_model;
mod library;
mod matcher;
mod model;
mod paint;
mod pieces;
mod pose_numbers;
mod surface;
mod traced;
mod unmatched;

pub use calibration::{CalibrationText, jt_intcalib_text};
pub use choice::{Chosen, Surroundings, choose_pose};
pub use film::Film;
pub use found::Match;
pub use jts::{read_jts, write_jts};
pub use library::{LibraryBuilder, LibraryViews};
pub use matcher::Matcher;
pub use model::Model;
pub use traced::{Traced, unknown_reach};
pub use unmatched::paint_unmatched;
