//! First poses from a part of an outline, from scratch: behind occluders and cut by the frame's
//! border, on the built-in implants.

use fluoropose::camera::Camera;
use fluoropose::finder::rivals::worth_refining;
use fluoropose::image::silhouette::Silhouette;
use fluoropose::library::Library;
use fluoropose::locate::partial::{
    Hypothesis, OutlinePoint, PartialMemory, PixelSide, known_fraction, locate_partial,
    partial_needed,
};
use fluoropose::locate::rerank::Reranked;
use fluoropose::math::apply;
use fluoropose::mesh::Model;
use fluoropose::pose::{EulerPose, Pose, geodesic_deg};
use fluoropose::refine::{CameraView, RefineOptions};
use fluoropose::render::{Projected, render, scratch_needed};
use fluoropose_laboratory::files::MaskBuffer;
use fluoropose_laboratory::finding::{Refiner, ViewOptions, build_library};
use fluoropose_laboratory::noise::DisturbanceOptions;
use fluoropose_tests::{camera, femur, surface, tibia};

const DISTANCE: f64 = 1084.0;
/// Poses of each test and part.
const POSES: u64 = 8;
/// Poses that are kept of each silhouette.
const KEPT: usize = 6;

/// A pose within the protocol of `synthetic`, evenly spread: each number is a sequence of
/// multiples of an irrational number, modulo 1.
fn pose(number: u64, mesh: &Model<'_>) -> Pose {
    let draw = |irrational: f64, reach: f64| {
        reach * (2.0 * (irrational * (number + 1) as f64).fract() - 1.0)
    };
    let mut pose = Pose::from(EulerPose {
        x_mm: draw(2f64.sqrt(), 40.0),
        y_mm: draw(3f64.sqrt(), 40.0),
        z_mm: draw(5f64.sqrt(), 50.0) - DISTANCE,
        z_rot_deg: draw(7f64.sqrt(), 180.0),
        x_rot_deg: draw(11f64.sqrt(), 11.5),
        y_rot_deg: draw(13f64.sqrt(), 16.5),
    });
    let centre = apply(&pose.rotation, &mesh.bounds().centre);
    for (translation, centre) in pose.translation.iter_mut().zip(centre) {
        *translation -= centre;
    }
    pose
}

fn locate(
    silhouette: &Silhouette<'_>,
    camera: &Camera,
    library: &Library<'_>,
    mesh: &Model<'_>,
) -> Vec<Reranked> {
    let needs = partial_needed(library, camera, mesh);
    let memory = PartialMemory {
        words: &mut vec![0; needs.words],
        sides: &mut vec![PixelSide::default(); needs.sides],
        points: &mut vec![OutlinePoint::default(); needs.points],
        cells: &mut vec![0; needs.cells],
        numbers: &mut vec![0.0; needs.numbers],
        hypotheses: &mut vec![Hypothesis::default(); needs.hypotheses],
        projected: &mut vec![Projected::default(); needs.projected],
    };
    locate_partial::<KEPT>(silhouette, camera, library, mesh, memory)
        .expect("a pose is found")
        .to_vec()
}

/// Whether a refinement from `found` would lead to `pose`: within 8 degrees, 10 mm, and 60 mm
/// along the view.
fn is_start(found: &Reranked, pose: &Pose, mesh: &Model<'_>) -> bool {
    let centre = mesh.bounds().centre;
    let (a, b) = (
        found.located.pose.transform(&centre),
        pose.transform(&centre),
    );
    geodesic_deg(&found.located.pose.rotation, &pose.rotation) <= 8.0
        && (a[0] - b[0]).hypot(a[1] - b[1]) <= 10.0
        && (a[2] - b[2]).abs() <= 60.0
}

/// A start is among the poses, and the best refined pose is the one that was drawn.
fn assert_found(
    silhouette: Silhouette<'_>,
    camera: &Camera,
    library: &Library<'_>,
    mesh: &Model<'_>,
    pose: &Pose,
    what: &str,
) {
    assert!(known_fraction(&silhouette).is_partial(), "{what}");
    let found = locate(&silhouette, camera, library, mesh);
    let good = found.iter().any(|found| is_start(found, pose, mesh));
    assert!(good, "{what}: no start among {found:?}");
    let starts: Vec<Pose> = worth_refining(&found)
        .iter()
        .map(|found| found.located.pose)
        .collect();
    let mut refiner = Refiner::new(*mesh, RefineOptions::default());
    let refined = refiner
        .refine(&[CameraView::only(camera, silhouette)], &starts)
        .expect("a start is near");
    let off = |rotation| geodesic_deg(rotation, &pose.rotation);
    let errors: Vec<(f64, f64)> = refined
        .iter()
        .map(|answer| (off(&answer.refined.pose.rotation), answer.refined.loss))
        .collect();
    assert!(
        errors[0].0 <= 1.0,
        "{what}: degrees off and loss of the refined poses, best first: {errors:?}, from starts that are {:?} degrees off",
        starts
            .iter()
            .map(|start| off(&start.rotation))
            .collect::<Vec<_>>()
    );
}

