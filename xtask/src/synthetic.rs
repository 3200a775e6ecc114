//! Verb `synthetic`: the accuracy protocol of Walker et al. 1996 on random known poses.

use std::path::PathBuf;

use anyhow::{Context, Result};
use fluoropose::camera::Camera;
use fluoropose::library::{Grid, GridAxis};
use fluoropose::mesh::Mesh;
use fluoropose::pose::{EulerPose, Pose};
use fluoropose::raster::{Projected, render, scratch_needed};
use fluoropose::silhouette::Silhouette;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde::Serialize;

use crate::pipeline::accuracy::{Errors, mean_absolute, rms};
use crate::pipeline::build::{Pair, ViewOptions, build_library, progress};
use crate::pipeline::files::{MaskBuffer, mesh_of, read_calibration, read_model, write_json};
use crate::pipeline::finder::{Finder, Method};

/// Options of `synthetic`.
#[derive(clap::Args)]
#[command(
    after_help = "Draws N random poses inside the library's range (x and y within 40 mm of the axis, z within 50 mm of the library's \
distance, z_rot any), renders each as a mask, finds it again and prints mean absolute errors. Poses wrong by more than 4 degrees are \
failures: they are counted and left out of the means, as in the source.\n\n\
Example:\n  cargo xtask synthetic --model femur.stl --calibration calibration.txt --poses 150 --seed 1"
)]
pub struct Args {
    /// The implant's model: STL (binary or ASCII), OBJ or PLY, in mm
    #[arg(long)]
    model: PathBuf,
    /// Calibration: JT_INTCALIB or a camera matrix (MayaCam 2.0)
    #[arg(long)]
    calibration: PathBuf,
    /// Width and height of the frames, pixels
    #[arg(long, value_name = "W,H", default_value = "1024,1024")]
    frame: Pair,
    /// Number of poses
    #[arg(long, default_value_t = 150)]
    poses: usize,
    /// Seed of the random poses
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// How poses are found
    #[arg(long, value_enum, default_value_t)]
    method: Method,
    #[command(flatten)]
    views: ViewOptions,
    /// Write the table as JSON
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

/// Rotation errors above this are failures, degrees.
const FAILURE_DEG: f64 = 4.0;
/// Half range of x and y, mm.
const LATERAL_MM: f64 = 40.0;
/// Half range of z about the library's distance, mm.
const DEPTH_MM: f64 = 50.0;
/// Out-of-plane rotations keep this far from the library's border, degrees: an object 40 mm off
/// the axis in x and y is seen from a direction that differs by up to 3 degrees.
const MARGIN_DEG: f64 = 3.5;

/// What is drawn and how it is found again.
#[derive(Clone, Copy, Debug)]
pub struct Protocol {
    /// How poses are found.
    pub method: Method,
    /// Middle of the range of z, and distance of the library's views, mm.
    pub distance: f64,
    /// Number of poses.
    pub poses: usize,
    /// Seed of the random poses.
    pub seed: u64,
}

/// The means of the protocol.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Accuracy {
    /// Number of poses drawn.
    pub poses: usize,
    /// Poses wrong by more than 4 degrees, not in the means.
    pub failures: usize,
    /// Mean absolute error of z_rot, degrees.
    pub in_plane_deg: f64,
    /// Mean absolute error of x_rot and y_rot, degrees.
    pub out_of_plane_deg: f64,
    /// Mean absolute error of x and y, mm.
    pub in_plane_mm: f64,
    /// Mean absolute error of z, mm.
    pub out_of_plane_mm: f64,
    /// Root mean square errors of all poses, failures among them.
    pub rms: Errors,
}

