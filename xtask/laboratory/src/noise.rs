//! From a mask to one that a hand would have traced, or of which a part is hidden.

pub mod curve;
mod disturb;
pub mod fill;
mod frame_cut;
pub mod jitter;
mod level;
mod occluder;
mod scene;

pub use disturb::{DisturbanceOptions, Disturbed};
pub use level::Noise;
pub use scene::Scene;
