//! Verb `evaluate`: poses from a study's masks against its reference poses.

mod found;
mod inside;
mod limits;
mod mirrored;
mod print;
mod reference;
mod request;
mod table;

use std::path::{Path, PathBuf};

use crate::choice::report::{report, write_report};
use crate::choice::{Reasons, report, uncertain};
use crate::files::{
    Component, Study, check_outputs, read_calibration, read_poses_of, write_covariances,
    write_json, write_poses,
};
use crate::finding::{EdgeOptions, Method};
use crate::noise::{DisturbanceOptions, Noise};
use crate::options::study_files;
use anyhow::{Context, Result, bail, ensure};
use found::{Found, Part, find_parts};
pub use inside::Inside;
use mirrored::doubt_parts;
pub use request::Request;
pub use table::{Row, StartDifference, Table, Verdicts};

/// Options of `evaluate`.
#[derive(clap::Args)]
#[command(
    after_help = format!("For each component and each folder of masks that STUDY.toml names: root mean square and median absolute error against \
the reference poses, and the other methods' pose files named there in the same table. wrong counts frames whose pose is nearer to the \
reference's mirror image than to the reference. The mean error stands below as bias, and then the percent of frames in which each number lies within one and two of its standard deviations of the reference's: 68 and 95 where they are told right; then the same \
without the mean error, which no frame tells: the reference's, the calibration's, the model's. No frame is left out: those without a pose are counted, and the uncertainty table says why; a verdict (good, doubtful, none) says how far a pose is to be trusted. A component without a reference has no row; its poses are written with the others' where --poses is given.\n\n\
Of several poses of a frame one is chosen by its residual, where it decides; of a tibia by the coronal tilt against the femur of the same \
source; then by continuity over the frames. How many frames were chosen by what stands below each row. Components are femur and tibia by their names or \
by the key role = \"femur\" or \"tibia\".\n\n\
--method image needs the key frames; it also refines from the reference poses, and the difference from what was found stands below the row: \
where it is small, the start does not matter.\n\n\
Under each row of poses found here stand the bound of Cramer and Rao at the reference poses, for masks that are rounded to pixels and \
err in nothing else, and the error divided by it: masks traced by a hand or a network err more, and their ratio says how much. \
--jitter S and --occlude F disturb each mask as they do in `pose`; the bound is then that for rounding and jitter, for the \
part of the outline that is not hidden. Tables unknown.SOURCE = \"folder\" of a component name masks of pixels of which nothing is known.\n\n{}\n\n\
Example:\n  cargo xtask evaluate --study study.toml --json table.json --poses found", report::HELP)
)]
pub struct Args {
    /// Study file, or its folder
    #[arg(long, value_parser = study_files())]
    study: PathBuf,
    /// Only masks of this source [default: all]
    #[arg(long, value_name = "NAME")]
    source: Option<String>,
    /// How poses are found
    #[arg(long, value_enum, default_value_t)]
    method: Method,
    #[command(flatten)]
    edges: EdgeOptions,
    /// Method refined: take away how far the masks of a source lie off the film's edges everywhere, as the key frames tell it
    #[arg(long)]
    centred: bool,
    /// Write the table as JSON
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Folder for the poses found, made if absent: COMPONENT-SOURCE.jts each, with the uncertainty table
    /// COMPONENT-SOURCE.csv and the covariances beside it; needed where no component has a reference
    #[arg(long, value_name = "DIR")]
    poses: Option<PathBuf>,
    #[command(flatten)]
    disturbance: DisturbanceOptions,
}

/// Runs the verb.
///
/// # Errors
/// For files that are missing, unreadable or do not belong together.
pub fn run(args: Args) -> Result<()> {
    args.edges.check(args.method)?;
    ensure!(
        args.method == Method::Refined || !args.centred,
        "--centred is of --method refined, not {}",
        args.method.word()
    );
    check_outputs(&[("--json", args.json.as_deref())], [Some(&*args.study)])?;
    let request = Request {
        source: args.source.as_deref(),
        method: args.method,
        edges: args.edges,
        centred: args.centred,
        disturbance: args.disturbance,
        poses: args.poses.as_deref(),
    };
    let table = evaluate(&args.study, &request)?;
    match table.rows.is_empty() {
        true => println!(
            "{}: no component has a reference; poses are written to {} and compared with nothing",
            table.study,
            args.poses.as_deref().unwrap_or(Path::new("")).display()
        ),
        false => print::print(&table),
    }
    write_json(args.json.as_deref(), &table)
}

