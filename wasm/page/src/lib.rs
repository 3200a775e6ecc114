//! What a page's own thread needs of the core: frames that it paints, tracing tools, models as drawn, small files.
//!
//! Every class owns its memory, from which the core borrows. Whatever goes wrong is thrown as a JavaScript `Error` whose
//! message is the core's sentence.
//!
//! WASM memory can neither adopt a JavaScript buffer nor give one away, so what is large (pixels, files, models, masks) is
//! moved once when it enters or leaves, and not copied inside: constructors take a `Vec` and keep it, getters make a typed
//! array from what is kept, and who reads a frame shares its pixels. What JavaScript reads at once stays here: a canvas
//! reads what is painted where it lies, and of a border it is given the address, which holds until the next call.
#![cfg_attr(test, allow(clippy::unwrap_used, reason = "it fails the test"))]

pub mod calibration;
mod covered;
pub mod distortion;
pub mod error;
pub mod frame_image;
mod jts;
mod kinematics;
mod model;
mod paint;
pub mod pose_numbers;
mod preprocessing;
pub mod traced;
mod tracing;
mod unmatched;

pub use calibration::{CalibrationText, jt_intcalib_text};
pub use distortion::{Undistorter, plate_camera, ruler_scale};
pub use frame_image::{Derived, FrameImage};
pub use jts::{read_jts, write_jts};
pub use kinematics::joint_motion;
pub use model::Model;
pub use traced::{Traced, unknown_reach};
pub use tracing::{
    Cooling, LiveWire, Reshaped, ThresholdTool, brush_outline, simplify_outline, smooth_outline,
    snap_outline, snap_path,
};
pub use unmatched::paint_unmatched;
