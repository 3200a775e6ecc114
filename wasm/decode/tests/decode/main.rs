//! Every format: exact pixels and meshes from files made here, and what comes of cut, flipped and lying ones.

#![allow(
    clippy::unwrap_used,
    reason = "an unwrap that fails here is a failed test"
)]

mod bmp;
mod dicom;
mod hostile;
mod jpeg;
mod jpeg2000;
mod masks;
mod models;
mod numpy;
mod png;
mod samples;
mod sniffing;
mod study;
mod tiff;
mod work;