/// Evaluates a study.
///
/// # Errors
/// For files that are missing, unreadable or do not belong together.
pub fn evaluate(path: &Path, request: &Request<'_>) -> Result<Table> {
    request.disturbance.check()?;
    let study = Study::read(path)?;
    let frames = request.asks_frames().then(|| study.frames_folder());
    study.check_files(frames.transpose()?)?;
    study.check_sizes()?;
    if let Some(source) = request.source
        && !study
            .components
            .iter()
            .any(|c| c.masks.contains_key(source))
    {
        bail!("{} names no masks of a source '{source}'", path.display());
    }
    if !study.components.iter().any(is_evaluated) {
        bail!(
            "{} names nothing to evaluate: a component has masks, as in masks.hand = \"masks/femur\", or a reference and the poses of another \
             method, as in reference = \"femur.jts\" and peer.other = \"other.jts\"",
            path.display()
        );
    }
    check_purpose(&study, request)?;
    // Before hours of work.
    if let Some(folder) = request.poses {
        std::fs::create_dir_all(folder)
            .with_context(|| format!("cannot make the folder {}", folder.display()))?;
    }
    let calibration = read_calibration(&study.calibration)?;
    let mut rows = Vec::new();
    let mut parts = find_parts(&study, &calibration, request)?;
    doubt_parts(&mut parts)?;
    for part in parts {
        for found in &part.found {
            part.write(found, request.poses)?;
            rows.extend(part.row(found, request)?);
        }
        rows.extend(part.peers(study.frames.as_deref())?);
    }
    Ok(Table {
        study: study.name,
        rows,
    })
}

/// Whether a component has poses to be found or to be compared.
fn is_evaluated(component: &Component) -> bool {
    let is_compared = component.reference.is_some() && !component.peer.is_empty();
    is_compared || !component.masks.is_empty()
}

/// Refuses work whose poses would neither be compared nor written; of single components it is said.
fn check_purpose(study: &Study, request: &Request<'_>) -> Result<()> {
    if request.poses.is_some() {
        return Ok(());
    }
    ensure!(
        study.components.iter().any(|one| one.reference.is_some()),
        "no component of {} has reference poses to compare with: name their file as reference in its [[component]], or a folder for the poses \
         that are found, by --poses",
        study.name
    );
    let alone = study
        .components
        .iter()
        .filter(|one| one.reference.is_none());
    for component in alone.filter(|one| !one.masks.is_empty()) {
        eprintln!(
            "the component {} has no reference: its poses are compared with nothing, and are not written (--poses names a folder for them)",
            component.name
        );
    }
    Ok(())
}

impl Part<'_> {
    /// Writes poses and their uncertainty.
    fn write(&self, found: &Found, folder: Option<&Path>) -> Result<()> {
        let Some(folder) = folder else {
            return Ok(());
        };
        let path = folder.join(format!("{}-{}.jts", self.component.name, found.source));
        write_poses(&path, &found.rows())?;
        write_covariances(&path, uncertain(&found.decisions, found.film.is_some()))?;
        let middle = self.model.as_model().bounds().centre;
        let frames = report(&found.frames, &found.decisions, &middle);
        write_report(&path.with_extension("csv"), &frames)
    }

    /// The row of a source, where there is a reference.
    fn row(&self, found: &Found, request: &Request<'_>) -> Result<Option<Row>> {
        let Some(reference) = &self.reference else {
            return Ok(None);
        };
        let poses = found.poses();
        let names = [&self.component.name, &found.source, request.method.word()];
        let mut row = reference.row(names, &poses)?;
        row.verdicts = Some(Verdicts::of(&found.decisions));
        row.reasons = Some(Reasons::of(&found.decisions));
        row.femur.clone_from(&found.femur);
        row.film.clone_from(&found.film);
        let starts = found.from_reference.as_deref();
        row.from_reference = starts.map(|starts| StartDifference::of(&poses, starts));
        let noise = Noise::of(&request.disturbance, 1);
        let mesh = self.model.as_model();
        let middle = mesh.bounds().centre;
        row.inside = inside::Inside::of(&found.decisions, &reference.poses, &middle);
        row.limits = Some(limits::against(reference, mesh, found, noise, &row.rms)?);
        Ok(Some(row))
    }

    /// The rows of other methods' pose files.
    fn peers(&self, frames: Option<&Path>) -> Result<Vec<Row>> {
        let Some(reference) = &self.reference else {
            return Ok(Vec::new());
        };
        let peers = self.component.peer.iter().map(|(source, path)| {
            let poses = read_poses_of(path, frames)?;
            reference.row([&self.component.name, source, "peer"], &poses)
        });
        peers.collect()
    }
}
