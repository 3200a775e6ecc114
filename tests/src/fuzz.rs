//! Changed files and outlines for every reader and for the way to a pose: `cargo xtask fuzz` runs them for long, and tests for a
//! moment, with all that is kept in `corpus`.

mod change;
mod jts;
mod made;
mod outline;
mod targets;

pub use change::{Random, changed};
pub use made::implant_file;
pub use targets::{Seed, Target};
