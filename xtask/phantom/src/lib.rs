//! A digital phantom: what an X-ray set would be tried out on. Implants made from numbers, synthetic films of them
//! at known poses, and all of that as the files of a study.
#![cfg_attr(test, allow(clippy::unwrap_used, reason = "it fails the test"))]

mod table;

pub mod implant;

pub mod film;

pub mod own_folder;
pub mod picture;
pub mod stl;
pub mod whole;

pub mod sequence;
