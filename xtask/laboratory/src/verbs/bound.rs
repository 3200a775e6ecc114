//! Verb `bound`: how well a pose can be known from a noisy outline.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use anyhow::{Context, Result, bail, ensure};
use fluoropose::camera::Camera;
use fluoropose::pose::{EulerPose, Pose};
use serde::Serialize;

use crate::files::{
    MaskBuffer, camera_for, read_calibration, read_mask, read_model, read_poses, size_taken,
    write_json,
};

use crate::measure::bound::{Limit, Outlines, PoseLimits};

use crate::noise::{DisturbanceOptions, Noise};

use crate::options::Pair;

/// Options of `bound`.
#[derive(clap::Args)]
#[command(
    after_help = "For each pose the standard deviation that no unbiased estimator undercuts (the bound of Cramer and Rao), and the one \
that plain least squares reaches, which weighs all of the outline alike: x, y, z of the model's origin (mm) and the angle of the rotation \
between estimate and truth (degrees, root mean square). The outline is that of the model drawn at the pose.\n\n\
Noise: rounding to pixels, 1/12 square pixel for each pixel of outline, white; with --jitter S also a hand's, displacement along the \
normal with the covariance S^2 exp(-d^2 / (2 l^2)) of the way d along the outline, l given by --correlation. White noise has one limit. \
Rounding alone is not Gaussian: an estimator that makes use of every pixel of a mask without other noise can come nearer than its \
limit.\n\n\
Example:\n  cargo xtask bound --model femur.stl --calibration calibration.txt --pose 0,0,-1000,20,5,-8 --jitter 1"
)]
pub struct Args {
    /// The implant's model: STL (binary or ASCII), OBJ or PLY, in mm
    #[arg(long)]
    model: PathBuf,
    /// Calibration: JT_INTCALIB or a camera matrix (MayaCam 2.0, OpenCV, ROS, MATLAB)
    #[arg(long)]
    calibration: PathBuf,
    /// Width and height of the frames, pixels; 1024,1024 if not given, but a camera matrix has its own
    #[arg(long, value_name = "W,H")]
    frame: Option<Pair>,
    /// A pose: x, y, z (mm), then rotation about z, x, y (degrees)
    #[arg(
        long,
        value_name = "X,Y,Z,ZR,XR,YR",
        allow_hyphen_values = true,
        required_unless_present = "poses"
    )]
    pose: Option<SixNumbers>,
    /// Poses of a .jts file instead, frames without one left out, and their root mean square
    #[arg(long, value_name = "FILE", conflicts_with = "pose")]
    poses: Option<PathBuf>,
    /// Standard deviation of a hand's jitter, pixels
    #[arg(
        long,
        value_name = "PX",
        default_value_t = 0.0,
        allow_negative_numbers = true
    )]
    jitter: f64,
    /// Correlation length of the jitter along the outline, pixels
    #[arg(
        long,
        value_name = "PX",
        default_value_t = 10.0,
        allow_negative_numbers = true
    )]
    correlation: f64,
    /// Mask image of pixels of which nothing is known
    #[arg(long, value_name = "FILE")]
    unknown: Option<PathBuf>,
    /// Write the table as JSON
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

/// The numbers of a pose.
#[derive(Clone, Copy, Debug)]
struct SixNumbers(EulerPose);

impl FromStr for SixNumbers {
    type Err = anyhow::Error;

    fn from_str(text: &str) -> Result<Self> {
        let numbers: Result<Vec<f64>, _> = text.split(',').map(|n| n.trim().parse()).collect();
        let wanted = || format!("'{text}' is not six numbers: x,y,z,z_rot,x_rot,y_rot");
        match <[f64; 6]>::try_from(numbers.with_context(wanted)?) {
            Ok(numbers) => Ok(Self(EulerPose::from(numbers))),
            _ => bail!(wanted()),
        }
    }
}

/// The limits of all poses.
#[derive(Serialize)]
struct Table {
    noise: Noise,
    poses: Vec<PoseLimits>,
    rms: PoseLimits,
}

/// A pose as `--pose` takes it.
fn words(pose: &Pose) -> String {
    let numbers: [f64; 6] = EulerPose::from(*pose).into();
    numbers.map(|number| number.to_string()).join(",")
}

