//! Verb `pose`: the pose of an implant in each mask of a folder.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use fluoropose::pose::EulerPose;

use crate::pipeline::build::progress;
use crate::pipeline::disturb::DisturbanceOptions;
use crate::pipeline::files::{mesh_of, read, read_calibration, read_model, write_poses};
use crate::pipeline::finder::{Answer, Finder, Method};
use crate::pipeline::source::Source;

/// Options of `pose`.
#[derive(clap::Args)]
#[command(
    after_help = "Masks are images (PNG, TIFF, ...) in which every pixel that is not 0 belongs to the implant; their names' order is \
the order of the frames. Where two poses fit nearly alike both are printed.\n\n\
With --unknown, what a mask says of the pixels set in its companion is not believed: they are hidden, cut off or were not traced.\n\n\
To see what a worse trace would give, --jitter S follows each outline of a mask, smooths its pixel steps, moves it along its normals by \
Gaussian noise of the standard deviation S and the correlation length --correlation, and fills it again; --occlude F hides the part F of \
the outline's length behind a half plane, a disc or a band, and what is hidden is left out of the mask or traced as a part of it.\n\n\
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
    /// Folder of mask images of unknown pixels, one for each mask, in the same order of names
    #[arg(long, value_name = "DIR")]
    unknown: Option<PathBuf>,
    /// How poses are found
    #[arg(long, value_enum, default_value_t)]
    method: Method,
    /// Pose file to write, a row a mask
    #[arg(long)]
    out: PathBuf,
    #[command(flatten)]
    disturbance: DisturbanceOptions,
}

/// A rival pose is mentioned when it fits at most this many times as badly as the best.
const RIVAL_RATIO: f64 = 1.3;

/// Runs the verb.
///
/// # Errors
/// For files that cannot be read, a model that the library was not made from, or a mask
/// without a pose: the file is named, and nothing is written.
pub fn run(args: Args) -> Result<()> {
    let bytes = read(&args.library)?;
    let model = read_model(&args.model)?;
    args.disturbance.check()?;
    let calibration = read_calibration(&args.calibration)?;
    let source = Source::read(&args.masks, args.unknown.as_deref(), &calibration)?;
    let mut finder = Finder::open(&bytes, mesh_of(&model)?, source.camera, args.method)
        .with_context(|| args.library.display().to_string())?;
    let bar = progress(source.masks.len(), "masks");
    let mut poses = Vec::new();
    for mask in source.disturbed(&args.disturbance) {
        let (path, seen) = mask?;
        let answers = seen
            .see(|silhouette| finder.all(&silhouette.into()))
            .with_context(|| format!("no pose for {}", path.display()))?;
        bar.suspend(|| describe(path, &answers));
        poses.extend(answers.first().map(|best| EulerPose::from(best.pose)));
        bar.inc(1);
    }
    bar.finish_and_clear();
    write_poses(&args.out, &poses)
}

/// Prints the best pose and the rivals that fit nearly as well.
fn describe(path: &Path, answers: &[Answer]) {
    println!("{}", path.file_name().unwrap_or_default().display());
    let least = answers.iter().map(misfit).fold(f64::MAX, f64::min);
    for (rank, answer) in answers.iter().enumerate() {
        if misfit(answer) > least * RIVAL_RATIO {
            continue;
        }
        let pose = EulerPose::from(answer.pose);
        let residual = match answer.refined {
            Some(refined) => format!("{:.3} px residual", refined.residual_px),
            None => format!("{} px unmatched", answer.located.unmatched),
        };
        println!(
            "  x {:8.2} y {:8.2} z {:9.2} mm   z {:8.2} x {:7.2} y {:7.2} deg   {residual}{}{}",
            pose.x_mm,
            pose.y_mm,
            pose.z_mm,
            pose.z_rot_deg,
            pose.x_rot_deg,
            pose.y_rot_deg,
            if rank == 0 { "" } else { "  (rival)" },
            if answer.located.located.fine.at_border {
                "  (at the border of the library)"
            } else {
                ""
            },
        );
    }
}

/// How badly a pose fits: its residual after refinement, or unmatched pixels.
fn misfit(answer: &Answer) -> f64 {
    answer
        .refined
        .map_or(answer.located.unmatched as f64, |r| r.residual_px)
}
