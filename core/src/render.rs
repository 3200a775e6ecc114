//! A component's silhouette as a camera sees it.

mod draw;
mod facing;
mod project;
mod reach;
mod whole;
mod winding;

pub(crate) use draw::{for_each_span, remains, render_with};
pub use draw::{render, scratch_for, scratch_needed};
pub(crate) use project::{Images, VERTICES, project};
pub use project::{Projected, RenderError};