/// Runs the verb.
///
/// # Errors
/// For files that cannot be read, and poses at which the model cannot be drawn.
pub fn run(args: Args) -> Result<()> {
    let options = DisturbanceOptions {
        jitter: args.jitter,
        correlation: args.correlation,
        ..DisturbanceOptions::default()
    };
    options.check()?;
    let model = read_model(&args.model)?;
    let calibration = read_calibration(&args.calibration)?;
    let camera = camera_for(&calibration, args.frame)?;
    if let Some(taken) = size_taken(&calibration, (camera.width(), camera.height())) {
        eprintln!("{taken}");
    }
    let poses: Vec<Pose> = match (&args.poses, args.pose) {
        (Some(path), _) => known_poses(path)?,
        (None, Some(SixNumbers(pose))) => vec![Pose::from(pose)],
        (None, None) => bail!("neither --pose nor --poses was given"),
    };
    let unknown = args.unknown.as_deref();
    let unknown = unknown.map(|path| unknown_pixels(path, &camera));
    let unknown = unknown.transpose()?;
    let noise = Noise {
        jitter_px: args.jitter,
        correlation_px: args.correlation,
        ..Noise::ROUNDING
    };
    let mut outlines = Outlines::new(model.as_model(), camera);
    let limits: Result<Vec<PoseLimits>> = poses
        .iter()
        .map(|pose| {
            let unknown = unknown.as_ref().map(|unknown| unknown.mask());
            outlines
                .pose_limits(pose, &noise, unknown.as_ref())
                .with_context(|| format!("at the pose {}", words(pose)))
        })
        .collect();
    let limits = limits?;
    let table = Table {
        noise,
        rms: PoseLimits::rms(&limits),
        poses: limits,
    };
    print(&table);
    write_json(args.json.as_deref(), &table)
}

/// A mask of what is not known of the camera's frames.
///
/// # Errors
/// For a file that cannot be read, and a mask of another size.
fn unknown_pixels(path: &Path, camera: &Camera) -> Result<MaskBuffer> {
    let mask = read_mask(path)?;
    let [own, frame] = [
        (mask.mask().width(), mask.mask().height()),
        (camera.width(), camera.height()),
    ];
    ensure!(
        own == frame,
        "{} is {} x {} pixels and the frame {} x {}: a mask is as large as its frame",
        path.display(),
        own.0,
        own.1,
        frame.0,
        frame.1
    );
    Ok(mask)
}

/// The poses of a file, without frames that have none.
///
/// # Errors
/// For a file of no pose: nothing would be printed below the heading.
fn known_poses(path: &Path) -> Result<Vec<Pose>> {
    let poses: Vec<Pose> = read_poses(path)?.into_iter().flatten().collect();
    ensure!(!poses.is_empty(), "{}: no frame has a pose", path.display());
    Ok(poses)
}

fn print(table: &Table) {
    println!(
        "{:<6} {:<15} {:>9} {:>9} {:>9} {:>12}",
        "pose", "limit", "x mm", "y mm", "z mm", "rotation deg"
    );
    let line = |name: &str, what: &str, limit: &Limit| {
        println!(
            "{name:<6} {what:<15} {:9.4} {:9.4} {:9.3} {:12.4}",
            limit.x_mm, limit.y_mm, limit.z_mm, limit.geodesic_deg
        );
    };
    let both = |name: &str, limits: &PoseLimits| {
        line(name, "bound", &limits.bound);
        if table.noise.jitter_px > 0.0 {
            line("", "least squares", &limits.least_squares);
        }
    };
    for (index, limits) in table.poses.iter().enumerate() {
        both(&(index + 1).to_string(), limits);
    }
    if table.poses.len() > 1 {
        both("RMS", &table.rms);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mask_of_unknown_pixels_is_as_large_as_the_frame() {
        let file =
            std::env::temp_dir().join(format!("fluoropose-hidden-{}.png", std::process::id()));
        fluoropose_phantom::picture::write_grey(&file, (20, 10), &[255; 200]).expect("a file");
        let read = |width, height| {
            let camera = Camera::new(width, height, [1e3; 2], [5.0; 2]).expect("possible");
            unknown_pixels(&file, &camera).map(drop)
        };
        read(20, 10).expect("as large");
        let told = read(20, 12).expect_err("another size").to_string();
        std::fs::remove_file(&file).expect("it was there");
        assert!(
            told.contains("20 x 10 pixels and the frame 20 x 12"),
            "{told}"
        );
    }

    #[test]
    fn a_file_without_a_pose_has_no_bound() {
        let file =
            std::env::temp_dir().join(format!("fluoropose-bound-{}.jts", std::process::id()));
        let none = "NaN,NaN,NaN,NaN,NaN,NaN\n";
        let read = |rows: &str| {
            std::fs::write(&file, format!("JT_EULER_312\n{rows}")).expect("a file");
            known_poses(&file)
        };
        assert_eq!(
            read(&format!("{none}1,2,-900,0,0,0\n")).expect("one").len(),
            1
        );
        let told = read(none).expect_err("none").to_string();
        std::fs::remove_file(&file).expect("it was there");
        assert!(told.contains("no frame has a pose"), "{told}");
    }
}
