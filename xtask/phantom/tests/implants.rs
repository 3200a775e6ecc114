//! The built-in implants: closed surfaces of the promised size, mirrored between sides, written as readable STL.
#![allow(clippy::unwrap_used, reason = "a refusal fails the test")]

use fluoropose_phantom::implant::check::{MeshFault, closed_volume};
use fluoropose_phantom::implant::{
    ImplantError, Parameters, SIZES_MM, Side, Size, Triangles, femur, tibia,
};
use fluoropose_phantom::stl;
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;

fn parts(parameters: &Parameters) -> [(&'static str, Triangles); 2] {
    [
        ("femur", femur(parameters).unwrap()),
        ("tibia", tibia(parameters).unwrap()),
    ]
}

fn extent(mesh: &Triangles, axis: usize) -> (f32, f32) {
    let values = || mesh.vertices.iter().map(|v| v[axis]);
    (
        values().fold(f32::INFINITY, f32::min),
        values().fold(f32::NEG_INFINITY, f32::max),
    )
}

#[test]
fn every_size_side_and_resolution_is_closed_and_wound_outwards() {
    for side in [Side::Left, Side::Right] {
        for number in 1..=SIZES_MM.len() {
            let size = Size::numbered(number).unwrap();
            for resolution in [0.5, 1.0, 2.3] {
                let parameters = Parameters {
                    side,
                    size,
                    resolution,
                };
                for (name, mesh) in parts(&parameters) {
                    let volume = closed_volume(&mesh)
                        .unwrap_or_else(|fault| panic!("{name} {parameters:?}: {fault}"));
                    assert!(
                        volume > 5_000.0 && volume < 80_000.0,
                        "{name}: {volume} mm^3"
                    );
                }
            }
        }
    }
}

#[test]
fn surfaces_are_one_piece_without_a_hole_through() {
    for (name, mesh) in parts(&Parameters::default()) {
        // A closed surface of genus 0 has V - E + F = 2; a closed mesh of triangles has 2 E = 3 F.
        let (v, f) = (mesh.vertices.len() as i64, mesh.triangles.len() as i64);
        assert_eq!(v - 3 * f / 2 + f, 2, "{name}");
    }
}

#[test]
fn default_meshes_have_the_size_that_speeds_are_measured_on() {
    let [(_, femur), (_, tibia)] = parts(&Parameters::default());
    assert!(
        (11_500..=12_500).contains(&femur.triangles.len()),
        "{}",
        femur.triangles.len()
    );
    assert!(
        (6_000..=12_000).contains(&tibia.triangles.len()),
        "{}",
        tibia.triangles.len()
    );
}

#[test]
fn mediolateral_width_is_the_one_asked_for() {
    for width in [58.0, 70.0, 83.25] {
        let size = Size::from_width_mm(width).unwrap();
        for (name, mesh) in parts(&Parameters {
            size,
            ..Parameters::default()
        }) {
            let (low, high) = extent(&mesh, 2);
            assert!((f64::from(high - low) - width).abs() < 1e-4, "{name}");
            assert!((low + high).abs() < 1e-4, "{name} is not centred");
        }
    }
}

#[test]
fn right_is_the_left_mirrored_in_x() {
    let right = Parameters {
        side: Side::Right,
        ..Parameters::default()
    };
    for ((name, left), (_, right)) in parts(&Parameters::default()).into_iter().zip(parts(&right)) {
        for (l, r) in left.vertices.iter().zip(&right.vertices) {
            assert_eq!([-l[0], l[1], l[2]], *r, "{name}");
        }
        assert_ne!(
            left.triangles, right.triangles,
            "{name}: the winding was not turned"
        );
    }
}

#[test]
fn femur_is_not_mirror_symmetric_and_the_tray_nearly_is() {
    let [(_, femur), (_, tibia)] = parts(&Parameters::default());
    // Posterior reach of each half: the condyles' radii differ, the tray's lobes hardly.
    let reach = |mesh: &Triangles, medial: bool| {
        let half = mesh.vertices.iter().filter(|v| (v[2] > 0.0) == medial);
        half.map(|v| v[0]).fold(f32::INFINITY, f32::min)
    };
    let femur_gap = reach(&femur, false) - reach(&femur, true);
    let tibia_gap = reach(&tibia, false) - reach(&tibia, true);
    assert!(femur_gap > 0.8, "femur {femur_gap} mm");
    assert!((0.0..1.0).contains(&tibia_gap), "tibia {tibia_gap} mm");
    // The flange's peak is lateral.
    let peak = femur
        .vertices
        .iter()
        .max_by(|a, b| a[1].total_cmp(&b[1]))
        .unwrap();
    assert!(peak[2] < -2.0, "peak at z {} mm", peak[2]);
}

#[test]
fn axes_are_those_of_the_module_text() {
    let [(_, femur), (_, tibia)] = parts(&Parameters::default());
    // Left: flange in front (+x) and above the condyles' axis, stem down (-y), plate about y = 0.
    let (back, front) = extent(&femur, 0);
    assert!(
        front > 38.0 && back > -23.0 && back < -19.0,
        "{back} {front}"
    );
    let (down, up) = extent(&tibia, 1);
    assert!(down < -36.0 && (up - 2.9).abs() < 0.2, "{down} {up}");
}

#[test]
fn impossible_wishes_are_refused_in_words() {
    assert_eq!(Size::numbered(0), Err(ImplantError::Number(0)));
    assert_eq!(Size::numbered(9), Err(ImplantError::Number(9)));
    for width in [f64::NAN, 0.0, -70.0, 1e9, f64::INFINITY] {
        let error = Size::from_width_mm(width).unwrap_err();
        assert!(error.to_string().contains("30 to 150 mm"));
    }
    for resolution in [f64::NAN, 0.0, 100.0] {
        let wish = Parameters {
            resolution,
            ..Parameters::default()
        };
        assert!(femur(&wish).unwrap_err().to_string().contains("0.5 to 4"));
        assert!(tibia(&wish).is_err());
    }
}

#[test]
fn check_names_what_is_wrong() {
    let whole = tibia(&Parameters::default()).unwrap();
    let mut holed = whole.clone();
    holed.triangles.pop();
    assert!(matches!(closed_volume(&holed), Err(MeshFault::Edge(..))));
    let mut one_turned = whole.clone();
    one_turned.triangles[7].swap(0, 1);
    assert!(matches!(
        closed_volume(&one_turned),
        Err(MeshFault::Edge(..))
    ));
    let mut all_turned = whole.clone();
    all_turned.triangles.iter_mut().for_each(|t| t.swap(0, 1));
    assert!(matches!(
        closed_volume(&all_turned),
        Err(MeshFault::InsideOut(_))
    ));
    let mut flat = whole;
    let [a, b, _] = flat.triangles[7];
    flat.vertices[a as usize] = flat.vertices[b as usize];
    assert!(matches!(
        closed_volume(&flat),
        Err(MeshFault::Degenerate(..))
    ));
}

/// Sharp folds are allowed only where the design has edges; a folded-over grid would show as opposite neighbours.
#[test]
fn no_triangle_is_folded_back_on_its_neighbour() {
    for (name, mesh) in parts(&Parameters::default()) {
        let normal = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|v| mesh.vertices[v as usize].map(f64::from));
            let [u, w] = [sub(b, a), sub(c, a)];
            let n = cross(u, w);
            let length = dot(n, n).sqrt();
            n.map(|x| x / length)
        };
        let mut first: BTreeMap<(u32, u32), [f64; 3]> = BTreeMap::new();
        for t in &mesh.triangles {
            let n = normal(t);
            for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
                if let Some(other) = first.insert((a.min(b), a.max(b)), n) {
                    let cosine = dot(n, other);
                    assert!(cosine > -0.5, "{name}: folded by {cosine} at {a}, {b}");
                }
            }
        }
    }
}

fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

#[test]
fn stl_holds_every_triangle() {
    let mesh = femur(&Parameters::default()).unwrap();
    let mut bytes = Vec::new();
    stl::write(&mesh, &mut bytes).unwrap();
    assert_eq!(bytes.len(), 84 + 50 * mesh.triangles.len());
    assert!(!bytes.starts_with(b"solid"));
    let float = |at: usize| f32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
    for (index, triangle) in mesh.triangles.iter().enumerate() {
        for (corner, &vertex) in triangle.iter().enumerate() {
            let at = 84 + 50 * index + 12 + 12 * corner;
            let read = [float(at), float(at + 4), float(at + 8)];
            assert_eq!(read, mesh.vertices[vertex as usize]);
        }
    }
}

/// The same on every machine, and a change of shape is a change of this line: accuracy figures belong to these shapes.
#[test]
fn default_meshes_are_the_ones_that_were_measured() {
    let digests = parts(&Parameters::default()).map(|(_, mesh)| {
        let mut bytes = Vec::new();
        stl::write(&mesh, &mut bytes).unwrap();
        let digest = Sha256::digest(&bytes);
        digest[..8]
            .iter()
            .map(|byte| format!("{byte:02x}"))
            .collect::<String>()
    });
    assert_eq!(digests, ["01d832088fcb3a32", "f2072ded0b311913"]);
}
