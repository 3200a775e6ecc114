//! What is followed.

use crate::camera::Camera;
use crate::mesh::Model;
use crate::mesh::symmetry::SymmetryPlane;
use crate::refine::{Effort, RefineOptions};

/// A component that is followed, the camera that sees it, and how poses are refined.
#[derive(Clone, Copy, Debug)]
pub struct Subject<'s> {
    /// The model.
    pub model: &'s Model<'s>,
    /// Its planes of near-symmetry.
    pub planes: &'s [SymmetryPlane],
    /// The camera.
    pub camera: &'s Camera,
    /// How poses are refined.
    pub options: RefineOptions,
}

impl<'s> Subject<'s> {
    /// A component whose poses are refined with the effort of a film, in which neighbouring frames know more than a longer search.
    #[must_use]
    pub fn new(model: &'s Model<'s>, planes: &'s [SymmetryPlane], camera: &'s Camera) -> Self {
        Self {
            model,
            planes,
            camera,
            options: RefineOptions {
                effort: Effort::Film,
                ..RefineOptions::default()
            },
        }
    }
}
