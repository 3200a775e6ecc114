//! Verb `evaluate`: poses from a study's masks against its reference poses.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use fluoropose::calibration::Calibration;
use fluoropose::pose::{EulerPose, Pose};
use fluoropose::silhouette::Silhouette;
use fluoropose_decode::Model;
use serde::Serialize;

use crate::pipeline::accuracy::{Errors, is_wrong_side, median_absolute, rms};
use crate::pipeline::build::{Pair, ViewOptions, build_library, progress};
use crate::pipeline::files::{
    mesh_of, read_calibration, read_model, read_poses, write_json, write_poses,
};
use crate::pipeline::finder::{Finder, Method};
use crate::pipeline::source::Source;
use crate::pipeline::study::{Component, Study};

/// Options of `evaluate`.
#[derive(clap::Args)]
#[command(
    after_help = "For each component and each folder of masks that STUDY.toml names: root mean square and median absolute error against \
the reference poses, and the other methods' pose files named there in the same table. wrong_side counts frames whose pose is nearer to the \
reference's mirror image than to the reference. No frame is left out. A component without a reference has its poses written and no row.\n\n\
Example:\n  cargo xtask evaluate --study study.toml --json table.json --poses found"
)]
pub struct Args {
    /// Study file
    #[arg(long)]
    study: PathBuf,
    /// How poses are found
    #[arg(long, value_enum, default_value_t)]
    method: Method,
    /// Write the table as JSON
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Folder for the poses found: COMPONENT-SOURCE.jts each [default: written only for
    /// components without a reference, to the current folder]
    #[arg(long, value_name = "DIR")]
    poses: Option<PathBuf>,
}

/// The table of a study.
#[derive(Debug, Serialize)]
pub struct Table {
    /// Name of the study.
    pub study: String,
    /// A row for each component, source and method.
    pub rows: Vec<Row>,
}

/// One row: errors of one method on one source.
#[derive(Debug, Serialize)]
pub struct Row {
    /// Name of the component.
    pub component: String,
    /// Name of the mask source, or of the other method's pose file.
    pub source: String,
    /// The method's word, or `peer` for another method's file.
    pub method: String,
    /// Number of frames, all of which count.
    pub frames: usize,
    /// Root mean square errors.
    pub rms: Errors,
    /// Median absolute errors.
    pub median: Errors,
    /// Frames nearer to the reference's mirror image than to the reference.
    pub wrong_side: usize,
}

/// Runs the verb.
///
/// # Errors
/// For files that are missing, unreadable or do not belong together.
pub fn run(args: Args) -> Result<()> {
    let table = evaluate(&args.study, args.method, args.poses.as_deref())?;
    print_table(&table);
    write_json(args.json.as_deref(), &table)
}

/// Evaluates a study; poses found are written to `poses`, or, where it is `None`, to the current
/// folder for components without a reference.
///
/// # Errors
/// For files that are missing, unreadable or do not belong together.
pub fn evaluate(study: &Path, method: Method, poses: Option<&Path>) -> Result<Table> {
    let study = Study::read(study)?;
    let calibration = read_calibration(&study.calibration)?;
    let mut rows = Vec::new();
    for component in &study.components {
        let reference = component.reference.as_deref().map(read_poses).transpose()?;
        for (source, found) in locate_component(component, &calibration, method)? {
            if let Some(folder) = poses.or(reference.is_none().then_some(Path::new(""))) {
                let path = folder.join(format!("{}-{source}.jts", component.name));
                write_poses(&path, &found)?;
            }
            if let Some(reference) = &reference {
                rows.push(row(component, &source, method.word(), &found, reference)?);
            }
        }
        for (source, path) in &component.peer {
            if let Some(reference) = &reference {
                let found = read_poses(path)?;
                rows.push(row(component, source, "peer", &found, reference)?);
            }
        }
    }
    Ok(Table {
        study: study.name,
        rows,
    })
}

/// Poses of every mask source of a component, in the order of their names.
fn locate_component(
    component: &Component,
    calibration: &Calibration,
    method: Method,
) -> Result<Vec<(String, Vec<EulerPose>)>> {
    let model = read_model(&component.model)
        .with_context(|| format!("for the component {}", component.name))?;
    let [x, y] = component.nominal;
    let views = ViewOptions {
        nominal: Pair([x, y]),
        distance: component.distance_mm,
        ..ViewOptions::default()
    };
    let mut all = Vec::new();
    for (name, folder) in &component.masks {
        let source = Source::read(folder, calibration)?;
        // Perspective depends on the distance: where nobody told it, the masks do, once.
        let distance = match views.distance {
            Some(distance) => distance,
            None => {
                let guess = views.distance_for(calibration);
                let poses = find_poses(&source, &model, &views, guess, Method::Library)?;
                median_absolute(&poses.iter().map(|p| p.z_mm).collect::<Vec<_>>())
            }
        };
        let poses = find_poses(&source, &model, &views, distance, method)?;
        all.push((name.clone(), poses));
    }
    Ok(all)
}

fn find_poses(
    source: &Source,
    model: &Model,
    views: &ViewOptions,
    distance: f64,
    method: Method,
) -> Result<Vec<EulerPose>> {
    let mesh = mesh_of(model)?;
    let built = build_library(mesh, source.camera, views, distance)?;
    let mut finder = Finder::open(&built.bytes, mesh, source.camera, method)?;
    let bar = progress(source.masks.len(), "masks");
    let poses = source.masks.iter().map(|(path, buffer)| {
        bar.inc(1);
        finder
            .best(&Silhouette::from(&buffer.mask()).into())
            .map(|best| EulerPose::from(best.pose))
            .with_context(|| format!("no pose for {}", path.display()))
    });
    poses.collect()
}

fn row(
    component: &Component,
    source: &str,
    method: &str,
    found: &[EulerPose],
    reference: &[EulerPose],
) -> Result<Row> {
    if found.len() != reference.len() {
        bail!(
            "{} {source}: {} poses but {} reference poses; both must be of the same frames",
            component.name,
            found.len(),
            reference.len()
        );
    }
    let pairs: Vec<(Pose, Pose)> = found
        .iter()
        .zip(reference)
        .map(|(&found, &reference)| in_frame_of(found, reference))
        .collect();
    let errors: Vec<Errors> = pairs.iter().map(|(a, b)| Errors::of(a, b)).collect();
    Ok(Row {
        component: component.name.clone(),
        source: source.to_owned(),
        method: method.to_owned(),
        frames: errors.len(),
        rms: Errors::summarise(&errors, rms),
        median: Errors::summarise(&errors, median_absolute),
        wrong_side: pairs.iter().filter(|(a, b)| is_wrong_side(a, b)).count(),
    })
}

/// Both poses in the reference's own camera frame. A reference in front of a camera that looks
/// along +z (computer vision, as camera-matrix studies may have) has positive z; ours never do.
fn in_frame_of(found: EulerPose, reference: EulerPose) -> (Pose, Pose) {
    let (found, reference_pose) = (Pose::from(found), Pose::from(reference));
    if reference.z_mm * found.translation[2] < 0.0 {
        (found.flip_camera_axes(), reference_pose)
    } else {
        (found, reference_pose)
    }
}

fn print_table(table: &Table) {
    println!(
        "{}: error against the reference, RMS over all frames (median absolute below)",
        table.study
    );
    println!(
        "{:<10} {:<12} {:<8} {:>6} {:>7} {:>7} {:>7} {:>8} {:>8} {:>8} {:>9} {:>6}",
        "component",
        "source",
        "method",
        "frames",
        "x mm",
        "y mm",
        "z mm",
        "z_rot",
        "x_rot",
        "y_rot",
        "geodesic",
        "wrong"
    );
    for row in &table.rows {
        let numbers = |e: &Errors| {
            format!(
                "{:7.3} {:7.3} {:7.2} {:8.3} {:8.3} {:8.3} {:9.3}",
                e.x_mm, e.y_mm, e.z_mm, e.z_rot_deg, e.x_rot_deg, e.y_rot_deg, e.geodesic_deg
            )
        };
        println!(
            "{:<10} {:<12} {:<8} {:>6} {} {:>6}",
            row.component,
            row.source,
            row.method,
            row.frames,
            numbers(&row.rms),
            row.wrong_side
        );
        println!("{:<39} {}", "", numbers(&row.median));
    }
}
