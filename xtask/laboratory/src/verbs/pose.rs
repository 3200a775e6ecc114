//! Verb `pose`: the pose of an implant in each mask of a folder.

use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use fluoropose::finder::Candidate;
use fluoropose::finder::choice::{Counterpart, DECISIVE_RATIO};
use fluoropose::math::Vector3;
use fluoropose::mesh::Model;
use fluoropose::pose::{EulerPose, Pose};

use crate::choice::{Decision, Reasons, decide, report};

use crate::choice::report::{Numbers, check_path, report, why, write_report};

use crate::files::{Role, name_of, read, read_calibration, read_model_of, read_poses, write_poses};

use crate::finding::{
    EdgeOptions, Filmed, Finder, FrameFound, Method, Stated, axes_of, bring_onto_frames, find_poses,
};

use crate::noise::DisturbanceOptions;

use crate::sequence::{Folders, Sequence, Source};

/// Options of `pose`.
#[derive(clap::Args)]
#[command(
    after_help = format!("Masks are images (PNG, TIFF, ...) in which every pixel that is not 0 belongs to the implant; their names' order is \
the order of the frames. Where two poses fit nearly alike both are printed, and why one was chosen: by its residual, where it decides; by the \
coronal tilt against the other component, where --counterpart tells its poses; by continuity over the frames. A verdict says how far a \
pose is to be trusted: good, doubtful or none, with the reason. A frame without a pose has a row of six times NaN. --method image brings the pose from each mask onto the edges of its grey frame in --frames.\n\n\
With --unknown, what a mask says of the pixels set in its companion is not believed: they are hidden, cut off or were not traced.\n\n\
To see what a worse trace would give, --jitter S follows each outline of a mask, smooths its pixel steps, moves it along its normals by \
Gaussian noise of the standard deviation S and the correlation length --correlation, and fills it again; --occlude F hides the part F of \
the outline's length behind a half plane, a disc or a band, and what is hidden is left out of the mask or traced as a part of it.\n\n\
After the sign ± stands one standard deviation (1 SD). {}\n\n\
Example:\n  cargo xtask pose --library femur.library --model femur.stl --calibration calibration.txt --masks masks/femur --out femur.jts \
--method refined --report femur.csv", report::HELP)
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
    /// Folder of grey frames for --method image, one for each mask, in the same order of names
    #[arg(long, value_name = "DIR")]
    frames: Option<PathBuf>,
    /// How poses are found
    #[arg(long, value_enum, default_value_t)]
    method: Method,
    #[command(flatten)]
    edges: EdgeOptions,
    /// Which component this is; needed for --counterpart
    #[arg(long, value_enum, requires = "counterpart")]
    role: Option<Role>,
    /// Poses of the other component in the same frames (.jts): the coronal tilt tells mirrored poses apart
    #[arg(long, value_name = "FILE", requires = "role")]
    counterpart: Option<PathBuf>,
    /// The other component's model: the tilt is then taken in the axes that both shapes tell, else in those of the files
    #[arg(long, value_name = "FILE", requires = "counterpart")]
    counterpart_model: Option<PathBuf>,
    /// Pose file to write, a row a mask
    #[arg(long)]
    out: PathBuf,
    /// Uncertainty table to write, .csv or .json
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,
    #[command(flatten)]
    disturbance: DisturbanceOptions,
}

