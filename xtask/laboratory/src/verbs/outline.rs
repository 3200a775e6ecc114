//! Verb `outline`: one-click outlines on a study's grey frames, against its masks.

mod known;
mod picture;

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use fluoropose::camera::Camera;
use fluoropose::finder::Verdict;
use fluoropose::image::mask::Mask;
use fluoropose::mesh::Model;
use fluoropose::pose::Pose;
use fluoropose::render::{Projected, render, scratch_needed};
use serde::Serialize;

use crate::files::{
    Component, MaskBuffer, Study, check_outputs, grey, read_calibration, read_poses, write_json,
};

use crate::finding::prompts::Kind;

use crate::finding::{Clicked, Clicker, ViewOptions, build_library};

use crate::measure::accuracy::{Errors, is_wrong_side, median_absolute};

use crate::options::{Pair, Shown, at_least_1, study_files};

use crate::sequence::{Folders, Source};
use known::Known;

/// Options of `outline`.
#[derive(clap::Args)]
#[command(
    after_help = "For each frame of the study: a click where the implant is thickest, a click anywhere inside it and a rough box, 5 to 15 % \
larger on each side, all derived from its mask, and a click at the middle of the model where the reference pose has it. Frames without the component, or for that click without a reference pose, are left out. Each is given to the one-click outline with the grey frame and the component's library, \
built for the usual distance; nothing else of the mask is used. The table holds the overlap (intersection over union) of the model's \
silhouette with the mask, the pose's errors against the reference poses, and the time; and how many poses are right (at most 4 degrees and 25 mm of \
depth off), how many of the others are told to be doubtful or refused, and how many are called good.\n\n\
Example:\n  cargo xtask outline --study study.toml --component femur"
)]
pub struct Args {
    /// Study file, or its folder; it needs the key frames
    #[arg(long, value_parser = study_files())]
    study: PathBuf,
    /// Name of the component
    #[arg(long)]
    component: String,
    /// Source of the masks
    #[arg(long, value_name = "NAME", default_value = "labels")]
    source: String,
    #[command(flatten)]
    shown: Shown,
    /// The femoral component's reference poses are known: of a tibia
    #[arg(long)]
    femur_known: bool,
    /// Only this kind of prompt
    #[arg(long, value_enum)]
    prompt: Option<Kind>,
    /// Only this frame, from 1
    #[arg(long, value_parser = at_least_1)]
    frame: Option<usize>,
    /// Tell every first pose and every answer
    #[arg(long)]
    verbose: bool,
    /// Folder for a picture of each answer
    #[arg(long, value_name = "DIR")]
    pictures: Option<PathBuf>,
    /// Write the table as JSON
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

/// A row of the table: one kind of prompt.
#[derive(Debug, Serialize)]
pub struct Row {
    /// Kind of prompt.
    pub prompt: &'static str,
    /// Prompts that were given.
    pub frames: usize,
    /// Prompts without an answer.
    pub failed: usize,
    /// Median overlap, failures counted as 0.
    pub median_iou: f64,
    /// Least overlap.
    pub least_iou: f64,
    /// Median absolute errors of the first answer's pose.
    pub median: Option<Errors>,
    /// First answers nearer to the reference's mirror image than to the reference.
    pub wrong_side: usize,
    /// Poses chosen at most 4 degrees and 25 mm of depth off.
    pub right: usize,
    /// The others that are told to be doubtful, were refused, or have no answer.
    pub marked: usize,
    /// The others that are called good.
    pub wrong: usize,
    /// Median time, ms.
    pub median_ms: f64,
    /// Median of the longest step of each, ms.
    pub step_ms: f64,
}

/// What came of one prompt.
struct Outcome {
    iou: f64,
    errors: Option<Errors>,
    wrong_side: bool,
    good: bool,
    ms: f64,
    step_ms: f64,
}

impl Outcome {
    fn is_right(&self) -> bool {
        let (turn, depth) = RIGHT;
        let right = |errors: Errors| errors.geodesic_deg <= turn && errors.z_mm.abs() <= depth;
        self.errors.is_some_and(right)
    }
}

/// A pose is right within this of the reference: degrees, mm of depth.
const RIGHT: (f64, f64) = (4.0, 25.0);

/// Runs the verb.
///
/// # Errors
/// For files that are missing, unreadable or do not belong together.
pub fn run(args: Args) -> Result<()> {
    check_outputs(&[("--json", args.json.as_deref())], [Some(&*args.study)])?;
    let study = Study::read(&args.study)?;
    let (component, masks) = asked_for(&study, &args)?;
    let folders = Folders {
        masks,
        unknown: None,
        frames: Some(study.frames_folder()?),
    };
    let calibration = read_calibration(&study.calibration)?;
    let source = Source::read(&folders, &calibration)?;
    if let Some(frame) = args.frame {
        let count = source.masks.len();
        ensure!(
            frame <= count,
            "there is no frame {frame}: the study has {count}"
        );
    }
    if let Some(folder) = &args.pictures {
        fs::create_dir_all(folder)
            .with_context(|| format!("cannot make the folder {}", folder.display()))?;
    }
    let views = ViewOptions {
        nominal: component.nominal.map(Pair),
        distance: component.distance_mm,
        ..ViewOptions::default()
    };
    let model = component.read_model()?;
    let mesh = model.as_model();
    let distance = views.distance_for(&calibration);
    let library =
        build_library(mesh, source.camera, &views, distance).with_context(|| component.words())?;
    let mut trial = Trial {
        known: match args.femur_known {
            true => Known::femurs(&study, component)?,
            false => Known::default(),
        },
        clicker: Clicker::open(&library.bytes, mesh, source.camera)?,
        references: references(component, source.masks.len())?,
        source: &source,
        mesh,
        args: &args,
    };
    let mut rows = Vec::new();
    for kind in trial.kinds()? {
        let row = trial.row(kind)?;
        print(&row);
        rows.push(row);
    }
    write_json(args.json.as_deref(), &rows)
}

/// The component, and the folder of its masks.
fn asked_for<'s>(study: &'s Study, args: &Args) -> Result<(&'s Component, &'s Path)> {
    let (name, source) = (&args.component, &args.source);
    let component = study.component(name)?;
    let masks = component.masks.get(source).with_context(|| {
        let sources: Vec<&str> = component.masks.keys().map(String::as_str).collect();
        let sources = if sources.is_empty() {
            "none"
        } else {
            &sources.join(", ")
        };
        format!("{name} has no masks.{source} (--source): those of it are {sources}")
    })?;
    Ok((component, masks))
}

