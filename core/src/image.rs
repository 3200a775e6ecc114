//! What is seen: grey frames, outlines, masks of one bit a pixel, and what is measured of them.

pub mod blank;
pub mod border;
pub mod contour;
pub mod crop;
mod crossing;
pub mod display;
pub mod frame;
pub mod grey;
pub mod mask;
pub mod moments;
mod point;
pub mod profile;
pub mod region;
pub mod runs;
pub mod scan;
pub mod shuttered;
pub mod silhouette;
mod squares;
pub(crate) mod tiles;
