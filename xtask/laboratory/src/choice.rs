//! From the poses of every frame to the one that is chosen, and what is told of it.

mod decide;
mod mirrored;
mod posed;
mod reasons;
pub mod report;

pub use decide::{Decision, Known, decide};
pub use mirrored::{are_good, doubt_mirrored, fit_flipped};
pub use posed::{Beside, Posed, Posing, uncertain};
pub use reasons::Reasons;
