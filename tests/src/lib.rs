//! Shared helpers of the tests that cross crates.

pub mod fuzz;

use std::io::Write as _;
use std::path::{Path, PathBuf};

use fluoropose::camera::Camera;
use fluoropose::mesh::Model;
use fluoropose::mesh::OwnedModel;
use fluoropose::pose::{EulerPose, Pose};
use fluoropose_laboratory::files::owned;
use fluoropose_phantom::implant::{self, Parameters, Triangles};

/// Set to 1 to rewrite golden masks and snapshots instead of comparing with them.
pub const REGENERATE: &str = "FLUOROPOSE_REGENERATE";

/// Whether expectations are to be rewritten.
pub fn regenerating() -> bool {
    std::env::var_os(REGENERATE).is_some_and(|value| value == "1")
}

/// The folder of this package.
pub fn home() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// A study that is not part of the project: in the folder that `FLUOROPOSE_STUDIES` names, or in
/// `../shared/studies` beside the project. `None` where it is absent: the test counts as skipped.
pub fn study(name: &str) -> Option<PathBuf> {
    let folder = std::env::var_os("FLUOROPOSE_STUDIES")
        .map_or_else(|| home().join("../../shared/studies"), PathBuf::from);
    let study = folder.join(name).join("study.toml");
    if study.is_file() {
        return Some(study);
    }
    skipped(&format!("the study {name} is not on this machine"));
    None
}

/// Names the file to which tests that check nothing write a line.
const SKIPPED: &str = "FLUOROPOSE_SKIPPED";

/// Says that the running test checks nothing, and why. The test runner knows only tests that pass or fail, so
/// `cargo xtask test` counts these lines.
fn skipped(why: &str) {
    let thread = std::thread::current();
    let line = format!("SKIPPED: {}: {why}\n", thread.name().unwrap_or("a test"));
    print!("{line}");
    let Some(file) = std::env::var_os(SKIPPED) else {
        return;
    };
    let file = std::fs::OpenOptions::new()
        .append(true)
        .create(true)
        .open(file);
    file.and_then(|mut file| file.write_all(line.as_bytes()))
        .expect("the file that counts skipped tests can be written");
}

/// Compares `text` with the committed file `snapshots/NAME`, or rewrites it.
///
/// # Panics
/// When they differ: the message shows both.
pub fn assert_snapshot(name: &str, text: &str) {
    let path = home().join("snapshots").join(name);
    if regenerating() {
        std::fs::write(&path, text).expect("the snapshot can be written");
        return;
    }
    let expected = std::fs::read_to_string(&path)
        .unwrap_or_else(|_| panic!("no snapshot {name}; make it with {REGENERATE}=1"));
    assert!(
        expected == text,
        "{name} changed; if it should have, run again with {REGENERATE}=1 and review the difference\n--- committed\n{expected}\n--- now\n{text}"
    );
}

/// The built-in femur, left, of the usual size.
pub fn femur() -> Triangles {
    implant::femur(&Parameters::default()).expect("the usual size is possible")
}

/// The built-in tibia, left, of the usual size.
pub fn tibia() -> Triangles {
    implant::tibia(&Parameters::default()).expect("the usual size is possible")
}

/// Femur and tibia with a third of the triangles, for tests in which models are drawn thousands of times.
pub fn coarse_parts() -> [Triangles; 2] {
    let parameters = Parameters {
        resolution: 0.5,
        ..Parameters::default()
    };
    [implant::femur(&parameters), implant::tibia(&parameters)].map(|part| part.expect("possible"))
}

/// A built-in implant with its edges, as it is drawn wherever poses are found.
pub fn surface(triangles: Triangles) -> OwnedModel {
    owned(triangles).expect("built-in implants are valid")
}

/// Where an implant is that is looked for: wholly in the frame of [`camera`], out of the views that are special.
pub const TRUTH: EulerPose = EulerPose {
    x_mm: 6.0,
    y_mm: -11.0,
    z_mm: -1070.0,
    z_rot_deg: 35.0,
    x_rot_deg: 4.0,
    y_rot_deg: -7.0,
};

/// A model with its file's axes turned by a rigid motion, mm.
///
/// # Panics
/// Never: it is as valid as before.
pub fn turned(model: &OwnedModel, by: &Pose) -> OwnedModel {
    let model = model.as_model();
    let vertices = model.vertices().iter();
    let vertices =
        vertices.flat_map(|vertex| by.transform(&vertex.map(f64::from)).map(|x| x as f32));
    let triangles = model.triangles().as_flattened().to_vec();
    OwnedModel::new(vertices.collect(), triangles).expect("as valid as before")
}

/// A mesh of the core over a built-in implant, without edges.
pub fn mesh(triangles: &Triangles) -> Model<'_> {
    Model::from_triangles(&triangles.vertices, &triangles.triangles)
        .expect("built-in implants are valid")
}

/// The camera of a usual single-plane study: 1200 mm, 0.373 mm a pixel, 1024 x 1024.
pub fn camera() -> Camera {
    Camera::from_principal_distance(1024, 1024, 1200.0, 0.373, [0.0, 0.0]).expect("valid")
}

/// Where the built-in femur stands in front of it, seen from a little beside.
pub const SEEN_FEMUR: EulerPose = EulerPose {
    x_mm: 10.0,
    y_mm: 5.0,
    z_mm: -1084.0,
    z_rot_deg: 20.0,
    x_rot_deg: 3.0,
    y_rot_deg: -4.0,
};

/// The README's example, compiled as a test.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
struct Readme;
