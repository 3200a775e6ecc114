//! What is looked for: a model, views of it, and how it is symmetric.

use crate::library::Library;
use crate::mesh::Model;
use crate::mesh::symmetry::SymmetryPlane;

/// A component that is looked for in frames.
#[derive(Clone, Copy, Debug)]
pub struct Component<'c> {
    /// Views of the model.
    pub library: &'c Library<'c>,
    /// The model that the library was made from.
    pub model: &'c Model<'c>,
    /// Its planes of near-symmetry, of which [`crate::mesh::symmetry::symmetry_planes`] tells: poses mirrored in them are
    /// tried too.
    pub planes: &'c [SymmetryPlane],
}
