//! What is evaluated, and how.

use std::path::Path;

use crate::finding::{EdgeOptions, Method};
use crate::noise::DisturbanceOptions;

/// What is evaluated, and how.
#[derive(Clone, Copy, Debug)]
pub struct Request<'a> {
    /// The only source of masks that is looked at; all where it is `None`.
    pub source: Option<&'a str>,
    /// How poses are found.
    pub method: Method,
    /// How edges are looked for.
    pub edges: EdgeOptions,
    /// What is done to each mask before.
    pub disturbance: DisturbanceOptions,
    /// Where poses and uncertainty tables are written to. `None`: those of components without a
    /// reference, to the current folder.
    pub poses: Option<&'a Path>,
}

impl Request<'_> {
    /// A method with everything else as it is by default.
    pub fn of(method: Method) -> Self {
        Self {
            source: None,
            method,
            edges: EdgeOptions::default(),
            disturbance: DisturbanceOptions::default(),
            poses: None,
        }
    }
}
