//! How well poses could be known from outlines, as tables have it; the bound itself is that of `fluoropose_noise::bound`.

mod outlines;
mod table;

pub use outlines::Outlines;
pub use table::{Comparison, Limit, PoseLimits};
