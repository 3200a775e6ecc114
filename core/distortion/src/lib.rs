//! Camera and image distortion from a frame of a bead plate or of a ruler, without allocation.
//!
//! An image intensifier bends straight lines into a pin-cushion. A flat plate with beads in a square lattice, the
//! distortion grid, shows how: the frame is corrected so that its rows are straight, and the corrected beads tell the
//! camera. The way of the data, and the types on it:
//!
//! ```text
//! frame --> discs::find --> Disc --> lattice::number --> Bead --> correction::fit --> Corrected { Distortion, .. }
//!       +-- automatic::find_distortion_grid does both ----^                               |
//!                                                                                         v
//!           frame --> resample::{map_row, resample_row} --> undistorted frame      undistorted beads
//!                                                                                         |
//!                                                      plate::camera(distances) <---------+
//!                                                              --> PlateCamera: pixel pitch, principal point
//! two marks of known distance --> ruler::scale --> RulerScale: pixel pitch alone
//! ```
//!
//! - [`discs`] finds round marks to a few hundredths of a pixel, [`lattice`] numbers the beads among them, and
//!   [`automatic`] does both without knowing their size.
//! - [`correction`] fits the [`polynomial`]s of a [`distortion`], whose order it chooses by cross-validation.
//! - [`resample`] applies a correction to frames. [`Distortion::undistorted`] and [`Distortion::distorted`] apply it to
//!   points.
//! - [`plate`] and [`ruler`] find the camera.
//!
//! Places are (column, row) in px, continuous, a pixel's centre at its index + 0.5. Lengths are in mm. All memory is
//! borrowed from the caller, more than needed is welcome, and less is the error [`DistortionError::Memory`].
//!
//! # Example
//! Beads of a lattice of 40 px, moved outwards the more the farther they are from the middle, are corrected to less than a
//! tenth of a pixel.
//!
//! ```
//! use fluoropose_distortion::correction::fit;
//! use fluoropose_distortion::lattice::Bead;
//!
//! let seen = |index: [i32; 2]| {
//!     let [x, y] = index.map(|number| 40.0 * f64::from(number));
//!     let magnification = 1.0 + 0.05 * (x * x + y * y) / (512.0 * 512.0);
//!     [512.0 + magnification * x, 512.0 + magnification * y]
//! };
//! let numbers = (-10..=10).flat_map(|i| (-10..=10).map(move |j| [i, j]));
//! let mut beads: Vec<Bead> = numbers.map(|index| Bead::new(seen(index), Some(index))).collect();
//!
//! let corrected = fit(&mut beads, (1024, 1024))?;
//! assert!(corrected.before_px > 1.0 && corrected.after_px < 0.1);
//!
//! // The way there and back.
//! let undistorted = corrected.distortion.undistorted([900.0, 200.0]);
//! let [column, row] = corrected.distortion.distorted(undistorted).expect("inside the plate");
//! assert!((column - 900.0).abs() < 1e-6 && (row - 200.0).abs() < 1e-6);
//! # Ok::<(), fluoropose_distortion::DistortionError>(())
//! ```

#![no_std]
#![forbid(unsafe_code)]

#[cfg(feature = "alloc")]
extern crate alloc;

#[cfg(test)]
extern crate std;

// In the order of the data.
mod error;

pub mod discs;
pub mod lattice;

pub mod automatic;

pub mod polynomial;

pub mod correction;
pub mod distortion;

pub mod resample;

pub mod plate;
pub mod ruler;

pub use distortion::Distortion;
pub use error::DistortionError;
