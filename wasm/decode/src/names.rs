//! Names of files of frames: their order, and what is missing among those that are numbered.

mod gaps;
mod order;

pub use gaps::gaps_among;
pub use order::name_order;
