//! From a traced outline to a refined pose: a library is built, the finder looks for all poses that explain the outline,
//! one of them is chosen and judged. `cargo run -p fluoropose --features alloc --example outline_to_pose`

use std::error::Error;

use fluoropose::finder::choice::ChoiceContext;
use fluoropose::finder::{Component, FinderBuffers, Goal, Verdict, find};
use fluoropose::image::border::follow_border;
use fluoropose::image::mask::words_needed;
use fluoropose::library::{ViewAxis, ViewScratch};
use fluoropose::mesh::symmetry::symmetry_planes;
use fluoropose::pose::geodesic_deg;
use fluoropose::render::{Projected, render, scratch_needed};
use fluoropose::search::kernels::Kernels;
use fluoropose::{
    Builder, Camera, CanonicalSpec, Contour, EulerPose, Library, MaskMut, Model, Outline,
    OwnedModel, Pose, RefineOptions, Silhouette, ViewGrid,
};

mod part;

const SIDE: usize = 512;

fn main() -> Result<(), Box<dyn Error>> {
    // A model comes from a CAD file, a camera from a calibration file; here both are made up.
    let vertices = part::vertices().concat();
    let owned = OwnedModel::new(vertices, part::triangles().concat())?;
    let model = owned.as_model();
    let camera = Camera::from_principal_distance(SIDE, SIDE, 1000.0, 0.4, [0.0, 0.0])?;
    let truth = Pose::from(EulerPose {
        x_mm: 6.0,
        y_mm: -9.0,
        z_mm: -940.0,
        z_rot_deg: 12.0,
        x_rot_deg: 3.3,
        y_rot_deg: -5.6,
    });

    // In place of a person's trace: the border of the silhouette at the true pose.
    let outline = traced(&model, &camera, &truth)?;
    let mut words = vec![0; words_needed(SIDE, SIDE)];
    let mut mask = MaskMut::new(&mut words, SIDE, SIDE)?;
    mask.fill_outline(&Outline::new(&outline, SIDE, SIDE)?);
    let mask = mask.into_mask();

    // All poses that explain the silhouette: those of the library's views that differ least from it, refined until the
    // model's outline lies on the mask's.
    let bytes = library(model, camera)?;
    let library = Library::open(&bytes)?;
    let planes = symmetry_planes(model.mesh());
    let component = Component {
        library: &library,
        model: &model,
        planes: &planes,
    };
    let mut buffers = FinderBuffers::default();
    let mut memory = buffers.borrow(&component, &camera, Kernels::PORTABLE);
    let silhouette = Silhouette::from(&mask);
    let options = RefineOptions::default();
    let found = find(
        &component,
        &camera,
        &silhouette,
        Goal::Outline,
        options,
        &mut memory,
    )?;

    // The one that explains it best, why it was chosen, and how far it is to be trusted.
    let decision = found
        .decide(&ChoiceContext::default())
        .ok_or("nothing was found")?;
    let best = &found.candidates[decision.choice.index];
    let covariance = best
        .covariance
        .ok_or("the outline does not determine the pose")?;
    println!("{:.3?}", EulerPose::from(best.pose));
    println!(
        "standard deviations: {:.3?}",
        covariance.deviations(&best.pose, &model.centre())
    );
    println!("chosen by {}", decision.choice);
    println!("{}: {}", decision.verdict.word(), decision.verdict);
    assert_eq!(decision.verdict, Verdict::Good);
    assert!(geodesic_deg(&best.pose.rotation, &truth.rotation) < 0.1);
    let off = [0, 1, 2].map(|k| (best.pose.translation[k] - truth.translation[k]).abs());
    assert!(off[0] < 0.05 && off[1] < 0.05 && off[2] < 1.0, "{off:?} mm");
    Ok(())
}

/// A library of 7 x 7 views, 3 degrees apart.
fn library(model: Model<'_>, camera: Camera) -> Result<Vec<u8>, Box<dyn Error>> {
    let axis = ViewAxis {
        first: -9.0,
        step: 3.0,
        count: 7,
    };
    let canonical = CanonicalSpec::USUAL;
    let builder = Builder::new(
        model,
        camera,
        canonical,
        ViewGrid { x: axis, y: axis },
        1000.0,
    )?;
    let mut bytes = vec![0; builder.bytes_needed()];
    builder.build(
        &mut bytes,
        &mut ViewScratch {
            projected: &mut vec![Projected::default(); builder.projected_needed()],
            render: &mut vec![0; builder.render_words_needed()],
            canonical: &mut vec![0; canonical.words_needed()],
        },
    )?;
    Ok(bytes)
}

/// The outline that a careful hand would trace.
fn traced(
    model: &Model<'_>,
    camera: &Camera,
    pose: &Pose,
) -> Result<Contour<4096>, Box<dyn Error>> {
    let mut words = vec![0; words_needed(SIDE, SIDE)];
    let mut mask = MaskMut::new(&mut words, SIDE, SIDE)?;
    let mut scratch = vec![Projected::default(); scratch_needed(model)];
    render(model, camera, pose, &mut scratch, &mut mask)?;
    let mut outline = Contour::new();
    follow_border(&mask.as_mask(), &mut outline)?;
    Ok(outline)
}
