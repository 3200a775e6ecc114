//! First poses from a part of an outline, without a start.
//!
//! Area, centroid and principal axis are what an occluder or the frame's border breaks, so none of
//! them is used. What is left are stretches of outline:
//!
//! 1. The borders of the mask are followed; sides next to an unknown pixel or at the frame's
//!    border are left out. What remains is smoothed and resampled at equal distances, whole
//!    stretches and parts of them (windows), at the scales that the object's distance allows.
//! 2. The outline of every fourth degree's view is followed likewise. Each window is slid along it
//!    by arc length; at each place the best similarity has a closed form (least squares with
//!    complex numbers). As in Wolfson, *On curve matching* (IEEE Trans. PAMI 12, 1990), a window
//!    only proposes.
//! 3. A proposal is judged by all that is known: the view's outline, laid on the frame, should
//!    meet the known outline wherever pixels are known, and cover all of it. The best of each view are
//!    brought nearer by a robust fit to the nearest points (four parameters), judged again, and
//!    the best of all views that differ in rotation are followed on the full grid.
//! 4. The similarity stands for the canonical form that the whole silhouette would have had, so the pose
//!    comes from it by the same equations as any other ([`crate::locate::estimate`]), and the poses are
//!    put in order by drawing the model and counting known pixels ([`crate::locate::rerank`]).

#[cfg(feature = "alloc")]
mod buffers;
mod error;
mod field;
mod find;
mod fit;
mod follow;
mod fraction;
mod hypothesis;
mod memory;
mod outline;
mod scale_levels;
mod search;
mod similarity;
mod slide;
mod smooth;
mod trace;
mod units;
mod view;

#[cfg(feature = "alloc")]
pub use buffers::PartialBuffers;
pub use error::PartialError;
pub use find::locate_partial;
pub use fraction::{KnownFraction, known_fraction};
pub use hypothesis::Hypothesis;
pub use memory::{PartialMemory, PartialNeeds, partial_needed};
pub use outline::OutlinePoint;
pub use trace::PixelSide;

#[cfg(test)]
mod tests;
