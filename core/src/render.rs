//! A component's silhouette as a camera sees it.

mod raster;
mod winding;

pub use raster::*;
pub(crate) use raster::{Images, contour, for_each_span, project};
