//! Planes of near-symmetry of the built-in implants and of a real pair.

use fluoropose::mesh::symmetry::{SymmetryPlane, symmetry_planes};
use fluoropose_laboratory::files::{Study, read_model};
use fluoropose_phantom::implant::{self, Parameters, Side, Size, Triangles};
use fluoropose_tests::{mesh, study};

/// Asserts that the planes are one, the mediolateral: its normal within `off_deg` of z.
fn assert_mediolateral(planes: &[SymmetryPlane], off_deg: f64, most_mm: f64) {
    let [plane] = planes else {
        panic!("not one plane: {planes:?}");
    };
    let off = plane.normal[2].clamp(-1.0, 1.0).acos().to_degrees();
    assert!(off < off_deg, "{off} degrees: {plane:?}");
    assert!(plane.deviation_mm < most_mm, "{plane:?}");
}

fn built_in(side: Side, size: usize, resolution: f64) -> (Triangles, Triangles) {
    let parameters = Parameters {
        side,
        size: Size::numbered(size).expect("a size"),
        resolution,
    };
    (
        implant::femur(&parameters).expect("possible"),
        implant::tibia(&parameters).expect("possible"),
    )
}

#[test]
fn built_in_implants_have_their_mediolateral_plane_alone() {
    for (side, size, resolution) in [
        (Side::Left, 5, 1.0),
        (Side::Right, 1, 1.0),
        (Side::Left, 8, 0.5),
        (Side::Right, 4, 2.0),
    ] {
        let (femur, tibia) = built_in(side, size, resolution);
        assert_mediolateral(&symmetry_planes(mesh(&femur).mesh()), 2.0, 2.0);
        assert_mediolateral(&symmetry_planes(mesh(&tibia).mesh()), 1.0, 0.15);
    }
}

#[test]
fn real_implants_have_their_mediolateral_plane_alone() {
    let Some(path) = study("left8") else { return };
    let study = Study::read(&path).expect("a study");
    for component in &study.components {
        let model = read_model(&component.model).expect("a model");
        let planes = symmetry_planes(model.as_model().mesh());
        println!("{}: {planes:?}", component.name);
        match component.name.as_str() {
            "tibia" => assert_mediolateral(&planes, 0.1, 0.01),
            _ => assert_mediolateral(&planes, 3.0, 2.0),
        }
    }
}
