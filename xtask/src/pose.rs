//! Verb `pose`: the pose of an implant in each mask of a folder.

use std::path::PathBuf;

use anyhow::{Context, Result};
use fluoropose::pose::EulerPose;
use fluoropose::verify::Verified;

use crate::pipeline::build::progress;
use crate::pipeline::files::{
    files_in, mesh_of, read, read_calibration, read_mask, read_model, write_poses,
};
use crate::pipeline::locator::Locator;

/// Options of `pose`.
#[derive(clap::Args)]
#[command(
    after_help = "Masks are images (PNG, TIFF, ...) in which every pixel that is not 0 belongs to the implant; their names' order is \
the order of the frames. Where two poses fit nearly alike both are printed.\n\n\
Example:\n  cargo xtask pose --library femur.library --model femur.stl --calibration calibration.txt --masks masks/femur --out femur.jts"
)]
pub struct Args {
    /// Library file from `cargo xtask library`
    #[arg(long)]
    library: PathBuf,
    /// The model that the library was made from; checked by its digest
    #[arg(long)]
    model: PathBuf,
    /// Calibration of the frames: JT_INTCALIB or a camera matrix (MayaCam 2.0)
    #[arg(long)]
    calibration: PathBuf,
    /// Folder of mask images
    #[arg(long)]
    masks: PathBuf,
    /// Pose file to write, a row a mask
    #[arg(long)]
    out: PathBuf,
}

/// A rival pose is mentioned when it leaves at most this many times the unmatched pixels of
/// the best.
const RIVAL_RATIO: f64 = 1.3;

/// Runs the verb.
///
/// # Errors
/// For files that cannot be read, a model that the library was not made from, or a mask
/// without a pose: the file is named, and nothing is written.
pub fn run(args: Args) -> Result<()> {
    let bytes = read(&args.library)?;
    let model = read_model(&args.model)?;
    let mut locator = Locator::open(&bytes, mesh_of(&model)?)
        .with_context(|| args.library.display().to_string())?;
    let calibration = read_calibration(&args.calibration)?;
    let files = files_in(&args.masks)?;
    let bar = progress(files.len(), "masks");
    let mut poses = Vec::new();
    for path in &files {
        let buffer = read_mask(path)?;
        let mask = buffer.mask();
        let camera = calibration.camera(mask.width(), mask.height())?;
        let found = locator
            .locate(&mask, &camera)
            .with_context(|| format!("no pose for {}", path.display()))?;
        bar.suspend(|| describe(path, &found));
        poses.extend(found.first().map(|best| EulerPose::from(best.located.pose)));
        bar.inc(1);
    }
    bar.finish_and_clear();
    write_poses(&args.out, &poses)
}

/// Prints the best pose and the rivals that fit nearly as well.
fn describe(path: &std::path::Path, rivals: &[Verified]) {
    let Some(best) = rivals.first() else { return };
    println!("{}", path.file_name().unwrap_or_default().display());
    let limit = best.unmatched as f64 * RIVAL_RATIO;
    for rival in rivals {
        if rival.unmatched as f64 > limit {
            break;
        }
        let pose = EulerPose::from(rival.located.pose);
        println!(
            "  x {:8.2} y {:8.2} z {:9.2} mm   z {:8.2} x {:7.2} y {:7.2} deg   {} px unmatched{}{}",
            pose.x_mm,
            pose.y_mm,
            pose.z_mm,
            pose.z_rot_deg,
            pose.x_rot_deg,
            pose.y_rot_deg,
            rival.unmatched,
            if rival == best { "" } else { "  (rival)" },
            if rival.located.fine.at_border {
                "  (at the border of the library)"
            } else {
                ""
            },
        );
    }
}
