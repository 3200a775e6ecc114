use super::*;
use crate::joint::fake::{pose, tray};
use crate::joint::kinematics::joint_axes;
use crate::math::{apply, transpose};

fn check(plate: &Plate) {
    check_within(plate, 1e-4);
    assert!((plate.percent(-25.0)).abs() < 1e-3 && (plate.percent(25.0) - 100.0).abs() < 1e-3);
}

fn check_within(plate: &Plate, tolerance: f64) {
    assert!((plate.depth_mm - 50.0).abs() < tolerance, "{plate:?}");
    assert!((plate.width_mm - 76.0).abs() < tolerance, "{plate:?}");
}

#[test]
fn a_tray_worked_by_hand() {
    for side in [Side::Left, Side::Right] {
        let axes = joint_axes(&Pose::IDENTITY, side);
        let plate = Plate::of(&tray().mesh(), &axes, side).expect("a plate");
        check(&plate);
        // The rim is no plate: its upper side lies 2 mm higher.
        let top = plate.from_tibia.transform(&[1.0, 4.0, 2.0]);
        assert!(top[1].abs() < 1e-6, "{top:?}");
        let middle = plate.from_tibia.transform(&[0.0, 4.0, 0.0]);
        assert!(norm(&middle) < 1e-6, "{middle:?}");
    }
}

/// A file's own axes are taken where they lie near the anatomical ones, and the plate may be tilted in them.
#[test]
fn a_tilted_plate_is_level_in_its_own_axes() {
    let tilt = pose([3.0, -40.0, 7.0], [4.0, -3.0, 0.0]);
    let parts = tray().in_axes(&tilt);
    let plate = Plate::of(&parts.mesh(), &Pose::IDENTITY, Side::Left).expect("a plate");
    // Two tilts together turn the tray in its plane by 0.2 degrees, which the file's axes do not.
    check_within(&plate, 0.3);
    let normal = transpose(&plate.from_tibia.rotation).map(|row| row[1]);
    let wanted = apply(&tilt.rotation, &[0.0, 1.0, 0.0]);
    assert!(norm(&subtract(&normal, &wanted)) < 1e-6);
    let corner = plate
        .from_tibia
        .transform(&tilt.transform(&[25.0, 4.0, 38.0]));
    assert!(corner[1].abs() < 1e-4, "{corner:?}");
}

#[test]
fn winding_and_axes_do_not_matter_and_an_edge_has_no_plate() {
    let mut parts = tray();
    let axes = pose([0.0; 3], [90.0, 0.0, 90.0]);
    parts
        .triangles
        .iter_mut()
        .step_by(3)
        .for_each(|t| t.swap(0, 1));
    let turned = parts.in_axes(&axes);
    check(&Plate::of(&turned.mesh(), &axes, Side::Left).expect("a plate"));
    // One upright triangle faces nowhere near up.
    let wall = crate::joint::fake::Parts {
        vertices: std::vec![[0.0, 0.0, 0.0], [0.0, 9.0, 0.0], [0.0, 0.0, 9.0]],
        triangles: std::vec![[0, 1, 2]],
    };
    assert_eq!(Plate::of(&wall.mesh(), &Pose::IDENTITY, Side::Left), None);
}

#[test]
fn the_border_of_a_rectangle_is_a_rectangle() {
    let tray = tray();
    let plate = Plate::of(&tray.mesh(), &Pose::IDENTITY, Side::Left).expect("a plate");
    let mut outline = [[0.0; 2]; 90];
    plate.outline(&tray.mesh(), &Pose::IDENTITY, &mut outline);
    for (k, [anterior, medial]) in outline.into_iter().enumerate() {
        let turn = core::f64::consts::TAU * k as f64 / 90.0;
        let (sin, cos) = crate::math::sin_cos(turn);
        // A ray leaves 50 x 76 mm through the nearer of its sides.
        let far = (25.0 / cos.abs()).min(38.0 / sin.abs());
        assert!(
            (anterior - far * cos).abs() < 1e-5,
            "{k}: {anterior} {}",
            far * cos
        );
        assert!(
            (medial - far * sin).abs() < 1e-5,
            "{k}: {medial} {}",
            far * sin
        );
    }
}
