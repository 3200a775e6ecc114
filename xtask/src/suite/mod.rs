//! The suites of the verb `test`.

pub(crate) mod browser;
pub(crate) mod counts;
pub(crate) mod firmware;
pub(crate) mod native;
pub(crate) mod report;
