//! The suites of the verb `test`.

pub mod browser;
pub mod counts;
pub mod firmware;
pub mod native;
pub mod report;