fn references(component: &Component, count: usize) -> Result<Vec<Option<Pose>>> {
    let Some(path) = &component.reference else {
        return Ok(Vec::new());
    };
    let poses = read_poses(path)?;
    let rows = poses.len();
    ensure!(
        rows == count,
        "{}: there are {rows} rows, but {count} masks; both must be of the same frames",
        path.display()
    );
    Ok(poses)
}

struct Trial<'t> {
    known: Known,
    clicker: Clicker<'t>,
    references: Vec<Option<Pose>>,
    source: &'t Source,
    mesh: Model<'t>,
    args: &'t Args,
}

impl Trial<'_> {
    /// The kinds of prompts that are asked for, as far as they can be derived.
    fn kinds(&self) -> Result<Vec<Kind>> {
        let is_told = !self.references.is_empty();
        ensure!(
            is_told || self.args.prompt != Some(Kind::Centre),
            "--prompt centre is where the reference poses have the component, and {} has none: name their file as reference",
            self.args.component
        );
        let wanted = |kind: &Kind| match self.args.prompt {
            Some(prompt) => prompt == *kind,
            None => is_told || *kind != Kind::Centre,
        };
        Ok(Kind::ALL.into_iter().filter(wanted).collect())
    }

    fn row(&mut self, kind: Kind) -> Result<Row> {
        let all = 0..self.source.masks.len();
        let is_asked = |frame: &usize| self.args.frame.is_none_or(|asked| asked == frame + 1);
        let frames = all.filter(|frame| is_asked(frame) && self.has(kind, *frame));
        let frames: Vec<usize> = frames.collect();
        let mut outcomes = Vec::new();
        for &frame in &frames {
            outcomes.push(self.outcome(kind, frame)?);
        }
        let done: Vec<&Outcome> = outcomes.iter().flatten().collect();
        let median = |value: fn(&Outcome) -> f64| {
            let values: Vec<f64> = done.iter().map(|outcome| value(outcome)).collect();
            median_absolute(&values)
        };
        let overlaps: Vec<f64> = outcomes
            .iter()
            .map(|outcome| outcome.as_ref().map_or(0.0, |outcome| outcome.iou))
            .collect();
        let errors: Vec<Errors> = done.iter().filter_map(|outcome| outcome.errors).collect();
        Ok(Row {
            prompt: kind.word(),
            frames: frames.len(),
            failed: frames.len() - done.len(),
            median_iou: median_absolute(&overlaps),
            least_iou: overlaps.iter().copied().fold(1.0, f64::min),
            median: (!errors.is_empty()).then(|| Errors::summarise(&errors, median_absolute)),
            wrong_side: done.iter().filter(|outcome| outcome.wrong_side).count(),
            right: done.iter().filter(|outcome| outcome.is_right()).count(),
            marked: frames.len() - done.iter().filter(|one| one.is_right() || one.good).count(),
            wrong: done
                .iter()
                .filter(|one| !one.is_right() && one.good)
                .count(),
            median_ms: median(|outcome| outcome.ms),
            step_ms: median(|outcome| outcome.step_ms),
        })
    }

    /// Whether a frame has what a prompt is derived from: some of the component, and where it lies.
    fn has(&self, kind: Kind, frame: usize) -> bool {
        let reference = self.references.get(frame).copied().flatten();
        let is_seen = self
            .source
            .masks
            .get(frame)
            .is_some_and(|(_, mask)| mask.mask().area() > 0);
        is_seen && (kind != Kind::Centre || reference.is_some())
    }

    /// One prompt; `None` where nothing came of it.
    fn outcome(&mut self, kind: Kind, frame: usize) -> Result<Option<Outcome>> {
        let (path, mask) = &self.source.masks[frame];
        let mask = mask.mask();
        let reference = self.references.get(frame).copied().flatten();
        let middle = self.mesh.bounds().centre;
        let centre =
            reference.and_then(|pose| self.source.camera.project(&pose.transform(&middle)));
        let prompt = kind
            .prompt(&mask, centre, frame as u64)
            .with_context(|| format!("{} is too thin to click into", path.display()))?;
        let frames = self.source.frames.as_ref().context("there are no frames")?;
        let decoded = frames.decode(frame)?;
        let grey = grey(&decoded)?;
        let stated = self.args.shown.stated();
        let polarity = stated.unwrap_or_else(|| prompt.polarity(&*grey));
        let camera = &self.source.camera;
        let beside = self.known.beside(frame, camera)?;
        let neighbour = beside.as_ref().map(known::BesideFemur::neighbour);
        let clicked = match self
            .clicker
            .click(&*grey, prompt, polarity, neighbour.as_ref())
        {
            Ok(clicked) => clicked,
            Err(error) => {
                eprintln!("frame {}, {}: {error}", frame + 1, kind.word());
                return Ok(None);
            }
        };
        if self.args.verbose {
            self.tell(
                &format!("frame {} {} {prompt:?}", frame + 1, kind.word()),
                &clicked,
                &mask,
                reference.as_ref(),
            )?;
        }
        let (chosen, verdict) = self
            .known
            .chosen(&clicked.candidates, frame)
            .context("there is no candidate")?;
        let best = &chosen.pose;
        let drawn = draw(&self.mesh, &self.source.camera, best)?;
        if let Some(folder) = &self.args.pictures {
            let name = format!("{}-{:03}-{kind:?}.png", self.args.component, frame + 1);
            picture::write(&folder.join(name), &*grey, &mask, &drawn.mask(), &prompt)?;
        }
        let planes = self.clicker.planes();
        Ok(Some(Outcome {
            iou: overlap(&mask, &drawn.mask()),
            good: verdict == Verdict::Good,
            errors: reference.map(|reference| Errors::of(best, &reference)),
            wrong_side: reference.is_some_and(|reference| is_wrong_side(best, &reference, planes)),
            ms: clicked.took.as_secs_f64() * 1e3,
            step_ms: clicked.longest.as_secs_f64() * 1e3,
        }))
    }

    fn tell(
        &self,
        what: &str,
        clicked: &Clicked,
        mask: &Mask<'_>,
        reference: Option<&Pose>,
    ) -> Result<()> {
        eprintln!("{what}: {:.0} ms", clicked.took.as_secs_f64() * 1e3);
        let iou = |pose: &Pose| -> Result<f64> {
            let drawn = draw(&self.mesh, &self.source.camera, pose)?;
            Ok(overlap(mask, &drawn.mask()))
        };
        for start in &clicked.starts {
            let errors = reference.map(|known| Errors::of(&start.pose, known));
            let (turn, depth) = errors.map_or((f64::NAN, f64::NAN), |e| (e.geodesic_deg, e.z_mm));
            eprintln!(
                "  start: {turn:5.1} deg, z {depth:6.1} mm, iou {:.3}, score {:.3}, region {:.3}, edges {:.3}, share {:.3}",
                iou(&start.pose)?,
                start.score,
                start.overlap,
                start.support.strength,
                start.support.fraction
            );
        }
        for answer in &clicked.answers {
            let errors = reference.map(|known| Errors::of(&answer.refined.pose, known));
            let (turn, depth) = errors.map_or((f64::NAN, f64::NAN), |e| (e.geodesic_deg, e.z_mm));
            eprintln!(
                "  answer: {turn:5.1} deg, z {depth:6.1} mm, iou {:.3}, score {:.3}, share {:.3}, residual {:.2} px, loss {:.3}{}",
                iou(&answer.refined.pose)?,
                answer.score,
                answer.support.fraction,
                answer.refined.residual_px,
                answer.refined.loss,
                if answer.mirrored { ", mirrored" } else { "" }
            );
        }
        Ok(())
    }
}

