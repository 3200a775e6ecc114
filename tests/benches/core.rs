//! Micro-benchmarks of the steps of the core, on the built-in femur in a frame of 1024 x 1024.
//!
//! `cargo bench --package fluoropose-tests`, or with the name of one behind `--`. Where time is too
//! noisy, the firmware prints how many instructions the same steps take (`cargo xtask test --firmware`).

use std::sync::LazyLock;

use divan::{Bencher, black_box};
use fluoropose::camera::Camera;
use fluoropose::canonical::{CanonicalSpec, canonicalise};
use fluoropose::image::mask::Word;
use fluoropose::image::silhouette::Silhouette;
use fluoropose::math::radians;
use fluoropose::mesh::Model;
use fluoropose::mesh::OwnedModel;
use fluoropose::pose::{EulerPose, Pose};
use fluoropose::refine::{
    CameraView, OutlineSample, RefineOptions, outline_samples, refine, uncertainty,
};
use fluoropose::render::{Projected, render, scratch_needed};
use fluoropose_laboratory::files::{MaskBuffer, owned};
use fluoropose_laboratory::finding::Refiner;
use fluoropose_phantom::implant::{self, Parameters};

fn main() {
    divan::main();
}

static SURFACE: LazyLock<OwnedModel> = LazyLock::new(|| {
    let model = implant::femur(&Parameters::default()).expect("the built-in femur is valid");
    owned(model).expect("the built-in femur has a surface")
});

fn mesh() -> Model<'static> {
    SURFACE.as_model()
}

fn camera(side: usize) -> Camera {
    let pitch = 0.373 * 1024.0 / side as f64;
    Camera::from_principal_distance(side, side, 1200.0, pitch, [0.0, 0.0]).expect("valid")
}

/// In the middle of the frame, turned out of its plane.
fn pose() -> Pose {
    turned(-11.7)
}

/// The same with a flat side of the femur edge-on, of which every triangle must be looked at.
fn pose_edge_on() -> Pose {
    turned(-8.7)
}

fn turned(y_rot_deg: f64) -> Pose {
    let turned = Pose::from(EulerPose {
        z_rot_deg: 20.0,
        x_rot_deg: 6.3,
        y_rot_deg,
        ..EulerPose::default()
    });
    let [x, y, z] = turned.transform(&mesh().bounds().centre);
    Pose {
        translation: [-x, -y, -z - 1080.0],
        ..turned
    }
}

/// As far off as the library leaves a pose.
fn start() -> Pose {
    let off = fluoropose::math::rotation_by(&[0.06, -0.06, 0.06].map(radians));
    let pose = pose();
    let [x, y, z] = pose.translation;
    Pose {
        rotation: fluoropose::math::multiply(&off, &pose.rotation),
        translation: [x + 0.03, y - 0.03, z + 0.5],
    }
}

fn drawn(side: usize) -> MaskBuffer {
    let mut scratch = vec![Projected::default(); scratch_needed(&mesh())];
    let mut drawn = MaskBuffer::new(side, side).expect("a frame");
    drawn
        .draw(|mask| render(&mesh(), &camera(side), &pose(), &mut scratch, mask))
        .expect("in front of the camera");
    drawn
}

#[divan::bench(args = [256, 1024])]
fn silhouette(bencher: Bencher<'_, '_>, side: usize) {
    draw_again(bencher, side, pose());
}

#[divan::bench(args = [256, 1024])]
fn silhouette_of_a_side_edge_on(bencher: Bencher<'_, '_>, side: usize) {
    draw_again(bencher, side, pose_edge_on());
}

fn draw_again(bencher: Bencher<'_, '_>, side: usize, pose: Pose) {
    let (mesh, camera) = (mesh(), camera(side));
    let mut scratch = vec![Projected::default(); scratch_needed(&mesh)];
    let mut drawn = MaskBuffer::new(side, side).expect("a frame");
    bencher.bench_local(|| {
        drawn.draw(|mask| render(&mesh, &camera, black_box(&pose), &mut scratch, mask))
    });
}

#[divan::bench]
fn canonical_form(bencher: Bencher<'_, '_>) {
    let (spec, drawn) = (CanonicalSpec::default(), drawn(1024));
    let mut words: Vec<Word> = vec![0; spec.words_needed()];
    bencher.bench_local(|| canonicalise(black_box(&drawn.mask()), &spec, 1.0, &mut words));
}

/// What each step of refinement draws and measures, but for the target.
#[divan::bench]
fn samples_of_the_outline(bencher: Bencher<'_, '_>) {
    let (mesh, camera) = (mesh(), camera(1024));
    let mut refiner = Refiner::new(mesh, RefineOptions::default());
    let pose = pose();
    bencher.bench_local(|| {
        let mut length = 0.0;
        let add = |sample: &OutlineSample| length += sample.length;
        outline_samples(
            &mesh,
            &camera,
            black_box(&pose),
            &mut refiner.memory(&camera),
            add,
        )?;
        Ok::<f64, fluoropose::refine::RefineError>(length)
    });
}

#[divan::bench]
fn refinement_from_a_library_pose(bencher: Bencher<'_, '_>) {
    let (mesh, camera, drawn) = (mesh(), camera(1024), drawn(1024));
    let mask = drawn.mask();
    let views = [CameraView::only(&camera, Silhouette::from(&mask))];
    let mut refiner = Refiner::new(mesh, RefineOptions::default());
    let start = start();
    let found = refine(
        &mesh,
        &views,
        &start,
        RefineOptions::default(),
        &mut refiner.memory(&camera),
    );
    println!("{found:?}");
    bencher.bench_local(|| {
        let options = RefineOptions::default();
        refine(
            &mesh,
            &views,
            black_box(&start),
            options,
            &mut refiner.memory(&camera),
        )
    });
}

#[divan::bench]
fn region_of_95_percent(bencher: Bencher<'_, '_>) {
    let (mesh, camera, drawn) = (mesh(), camera(1024), drawn(1024));
    let mask = drawn.mask();
    let views = [CameraView::only(&camera, Silhouette::from(&mask))];
    let mut refiner = Refiner::new(mesh, RefineOptions::default());
    let options = RefineOptions::default();
    let refined = refine(
        &mesh,
        &views,
        &start(),
        options,
        &mut refiner.memory(&camera),
    )
    .expect("near");
    bencher.bench_local(|| {
        uncertainty(
            &mesh,
            &views,
            black_box(&refined),
            &mut refiner.memory(&camera),
        )
    });
}
