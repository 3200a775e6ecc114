//! The suites of the verb `test`.

mod at_once;
mod board_rows;
pub(crate) mod boards;
pub(crate) mod browser;
mod calls;
pub(crate) mod changed;
mod checked_profile;
pub(crate) mod cluster;
mod counts;
pub(crate) mod firmware;
pub(crate) mod miri;
mod native;
pub(crate) mod python;
pub(crate) mod report;
pub(crate) mod side_by_side;
mod test_files;
mod test_programs;
