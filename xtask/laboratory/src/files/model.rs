//! Models.

use std::path::Path;

use anyhow::Result;
use fluoropose::mesh::OwnedModel;
use fluoropose::mesh::anatomy::{KneeComponent, component_by_shape};
use fluoropose_decode::decode_model;
use fluoropose_phantom::implant::Triangles;

use super::role::Role;
use super::text::read;

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
    read_model_of(path, None)
}

/// The same with what there is to say of the file, a sentence each.
///
/// # Errors
/// Those of [`read_model`].
pub fn read_model_and_remarks(path: &Path) -> Result<(OwnedModel, Vec<String>)> {
    let model = decode_model(&read(path)?, &path.display().to_string())?;
    let (vertices, triangles) = (model.vertices, model.triangles);
    let owned = OwnedModel::new(vertices.into_flattened(), triangles.into_flattened())?;
    let mut remarks = model.notes;
    remarks.extend(owned.remarks());
    Ok((owned, remarks))
}

/// The same of a component, where it is known which one; where its model has the shape of the other one, that is said too.
///
/// # Errors
/// Those of [`read_model`].
pub fn read_model_of(path: &Path, role: Option<Role>) -> Result<OwnedModel> {
    let (owned, remarks) = read_model_and_remarks_of(path, role)?;
    for remark in remarks {
        eprintln!("{}: {remark}", path.display());
    }
    Ok(owned)
}

/// The same with what there is to say, a sentence each.
///
/// # Errors
/// Those of [`read_model`].
pub fn read_model_and_remarks_of(
    path: &Path,
    role: Option<Role>,
) -> Result<(OwnedModel, Vec<String>)> {
    let (owned, mut remarks) = read_model_and_remarks(path)?;
    remarks.extend(role.and_then(|role| shape_doubt(&owned, role)));
    Ok((owned, remarks))
}

/// The component that a model has the shape of, where that is the other one.
pub fn other_shape(model: &OwnedModel, role: Role) -> Option<KneeComponent> {
    component_by_shape(model.as_model().mesh()).filter(|shape| *shape != role.component())
}

/// What is doubtful of a model as that of a component: its shape is the other one's. A sentence without its full stop.
pub fn shape_doubt(model: &OwnedModel, role: Role) -> Option<String> {
    other_shape(model, role)?;
    let words = |role: Role| match role {
        Role::Femur => "femoral component",
        Role::Tibia => "tibial tray",
    };
    let (is, of) = (words(role.other()), words(role));
    Some(format!(
        "this is given as the {of} but has the shape of a {is}: were the models swapped?"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use fluoropose_phantom::implant::{Parameters, femur, tibia};

    #[test]
    fn swapped_models_are_told_and_right_ones_are_not() {
        let parameters = Parameters::default();
        let models = [femur(&parameters), tibia(&parameters)]
            .map(|made| owned(made.expect("usual")).expect("valid"));
        for (model, role) in models.iter().zip([Role::Femur, Role::Tibia]) {
            assert_eq!(shape_doubt(model, role), None);
            let doubt = shape_doubt(model, role.other()).expect("a doubt");
            assert!(doubt.contains("swapped"), "{doubt}");
        }
    }
}
