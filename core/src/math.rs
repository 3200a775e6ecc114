//! Elementary functions and small algebra, the same to the last bit on every target.

mod basic;
pub(crate) mod eigen;

pub use basic::*;
