//! A library and all working memory in static arrays whose lengths are known when the program is built, as on a
//! microcontroller. Nothing is allocated between `main` and the pose.
//!
//! `cargo run -p fluoropose --example library_in_static_memory`

use std::sync::Mutex;

use fluoropose::image::mask::{Word, words_needed};
use fluoropose::library::{HEADER_BYTES, RECORD_BYTES, ViewAxis, ViewScratch};
use fluoropose::locate::workspace_bytes_needed;
use fluoropose::pose::geodesic_deg;
use fluoropose::render::{Projected, render};
use fluoropose::search::kernels::Kernels;
use fluoropose::search::scores_needed;
use fluoropose::{
    Builder, Camera, CanonicalSpec, EulerPose, Library, MaskMut, Model, Pose, ViewGrid, Workspace,
    locate,
};

mod part;

const SIDE: usize = 256;
const SPEC: CanonicalSpec = CanonicalSpec::USUAL;
const VIEWS: usize = 5 * 5;
const CANONICAL_WORDS: usize = words_needed(SPEC.size(), SPEC.size());
/// A plain library: the header, then a record and one bit a pixel for each view.
const LIBRARY_BYTES: usize = HEADER_BYTES + VIEWS * (RECORD_BYTES + SPEC.size() * SPEC.size() / 8);

/// Everything that is written to.
struct Memory {
    library: [u8; LIBRARY_BYTES],
    projected: [Projected; 4096],
    view: [Word; words_needed(320, 320)],
    mask: [Word; words_needed(SIDE, SIDE)],
    canonical: [Word; CANONICAL_WORDS],
    rotated: [Word; CANONICAL_WORDS],
    scores: [u32; scores_needed(VIEWS)],
    bytes: [u8; workspace_bytes_needed(&SPEC)],
}

/// A microcontroller would keep its library in flash and the rest in a `static` of its own kind of cell.
static MEMORY: Mutex<Memory> = Mutex::new(Memory {
    library: [0; LIBRARY_BYTES],
    projected: [Projected::ZERO; 4096],
    view: [0; words_needed(320, 320)],
    mask: [0; words_needed(SIDE, SIDE)],
    canonical: [0; CANONICAL_WORDS],
    rotated: [0; CANONICAL_WORDS],
    scores: [0; scores_needed(VIEWS)],
    bytes: [0; workspace_bytes_needed(&SPEC)],
});

fn main() {
    let memory = &mut *MEMORY.lock().expect("the first to ask");
    let (vertices, triangles) = (part::vertices(), part::triangles());
    let model = Model::from_triangles(&vertices, &triangles).expect("a mesh");
    let camera =
        Camera::from_principal_distance(SIDE, SIDE, 1000.0, 0.8, [0.0, 0.0]).expect("a camera");

    let axis = ViewAxis {
        first: -8.0,
        step: 4.0,
        count: 5,
    };
    let builder =
        Builder::new(model, camera, SPEC, ViewGrid { x: axis, y: axis }, 1000.0).expect("a plan");
    let mut scratch = ViewScratch {
        projected: &mut memory.projected,
        render: &mut memory.view,
        canonical: &mut memory.canonical,
    };
    builder
        .build(&mut memory.library, &mut scratch)
        .expect("room for all views");
    let library = Library::open(&memory.library).expect("what was just written");

    let truth = Pose::from(EulerPose {
        x_mm: 3.0,
        y_mm: 5.0,
        z_mm: -1030.0,
        z_rot_deg: -20.0,
        x_rot_deg: 2.5,
        y_rot_deg: 1.5,
    });
    let mut mask = MaskMut::new(&mut memory.mask, SIDE, SIDE).expect("room for the frame");
    render(&model, &camera, &truth, &mut memory.projected, &mut mask)
        .expect("in front of the camera");

    let work = Workspace {
        canonical: &mut memory.canonical,
        rotated: &mut memory.rotated,
        scores: &mut memory.scores,
        bytes: &mut memory.bytes,
        kernels: Kernels::PORTABLE,
    };
    let found = locate::<4>(&mask.as_mask(), &camera, &library, work).expect("a silhouette");
    let best = found.poses.first().expect("a pose");
    let off = geodesic_deg(&best.pose.rotation, &truth.rotation);
    println!(
        "{} bytes of static memory; {off:.2} deg off",
        size_of::<Memory>()
    );
    assert!(off < 2.0, "{off} deg");
}
