//! Canonical form: a silhouette centred, its principal axis level, its area constant.
//!
//! Two silhouettes of one shape that differ by a shift, a rotation in the plane and a scale have the same canonical form, up
//! to sampling (Walker et al. 1996, section 2). Shift, rotation and scale are recorded, because the pose comes from them.

mod canonicalise;
mod cells;
mod form;
mod marks;
mod sampler;

pub use canonicalise::{canonicalise, reverse};
pub use form::{CanonicalError, CanonicalForm, CanonicalSpec};
