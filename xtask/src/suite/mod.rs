//! The suites of the verb `test`.

mod browser;
pub(crate) mod changed;
mod counts;
mod firmware;
mod native;
pub(crate) mod report;
pub(crate) mod side_by_side;
