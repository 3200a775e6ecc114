//! The core of fluoropose for a page: owns pixels, meshes, libraries and masks, and paints them through web-sys.
//!
//! Every class owns its memory and lends it to the core. Whatever goes wrong is thrown as a JavaScript `Error` whose
//! message is the core's sentence. Nothing here hands out a view of WASM memory: what leaves is copied.
//!
//! The page's own thread loads this without the feature `poses`: libraries are built and poses found in workers.
#![cfg_attr(test, allow(clippy::unwrap_used, reason = "it fails the test"))]

mod aids;
mod calibration;
#[cfg(feature = "poses")]
mod choice;
mod error;
mod exchange;
mod film;
#[cfg(feature = "poses")]
mod found;
mod grid;
mod jts;
mod kinematics;
#[cfg(feature = "poses")]
mod lent_model;
#[cfg(feature = "poses")]
mod library;
mod library_check;
mod looks;
#[cfg(feature = "poses")]
mod matcher;
mod model;
mod paint;
#[cfg(feature = "poses")]
mod pieces;
mod pose_numbers;
mod surface;
mod traced;
mod unmatched;

pub use aids::{
    Cooling, LiveWire, Reshaped, ThresholdAid, brush_outline, simplify_outline, smooth_outline,
    snap_outline, snap_path,
};
pub use calibration::{CalibrationText, jt_intcalib_text};
#[cfg(feature = "poses")]
pub use choice::{Chosen, Surroundings, choose_pose};
pub use exchange::{MaskOutline, mask_of_outline, outline_of_mask};
pub use film::{Film, FilmLook};
#[cfg(feature = "poses")]
pub use found::Match;
pub use grid::{BeadGrid, DistortionFit, Straightener, fit_distortion, plate_camera, ruler_scale};
pub use jts::{read_jts, write_jts};
pub use kinematics::joint_motion;
#[cfg(feature = "poses")]
pub use library::{LibraryBuilder, LibraryViews};
pub use library_check::check_library;
#[cfg(feature = "poses")]
pub use matcher::{HandFit, HiddenPixels, Landscape, Matcher, OneClick, OneClickAnswer, ViewPose};
pub use model::Model;
pub use traced::{Traced, unknown_reach};
pub use unmatched::paint_unmatched;
