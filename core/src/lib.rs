//! Six-degree-of-freedom pose of a known implant from one X-ray silhouette, in fixed memory.
//!
//! The method is that of Walker, Hoff, Komistek and Dennis (1996). Data flow through the modules
//! in this order: a grey [`frame`], a traced [`contour`], a [`mask`], its [`canonical`] form,
//! the best views of a [`library`] by [`matching`], a view between them by [`interpolate`], a
//! [`pose`] by [`estimate`], and joint [`kinematics`] from two poses. Nothing is allocated:
//! callers lend memory and can ask how much.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(feature = "alloc")]
extern crate alloc;
#[cfg(test)]
extern crate std;

pub mod camera;
pub mod canonical;
pub mod finder;
pub mod image;
pub mod library;
pub mod locate;
pub mod math;
pub mod memory;
pub mod mesh;
pub mod pose;
pub mod refine;
pub mod render;
pub mod search;
pub mod shortlist;
