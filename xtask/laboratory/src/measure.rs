//! Poses against known ones, and how well they can be known at all.

pub mod accuracy;
pub mod bound;
pub mod coverage;
