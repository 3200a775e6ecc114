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
    /// Whether what masks have in common is taken away from them, as the frames tell it.
    pub centred: bool,
    /// What is done to each mask before.
    pub disturbance: DisturbanceOptions,
    /// Where poses, their covariances and uncertainty tables are written to; nowhere where it is `None`.
    pub poses: Option<&'a Path>,
}

impl Request<'_> {
    /// Whether the grey frames are looked at.
    pub(super) fn asks_frames(&self) -> bool {
        self.method == Method::Image || self.is_centred()
    }

    pub(super) fn is_centred(&self) -> bool {
        self.method == Method::Refined && self.centred
    }

    /// A method with everything else as it is by default.
    pub fn of(method: Method) -> Self {
        Self {
            source: None,
            method,
            edges: EdgeOptions::default(),
            centred: false,
            disturbance: DisturbanceOptions::default(),
            poses: None,
        }
    }
}
