//! Everybody finds the same: what the native program finds in outlines on built-in implants, for the npm module to find
//! it to the last bit (`tests/browser/parity.test.mjs`).
//!
//! `FLUOROPOSE_REGENERATE=1 cargo test -p fluoropose-tests parity` rewrites `snapshots/parity.json`.

mod image;

use std::fmt::Write as _;

use fluoropose::camera::calibration::Calibration;
use fluoropose::finder::choice::ChoiceContext;
use fluoropose::image::border::follow_border;
use fluoropose::image::contour::{Contour, Outline, Point};
use fluoropose::image::silhouette::Silhouette;
use fluoropose::mesh::OwnedModel;
use fluoropose::pose::{EulerPose, Pose};
use fluoropose::render::{Projected, render, scratch_needed};
use fluoropose_laboratory::files::{MaskBuffer, read_model};
use fluoropose_laboratory::finding::{Finder, Method, ViewOptions, build_library};
use fluoropose_phantom::implant::Triangles;
use fluoropose_phantom::stl;
use fluoropose_tests::{assert_snapshot, femur, tibia};
use fluoropose_tracing::simplify::{Simplify, simplify};
use fluoropose_tracing::{List, Vertex};
use sha2::{Digest, Sha256};

/// The demonstration's.
const CALIBRATION: &str = "JT_INTCALIB\n1200\n0\n0\n0.373\n";
const SIDE: usize = 1024;

/// An outline that is looked for with a model.
struct Case {
    name: &'static str,
    outline: Vec<Point>,
}

/// A model as it comes from its file, with the library of all directions.
struct Part {
    name: &'static str,
    model: OwnedModel,
    library: Vec<u8>,
}

fn calibration() -> Calibration {
    Calibration::parse(CALIBRATION).expect("a calibration")
}

