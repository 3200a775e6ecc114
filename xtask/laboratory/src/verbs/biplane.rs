//! Verb `biplane`: one pose from the masks of two calibrated cameras.

use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use fluoropose::image::silhouette::Silhouette;
use fluoropose::pose::covariance::PoseCovariance;
use fluoropose::pose::{EulerPose, Pose};
use fluoropose::refine::{CameraView, Refined};
use fluoropose_report::plus_minus;

use crate::files::{read, read_calibration, read_model, write_poses};

use crate::finding::{Finder, Method};

use crate::finding::biplane::between;

use crate::progress::progress;

use crate::sequence::{Folders, Source};

/// Options of `biplane`.
#[derive(clap::Args)]
#[command(
    after_help = "Both calibrations are camera matrices with rotation and translation from one laboratory (MayaCam 2.0, XMALab). The library \
gives first poses in the first camera; refinement then brings the model onto the masks of both at once. Poses are written in the first \
camera's frame, looking along -z; plus-minus is one standard deviation.\n\n\
Example:\n  cargo xtask biplane --library femur.library --model femur.stl --calibration one.txt --masks one --second-calibration two.txt \
--second-masks two --out femur.jts"
)]
pub struct Args {
    /// Library file from `cargo xtask library`
    #[arg(long)]
    library: PathBuf,
    /// The model that the library was made from; checked by its digest
    #[arg(long)]
    model: PathBuf,
    /// Calibration of the first camera
    #[arg(long)]
    calibration: PathBuf,
    /// Folder of the first camera's masks
    #[arg(long)]
    masks: PathBuf,
    /// Calibration of the second camera
    #[arg(long)]
    second_calibration: PathBuf,
    /// Folder of the second camera's masks: as many, in the same order
    #[arg(long)]
    second_masks: PathBuf,
    /// Pose file to write, a row a pair of masks
    #[arg(long)]
    out: PathBuf,
}

/// Runs the verb.
///
/// # Errors
/// For files that cannot be read or do not belong together, and a pair of masks without a pose:
/// nothing is written then.
pub fn run(args: Args) -> Result<()> {
    let first_calibration = read_calibration(&args.calibration)?;
    let second_calibration = read_calibration(&args.second_calibration)?;
    let placement = between(&first_calibration, &second_calibration).context(
        "the calibrations do not say where the cameras stand to each other: both must be camera matrices with a rotation and a translation from one laboratory",
    )?;
    let folder = |masks| Folders {
        masks,
        unknown: None,
        frames: None,
    };
    let first = Source::read(&folder(&args.masks), &first_calibration)?;
    let second = Source::read(&folder(&args.second_masks), &second_calibration)?;
    if first.masks.len() != second.masks.len() {
        bail!(
            "{} masks of the first camera but {} of the second; both must show the same moments",
            first.masks.len(),
            second.masks.len()
        );
    }
    let bytes = read(&args.library)?;
    let model = read_model(&args.model)?;
    let mesh = model.as_model();
    let mut finder = Finder::open(&bytes, mesh, first.camera, Method::Refined)
        .with_context(|| args.library.display().to_string())?;
    let bar = progress(first.masks.len(), "pairs of masks");
    let mut poses = Vec::new();
    for ((path, one), (_, two)) in first.masks.iter().zip(&second.masks) {
        let (one, two) = (one.mask(), two.mask());
        let silhouette = Silhouette::from(&one);
        let views = [
            CameraView::only(&first.camera, silhouette),
            CameraView {
                placement,
                ..CameraView::only(&second.camera, &two)
            },
        ];
        let found = pair(&mut finder, &silhouette, &views)
            .with_context(|| format!("no pose for {}", path.display()))?;
        bar.suspend(|| describe(path, &found, &mesh.bounds().centre));
        poses.push(Some(EulerPose::from(found.0.pose)));
        bar.inc(1);
    }
    bar.finish_and_clear();
    write_poses(&args.out, &poses)
}

/// The pose that explains what both cameras saw.
fn pair(
    finder: &mut Finder<'_>,
    silhouette: &Silhouette<'_>,
    views: &[CameraView<'_>],
) -> Result<(Refined, Option<PoseCovariance>)> {
    let found = finder.all(&(*silhouette).into())?;
    let starts: Vec<Pose> = found.candidates.iter().map(|one| one.pose).collect();
    let found = finder.refine_views(views, &starts)?;
    found
        .into_iter()
        .next()
        .context("there is nothing to start from")
}

fn describe(
    path: &std::path::Path,
    (refined, covariance): &(Refined, Option<PoseCovariance>),
    middle: &fluoropose::math::Vector3,
) {
    let pose = EulerPose::from(refined.pose);
    let sure = covariance.map(|covariance| covariance.deviations(&refined.pose, middle));
    let number = |value: f64, deviation: Option<f64>| match deviation {
        Some(deviation) => plus_minus(value, deviation, 3),
        None => format!("{value:.3}"),
    };
    println!(
        "{}\n  x {}  y {}  z {} mm   z {}  x {}  y {} deg   {:.3} px residual",
        path.file_name().unwrap_or_default().display(),
        number(pose.x_mm, sure.map(|sure| sure.x_mm)),
        number(pose.y_mm, sure.map(|sure| sure.y_mm)),
        number(pose.z_mm, sure.map(|sure| sure.z_mm)),
        number(pose.z_rot_deg, sure.map(|sure| sure.z_rot_deg)),
        number(pose.x_rot_deg, sure.map(|sure| sure.x_rot_deg)),
        number(pose.y_rot_deg, sure.map(|sure| sure.y_rot_deg)),
        refined.residual_px
    );
}
