//! Cement between bone and implants: the implant's mesh, grown where it faces the bone.

use crate::implant::{Side, Triangles};
use glam::DVec3;

/// A femoral component's bone lies around this point, for a left part 70 mm wide, anterior and proximal mm. A tray reaches
/// no higher than some millimetres, and its bone lies below.
const INSIDE: [f64; 2] = [10.0, 20.0];
const TRAY_TOP: f64 = 8.0;

/// A femoral component or a tray, told apart by whether it reaches up, with a mantle of this thickness, mm: one closed mesh,
/// whose inside is to count as cement beneath the metal.
pub(super) fn mantle(mesh: &Triangles, side: Side, thickness: f64) -> Triangles {
    let points: Vec<DVec3> = mesh
        .vertices
        .iter()
        .map(|v| DVec3::from(v.map(f64::from)))
        .collect();
    let top = points.iter().fold(f64::NEG_INFINITY, |top, p| top.max(p.y));
    let is_tray = top < TRAY_TOP;
    let anterior = if side == Side::Right { -1.0 } else { 1.0 };
    let faces_bone = |point: DVec3, normal: DVec3| match is_tray {
        true => point.y < 0.0 && normal.y < 0.5,
        false => {
            let to_bone = DVec3::new(anterior * INSIDE[0], INSIDE[1], point.z) - point;
            normal.dot(to_bone.normalize_or_zero()) > 0.5
        }
    };
    let vertices = points
        .iter()
        .zip(normals(mesh, &points))
        .map(|(&point, normal)| {
            let grown = match faces_bone(point, normal) {
                true => point + thickness * normal,
                false => point,
            };
            grown.as_vec3().to_array()
        });
    Triangles {
        vertices: vertices.collect(),
        triangles: mesh.triangles.clone(),
    }
}

/// Normals at the vertices: means over the triangles around, weighted by area.
fn normals(mesh: &Triangles, points: &[DVec3]) -> Vec<DVec3> {
    let mut sums = vec![DVec3::ZERO; points.len()];
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|v| points[v as usize]);
        let normal = (b - a).cross(c - a);
        for &vertex in triangle {
            sums[vertex as usize] += normal;
        }
    }
    sums.into_iter().map(DVec3::normalize_or_zero).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::implant::check::closed_volume;
    use crate::implant::{Parameters, femur, tibia};

    #[test]
    fn a_mantle_grows_towards_the_bone_alone() {
        let parameters = Parameters::default();
        for (mesh, low, high) in [
            (femur(&parameters).unwrap(), 0.1, 0.6),
            (tibia(&parameters).unwrap(), 0.2, 0.8),
        ] {
            let grown = mantle(&mesh, Side::Left, 1.8);
            let [before, after] = [&mesh, &grown].map(|mesh| closed_volume(mesh).unwrap());
            let gained = after / before - 1.0;
            assert!((low..high).contains(&gained), "{gained}");
        }
        // The bearing surface, below and in front of the bone, and the tray's recess stay where they are.
        let femur = femur(&parameters).unwrap();
        let grown = mantle(&femur, Side::Left, 1.8);
        let lowest = |mesh: &Triangles| mesh.vertices.iter().map(|v| v[1]).fold(f32::MAX, f32::min);
        assert_eq!(lowest(&femur), lowest(&grown));
    }
}
