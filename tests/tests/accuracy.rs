//! The source's accuracy protocol on the built-in implants, as a committed snapshot, and the
//! real study where it is present.

use std::fmt::Write as _;

use fluoropose_tests::{assert_snapshot, camera, femur, mesh, study, tibia};
use xtask::evaluate::{Row, evaluate};
use xtask::implant::Triangles;
use xtask::pipeline::build::ViewOptions;
use xtask::pipeline::disturb::DisturbanceOptions;
use xtask::pipeline::finder::Method;
use xtask::synthetic::{Accuracy, Protocol, measure};

const POSES: usize = 60;
const SEED: u64 = 7;

fn accuracy_of(model: &Triangles, method: Method) -> Accuracy {
    let protocol = Protocol {
        method,
        distance: 1084.0,
        poses: POSES,
        seed: SEED,
        disturbance: DisturbanceOptions::default(),
    };
    let views = ViewOptions::default();
    measure(mesh(model), camera(), &views, &protocol).expect("poses are found")
}

fn line(text: &mut String, name: &str, found: &Accuracy, goals: [f64; 4]) {
    let errors = [
        found.in_plane_deg,
        found.out_of_plane_deg,
        found.in_plane_mm,
        found.out_of_plane_mm,
    ];
    write!(text, "{name:<6} {:>5} {:>8}", found.poses, found.failures).expect("memory");
    for (error, goal) in errors.iter().zip(goals) {
        assert!(*error <= goal, "{name}: {errors:?} exceeds {goals:?}");
        write!(text, " {error:>12.4}").expect("memory");
    }
    text.push('\n');
}

/// Method library, no noise. The goals are bounds; the snapshot shows any change at all.
#[test]
fn known_poses_are_found_again() {
    let mut text =
        String::from("part   poses failures in-plane-deg out-of-plane  in-plane-mm         z-mm\n");
    line(
        &mut text,
        "femur",
        &accuracy_of(&femur(), Method::Library),
        [0.10, 0.10, 0.06, 1.5],
    );
    line(
        &mut text,
        "tibia",
        &accuracy_of(&tibia(), Method::Library),
        [0.20, 0.25, 0.10, 3.0],
    );
    assert_snapshot("accuracy-library.txt", &text);
}

/// Method refined, no noise, RMS of all poses: rotation (degrees), x and y, z (mm).
#[test]
fn refined_poses_are_those_that_were_drawn() {
    let mut text =
        String::from("part   poses geodesic-deg         x-mm         y-mm         z-mm\n");
    for (name, model, [geodesic, xy, z]) in [
        ("femur", femur(), [0.02, 0.01, 0.25]),
        ("tibia", tibia(), [0.04, 0.015, 0.45]),
    ] {
        let found = accuracy_of(&model, Method::Refined);
        let rms = found.rms;
        assert_eq!(found.failures, 0, "{name}");
        assert!(
            rms.geodesic_deg <= geodesic && rms.x_mm.max(rms.y_mm) <= xy && rms.z_mm <= z,
            "{name}: {rms:?}"
        );
        writeln!(
            text,
            "{name:<6} {:>5} {:>12.4} {:>12.4} {:>12.4} {:>12.4}",
            found.poses, rms.geodesic_deg, rms.x_mm, rms.y_mm, rms.z_mm
        )
        .expect("memory");
    }
    assert_snapshot("accuracy-refined.txt", &text);
}

fn find<'t>(rows: &'t [Row], component: &str, source: &str) -> &'t Row {
    rows.iter()
        .find(|row| row.component == component && row.source == source)
        .unwrap_or_else(|| panic!("no row for {component} {source}"))
}

/// Bounds: x and y (mm), z (mm), geodesic rotation (degrees), RMS.
fn assert_within(row: &Row, [xy, z, geodesic]: [f64; 3]) {
    let rms = &row.rms;
    assert!(
        rms.x_mm <= xy && rms.y_mm <= xy && rms.z_mm <= z && rms.geodesic_deg <= geodesic,
        "{} {}: {rms:?} exceeds x, y {xy} mm, z {z} mm, {geodesic} deg",
        row.component,
        row.source
    );
}

#[test]
fn the_real_study_stays_within_its_bounds() {
    let Some(study) = study("left8") else { return };
    let none = DisturbanceOptions::default();
    let table = evaluate(&study, Method::Library, &none, None).expect("the study is complete");
    assert_within(find(&table.rows, "femur", "labels"), [0.10, 3.0, 0.25]);
    assert_within(find(&table.rows, "femur", "cnn"), [0.35, 8.0, 0.9]);
    assert_eq!(find(&table.rows, "tibia", "labels").wrong_side, 0);
    let refined = evaluate(&study, Method::Refined, &none, None).expect("the study is complete");
    assert_within(find(&refined.rows, "femur", "labels"), [0.02, 0.25, 0.04]);
    assert_within(find(&refined.rows, "tibia", "labels"), [0.02, 0.45, 0.05]);
    assert_eq!(find(&refined.rows, "tibia", "labels").wrong_side, 0);
    // The other method's rows are in the same table, with the figures published for it.
    let peer = find(&table.rows, "femur", "nfd_labels");
    assert_eq!(peer.method, "peer");
    assert!((peer.rms.z_mm - 9.7).abs() < 0.05);
}
