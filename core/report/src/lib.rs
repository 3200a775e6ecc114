#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]
#![cfg_attr(test, allow(clippy::unwrap_used, reason = "it fails the test"))]

mod facts;
mod figure;
mod film;
mod html;
pub mod read;
mod svg;
pub mod write;

pub use facts::{Facts, Input};
pub use figure::figure;
pub use film::{JointFilm, JointRow, Step, impossibilities};
pub use html::html;
