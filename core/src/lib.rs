//! Six-degree-of-freedom pose of a known implant from one X-ray silhouette, in fixed memory.
//!
//! The method is that of Walker, Hoff, Komistek and Dennis (1996). Data flow through the modules
//! in this order: a grey [`frame`], a traced [`contour`], a [`mask`], its [`canonical`] form,
//! the best views of a [`library`] by [`matching`], a view between them by [`interpolate`], a
//! [`pose`] by [`estimate`], and joint [`kinematics`] from two poses. Nothing is allocated:
//! callers lend memory and can ask how much.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

pub mod aids;
mod bands;
pub mod border;
pub mod calibration;
pub mod camera;
pub mod canonical;
pub mod choice;
pub mod contour;
pub mod covariance;
pub mod edges;
mod eigen;
pub mod estimate;
pub mod frame;
pub mod grid;
pub mod interpolate;
pub mod jts;
pub mod kernels;
pub mod kinematics;
pub mod library;
pub mod locate;
pub mod mask;
pub mod matching;
pub mod math;
pub mod median;
pub mod mesh;
pub mod mirror;
pub mod moments;
pub mod nearby;
pub mod oneclick;
pub mod partial;
pub mod pose;
pub mod raster;
pub mod refine;
pub mod region;
pub mod rivals;
pub mod scan;
pub mod search;
pub mod silhouette;
pub mod symmetry;
pub mod verify;
mod winding;
