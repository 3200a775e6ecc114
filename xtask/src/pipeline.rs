//! From files to poses: what the verbs that measure and track share.

pub mod accuracy;
pub mod build;
pub mod files;
pub mod locator;
pub mod study;
