//! Verb `pose`: the pose of an implant in each mask of a folder.

mod other;

use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use fluoropose::finder::Candidate;
use fluoropose::finder::choice::DECISIVE_RATIO;
use fluoropose::math::Vector3;
use fluoropose::mesh::OwnedModel;
use fluoropose::pose::EulerPose;
use fluoropose_report::plus_minus;

use crate::exit;

use crate::choice::report::{self, FrameReport, Numbers, check_path, write_report};
use crate::choice::{Decision, Posed, Posing, Reasons};

use crate::files::{
    Role, check_outputs, covariances_beside, name_of, read, read_calibration,
    read_model_and_remarks_of, shape_doubt, size_taken, write_covariances, write_poses,
};

use crate::finding::{EdgeOptions, Finder, FrameFound, Method};

use crate::noise::DisturbanceOptions;

use crate::progress::Stop;

use crate::sequence::{Folders, Source};

use other::Other;

/// Options of `pose`.
#[derive(clap::Args)]
#[command(
    after_help = format!("Masks are images (PNG, TIFF, ...) in which every pixel that is not 0 belongs to the implant (of graded values, as probabilities, what is at least half the largest); their names' order is \
the order of the frames. Where two poses fit nearly alike both are printed, and why one was chosen: by its residual, where it decides; by the \
coronal tilt against the other component, where --counterpart tells its poses; by continuity over the frames. A verdict says how far a \
pose is to be trusted: good, doubtful or none, with the reason. A frame without a pose has a row of six times NaN. --method image brings the pose from each mask onto the edges of its grey frame in --frames.\n\n\
With --unknown, what a mask says of the pixels set in its companion is not believed: they are hidden, cut off or were not traced.\n\n\
To see what a worse trace would give, --jitter S follows each outline of a mask, smooths its pixel steps, moves it along its normals by \
Gaussian noise of the standard deviation S and the correlation length --correlation, and fills it again; --occlude F hides the part F of \
the outline's length behind a half plane, a disc or a band, and what is hidden is left out of the mask or traced as a part of it.\n\n\
After the sign ± stands one standard deviation (1 SD). {}\n\n{}\n\n\
`report --poses DIR` takes the files where they stand in one folder as COMPONENT.jts, with --report COMPONENT.csv for their verdicts.\n\n\
Example:\n  cargo xtask pose --library femur.library --model femur.stl --calibration calibration.txt --masks masks/femur --out femur.jts \
--method refined --report femur.csv", report::HELP, report::NEAR_THE_POLE)
)]
pub struct Args {
    /// Library file from `cargo xtask library`
    #[arg(long)]
    library: PathBuf,
    /// The model that the library was made from; checked by its digest
    #[arg(long)]
    model: PathBuf,
    /// Calibration of the frames: JT_INTCALIB or a camera matrix (MayaCam 2.0, OpenCV, ROS, MATLAB)
    #[arg(long)]
    calibration: PathBuf,
    /// Folder of mask images
    #[arg(long)]
    masks: PathBuf,
    /// Folder of mask images of unknown pixels, one for each mask, in the same order of names
    #[arg(long, value_name = "DIR")]
    unknown: Option<PathBuf>,
    /// Folder of grey frames for --method image, one for each mask, in the same order of names
    #[arg(long, value_name = "DIR")]
    frames: Option<PathBuf>,
    /// How poses are found
    #[arg(long, value_enum, default_value_t)]
    method: Method,
    #[command(flatten)]
    edges: EdgeOptions,
    /// Which component this is: no pose is good of a model that has the other one's shape; needed for --counterpart
    #[arg(long, value_enum)]
    role: Option<Role>,
    /// Poses of the other component in the same frames (.jts): the coronal tilt tells mirrored poses apart; those that the table beside the file calls doubtful rule out nothing
    #[arg(long, value_name = "FILE", requires = "role")]
    counterpart: Option<PathBuf>,
    /// The other component's model: the tilt is then taken in the axes that both shapes tell, else in those of the files
    #[arg(long, value_name = "FILE", requires = "counterpart")]
    counterpart_model: Option<PathBuf>,
    /// Pose file to write, a row a mask; beside it the covariances of its poses, for `report`: femur.covariances.csv beside femur.jts
    #[arg(long)]
    out: PathBuf,
    /// Uncertainty table to write, .csv or .json
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,
    #[command(flatten)]
    disturbance: DisturbanceOptions,
}

