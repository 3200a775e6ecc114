//! The core of fluoropose for a page: owns pixels, meshes, libraries and masks, and paints them through web-sys.
//!
//! Every class owns its memory and lends it to the core. Whatever goes wrong is thrown as a JavaScript `Error` whose
//! message is the core's sentence.
//!
//! WASM memory can neither adopt a JavaScript buffer nor give one away, so what is large (pixels, files, models, libraries,
//! canonical pictures, landscapes, masks) is moved once when it enters or leaves, and not copied inside: constructors take
//! a `Vec` and keep it, getters make a typed array from what is kept, and who reads a film shares its pixels. What
//! JavaScript reads at once stays here: a canvas reads what is painted where it lies, and of a border it is told the
//! address, which holds until the next call.
//!
//! The page's own thread loads this without the feature `workers`: libraries are built, and poses and grids found, in workers.
#![cfg_attr(test, allow(clippy::unwrap_used, reason = "it fails the test"))]
#![cfg_attr(
    not(feature = "workers"),
    allow(dead_code, reason = "helpers that only workers need")
)]

mod aids;
#[cfg(feature = "workers")]
mod bead_grid;
mod calibration;
#[cfg(feature = "workers")]
mod choice;
mod error;
#[cfg(feature = "workers")]
mod exchange;
mod film;
#[cfg(feature = "workers")]
mod found;
mod grid;
mod jts;
mod kinematics;
#[cfg(feature = "workers")]
mod library;
mod library_check;
mod looks;
#[cfg(feature = "workers")]
mod matcher;
mod model;
mod paint;
mod pose_numbers;
mod traced;
mod unmatched;
#[cfg(feature = "workers")]
mod working_model;

pub use aids::{
    Cooling, LiveWire, Reshaped, ThresholdAid, brush_outline, simplify_outline, smooth_outline,
    snap_outline, snap_path,
};
#[cfg(feature = "workers")]
pub use bead_grid::{BeadGrid, DistortionFit, fit_distortion};
pub use calibration::{CalibrationText, jt_intcalib_text};
#[cfg(feature = "workers")]
pub use choice::{Chosen, Surroundings, choose_pose};
#[cfg(feature = "workers")]
pub use exchange::{MaskOutline, labels_of_mask, mask_of_outline, outline_of_mask};
pub use film::{Film, FilmLook};
#[cfg(feature = "workers")]
pub use found::Match;
pub use grid::{Straightener, plate_camera, ruler_scale};
pub use jts::{read_jts, write_jts};
pub use kinematics::joint_motion;
#[cfg(feature = "workers")]
pub use library::{LibraryBuilder, LibraryViews};
pub use library_check::check_library;
#[cfg(feature = "workers")]
pub use matcher::{
    Canonical, HandFit, HiddenPixels, Landscape, Matcher, NearestView, OneClick, OneClickAnswer,
    ViewPose,
};
pub use model::Model;
pub use traced::{Traced, unknown_reach};
pub use unmatched::paint_unmatched;
