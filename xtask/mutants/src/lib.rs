//! Changes of the sources, one at a time, that the tests have to notice.
//!
//! To compile a crate anew for each change takes minutes. Here all changes that were chosen are woven into a copy of the sources at once, each behind the question
//! whether it is the one that counts (mutant schemata: Untch, Offutt and Harrold 1993). It is compiled once; a run of a test names one change by its environment.
//! Which tests reach a change at all is recorded first, so that each change is tried by those alone.

mod change;
mod crates;
mod places;
mod program;
mod switch;
mod trial;
mod weave;

pub use crates::{Package, package};
pub use program::{Options, run};
