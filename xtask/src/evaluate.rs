//! Verb `evaluate`: poses from a study's masks against its reference poses.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use fluoropose::calibration::Calibration;
use fluoropose::camera::Camera;
use fluoropose::pose::{EulerPose, Pose};
use fluoropose::symmetry::{SymmetryPlane, symmetry_planes};
use fluoropose_decode::Model;
use serde::Serialize;

use crate::pipeline::accuracy::{Errors, is_wrong_side, median_absolute, rms};
use crate::pipeline::bound::{Comparison, Limit, Noise, Outlines, PoseLimits};
use crate::pipeline::build::{Pair, ViewOptions, build_library, progress};
use crate::pipeline::disturb::{DisturbanceOptions, Disturbed};
use crate::pipeline::files::{
    MaskBuffer, mesh_of, read_calibration, read_model, read_poses, write_json, write_poses,
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
Under each row of poses found here stand the bound of Cramer and Rao at the reference poses, for masks that are rounded to pixels and \
err in nothing else, and the error divided by it: masks traced by a hand or a network err more, and their ratio says how much. \
--jitter S and --occlude F disturb each mask as they do in `pose`; the bound is then that for rounding and jitter, for the \
part of the outline that is not hidden. Tables unknown.SOURCE = \"folder\" of a component name masks of pixels of which nothing is known.\n\n\
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
    #[command(flatten)]
    disturbance: DisturbanceOptions,
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
    /// Of poses found here: the limits at the reference poses, and the root mean square errors
    /// against them.
    pub limits: Option<Comparison>,
}

/// Runs the verb.
///
/// # Errors
/// For files that are missing, unreadable or do not belong together.
pub fn run(args: Args) -> Result<()> {
    let table = evaluate(
        &args.study,
        args.method,
        &args.disturbance,
        args.poses.as_deref(),
    )?;
    print_table(&table);
    write_json(args.json.as_deref(), &table)
}

/// What a component's poses are compared with.
struct Reference {
    model: Model,
    poses: Vec<EulerPose>,
    /// Planes in which the component is nearly symmetric.
    planes: Vec<SymmetryPlane>,
}

impl Reference {
    fn of(component: &Component) -> Result<Option<Self>> {
        let Some(path) = &component.reference else {
            return Ok(None);
        };
        let model = read_model(&component.model)?;
        Ok(Some(Self {
            poses: read_poses(path)?,
            planes: symmetry_planes(&mesh_of(&model)?).to_vec(),
            model,
        }))
    }
}

