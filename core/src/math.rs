//! Elementary functions and small algebra, the same to the last bit on every target.

mod basic;
mod decimal;
pub(crate) mod eigen;

pub use basic::*;
pub use decimal::Decimal;
