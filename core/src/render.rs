//! A component's silhouette as a camera sees it.

mod draw;
mod facing;
mod project;
mod winding;

pub(crate) use draw::{contour, for_each_span};
pub use draw::{render, scratch_for, scratch_needed};
pub(crate) use project::project;
pub use project::{Projected, RenderError};