/// Runs the verb.
///
/// # Errors
/// For files that cannot be read or do not belong together, a model that the library was not made
/// from, and masks of which not one has a pose: nothing is written then.
pub fn run(args: Args) -> Result<()> {
    args.disturbance.check()?;
    args.report.as_deref().map_or(Ok(()), check_path)?;
    if args.method == Method::Image && args.frames.is_none() {
        bail!("--method image needs the grey frames: name their folder with --frames");
    }
    let bytes = read(&args.library)?;
    let model = read_model_of(&args.model, args.role)?;
    let mesh = model.as_model();
    let calibration = read_calibration(&args.calibration)?;
    let folders = Folders {
        masks: &args.masks,
        unknown: args.unknown.as_deref(),
        frames: args.frames.as_deref(),
    };
    let source = Source::read(&folders, &calibration)?;
    let counterparts = counterparts(&args, source.masks.len())?;
    let onto_frames = args.method == Method::Image;
    // Outlines first: they tell the film.
    let method = if onto_frames {
        Method::Refined
    } else {
        args.method
    };
    let finder = Finder::open(&bytes, mesh, source.camera, method)
        .with_context(|| args.library.display().to_string())?
        .with_edges(args.edges);
    let sequence = source.disturbed(&args.disturbance)?;
    let mut found = find_poses(&finder, &sequence);
    if onto_frames {
        onto_the_frames(mesh, sequence, args.edges, &mut found);
    }
    let decisions = decide(&found, &counterparts, &own_axes(&args, &mesh)?)?;
    let middle = mesh.bounds().centre;
    for (frame, decision) in found.iter().zip(&decisions) {
        describe(frame, decision.as_ref(), &middle);
    }
    let poses: Vec<Option<Pose>> = decisions
        .iter()
        .map(|decision| decision.and_then(|decision| decision.pose()))
        .collect();
    let missing = poses.iter().filter(|pose| pose.is_none()).count();
    println!("chosen by: {}", Reasons::of(&decisions));
    if missing == decisions.len() {
        bail!("no mask has a pose; nothing was written");
    }
    if missing > 0 {
        eprintln!("{missing} of {} masks have no pose", decisions.len());
    }
    if let Some(path) = &args.report {
        write_report(path, &report(&found, &decisions, &middle))?;
    }
    let rows = poses.into_iter().map(|pose| pose.map(EulerPose::from));
    write_poses(&args.out, &rows.collect::<Vec<_>>())
}

/// Brings poses onto the frames of a sequence, and says what these tell of their film.
fn onto_the_frames(
    model: Model<'_>,
    sequence: Sequence<'_>,
    edges: EdgeOptions,
    found: &mut Vec<FrameFound>,
) {
    let filmed = Filmed {
        name: "metal",
        model,
        sequence,
        edges,
        found,
    };
    let known = bring_onto_frames(&mut [filmed], &Stated::default());
    println!("film: {}", known.words);
}

/// The other component's poses, a frame each; none where no file of them was given.
fn counterparts(args: &Args, frames: usize) -> Result<Vec<Option<Counterpart>>> {
    let (Some(role), Some(path)) = (args.role, &args.counterpart) else {
        return Ok(Vec::new());
    };
    let rows = read_poses(path)?;
    if rows.len() != frames {
        bail!(
            "{} has {} poses but there are {frames} masks; both must be of the same frames",
            path.display(),
            rows.len()
        );
    }
    let axes = match &args.counterpart_model {
        Some(file) => {
            let other = role.other();
            shape_axes(&read_model_of(file, Some(other))?.as_model(), other)?
        }
        None => Pose::IDENTITY,
    };
    let against = |row: Option<Pose>| row.map(|pose| role.against(pose.compose(&axes)));
    Ok(rows.into_iter().map(against).collect())
}

/// The rotation from the field's axes to the model's, where the other component's are known too.
fn own_axes(args: &Args, model: &Model<'_>) -> Result<Pose> {
    match (args.role, &args.counterpart_model) {
        (Some(role), Some(_)) => shape_axes(model, role),
        _ => Ok(Pose::IDENTITY),
    }
}

fn shape_axes(model: &Model<'_>, role: Role) -> Result<Pose> {
    let axes = axes_of(model, role, None)?;
    let axes = axes.with_context(|| format!("the shape of the {role:?} does not tell its axes"))?;
    Ok(axes.model_from_field)
}

/// Prints a frame's pose, why it was chosen, and the rivals that fit nearly as well.
fn describe(frame: &FrameFound, decision: Option<&Decision>, middle: &Vector3) {
    println!("{}", name_of(&frame.file));
    let posed = decision.filter(|decision| decision.pose().is_some());
    let Some(decision) = posed else {
        println!("  no pose: {}", why(frame, decision));
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
    println!("  {}: {}", decision.verdict.word(), decision.verdict);
}

fn line(candidate: &Candidate, middle: &Vector3, note: &str) {
    let values = Numbers::from(candidate.pose).all();
    let deviations = Numbers::deviations(candidate, middle).map(|sd| sd.all());
    let number = |k: usize| match deviations {
        Some(sd) => format!("{:8.2} ±{:.2}", values[k], sd[k]),
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