/// Evaluates a study; poses found are written to `poses`, or, where it is `None`, to the current
/// folder for components without a reference.
///
/// # Errors
/// For files that are missing, unreadable or do not belong together.
pub fn evaluate(
    study: &Path,
    method: Method,
    disturbance: &DisturbanceOptions,
    poses: Option<&Path>,
) -> Result<Table> {
    disturbance.check()?;
    let study = Study::read(study)?;
    let calibration = read_calibration(&study.calibration)?;
    let mut rows = Vec::new();
    for component in &study.components {
        let reference = Reference::of(component)?;
        for located in locate_component(component, &calibration, method, disturbance)? {
            if let Some(folder) = poses.or(reference.is_none().then_some(Path::new(""))) {
                let path = folder.join(format!("{}-{}.jts", component.name, located.source));
                write_poses(&path, &located.poses)?;
            }
            if let Some(reference) = &reference {
                let mut row = row(
                    component,
                    &located.source,
                    method.word(),
                    &located.poses,
                    reference,
                )?;
                row.limits = Some(located.limits(reference, disturbance, &row.rms)?);
                rows.push(row);
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

/// What was found in the masks of one source.
struct Located {
    source: String,
    camera: Camera,
    poses: Vec<EulerPose>,
    /// Pixels of each mask that say nothing.
    hidden: Vec<Option<MaskBuffer>>,
}

impl Located {
    /// The limits at the reference poses, and errors against them.
    fn limits(
        &self,
        reference: &Reference,
        disturbance: &DisturbanceOptions,
        rms: &Errors,
    ) -> Result<Comparison> {
        let noise = Noise::of(disturbance, 1);
        let mut outlines = Outlines::new(mesh_of(&reference.model)?, self.camera);
        let poses = reference.poses.iter().zip(&self.hidden);
        let limits: Result<Vec<PoseLimits>> = poses
            .map(|(&pose, hidden)| {
                let hidden = hidden.as_ref().map(MaskBuffer::mask);
                outlines
                    .pose_limits(&in_front(pose), &noise, hidden.as_ref())
                    .with_context(|| format!("at the reference {pose:?}"))
            })
            .collect();
        Ok(Comparison::of(noise, &limits?, rms))
    }
}

/// Poses of every mask source of a component, in the order of their names.
fn locate_component(
    component: &Component,
    calibration: &Calibration,
    method: Method,
    disturbance: &DisturbanceOptions,
) -> Result<Vec<Located>> {
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
        let unknown = component.unknown.get(name).map(PathBuf::as_path);
        let source = Source::read(folder, unknown, calibration)?;
        let seen: Result<Vec<_>> = source.disturbed(disturbance).collect();
        let seen = Seen {
            camera: source.camera,
            masks: seen?,
        };
        // Perspective depends on the distance: where nobody told it, the masks do, once.
        let distance = match views.distance {
            Some(distance) => distance,
            None => {
                let guess = views.distance_for(calibration);
                let poses = seen.find_poses(&model, &views, guess, Method::Library)?;
                median_absolute(&poses.iter().map(|p| p.z_mm).collect::<Vec<_>>())
            }
        };
        let poses = seen.find_poses(&model, &views, distance, method)?;
        all.push(Located {
            source: name.clone(),
            camera: source.camera,
            poses,
            hidden: seen
                .masks
                .into_iter()
                .map(|(_, mask)| mask.hidden)
                .collect(),
        });
    }
    Ok(all)
}

/// The masks of one source as the method gets to see them.
struct Seen<'s> {
    camera: Camera,
    masks: Vec<(&'s Path, Disturbed)>,
}

impl Seen<'_> {
    fn find_poses(
        &self,
        model: &Model,
        views: &ViewOptions,
        distance: f64,
        method: Method,
    ) -> Result<Vec<EulerPose>> {
        let mesh = mesh_of(model)?;
        let built = build_library(mesh, self.camera, views, distance)?;
        let mut finder = Finder::open(&built.bytes, mesh, self.camera, method)?;
        let bar = progress(self.masks.len(), "masks");
        let poses = self.masks.iter().map(|(path, mask)| {
            bar.inc(1);
            mask.see(|silhouette| finder.best(&silhouette.into()))
                .map(|best| EulerPose::from(best.pose))
                .with_context(|| format!("no pose for {}", path.display()))
        });
        poses.collect()
    }
}

fn row(
    component: &Component,
    source: &str,
    method: &str,
    found: &[EulerPose],
    reference: &Reference,
) -> Result<Row> {
    if found.len() != reference.poses.len() {
        bail!(
            "{} {source}: {} poses but {} reference poses; both must be of the same frames",
            component.name,
            found.len(),
            reference.poses.len()
        );
    }
    let pairs: Vec<(Pose, Pose)> = found
        .iter()
        .zip(&reference.poses)
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
        wrong_side: pairs
            .iter()
            .filter(|(found, known)| is_wrong_side(found, known, &reference.planes))
            .count(),
        limits: None,
    })
}

/// A pose in our camera frame, which looks along -z.
fn in_front(pose: EulerPose) -> Pose {
    let own = Pose::from(pose);
    if pose.z_mm > 0.0 {
        own.flip_camera_axes()
    } else {
        own
    }
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

/// Limits and ratios in the columns of the table.
fn print_limits(limits: &Comparison) {
    let line = |name: &str, l: &Limit| {
        println!(
            "{name:>39} {:7.3} {:7.3} {:7.2} {:26} {:9.3}",
            l.x_mm, l.y_mm, l.z_mm, "", l.geodesic_deg
        );
    };
    line("bound", &limits.bound);
    line("RMS / bound", &limits.ratio_to_bound);
    if limits.noise.jitter_px > 0.0 {
        line("plain least squares", &limits.least_squares);
        line("RMS / that", &limits.ratio_to_least_squares);
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
        if let Some(limits) = &row.limits {
            print_limits(limits);
        }
    }
}
