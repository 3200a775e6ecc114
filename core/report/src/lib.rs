#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]
#![cfg_attr(test, allow(clippy::unwrap_used, reason = "it fails the test"))]

mod axes;
pub mod cell;
pub mod cohorts;
mod count;
mod drawing;
mod facts;
mod figure;
mod film;
mod group;
mod html;
#[cfg(feature = "png")]
mod letters;
pub mod levels;
#[cfg(feature = "png")]
pub mod overlay;
mod pdf;
#[cfg(feature = "png")]
mod picture;
mod plus_minus;
pub mod read;
mod svg;
#[cfg(feature = "webm")]
pub mod webm;
pub mod write;

pub use count::counted;
pub use drawing::Figure;
pub use facts::{Facts, Input};
pub use figure::{figure, group_figure};
pub use film::{JointFilm, JointRow, ORIGINS, Step, besides, impossibilities, origins_told};
pub use group::{Group, Knee};
pub use html::html;
#[cfg(feature = "png")]
pub use picture::Picture;
pub use plus_minus::plus_minus;
