//! What a film shows of a component: intensity behind metal, blurred, and where its edge seems to be.
//!
//! The steepest place of an edge on a film is not the outline: metal is thin near a rounded edge and darkens late, and a
//! logarithmic display puts the steepest place of a blurred edge on its dark side. Both are the same for the film and for the
//! model as drawn, so refinement compares where the edge seems to be in either. Edges that were enhanced are drawn enhanced.
//!
//! - [`lines`]: the path of X-rays through a mesh along lines across its outline.
//! - [`model`]: constants of a film, and the profile and the edge that they make of paths.
//! - [`profile`], [`mod@estimate`]: profiles read from frames, and the constants that explain them.
//! - [`SquareChoice`]: the squares of pixels that a film finer than its blur is read in.
//! - [`given`]: what a person states instead. [`pool`]: the profiles of a study, for callers that have an allocator.

mod clipped;
mod drawn;
pub(crate) mod edge;
pub mod estimate;
mod fit;
pub mod given;
pub mod lines;
pub mod model;
#[cfg(feature = "alloc")]
pub mod pool;
pub mod profile;
mod sharpening;
mod squares;

pub use clipped::Clipped;
pub use estimate::{FilmEstimate, estimate, estimate_with};
pub use given::{DisplayKind, GivenFilm};
pub use lines::{LineMemory, PathLine};
pub use model::{FilmConstants, FilmModel};
#[cfg(feature = "alloc")]
pub use pool::FilmPool;
pub use profile::FilmProfile;
pub use sharpening::{MetalContrast, Sharpening};
pub use squares::{MOST_BLUR_PX, SquareChoice};
