//! Image formation: what an X-ray film of a replaced knee looks like, from known poses.
//!
//! Along each ray from the focus the attenuation of skin, muscle, bone and metal is added up (Beer and Lambert);
//! scatter, focal-spot blur, quantum noise, detector blur and a logarithmic display follow. Implant edges come from the core's
//! rasteriser, sampled 4 x 4 times in a pixel, so they agree with the silhouettes of the same poses. Anatomy is
//! drawn in the sagittal plane of the bone that carries it: outlines are tables, thickness across is that of a rounded tube.
//!
//! Nothing here is measured from a patient, and no distance in the picture means anything but the implants' poses.

mod anatomy;
mod detector;
mod exposure;
mod metal;
pub mod motion;
mod placed;
mod plane;
mod sagittal;
mod texture;
mod tissue;
mod tube;

pub use exposure::{Scene, expose};
pub use placed::{Placed, silhouette};
