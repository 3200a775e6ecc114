//! Models.

use std::path::Path;

use anyhow::Result;
use fluoropose::mesh::OwnedModel;
use fluoropose_decode::decode_model;
use fluoropose_phantom::implant::Triangles;

use super::text::{name_of, read};

/// A built-in implant as the core takes it.
///
/// # Errors
/// The core's sentence about the vertex or triangle at fault.
pub fn owned(made: Triangles) -> Result<OwnedModel> {
    let (vertices, triangles) = (made.vertices, made.triangles);
    Ok(OwnedModel::new(
        vertices.into_flattened(),
        triangles.into_flattened(),
    )?)
}

/// Reads an STL, OBJ or PLY model. What was left out of the file is said on standard error.
///
/// # Errors
/// Names the file and what is wrong with it.
pub fn read_model(path: &Path) -> Result<OwnedModel> {
    let model = decode_model(&read(path)?, &name_of(path))?;
    for note in &model.notes {
        eprintln!("{}: {note}", path.display());
    }
    let (vertices, triangles) = (model.vertices, model.triangles);
    let owned = OwnedModel::new(vertices.into_flattened(), triangles.into_flattened())?;
    for remark in owned.remarks() {
        eprintln!("{}: {remark}", path.display());
    }
    Ok(owned)
}
