//! Gets what the page and the tests need and a newcomer's machine may lack.
//!
//! Each part first looks whether the thing is there, then tries to get it, and else says in one line what
//! could not be had and how to get it ([`Missing`]).

pub(crate) mod command;
pub(crate) mod components;
mod debian;
pub(crate) mod ended;
pub(crate) mod failed;
pub(crate) mod miri;
mod missing;
pub(crate) mod node;
pub(crate) mod programs;
pub(crate) mod python;
pub(crate) mod rust_target;
pub(crate) mod telling;
mod turns;

pub(crate) use missing::Missing;