/// Calls `check` with a part's name, mesh and library.
fn for_parts(check: impl Fn(&str, &Model<'_>, &Library<'_>)) {
    let parts = [("femur", surface(femur())), ("tibia", surface(tibia()))];
    for (name, model) in &parts {
        let mesh = model.as_model();
        let built = build_library(mesh, camera(), &ViewOptions::window([0.0, 0.0]), DISTANCE);
        let bytes = built.expect("renders").bytes;
        check(name, &mesh, &Library::open(&bytes).expect("valid"));
    }
}

fn drawn(mesh: &Model<'_>, camera: &Camera, pose: &Pose) -> MaskBuffer {
    let mut mask = MaskBuffer::new(camera.width(), camera.height()).expect("possible");
    let mut scratch = vec![Projected::default(); scratch_needed(mesh)];
    mask.draw(|mask| render(mesh, camera, pose, &mut scratch, mask))
        .expect("in front");
    mask
}

#[test]
fn an_occluded_implant_is_found_from_scratch() {
    for_parts(|name, mesh, library| {
        let camera = camera();
        for number in 0..POSES {
            let pose = pose(number, mesh);
            let mask = drawn(mesh, &camera, &pose);
            let options = DisturbanceOptions {
                occlude: 0.2 + 0.1 * number as f64 / (POSES - 1) as f64,
                ..DisturbanceOptions::default()
            };
            let disturbed = options.disturb(&mask.mask(), None, number);
            let see = |silhouette: Silhouette<'_>| {
                let what = format!("{name} {number}");
                assert_found(silhouette, &camera, library, mesh, &pose, &what);
                Ok(())
            };
            disturbed.and_then(|seen| seen.see(see)).expect("possible");
        }
    });
}

/// The part of the outline that the frame's border hides.
const HIDDEN: std::ops::RangeInclusive<f64> = 0.2..=0.3;

/// The camera moved along the detector so that a border of its frame cuts off the part `cut` of the
/// width or height of what `mask` shows.
fn cutting(camera: &Camera, mask: &MaskBuffer, border: u64, cut: f64) -> Camera {
    let (columns, rows) = mask.mask().bounds();
    let [width, height] = [camera.width(), camera.height()].map(|side| side as f64);
    let start = |range: &std::ops::Range<usize>| range.start as f64 + cut * range.len() as f64;
    let end = |range: &std::ops::Range<usize>| range.end as f64 - cut * range.len() as f64;
    let [cx, cy] = camera.principal_point();
    let centre = match border % 4 {
        0 => [cx - start(&columns), cy],
        1 => [cx - end(&columns) + width, cy],
        2 => [cx, cy - start(&rows)],
        _ => [cx, cy - end(&rows) + height],
    };
    Camera::new(camera.width(), camera.height(), camera.focal(), centre).expect("possible")
}

/// The first camera and mask of which the border hides as much of the outline as is wanted; `None`
/// where it hides too little or, by the next row or column, too much.
fn cut(mesh: &Model<'_>, pose: &Pose, border: u64) -> Option<(Camera, MaskBuffer)> {
    let whole = drawn(mesh, &camera(), pose);
    let sides = known_fraction(&Silhouette::from(&whole.mask())).sides as f64;
    (1..40).find_map(|step| {
        let camera = cutting(&camera(), &whole, border, 0.02 * f64::from(step));
        let mask = drawn(mesh, &camera, pose);
        let known = known_fraction(&Silhouette::from(&mask.mask())).known as f64;
        HIDDEN
            .contains(&(1.0 - known / sides))
            .then_some((camera, mask))
    })
}

#[test]
fn an_implant_cut_by_the_frames_border_is_found_from_scratch() {
    for_parts(|name, mesh, library| {
        let mut looked_at = 0;
        for number in 0..POSES {
            let pose = pose(100 + number, mesh);
            let Some((camera, mask)) = cut(mesh, &pose, number) else {
                continue;
            };
            let (mask, what) = (mask.mask(), format!("{name} {number}"));
            assert_found(
                Silhouette::from(&mask),
                &camera,
                library,
                mesh,
                &pose,
                &what,
            );
            looked_at += 1;
        }
        assert!(
            looked_at > POSES * 3 / 4,
            "{looked_at} {name} poses are cut"
        );
    });
}