/// The silhouette of a pose.
fn draw(mesh: &Model<'_>, camera: &Camera, pose: &Pose) -> Result<MaskBuffer> {
    let mut buffer = MaskBuffer::new(camera.width(), camera.height())?;
    let mut scratch = vec![Projected::default(); scratch_needed(mesh)];
    buffer.draw(|mask| render(mesh, camera, pose, &mut scratch, mask))?;
    Ok(buffer)
}

/// Pixels in both masks divided by those in either.
fn overlap(a: &Mask<'_>, b: &Mask<'_>) -> f64 {
    let count = |rule: fn(u32, u32) -> u32| -> f64 {
        let pairs = a.words().iter().zip(b.words());
        pairs
            .map(|(&a, &b)| f64::from(rule(a, b).count_ones()))
            .sum()
    };
    count(|a, b| a & b) / count(|a, b| a | b).max(1.0)
}

fn print(row: &Row) {
    println!(
        "{:22} {:3} frames, {} without an answer: overlap median {:.3}, least {:.3}; {:.0} ms, longest step {:.0} ms",
        row.prompt,
        row.frames,
        row.failed,
        row.median_iou,
        row.least_iou,
        row.median_ms,
        row.step_ms
    );
    if let Some(errors) = &row.median {
        println!(
            "{:22} median errors: x {:.2}, y {:.2}, z {:.2} mm; {:.2} deg; {} on the wrong side",
            "", errors.x_mm, errors.y_mm, errors.z_mm, errors.geodesic_deg, row.wrong_side
        );
        println!(
            "{:22} right {}, marked {}, wrong and called good {}",
            "", row.right, row.marked, row.wrong
        );
    }
}