fn part(name: &'static str, triangles: &Triangles) -> Part {
    let folder = std::env::temp_dir().join(format!("fluoropose-parity-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a temporary folder");
    let path = folder.join(format!("{name}.stl"));
    stl::write_file(triangles, &path).expect("the model can be written");
    let model = read_model(&path).expect("the model can be read");
    std::fs::remove_dir_all(&folder).expect("the folder can be taken away");
    let camera = calibration().camera(SIDE, SIDE).expect("a camera");
    let views = ViewOptions::default();
    let distance = views.distance_for(&calibration());
    let built = build_library(model.as_model(), camera, &views, distance).expect("a library");
    Part {
        name,
        model,
        library: built.bytes,
    }
}

/// The border of a model's silhouette with few points, all at whole pixels.
fn traced(part: &Part, pose: EulerPose) -> Vec<Point> {
    let camera = calibration().camera(SIDE, SIDE).expect("a camera");
    let model = part.model.as_model();
    let mut scratch = vec![Projected::default(); scratch_needed(&model)];
    let mut mask = MaskBuffer::new(SIDE, SIDE).expect("possible");
    mask.draw(|mask| render(&model, &camera, &Pose::from(pose), &mut scratch, mask))
        .expect("in front of the camera");
    let mut border = Box::<Contour<16_384>>::default();
    follow_border(&mask.mask(), border.as_mut()).expect("a silhouette");
    let line: Vec<Vertex> = border.iter().copied().map(Vertex::new).collect();
    let mut marks = vec![false; line.len()];
    let mut places = vec![Vertex::default(); line.len()];
    let mut few = List::new(&mut places);
    let settings = Simplify {
        closed: true,
        tolerance: 1.0,
        balanced: false,
    };
    simplify(&line, &settings, |_| false, &mut marks, &mut few).expect("a line");
    few.as_slice().iter().map(|vertex| vertex.at).collect()
}

fn pose(z_rot_deg: f64, x_rot_deg: f64, y_rot_deg: f64) -> EulerPose {
    EulerPose {
        x_mm: 6.0,
        y_mm: -9.0,
        z_mm: -1070.0,
        z_rot_deg,
        x_rot_deg,
        y_rot_deg,
    }
}

/// What is found for an outline, as JSON: poses in every digit, best first.
fn found(part: &Part, case: &Case) -> String {
    let camera = calibration().camera(SIDE, SIDE).expect("a camera");
    let outline = Outline::new(&case.outline, SIDE, SIDE).expect("simple");
    let mut mask = MaskBuffer::new(SIDE, SIDE).expect("possible");
    mask.draw(|mask| mask.fill_outline(&outline));
    let model = part.model.as_model();
    let finder = Finder::open(&part.library, model, camera, Method::Refined);
    let mask = mask.mask();
    let silhouette = Silhouette::from(&mask);
    let found = finder.and_then(|mut finder| finder.all(&silhouette.into()));
    let found = found.expect("candidates");
    let decision = found.decide(&ChoiceContext::default()).expect("a choice");
    let mut text = String::new();
    let points = case
        .outline
        .iter()
        .map(|p| format!("[{}, {}]", p.column, p.row));
    let _ = writeln!(text, "    {{\n      \"name\": \"{}\",", case.name);
    let _ = writeln!(text, "      \"model\": \"{}\",", part.name);
    let _ = writeln!(
        text,
        "      \"outline\": [{}],",
        points.collect::<Vec<_>>().join(", ")
    );
    let _ = writeln!(text, "      \"verdict\": \"{}\",", decision.verdict.word());
    let _ = writeln!(text, "      \"because\": \"{}\",", decision.verdict);
    let _ = writeln!(text, "      \"chosen\": {},", decision.choice.index);
    let poses = found
        .candidates
        .iter()
        .map(|candidate| format!("        {}", six(candidate.pose)));
    let _ = write!(
        text,
        "      \"candidates\": [\n{}\n      ]\n    }}",
        poses.collect::<Vec<_>>().join(",\n")
    );
    text
}

fn digest(part: &Part) -> String {
    let hex = Sha256::digest(&part.library)
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect::<String>();
    format!("    \"{}\": \"{hex}\"", part.name)
}

#[test]
fn what_the_native_program_finds() {
    let parts = [part("femur", &femur()), part("tibia", &tibia())];
    let [femur, tibia] = &parts;
    let case = |name, outline| Case { name, outline };
    let triangle = [(300.0, 300.0), (700.0, 300.0), (500.0, 640.0)];
    let triangle = triangle
        .map(|(column, row)| Point::new(column, row))
        .to_vec();
    let cases = [
        (
            femur,
            case("from the side", traced(femur, pose(20.0, 4.0, -7.0))),
        ),
        (
            femur,
            case(
                "from behind and above",
                traced(femur, pose(-70.0, 31.0, 117.0)),
            ),
        ),
        (
            tibia,
            case("from the side", traced(tibia, pose(10.0, 3.0, 5.0))),
        ),
        (
            tibia,
            case("another component", traced(femur, pose(20.0, 4.0, -7.0))),
        ),
        (tibia, case("a triangle", triangle)),
    ];
    let on_a_frame = case("on a frame", traced(femur, pose(20.0, 4.0, -7.0)));
    let cases: Vec<String> = cases.iter().map(|(part, case)| found(part, case)).collect();
    let text = format!(
        "{{\n  \"calibration\": {CALIBRATION:?},\n  \"side\": {SIDE},\n  \"libraries\": {{\n{}\n  }},\n  \"cases\": [\n{}\n  ],\n  \"image\": {}\n}}\n",
        parts.each_ref().map(digest).join(",\n"),
        cases.join(",\n"),
        image::found(femur, &on_a_frame)
    );
    assert_snapshot("parity.json", &text);
}

/// The six numbers of a pose, to the last digit.
fn six(pose: Pose) -> String {
    let EulerPose {
        x_mm,
        y_mm,
        z_mm,
        z_rot_deg,
        x_rot_deg,
        y_rot_deg,
    } = pose.into();
    format!("{:?}", [x_mm, y_mm, z_mm, z_rot_deg, x_rot_deg, y_rot_deg])
}