/// Runs the verb.
///
/// # Errors
/// For files that cannot be read and views that cannot be rendered.
pub fn run(args: Args) -> Result<()> {
    let model = read_model(&args.model)?;
    let calibration = read_calibration(&args.calibration)?;
    let Pair([width, height]) = args.frame;
    let camera = match calibration {
        fluoropose::calibration::Calibration::CameraMatrix { size, .. } => {
            calibration.camera(size.0, size.1)?
        }
        _ => calibration.camera(width as usize, height as usize)?,
    };
    let distance = args.views.distance_for(&calibration);
    let mesh = mesh_of(&model)?;
    let protocol = Protocol {
        method: args.method,
        distance,
        poses: args.poses,
        seed: args.seed,
    };
    let accuracy = measure(mesh, camera, &args.views, &protocol)?;
    println!(
        "{} poses, seed {}, {} triangles, library of {} views at {distance} mm, method {}",
        args.poses,
        args.seed,
        model.triangles.len(),
        args.views.grid().views(),
        args.method.word(),
    );
    println!("in-plane rotation      {:.3} deg", accuracy.in_plane_deg);
    println!(
        "out-of-plane rotation  {:.3} deg",
        accuracy.out_of_plane_deg
    );
    println!("in-plane translation   {:.3} mm", accuracy.in_plane_mm);
    println!("out-of-plane           {:.3} mm", accuracy.out_of_plane_mm);
    println!("failures (over {FAILURE_DEG} deg) {}", accuracy.failures);
    let Errors {
        x_mm,
        y_mm,
        z_mm,
        geodesic_deg,
        ..
    } = accuracy.rms;
    println!(
        "RMS of all poses: x {x_mm:.4}, y {y_mm:.4}, z {z_mm:.3} mm, rotation {geodesic_deg:.4} deg"
    );
    write_json(args.json.as_deref(), &accuracy)
}

/// Builds a library of `mesh` and finds random poses again.
///
/// # Errors
/// Those of the core's builder, rasteriser and locator.
pub fn measure(
    mesh: Mesh<'_>,
    camera: Camera,
    views: &ViewOptions,
    protocol: &Protocol,
) -> Result<Accuracy> {
    let distance = protocol.distance;
    let built = build_library(mesh, camera, views, distance)?;
    let mut finder = Finder::open(&built.bytes, mesh, camera, protocol.method)?;
    let mut random = ChaCha8Rng::seed_from_u64(protocol.seed);
    let mut buffer = MaskBuffer::new(camera.width(), camera.height())?;
    let mut scratch = vec![Projected::default(); scratch_needed(&mesh)];
    let bar = progress(protocol.poses, "poses");
    let mut errors = Vec::with_capacity(protocol.poses);
    for _ in 0..protocol.poses {
        let reference = random_pose(&mut random, &views.grid(), &mesh, distance);
        buffer.draw(|mask| render(&mesh, &camera, &reference, &mut scratch, mask))?;
        let found = finder
            .best(&Silhouette::from(&buffer.mask()).into())
            .with_context(|| format!("at {:?}", EulerPose::from(reference)))?;
        errors.push(Errors::of(&found.pose, &reference));
        bar.inc(1);
    }
    bar.finish_and_clear();
    Ok(means(&errors))
}

/// A pose inside the library's range, with the middle of the model's box near the axis.
fn random_pose(random: &mut ChaCha8Rng, grid: &Grid, mesh: &Mesh<'_>, distance: f64) -> Pose {
    let inside = |axis: &GridAxis| {
        let last = axis.at(axis.count as f64 - 1.0);
        let middle = (axis.first + last) / 2.0;
        let reach = ((last - axis.first) / 2.0 - MARGIN_DEG).max(0.0);
        (middle, reach)
    };
    let mut draw = |(middle, reach): (f64, f64)| middle + reach * random.random_range(-1.0..=1.0);
    let mut pose = Pose::from(EulerPose {
        x_mm: draw((0.0, LATERAL_MM)),
        y_mm: draw((0.0, LATERAL_MM)),
        z_mm: draw((-distance, DEPTH_MM)),
        z_rot_deg: draw((0.0, 180.0)),
        x_rot_deg: draw(inside(&grid.x)),
        y_rot_deg: draw(inside(&grid.y)),
    });
    let centre = fluoropose::math::apply(&pose.rotation, &mesh.bounds().centre);
    for (translation, centre) in pose.translation.iter_mut().zip(centre) {
        *translation -= centre;
    }
    pose
}

fn means(errors: &[Errors]) -> Accuracy {
    let kept: Vec<Errors> = errors
        .iter()
        .copied()
        .filter(|e| e.geodesic_deg <= FAILURE_DEG)
        .collect();
    let mean = Errors::summarise(&kept, mean_absolute);
    Accuracy {
        poses: errors.len(),
        failures: errors.len() - kept.len(),
        in_plane_deg: mean.z_rot_deg,
        out_of_plane_deg: (mean.x_rot_deg + mean.y_rot_deg) / 2.0,
        in_plane_mm: (mean.x_mm + mean.y_mm) / 2.0,
        out_of_plane_mm: mean.z_mm,
        rms: Errors::summarise(errors, rms),
    }
}
