//! Which way a component lies in the axes of its file, as far as its shape tells.

use fluoropose::mesh::Mesh;
use fluoropose::mesh::anatomy::{KneeComponent, anatomical_axes, field_axes};
use fluoropose::mesh::symmetry::symmetry_planes;
use fluoropose::pose::Pose;
use wasm_bindgen::prelude::*;

use fluoropose_page::error::sentence;

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

/// What the shape of a femoral component, or of a tray, tells of its axes.
///
/// # Errors
/// The core's sentence about the vertex or triangle at fault.
#[wasm_bindgen(js_name = shapeAxes)]
pub fn shape_axes(vertices: &[f32], triangles: &[u32], femoral: bool) -> Result<ShapeAxes, JsError> {
    let mesh = Mesh::new(vertices.as_chunks().0, triangles.as_chunks().0).map_err(sentence)?;
    let planes = symmetry_planes(&mesh);
    let component = match femoral {
        true => KneeComponent::Femur,
        false => KneeComponent::Tibia,
    };
    if let Some(found) = anatomical_axes(&mesh, &planes, component) {
        return Ok(ShapeAxes {
            model_from_field: found.model_from_field,
            told: if found.front_is_known { "all" } else { "not the front" },
        });
    }
    let directions = field_axes(&mesh, &planes, component);
    Ok(ShapeAxes {
        told: if directions.is_some() { "no signs" } else { "nothing" },
        model_from_field: directions.unwrap_or(Pose::IDENTITY),
    })
}
