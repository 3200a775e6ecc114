//! Six-degree-of-freedom pose of a known implant from one X-ray silhouette, in fixed memory.
//!
//! The method is that of Walker, Hoff, Komistek and Dennis (1996). Data flow through the modules
//! [`kinematics`] from two of them. Nothing is allocated: callers lend memory and can ask how
//! much.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;
#[cfg(test)]

pub mod border;
pub mod calibration;
pub mod camera;
pub mod contour;
pub mod frame;
pub mod jts;
pub mod mask;
pub mod math;
pub mod median;
pub mod mesh;
pub mod pose;
pub mod raster;
pub mod region;
pub mod scan;
