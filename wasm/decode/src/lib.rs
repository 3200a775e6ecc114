//! Image and model files decoded, natively and in a page's worker.
//!
//! [`decode_frames`] and [`FrameFile`] give grey frames from PNG, JPEG, JPEG 2000, TIFF and DICOM; [`decode_mask`] gives masks
//! from the same; [`decode_model`] gives an indexed mesh from STL, OBJ and PLY; [`sniff`] tells what a file is. The
//! decoding is done by existing libraries. What is here is the choice of what is read, checks that keep hostile
//! lengths away from them (a panic would end the page's module), conversion to grey, and errors in sentences.
//!
//! Everything that is refused for its size is in [`limits`].

mod dicom;
mod encode;
mod error;
mod file;
mod frame;
mod jpeg;
mod jpeg2000;
pub mod limits;
mod luminance;
mod mask;
mod model;
pub mod page;
mod png;
mod sniff;
mod tiff;

pub use encode::encode_mask;
pub use error::{DecodeError, Problem};
pub use file::{FrameFile, decode_frames};
pub use frame::{Geometry, GreyFrame, Pixels, SpacingCalibration, Window};
pub use mask::{MaskImage, MaskRule, decode_mask, decode_mask_by, mask_of};
pub use model::{Model, decode_model};
pub use sniff::{Kind, SNIFFED, sniff, sniff_head};
