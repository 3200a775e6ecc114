//! Golden masks: the rasteriser draws the same pixels on every machine.
//!
//! `FLUOROPOSE_REGENERATE=1 cargo test -p fluoropose-tests` rewrites them; look at them then.

use fluoropose::camera::Camera;
use fluoropose::image::contour::{Outline, Point};
use fluoropose::image::mask::Mask;
use fluoropose::pose::{EulerPose, Pose};
use fluoropose::render::{Projected, render, scratch_needed};
use fluoropose_laboratory::files::{MaskBuffer, read_mask};
use fluoropose_phantom::implant::Triangles;
use fluoropose_phantom::picture::write_mask;
use fluoropose_tests::{femur, home, mesh, regenerating, tibia};

const SIDE: usize = 256;

fn assert_golden(name: &str, mask: &Mask<'_>) {
    let path = home().join("golden").join(format!("{name}.png"));
    if regenerating() {
        write_mask(&path, mask).expect("the picture can be written");
    }
    let golden = read_mask(&path).expect("a golden mask");
    assert_eq!(golden.mask().unmatched(mask), Some(0), "{name} changed");
}

fn draw(model: &Triangles, pose: EulerPose) -> MaskBuffer {
    let camera = Camera::new(SIDE, SIDE, [2600.0, 2500.0], [130.0, 120.0]).expect("valid");
    let mesh = mesh(model);
    let mut scratch = vec![Projected::default(); scratch_needed(&mesh)];
    let mut buffer = MaskBuffer::new(SIDE, SIDE).expect("possible");
    buffer
        .draw(|mask| render(&mesh, &camera, &Pose::from(pose), &mut scratch, mask))
        .expect("in front of the camera");
    buffer
}

fn pose(z_rot_deg: f64, x_rot_deg: f64, y_rot_deg: f64) -> EulerPose {
    EulerPose {
        x_mm: 2.0,
        y_mm: -4.0,
        z_mm: -1080.0,
        z_rot_deg,
        x_rot_deg,
        y_rot_deg,
    }
}

#[test]
fn built_in_implants() {
    assert_golden("femur-side", &draw(&femur(), pose(20.0, 0.0, 0.0)).mask());
    assert_golden(
        "femur-turned",
        &draw(&femur(), pose(-70.0, 11.0, -17.0)).mask(),
    );
    assert_golden("tibia-side", &draw(&tibia(), pose(-84.0, 0.0, 0.0)).mask());
    assert_golden(
        "tibia-turned",
        &draw(&tibia(), pose(10.0, -9.0, 14.0)).mask(),
    );
}

#[test]
fn an_outline_with_sharp_corners() {
    let corners = [
        (20.25, 30.5),
        (240.0, 18.75),
        (128.0, 60.5),
        (250.5, 128.0),
        (90.125, 120.0),
        (200.0, 249.9),
        (15.0, 200.0),
    ];
    let points = corners.map(|(column, row)| Point::new(column, row));
    let outline = Outline::new(&points, SIDE, SIDE).expect("simple");
    let mut buffer = MaskBuffer::new(SIDE, SIDE).expect("possible");
    buffer.draw(|mask| mask.fill_outline(&outline));
    assert_golden("outline", &buffer.mask());
}
