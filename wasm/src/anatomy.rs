//! Which way a component lies in the axes of its file, as far as its shape tells.

use fluoropose::joint::flange::side_by_flange;
use fluoropose::mesh::anatomy::{
    AnatomicalAxes, KneeComponent, anatomical_axes, component_by_shape, field_axes,
};
use fluoropose::mesh::symmetry::{SymmetryPlane, symmetry_planes};
use fluoropose::mesh::{Mesh, OwnedModel};
use fluoropose::pose::Pose;
use wasm_bindgen::prelude::*;

use fluoropose_page::error::sentence;
use fluoropose_page::pose_numbers::axes_from;

/// Anatomical axes that a shape tells.
#[wasm_bindgen]
pub struct ShapeAxes {
    model_from_field: Pose,
    told: &'static str,
}

#[wasm_bindgen]
impl ShapeAxes {
    /// The directions anterior, superior and to the patient's right in the file's coordinates, nine numbers.
    #[wasm_bindgen(getter)]
    pub fn directions(&self) -> Vec<f64> {
        let rows = self.model_from_field.rotation;
        let direction = |column: usize| rows.map(|row| row[column]);
        (0..3).flat_map(direction).collect()
    }

    /// How much of them the shape tells: `all`; `not the front`, where anterior and right may both have the other sign; `no
    /// signs`, where of a tray each of the three may, and of a femoral component right alone is told, with either sign; or
    /// `nothing`, and then they are the file's own.
    #[wasm_bindgen(getter)]
    pub fn told(&self) -> String {
        self.told.to_owned()
    }
}

/// Which component of a knee a model has the shape of: `femur` or `tibia`; nothing where its shape does not tell.
///
/// # Errors
/// The core's sentence about the vertex or triangle at fault.
#[wasm_bindgen(js_name = componentByShape)]
pub fn shape_component(vertices: &[f32], triangles: &[u32]) -> Result<Option<String>, JsError> {
    let mesh = Mesh::new(vertices.as_chunks().0, triangles.as_chunks().0).map_err(sentence)?;
    let word = |component| match component {
        KneeComponent::Femur => "femur",
        KneeComponent::Tibia => "tibia",
    };
    Ok(component_by_shape(&mesh).map(|component| word(component).to_owned()))
}

/// What a person should know of a model as it was read, in sentences without their full stops: holes, that it is round, a size that is no knee
/// component's.
///
/// # Errors
/// The core's sentence about the vertex or triangle at fault.
#[wasm_bindgen(js_name = modelRemarks)]
pub fn model_remarks(vertices: Vec<f32>, triangles: Vec<u32>) -> Result<Vec<String>, JsError> {
    Ok(OwnedModel::new(vertices, triangles)
        .map_err(sentence)?
        .remarks())
}

/// What the shape of a femoral component, or of a tray, tells of its axes.
///
/// # Errors
/// The core's sentence about the vertex or triangle at fault.
#[wasm_bindgen(js_name = shapeAxes)]
pub fn shape_axes(
    vertices: &[f32],
    triangles: &[u32],
    femoral: bool,
) -> Result<ShapeAxes, JsError> {
    let mesh = Mesh::new(vertices.as_chunks().0, triangles.as_chunks().0).map_err(sentence)?;
    Ok(ShapeAxes::of(&mesh, &symmetry_planes(&mesh), femoral))
}

impl ShapeAxes {
    /// Of a mesh with these symmetry planes.
    pub(crate) fn of(mesh: &Mesh<'_>, planes: &[SymmetryPlane], femoral: bool) -> Self {
        let component = match femoral {
            true => KneeComponent::Femur,
            false => KneeComponent::Tibia,
        };
        if let Some(found) = anatomical_axes(mesh, planes, component) {
            return Self {
                model_from_field: found.model_from_field,
                told: if found.front_is_known {
                    "all"
                } else {
                    "not the front"
                },
            };
        }
        let directions = field_axes(mesh, planes, component);
        Self {
            told: if directions.is_some() {
                "no signs"
            } else {
                "nothing"
            },
            model_from_field: directions.unwrap_or(Pose::IDENTITY),
        }
    }
}

/// Which knee a femoral component is made for, as its flange tells: `left` or `right`; nothing where it does not tell. `axes` are nine
/// numbers as [`ShapeAxes::directions`] gives them, with their signs.
///
/// # Errors
/// The core's sentence about the vertex or triangle at fault, or about axes that are no right-handed frame.
#[wasm_bindgen(js_name = flangeSide)]
pub fn flange_side(
    vertices: &[f32],
    triangles: &[u32],
    axes: &[f64],
) -> Result<Option<String>, JsError> {
    let mesh = Mesh::new(vertices.as_chunks().0, triangles.as_chunks().0).map_err(sentence)?;
    let axes = AnatomicalAxes {
        model_from_field: axes_from(axes)?,
        front_is_known: true,
        are_files_own: false,
    };
    Ok(side_by_flange(&mesh, &axes).map(|side| side.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fake::add_box;

    /// A plate 76 mm wide on a keel, with its notch behind or without one; x is anterior and y superior.
    fn tray(notched: bool) -> (Vec<f32>, Vec<u32>) {
        let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
        let mut add = |low, high| add_box(low, high, &mut vertices, &mut triangles);
        add([-7.0, -40.0, -5.0], [7.0, 0.0, 5.0]);
        if notched {
            add([-20.0, 0.0, -38.0], [25.0, 4.0, 38.0]);
            // Corners in the notch, as a model has them that is cut finely.
            add([-20.0, 0.0, -6.0], [25.0, 4.0, 6.0]);
            add([-25.0, 0.0, 12.0], [-20.0, 4.0, 38.0]);
            add([-25.0, 0.0, -38.0], [-20.0, 4.0, -12.0]);
        } else {
            add([-25.0, 0.0, -38.0], [25.0, 4.0, 38.0]);
        }
        (vertices, triangles)
    }

    #[test]
    fn a_notch_tells_the_front_and_without_one_a_person_has_to() {
        for (notched, told) in [(true, "all"), (false, "not the front")] {
            let (vertices, triangles) = tray(notched);
            let axes = shape_axes(&vertices, &triangles, false).ok().unwrap();
            assert_eq!(axes.told(), told);
            let directions = axes.directions();
            assert_eq!(directions[3..6], [0.0, 1.0, 0.0], "superior");
            assert_eq!(directions[0].abs(), 1.0, "x is anterior, or its opposite");
            assert!(!notched || directions[0] > 0.0, "the notch is behind");
        }
    }
}
