//! Verb `biplane`: one pose from the masks of two calibrated cameras.

use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use fluoropose::finder::choice::DECISIVE_RATIO;
use fluoropose::finder::{Doubt, Limits, OTHER_DEG, Verdict, is_determined, judge_fit};
use fluoropose::image::silhouette::Silhouette;
use fluoropose::pose::covariance::PoseCovariance;
use fluoropose::pose::{EulerPose, Pose, geodesic_deg};
use fluoropose::refine::{CameraView, Refined};
use fluoropose_report::plus_minus;

use crate::exit;
use crate::files::{read, read_calibration, read_model, write_poses};
use crate::finding::biplane::{Contradiction, between};
use crate::finding::{Finder, Method};
use crate::progress::progress;
use crate::sequence::{Folders, Source};

/// Options of `biplane`.
#[derive(clap::Args)]
#[command(
    after_help = "Both calibrations are camera matrices with rotation and translation from one laboratory (MayaCam 2.0, XMALab). The library \
gives first poses in the first camera; refinement then brings the model onto the masks of both at once. Poses are written in the first \
camera's frame, looking along -z; plus-minus is one standard deviation. A pose is doubtful where the cameras contradict each other: each mask alone is met clearly better \
elsewhere, as of other moments or exchanged calibrations; and where another pose fits both as well. A pair that no pose explains has NaN. The command exits with 3 where a pose is doubtful or missing.\n\n\
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

/// Runs the verb; the code to exit with.
///
/// # Errors
/// For files that cannot be read or do not belong together, and a pair of masks that leads to no first pose:
/// nothing is written then.
pub fn run(args: Args) -> Result<u8> {
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
    let (mut poses, mut all_good) = (Vec::new(), true);
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
        let best = found
            .first()
            .with_context(|| format!("nothing to start from for {}", path.display()))?;
        let (word, because) = judge(&mut finder, &views, &found)?;
        bar.suspend(|| {
            describe(path, best, &mesh.bounds().centre);
            println!("  {word}: {because}");
        });
        all_good &= word == Verdict::Good.word();
        let pose = (word != NONE).then(|| EulerPose::from(best.0.pose));
        poses.push(pose);
        bar.inc(1);
    }
    bar.finish_and_clear();
    write_poses(&args.out, &poses)?;
    Ok(if all_good { 0 } else { exit::DOUBTFUL })
}

/// The word of a verdict that there is no pose.
const NONE: &str = "none";

/// A refined pose and how sure it is.
type Sure = (Refined, Option<PoseCovariance>);

/// How far the first of the poses is to be trusted, in a word, and why.
fn judge(
    finder: &mut Finder<'_>,
    views: &[CameraView<'_>],
    found: &[Sure],
) -> Result<(&'static str, String)> {
    let (refined, covariance) = found.first().context("there is nothing to start from")?;
    let fit = finder.fit_views(views, &refined.pose)?;
    let verdict = judge_fit(&fit, is_determined(covariance.as_ref()), &Limits::USUAL);
    let verdict = verdict.or_doubt(open(found));
    let told = (verdict.word(), verdict.to_string());
    if verdict.word() == NONE {
        return Ok(told);
    }
    // Before parts without a counterpart, which it makes.
    let contradiction = Contradiction::at(finder, views, &refined.pose)?;
    Ok(contradiction.map_or(told, |why| ("doubtful", why.to_string())))
}

/// That another pose than the first fits as well, as of a part with two planes of symmetry, which falls on itself by half a turn.
fn open(found: &[Sure]) -> Option<Doubt> {
    let misfit_px = |(refined, _): &Sure| (2.0 * refined.loss).sqrt();
    let (best, others) = found.split_first()?;
    let is_open = |other: &&Sure| {
        let turn_deg = geodesic_deg(&best.0.pose.rotation, &other.0.pose.rotation);
        turn_deg >= OTHER_DEG && misfit_px(other) <= DECISIVE_RATIO * misfit_px(best)
    };
    let other = others.iter().find(is_open)?;
    Some(Doubt::open(&best.0.pose, &other.0.pose, misfit_px(other)))
}

/// The poses that explain what both cameras saw, the best first.
fn pair(
    finder: &mut Finder<'_>,
    silhouette: &Silhouette<'_>,
    views: &[CameraView<'_>],
) -> Result<Vec<Sure>> {
    let found = finder.all(&(*silhouette).into())?;
    let starts: Vec<Pose> = found.candidates.iter().map(|one| one.pose).collect();
    finder.refine_views(views, &starts)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn another_pose_that_fits_both_cameras_as_well_is_told() {
        let found = |turn_deg: f64, misfit_px: f64| {
            let pose = Pose::from(EulerPose {
                y_rot_deg: turn_deg,
                z_mm: -900.0,
                ..EulerPose::default()
            });
            let mut refined = Refined::at(pose);
            refined.loss = misfit_px * misfit_px / 2.0;
            (refined, None)
        };
        let told = |other| open(&[found(0.0, 0.5), other]);
        assert!(
            matches!(told(found(180.0, 0.5)), Some(Doubt::Open { turn_deg, .. }) if turn_deg > 179.0)
        );
        // Hardly another one, and one that leaves by far more.
        assert_eq!(told(found(2.0, 0.5)), None);
        assert_eq!(told(found(180.0, 0.7)), None);
        assert_eq!(open(&[found(0.0, 0.5)]), None);
        assert_eq!(open(&[]), None);
    }
}
