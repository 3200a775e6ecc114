//! Tools for tracing an implant's outline on a grey X-ray frame, without allocation.
//!
//! What each tool takes and gives, from a frame to an outline:
//!
//! ```text
//! frame --> Smoothed --> threshold::region_at(cursor, level) --------------+
//!       --> CostBuilder --> Costs --> Wire --> Follower::follow(cursor) ---+--> outline of Vertex
//!       --> one_click::OneClick(click or box) --> pose and outline         |
//!                                                                          v
//!       --> snap::snap(outline): onto the edges of the frame      brush, soften, simplify
//! ```
//!
//! - [`threshold`] outlines the region around the cursor at a grey level; [`smoothed`] prepares its frame.
//! - [`wire`] is the live-wire: cheapest paths along edges. [`costs`] prepares them, [`follow`] holds the path's end
//!   under the cursor, [`cooling`] tells which part of the path may be fixed.
//! - [`one_click`] needs one click inside the implant or a rough box around it.  [`seeds`] are clicks worth trying where there is none,
//!   [`whole_frame`] tries them.
//! - [`snap`](mod@snap) pulls a rough outline onto edges, [`soften`](mod@soften) takes the shaking of the hand from
//!   it, [`simplify`](mod@simplify) leaves out points, [`brush`](mod@brush) adds to it and erases from it.
//!
//! A tool that changes an outline tells of each new point which place of the old outline it comes from
//! ([`Vertex::from`]), so that marks on the outline can follow, and how far the shape has moved ([`ShapeError`]).
//!
//! All memory is borrowed from the caller: a function next to each tool tells how much it needs, more is welcome, and
//! less is the error [`TracingError::Memory`]. Places are in pixels, a pixel's centre at its index + 0.5.
//!
//! # Example
//! A dark disc is outlined at the grey level 125 around a cursor inside it.
//!
//! ```
//! use fluoropose::image::contour::Point;
//! use fluoropose::image::frame::Frame;
//! use fluoropose_tracing::smoothed::Smoothed;
//! use fluoropose_tracing::threshold::{Threshold, ThresholdMemory, region_at, threshold_needed};
//! use fluoropose_tracing::{Inside, List, Vertex};
//!
//! const SIDE: usize = 64;
//! let distance = |column: usize, row: usize| f64::hypot(column as f64 - 31.5, row as f64 - 31.5);
//! let grey = |k: usize| if distance(k % SIDE, k / SIDE) < 20.0 { 50u8 } else { 200 };
//! let pixels: Vec<u8> = (0..SIDE * SIDE).map(grey).collect();
//! let frame = Frame::new(&pixels, SIDE, SIDE, SIDE)?;
//!
//! let mut cells = vec![0; SIDE * SIDE];
//! let smoothed = Smoothed::new(&frame, &mut cells)?;
//! let (words, points) = threshold_needed(SIDE, SIDE);
//! let memory = ThresholdMemory {
//!     words: &mut vec![0; words],
//!     line: &mut vec![Vertex::default(); points],
//!     marks: &mut vec![false; points],
//! };
//! let mut places = vec![Vertex::default(); points];
//! let mut outline = List::new(&mut places);
//! let threshold = Threshold { inside: Inside::Dark, level: 125.0, bridge: 0, tolerance: 0.5 };
//! let error = region_at(&smoothed, Point::new(32.0, 32.0), &threshold, memory, &mut outline)?;
//!
//! assert!(error.expect("there is a region").max <= 0.75);
//! assert!((8..64).contains(&outline.len()));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![no_std]
#![forbid(unsafe_code)]

#[cfg(feature = "alloc")]
extern crate alloc;

#[cfg(test)]
extern crate std;

// In the order of use: what all tools share, then how an outline is made, then how it is changed.
mod error;
pub mod list;
mod noise;
mod polyline;
mod side;
mod vertex;

pub mod smoothed;
pub mod threshold;

pub mod cooling;
pub mod costs;
pub mod follow;
pub mod wire;

mod cells;
mod dark_regions;
pub mod one_click;
#[cfg(feature = "alloc")]
mod places_buffers;
pub mod reduced;
pub mod seeds;
pub mod shapes;
mod surround;
pub mod whole_frame;

pub mod beside;
pub mod brush;
pub mod morphology;
pub mod simplify;
pub mod snap;
pub mod soften;

#[cfg(test)]
mod synthetic;

pub use error::TracingError;
pub use list::List;
#[cfg(feature = "alloc")]
pub use places_buffers::PlacesBuffers;
pub use polyline::squared_distance;
pub use side::{Hand, Inside};
pub use vertex::{NEW, ShapeError, Vertex};