/// Runs the verb; the code to exit with.
///
/// # Errors
/// For files that cannot be read or do not belong together, and a model that the library was not made from.
pub fn run(args: Args) -> Result<u8> {
    args.disturbance.check()?;
    check_options(&args)?;
    let bytes = read(&args.library)?;
    let (model, remarks) = model_and_remarks(&args)?;
    let mesh = model.as_model();
    let calibration = read_calibration(&args.calibration)?;
    let folders = Folders {
        masks: &args.masks,
        unknown: args.unknown.as_deref(),
        frames: args.frames.as_deref(),
    };
    let source = Source::read(&folders, &calibration)?;
    let other = other_of(&args, source.masks.len())?;
    let finder = Finder::open(&bytes, mesh, source.camera, args.method)
        .with_context(|| args.library.display().to_string())?;
    let posing = Posing {
        finder: &finder,
        method: args.method,
        edges: args.edges,
        beside: other.as_ref().map(Other::beside),
        doubt: args.role.and_then(|role| shape_doubt(&model, role)),
        stop: Stop::default(),
    };
    let sequence = source.disturbed(&args.disturbance)?;
    let posed = posing.run(sequence)?;
    let (rows, poses) = (posed.report(), posed.poses());
    let missing = poses.iter().filter(|pose| pose.is_none()).count();
    let is_found = missing < poses.len();
    let is_good = rows.iter().any(|row| row.verdict == "good");
    // Written before anything is said, so that they are there where nobody reads on.
    if is_found {
        if let Some(path) = &args.report {
            write_report(path, &rows)?;
        }
        let poses = poses.into_iter().map(|pose| pose.map(EulerPose::from));
        write_poses(&args.out, &poses.collect::<Vec<_>>())?;
        write_covariances(&args.out, posed.uncertain())?;
    }
    let size = (source.camera.width(), source.camera.height());
    if let Some(words) = size_taken(&calibration, size) {
        println!("{words}");
    }
    say(&posed, &rows, &mesh.bounds().centre);
    // Told when the run began, which many lines may stand below by now.
    remarks
        .iter()
        .for_each(|remark| println!("remark: {remark}"));
    if !is_found {
        eprintln!("no mask has a pose; nothing was written");
        return Ok(exit::NOTHING_FOUND);
    }
    if missing > 0 {
        eprintln!("{missing} of {} masks have no pose", rows.len());
    }
    Ok(if is_good { 0 } else { exit::DOUBTFUL })
}

/// Whether what was asked for goes together, and can be written.
fn check_options(args: &Args) -> Result<()> {
    args.report.as_deref().map_or(Ok(()), check_path)?;
    args.edges.check(args.method)?;
    match (args.method, &args.frames) {
        (Method::Image, None) => {
            bail!("--method image needs the grey frames: name their folder with --frames")
        }
        (Method::Image, _) | (_, None) => {}
        (_, Some(_)) => bail!("--frames are looked at by --method image alone: ask for it"),
    }
    let covariances = covariances_beside(&args.out);
    let outputs = [
        ("--out", Some(&*args.out)),
        ("--out (covariances)", Some(&*covariances)),
        ("--report", args.report.as_deref()),
    ];
    let read = [&args.library, &args.model, &args.calibration];
    let read = read.map(|path| Some(&**path)).into_iter();
    let of_other = [&args.counterpart, &args.counterpart_model];
    check_outputs(&outputs, read.chain(of_other.map(Option::as_deref)))
}

fn other_of(args: &Args, frames: usize) -> Result<Option<Other>> {
    let named = args.role.zip(args.counterpart.as_deref());
    let model = args.counterpart_model.as_deref();
    let other = named.map(|(role, poses)| Other::read(role, poses, model, frames));
    other.transpose()
}

/// The model, and what there is to say of it, which is said.
fn model_and_remarks(args: &Args) -> Result<(OwnedModel, Vec<String>)> {
    let (model, remarks) = read_model_and_remarks_of(&args.model, args.role)?;
    let named = |remark: &String| format!("{}: {remark}", args.model.display());
    let remarks: Vec<String> = remarks.iter().map(named).collect();
    remarks.iter().for_each(|remark| eprintln!("{remark}"));
    Ok((model, remarks))
}

/// Prints what was found.
fn say(posed: &Posed, rows: &[FrameReport], middle: &Vector3) {
    if let Some(words) = &posed.film {
        println!("film: {words}");
    }
    let decisions = &posed.decisions;
    for ((frame, decision), row) in posed.found.iter().zip(decisions).zip(rows) {
        describe(frame, decision.as_ref(), row, middle);
    }
    println!("chosen by: {}", Reasons::of(decisions));
}

/// Prints a frame's pose, why it was chosen, and the rivals that fit nearly as well.
fn describe(frame: &FrameFound, decision: Option<&Decision>, row: &FrameReport, middle: &Vector3) {
    println!("{}", name_of(&frame.file));
    let posed = decision.filter(|decision| decision.pose().is_some());
    let Some(decision) = posed else {
        println!("  no pose: {}", row.because);
        return;
    };
    line(&decision.chosen, middle, "");
    let misfits = frame.candidates.iter().map(Candidate::misfit);
    let least = misfits.fold(f64::MAX, f64::min);
    let rivals = frame.candidates.iter().filter(|candidate| {
        candidate.pose != decision.chosen.pose && candidate.misfit() <= least * DECISIVE_RATIO
    });
    for rival in rivals {
        line(rival, middle, "  (rival)");
    }
    println!("  chosen by: {decision}");
    println!("  {}: {}", row.verdict, row.because);
}

fn line(candidate: &Candidate, middle: &Vector3, note: &str) {
    let values = Numbers::from(candidate.pose).all();
    let deviations = Numbers::deviations(candidate, middle).map(|sd| sd.all());
    let number = |k: usize| match deviations {
        Some(sd) => format!("{:>15}", plus_minus(values[k], sd[k], 2)),
        None => format!("{:8.2}", values[k]),
    };
    let fit = match candidate.refined {
        Some(_) => format!("{:.3} px residual", candidate.misfit()),
        None => format!("{} px unmatched", candidate.misfit()),
    };
    let offset = candidate.refined.filter(|refined| refined.offset_px != 0.0);
    let offset = offset.map_or(String::new(), |refined| {
        format!(", edges {:.2} px outside", refined.offset_px)
    });
    let located = candidate.located.map(|located| located.located);
    let border = if located.is_some_and(|located| located.fine.at_border) {
        "  (at the border of the library)"
    } else {
        ""
    };
    println!(
        "  x {} y {} z {} mm   z {} x {} y {} deg   {fit}{offset}{note}{border}",
        number(0),
        number(1),
        number(2),
        number(3),
        number(4),
        number(5),
    );
}
