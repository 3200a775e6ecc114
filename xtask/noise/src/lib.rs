//! From a mask to one that a hand would have traced, or of which a part is hidden; and how well a pose can be known from it.
//!
//! A crate of its own, as its loops have to be optimised wherever they run, and the laboratory's program hardly.
#![cfg_attr(test, allow(clippy::unwrap_used, reason = "it fails the test"))]

pub mod bound;
pub mod curve;
mod disturb;
pub mod fill;
mod frame_cut;
pub mod jitter;
mod level;
mod mask_buffer;
mod occluder;
mod scene;

pub use disturb::{DisturbanceOptions, Disturbed};
pub use level::Noise;
pub use mask_buffer::MaskBuffer;
pub use scene::Scene;
