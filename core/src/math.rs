//! Elementary functions and small algebra, the same to the last bit on every target.

mod angle;
mod basic;
mod decimal;
mod definite;
pub(crate) mod eigen;
mod median;

pub use angle::sin_cos;
pub use basic::*;
pub use decimal::Decimal;
pub(crate) use definite::solve_few;
pub use definite::{inverse_spd, solve_spd};
pub(crate) use median::median;
