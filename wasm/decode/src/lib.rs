//! Image and model files decoded, natively and in a page's worker.
//!
//! ```text
//! bytes --> sniff --> Kind
//!       --> FrameFile::open --> frame(index) --> GreyFrame      PNG, JPEG, JPEG 2000, TIFF, BMP, DICOM, NumPy
//!       --> decode_mask ------------------------> MaskImage     the same, one frame
//!       --> decode_model -----------------------> Model         STL, OBJ, PLY
//! ```
//!
//! Existing libraries do the decoding. This crate chooses what is read, keeps hostile lengths away from the libraries (a
//! panic would end the page's module), converts to grey, and says in sentences what is wrong with a file ([`DecodeError`]).
//! [`limits`] are the sizes from which files are refused. [`page`] is what JavaScript calls.
//!
//! # Example
//! A mask is written as a PNG and read back.
//!
//! ```
//! let inside = vec![0, 1, 1, 0, 0, 1];
//! let png = fluoropose_decode::encode_mask(inside.clone(), 3, 2)?;
//! assert_eq!(fluoropose_decode::sniff(&png, "mask.png").word(), "png");
//!
//! let mask = fluoropose_decode::decode_mask(&png, "mask.png")?;
//! assert_eq!((mask.width, mask.height, mask.pixels), (3, 2, inside));
//!
//! let error = fluoropose_decode::decode_mask(&png[..20], "mask.png").expect_err("cut short");
//! assert!(error.to_string().starts_with("mask.png: this PNG file is damaged or incomplete"));
//! # Ok::<(), fluoropose_decode::DecodeError>(())
//! ```

#![cfg_attr(test, allow(clippy::unwrap_used, reason = "it fails the test"))]

// In the order of the data.
mod error;
pub mod limits;

mod sniff;

mod frame;
mod luminance;
mod numbers;
mod shutter;

mod bmp;
mod dicom;
mod jpeg;
mod jpeg2000;
mod numpy;
mod png;
mod tiff;

mod file;

mod encode;
mod mask;

mod model;

mod names;

pub mod page;

pub use encode::encode_mask;
pub use error::{DecodeError, Problem};
pub use file::{FrameFile, decode_frames};
pub use frame::{Geometry, GreyFrame, Pixels, SpacingCalibration, Window};
pub use mask::{
    MaskImage, MaskRule, decode_mask, decode_mask_by, decode_masks, graded_mask, mask_of, mask_rule,
};
pub use model::{Model, decode_model};
pub use names::{gaps_among, name_order};
pub use shutter::{MAX_CORNERS, Shutter};
pub use sniff::{Kind, SNIFFED, sniff, sniff_head};
