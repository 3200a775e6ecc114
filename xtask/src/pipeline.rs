//! From files to poses: what the verbs that measure and track share.

pub mod accuracy;
pub mod biplane;
pub mod bound;
pub mod build;
pub mod clicker;
pub mod decide;
pub mod distortion;
pub mod disturb;
pub mod files;
pub mod finder;
pub mod frames;
pub mod locator;
pub mod refiner;
pub mod report;
pub mod scene;
pub mod source;
pub mod study;
