//! Image formation: what an X-ray film of a replaced knee looks like, from known poses.
//!
//! Along each ray from the focus the attenuation of skin, muscle, bone and metal is added up (Beer and Lambert);
//! scatter, focal-spot blur, quantum noise, detector blur and a display follow, each as [`Physics`] says; its default is the
//! demonstration's. Implant edges come from the core's rasteriser, sampled 4 x 4 times in a pixel or finer, so they agree with
//! the silhouettes of the same poses. Nothing else is shared with the core's film model, which is measured against these films. Anatomy is
//! drawn in the sagittal plane of the bone that carries it: outlines are tables, thickness across is that of a rounded tube.
//!
//! Nothing here is measured from a patient, and no distance in the picture means anything but the implants' poses.

pub mod activity;
mod anatomy;
mod beam;
mod cement;
mod detector;
mod display;
mod exposure;
mod field;
mod metal;
pub mod motion;
mod physics;
mod placed;
mod plane;
mod ruler;
mod sagittal;
mod screws;
mod texture;
mod tissue;
mod tube;

pub use display::{Display, Unsharp};
pub use exposure::{Scene, expose};
pub use physics::{
    Alloys, Blur, Cement, Exposure, Field, Physics, Sampling, Scatter, Surroundings,
};
pub use placed::{Motion, Placed, silhouette};
