//! Models.

use std::path::Path;

use anyhow::Result;
use fluoropose::mesh::OwnedModel;
use fluoropose::mesh::SuspectedUnit;
use fluoropose::mesh::anatomy::{KneeComponent, component_by_shape};
use fluoropose_decode::decode_model;
use fluoropose_phantom::implant::Triangles;
use serde::Deserialize;

use super::role::Role;
use super::text::read;

/// The unit of length of a model's file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Unit {
    /// Millimetres.
    #[default]
    Mm,
    /// Centimetres.
    Cm,
    /// Metres.
    M,
    /// Inches.
    In,
}

impl Unit {
    /// Those that a size speaks for, as a study names them.
    pub(super) fn of(suspected: SuspectedUnit) -> Vec<&'static str> {
        match suspected {
            SuspectedUnit::Metres => vec!["m"],
            SuspectedUnit::CentimetresOrInches => vec!["cm", "in"],
        }
    }

    /// As a study names it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Mm => "mm",
            Self::Cm => "cm",
            Self::M => "m",
            Self::In => "in",
        }
    }

    /// A length of the file in millimetres; one in millimetres stays as it is, to the last bit.
    pub fn in_mm(self, length: f32) -> f32 {
        let mm = match self {
            Self::Mm => return length,
            Self::Cm => 10.0,
            Self::M => 1000.0,
            Self::In => 25.4,
        };
        (f64::from(length) * mm) as f32
    }
}

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
    read_model_in(path, Unit::Mm, None)
}

/// The same of a file in another unit, in millimetres; of a component, where it is known which one.
///
/// # Errors
/// Those of [`read_model`].
pub(super) fn read_model_in(
    path: &Path,
    unit: Unit,
    role: Option<Role>,
) -> Result<(OwnedModel, Vec<String>)> {
    let model = decode_model(&read(path)?, &path.display().to_string())?;
    let (vertices, triangles) = (model.vertices.into_flattened(), model.triangles);
    let vertices = vertices.into_iter().map(|x| unit.in_mm(x)).collect();
    let owned = OwnedModel::new(vertices, triangles.into_flattened())?;
    let mut remarks = model.notes;
    remarks.extend(owned.remarks());
    remarks.extend(role.and_then(|role| shape_doubt(&owned, role)));
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
    read_model_in(path, Unit::Mm, role)
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
    use crate::files::Component;
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

    #[test]
    fn a_model_in_another_unit_is_read_in_millimetres() {
        let made = femur(&Parameters::default()).expect("usual");
        let mm = made.vertices.clone();
        let path = std::env::temp_dir().join(format!("fluoropose-unit-{}.stl", std::process::id()));
        for (unit, per_mm) in [
            (Unit::Mm, 1.0),
            (Unit::Cm, 0.1),
            (Unit::M, 0.001),
            (Unit::In, 1.0 / 25.4),
        ] {
            let mut written = made.clone();
            written.vertices = mm.iter().map(|one| one.map(|x| x * per_mm)).collect();
            let mut bytes = Vec::new();
            fluoropose_phantom::stl::write(&written, &mut bytes).expect("a file");
            std::fs::write(&path, bytes).expect("written");
            let component = |unit: &str| -> Component {
                toml::from_str(&format!("name = 'femur'\nmodel = {path:?}\n{unit}"))
                    .expect("a component")
            };
            let stated = component(&format!("unit = '{}'", format!("{unit:?}").to_lowercase()));
            let (model, remarks) = stated.read_model_and_remarks().expect("a model");
            assert!(remarks.is_empty(), "{unit:?}: {remarks:?}");
            let radius = model.as_model().bounds().radius;
            let expected = OwnedModel::new(
                mm.clone().into_flattened(),
                made.triangles.clone().into_flattened(),
            );
            let expected = expected.expect("valid").as_model().bounds().radius;
            assert!((radius / expected - 1.0).abs() < 1e-6, "{unit:?}: {radius}");
            let guessed = component("").read_model_and_remarks();
            let refusal = guessed.map_or_else(|error| error.to_string(), |_| String::new());
            let is_told = refusal.contains(&format!("unit = \"{}\"", unit.word()));
            assert_eq!(is_told, unit != Unit::Mm, "{unit:?}: {refusal:?}");
            let (_, remarks) = component("unit = 'mm'")
                .read_model_and_remarks()
                .expect("as stated");
            assert_eq!(
                remarks.is_empty(),
                unit == Unit::Mm,
                "{unit:?}: {remarks:?}"
            );
        }
        std::fs::remove_file(&path).expect("it was there");
    }
}
