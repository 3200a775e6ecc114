//! The implants of a study as a synthetic film shows them: in the axes of the built-in ones, and of other proportions if that is asked for.

use std::path::Path;

use anyhow::{Context, Result, ensure};
use fluoropose::mesh::Model;
use fluoropose::pose::Pose;
use fluoropose_phantom::implant::{Side, Triangles};
use fluoropose_phantom::sequence::Implants;

use crate::files::{Component, Role, Study};
use crate::finding::axes_of;

/// Where the origin of a tray lies below its upper side, mm.
const BELOW_TOP_MM: f64 = 2.5;

/// Reads femur and tibia of a study for a film of a left or right knee, stretched along the anterior, superior and lateral axis.
///
/// # Errors
/// For files that cannot be read, and shapes that do not tell which way they lie.
pub(super) fn of_study(file: &Path, side: Side, stretch: [f64; 3]) -> Result<Implants> {
    ensure!(
        stretch.iter().all(|by| (0.5..=2.0).contains(by)),
        "implants are stretched by 0.5 to 2, not {stretch:?}"
    );
    let study = Study::read(file)?;
    let own = study.known_side()?;
    let part = |role: Role| -> Result<Triangles> {
        let of_role = |one: &&Component| one.role() == Some(role);
        let component = study.components.iter().find(of_role);
        let component = component.with_context(|| format!("the study has no {role:?}"))?;
        let (model, _) = component.read_model_and_remarks()?;
        let model = model.as_model();
        let axes = axes_of(&model, role, component.axes.as_deref())?;
        let axes = axes.with_context(|| {
            let file = component.model.display();
            format!("{file}: its shape does not tell its axes; state them as axes in the study")
        })?;
        Ok(placed(
            &model,
            &axes.model_from_field,
            role,
            [own, side],
            stretch,
        ))
    };
    let parts = [part(Role::Femur)?, part(Role::Tibia)?];
    let width_mm = extent(&parts[1].vertices, 2);
    let width_mm = width_mm[1] - width_mm[0];
    Ok(Implants { parts, width_mm })
}

/// In the axes of the built-in ones: z points to the medial side, and x of a right knee to the back. `own` is the knee that they are made
/// for; for the other one they are mirrored.
fn placed(
    model: &Model<'_>,
    model_from_field: &Pose,
    role: Role,
    [own, film]: [Side; 2],
    stretch: [f64; 3],
) -> Triangles {
    let sign = |side| if side == Side::Left { 1.0 } else { -1.0 };
    let turn = [sign(film), 1.0, sign(own)];
    let field_from_model = model_from_field.inverse();
    let turned = |vertex: &[f32; 3]| {
        let at = field_from_model.transform(&vertex.map(f64::from));
        core::array::from_fn(|k| (turn[k] * stretch[k] * at[k]) as f32)
    };
    let mut vertices: Vec<[f32; 3]> = model.vertices().iter().map(turned).collect();
    let origin = origin(&vertices, role);
    for vertex in &mut vertices {
        for (value, origin) in vertex.iter_mut().zip(origin) {
            *value -= origin as f32;
        }
    }
    let wound = |&[a, b, c]: &[u32; 3]| if own == film { [a, b, c] } else { [a, c, b] };
    Triangles {
        vertices,
        triangles: model.triangles().iter().map(wound).collect(),
    }
}

/// Middle of the box; of a tray that of its plate's upper side.
fn origin(vertices: &[[f32; 3]], role: Role) -> [f64; 3] {
    let middle = |vertices: &[[f32; 3]], axis| extent(vertices, axis).iter().sum::<f64>() / 2.0;
    if role == Role::Femur {
        return core::array::from_fn(|axis| middle(vertices, axis));
    }
    let [_, top] = extent(vertices, 1);
    let is_plate = |vertex: &&[f32; 3]| f64::from(vertex[1]) > top - 2.0 * BELOW_TOP_MM;
    let plate: Vec<[f32; 3]> = vertices.iter().filter(is_plate).copied().collect();
    [middle(&plate, 0), top - BELOW_TOP_MM, middle(&plate, 2)]
}

fn extent(vertices: &[[f32; 3]], axis: usize) -> [f64; 2] {
    let values = vertices.iter().map(|vertex| f64::from(vertex[axis]));
    values.fold(
        [f64::INFINITY, f64::NEG_INFINITY],
        |[least, most], value| [least.min(value), most.max(value)],
    )
}
